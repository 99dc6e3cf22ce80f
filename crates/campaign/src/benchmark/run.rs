//! All records, all methods, all answers. The work is shared by threads; what comes out has the order of the
//! definition.

use rayon::prelude::*;
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::StreamKey;
use trial::{Scales, Trial};

use crate::Observer;
use crate::benchmark::cases::{BenchCase, BenchTask, CaseAnswer, MEASURED, Naming, stored};
use crate::benchmark::definition::{Definition, Question, RecordFile, RecordSet, SetRecord, SetSource};
use crate::benchmark::method::{self, BenchMethod, BenchModel, Failed};
use crate::benchmark::record_store::{RecordStore, UsedFile};
use crate::benchmark::results::{BenchDocument, Present, Skipped};
use crate::engine::{self, simulate, truths};
use crate::failure::Failure;
use crate::statistics::grouped;
use crate::task::Task;

/// The records of one set or of one trial of it.
struct BenchTrial<'a> {
    set: &'a RecordSet,
    trial: Option<u64>,
    /// In the order of the set; none for what is not there.
    records: Vec<Option<Trial>>,
    /// The ship, where it is first order.
    truth: Option<FirstOrder>,
    key: StreamKey,
}

/// Why a fit is missing that was not asked of every method.
pub const STOPPED: &str = "the run was stopped before every method had answered";

/// Questions that have their fit in common.
struct SharedFit<'a> {
    trial: &'a BenchTrial<'a>,
    questions: Vec<&'a Question>,
    records: Vec<Trial>,
}

/// Runs a benchmark: every method on the records that are there. Where there is something to ask, `begin` is called
/// before the first answer, to see to the place of results.
///
/// Where it is asked to stop, what every method has answered is kept, and the rest is skipped as [`STOPPED`].
///
/// Fails when two methods have one label, when records of a set are of different scale, when `begin` fails, and when it
/// is asked to stop before anything was answered.
pub fn run(
    definition: &Definition,
    store: &RecordStore,
    methods: &[BenchMethod],
    observer: &dyn Observer,
    begin: impl FnOnce() -> Result<(), Failure>,
) -> Result<BenchDocument, Failure> {
    method::check_labels(methods)?;
    let (mut trials, mut present, mut skipped) = (Vec::new(), Vec::new(), Vec::new());
    for (number, set) in definition.sets.iter().enumerate() {
        let (own, found) = match &set.source {
            SetSource::Measured { copies, .. } => measured(set, copies, number, store, &mut skipped)?,
            SetSource::Simulated { .. } => (simulated(set, &mut skipped), Vec::new()),
        };
        present.push(Present::of(set, found, own.len()));
        trials.extend(own);
    }
    let fits: Vec<SharedFit> = trials.iter().flat_map(fits_of).collect();
    let work: Vec<(&SharedFit, &BenchMethod)> =
        fits.iter().flat_map(|fit| methods.iter().map(move |method| (fit, method))).collect();
    if !work.is_empty() {
        begin()?;
    }
    observer.begin(work.len() as u64, 0);
    let answer = |(fit, method): &(&SharedFit, &BenchMethod)| {
        let answers = (!observer.is_asked_to_stop()).then(|| answers(fit, method));
        observer.advance();
        answers
    };
    let answers: Vec<Option<Vec<Option<CaseAnswer>>>> = work.par_iter().map(answer).collect();
    observer.end();
    let (mut cases, mut unanswered) = (Vec::new(), Vec::new());
    for (fit, answers) in fits.iter().zip(answers.chunks(methods.len().max(1))) {
        // Only what all methods were asked can be compared.
        let answers: Option<Vec<&Vec<Option<CaseAnswer>>>> = answers.iter().map(Option::as_ref).collect();
        let Some(answers) = answers else {
            unanswered.push(fit.trial.set.name.as_str());
            continue;
        };
        for (place, question) in fit.questions.iter().enumerate() {
            let own = answers.iter().filter_map(|of_method| of_method[place].clone());
            cases.push(case(fit.trial, question, own.collect()));
        }
    }
    cases.retain(|case| !case.answers.is_empty());
    if cases.is_empty() && !unanswered.is_empty() {
        return Err(Failure::work("stopped; nothing was written"));
    }
    let stopped = grouped(unanswered, |set| *set).into_iter().map(|(set, fits)| Skipped {
        set: set.to_owned(),
        record: format!("{} of its fits", fits.len()),
        reason: STOPPED.to_owned(),
    });
    skipped.extend(stopped);
    // By task, as they are read; within a task in the order of the definition.
    cases.sort_by_key(|case| case.task);
    Ok(BenchDocument::of(definition, methods, present, skipped, cases))
}

fn measured<'a>(
    set: &'a RecordSet,
    copies: &[Vec<RecordFile>],
    number: usize,
    store: &RecordStore,
    skipped: &mut Vec<Skipped>,
) -> Result<(Vec<BenchTrial<'a>>, Vec<Option<UsedFile>>), Failure> {
    let mut take = |(place, (record, copies)): (usize, (&SetRecord, &Vec<RecordFile>))| {
        let is_asked_for = |question: &Question| question.fit.contains(&place) || question.score == Some(place);
        if !set.questions.iter().any(is_asked_for) {
            return (None, None);
        }
        match store.take(copies) {
            Ok((trial, file)) => (Some(trial), Some(file)),
            Err(reason) => {
                skipped.push(Skipped { set: set.name.clone(), record: record.name.clone(), reason });
                (None, None)
            }
        }
    };
    let (records, files): (Vec<Option<Trial>>, Vec<_>) =
        set.records.iter().zip(copies).enumerate().map(&mut take).unzip();
    let several = match Scales::among(records.iter().flatten()) {
        Ok(None) => None,
        Ok(Some(scales)) => Some(format!("its records are of {} scales", scales.particulars.len())),
        Err(error) => Some(error.to_string()),
    };
    if let Some(why) = several {
        return Err(Failure::input(format!("set {}: {why}; make a set for every scale", set.name)));
    }
    let key = StreamKey { seed: 0, cell: number as u64, replicate: 0 };
    let is_there = records.iter().any(Option::is_some);
    let trial = is_there.then_some(BenchTrial { set, trial: None, records, truth: None, key });
    Ok((trial.into_iter().collect(), files))
}

fn simulated<'a>(set: &'a RecordSet, skipped: &mut Vec<Skipped>) -> Vec<BenchTrial<'a>> {
    let SetSource::Simulated { scenario, cell } = &set.source else { return Vec::new() };
    let of_replicate = |replicate: u64| {
        let task = Task { cell: *cell, replicate };
        let refused = |reason| Skipped { set: set.name.clone(), record: format!("trial {replicate}"), reason };
        let records = simulate(scenario, task).map_err(refused)?;
        let truth = match !scenario.cells[*cell].is_nearest() {
            true => truths(scenario, task).map_err(refused)?.nearest,
            false => None,
        };
        let records = records.into_iter().map(|simulated| Some(simulated.trial)).collect();
        Ok(BenchTrial { set, trial: Some(replicate), records, truth, key: engine::key(scenario, task) })
    };
    let trials: Vec<Result<BenchTrial, Skipped>> = (0..scenario.replicates).into_par_iter().map(of_replicate).collect();
    trials.into_iter().filter_map(|trial| trial.map_err(|refused| skipped.push(refused)).ok()).collect()
}

/// The questions of a trial whose records are there, those with one fit together.
fn fits_of<'a>(trial: &'a BenchTrial<'a>) -> impl Iterator<Item = SharedFit<'a>> {
    let is_there = |record: &usize| trial.records[*record].is_some();
    let asked = trial.set.questions.iter().filter(move |own| own.fit.iter().chain(&own.score).all(is_there));
    grouped(asked, |question| question.fit.as_slice()).into_iter().map(|(fit, questions)| {
        let records = fit.iter().filter_map(|&record| trial.records[record].clone()).collect();
        SharedFit { trial, questions, records }
    })
}

/// The answers of a method to the questions of a fit; none to what it does not answer at all.
fn answers(fit: &SharedFit, method: &BenchMethod) -> Vec<Option<CaseAnswer>> {
    let takes_part = |task: BenchTask| match task {
        BenchTask::Indices => method.has_indices(),
        BenchTask::Name => method.names_effects(),
        _ => true,
    };
    if !fit.questions.iter().any(|question| takes_part(question.task)) {
        return vec![None; fit.questions.len()];
    }
    let model = method.fit(&fit.records, &fit.trial.key);
    let answer = |question: &&Question| {
        let answer = model.as_ref().map_err(Clone::clone).and_then(|model| answered(fit.trial, question, model));
        let answer = answer.unwrap_or_else(|Failed { kind, reason }| CaseAnswer {
            failure: Some(kind),
            reason: Some(reason),
            ..CaseAnswer::default()
        });
        takes_part(question.task).then(|| CaseAnswer { method: method.label().to_owned(), ..answer })
    };
    fit.questions.iter().map(answer).collect()
}

fn answered(trial: &BenchTrial, question: &Question, model: &BenchModel) -> Result<CaseAnswer, Failed> {
    match question.task {
        BenchTask::Name => {
            let named = model.named().unwrap_or_default();
            let naming = Some(Naming::of(missing(trial).as_deref(), &named));
            Ok(CaseAnswer { naming, named, ..CaseAnswer::default() })
        }
        BenchTask::Indices => indices(trial, model).ok_or_else(|| Failed::of("not-finite", &"K or T is not finite")),
        _ => {
            let scored = question.score.and_then(|record| trial.records[record].as_ref());
            let fitted = question.score.and_then(|record| question.fit.iter().position(|own| *own == record));
            let error = scored.and_then(|record| model.heading_error(record, fitted));
            let error = error.ok_or_else(|| Failed::of("not-finite", &"the replay leaves the range of numbers"))?;
            Ok(CaseAnswer { score: Some(stored(to_deg(error))), ..CaseAnswer::default() })
        }
    }
}

/// Errors of K and T of a ship that is first order.
fn indices(trial: &BenchTrial, model: &BenchModel) -> Option<CaseAnswer> {
    let truth = trial.truth?;
    let found = model.indices()?;
    let truths = [truth.K(), truth.T()];
    let errors = [0, 1].map(|index| stored(100.0 * (found[index].value / truths[index] - 1.0)));
    let holds = |index: usize| {
        let [low, high] = found[index].ci95?;
        Some((low..=high).contains(&truths[index]))
    };
    let holds = holds(0).zip(holds(1)).map(|(k, t)| [k, t]);
    let score = errors[0].abs().max(errors[1].abs());
    let is_finite = errors.iter().all(|error| error.is_finite());
    is_finite.then(|| CaseAnswer { score: Some(score), errors_percent: Some(errors), holds, ..CaseAnswer::default() })
}

/// The effect that the ship of a trial lacks.
fn missing(trial: &BenchTrial) -> Option<String> {
    match &trial.set.source {
        SetSource::Simulated { scenario, cell } => scenario.cells[*cell].missing().into_iter().next(),
        SetSource::Measured { .. } => None,
    }
}

fn case(trial: &BenchTrial, question: &Question, answers: Vec<CaseAnswer>) -> BenchCase {
    let name = |record: usize| trial.set.records[record].name.clone();
    BenchCase {
        task: question.task,
        field: if trial.trial.is_some() { trial.set.group.clone() } else { MEASURED.to_owned() },
        set: trial.set.name.clone(),
        trial: trial.trial,
        fitted: question.fit.iter().copied().map(name).collect(),
        scored: question.score.map(name),
        missing: if question.task == BenchTask::Name { missing(trial) } else { None },
        answers,
    }
}

#[cfg(test)]
mod tests;
