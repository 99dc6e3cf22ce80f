//! All records, all methods, all answers. The work is shared by threads; what comes out has the order of the
//! definition.

use crate::Observer;
use crate::engine::{simulate, truths};
use crate::task::Task as Replicate;
use rayon::prelude::*;
use scenario::failure::Failure;
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::StreamKey;
use trial::{Scales, Trial};

use crate::benchmark::cases::{Answer, Case, MEASURED, Naming, stored};
use crate::benchmark::definition::{Definition, Question, RecordFile, Set, Source};
use crate::benchmark::method::{self, Failed, Method, Model};
use crate::benchmark::results::{self, Present, Results, Skipped};
use crate::benchmark::shelf::{Shelf, UsedFile};
use crate::benchmark::task::Task;

/// What is entered.
pub struct Entry<'a> {
    /// The benchmark.
    pub definition: &'a Definition,
    /// Where measured records are.
    pub shelf: &'a Shelf,
    /// Who takes part.
    pub methods: &'a [Method],
}

/// The records of one set or of one trial of it.
struct Unit<'a> {
    set: &'a Set,
    trial: Option<u64>,
    /// In the order of the set; none for what is not there.
    records: Vec<Option<Trial>>,
    /// The ship, where it is first order.
    truth: Option<FirstOrder>,
    key: StreamKey,
}

/// Questions that have their fit in common.
struct Fit<'a> {
    unit: &'a Unit<'a>,
    questions: Vec<&'a Question>,
    trials: Vec<Trial>,
}

/// Runs a benchmark.
///
/// Fails when two methods have one label, when records of a set are of different scale, and when it is asked to stop.
pub fn run(entry: &Entry, observer: &dyn Observer) -> Result<Results, Failure> {
    let Entry { definition, shelf, methods } = entry;
    method::distinct(methods)?;
    let (mut units, mut present, mut skipped) = (Vec::new(), Vec::new(), Vec::new());
    for (number, set) in definition.sets.iter().enumerate() {
        let (own, found) = match &set.source {
            Source::Measured { copies, .. } => measured(set, copies, number, shelf, &mut skipped)?,
            Source::Simulated { .. } => (simulated(set, &mut skipped), Vec::new()),
        };
        present.push(Present::of(set, found, own.len()));
        units.extend(own);
    }
    let fits: Vec<Fit> = units.iter().flat_map(fits_of).collect();
    let work: Vec<(&Fit, &Method)> =
        fits.iter().flat_map(|fit| methods.iter().map(move |method| (fit, method))).collect();
    observer.begin(work.len() as u64, 0);
    let answers: Vec<Option<Vec<Option<Answer>>>> = work
        .par_iter()
        .map(|(fit, method)| {
            let answers = (!observer.is_asked_to_stop()).then(|| answers(fit, method));
            observer.advance();
            answers
        })
        .collect();
    observer.end();
    let Some(answers) = answers.into_iter().collect::<Option<Vec<_>>>() else {
        return Err(Failure::work("stopped; nothing was written"));
    };
    let mut cases = Vec::new();
    for (fit, answers) in fits.iter().zip(answers.chunks(methods.len().max(1))) {
        for (place, question) in fit.questions.iter().enumerate() {
            let own = answers.iter().filter_map(|of_method| of_method[place].clone());
            cases.push(case(fit.unit, question, own.collect()));
        }
    }
    cases.retain(|case| !case.answers.is_empty());
    // By task, as they are read; within a task in the order of the definition.
    cases.sort_by_key(|case| case.task);
    let words = |of: fn(&Method) -> &str| methods.iter().map(|method| of(method).to_owned()).collect();
    let words = [words(Method::label), words(Method::summary)];
    Ok(results::of(definition, words, present, skipped, cases))
}

fn measured<'a>(
    set: &'a Set,
    copies: &[Vec<RecordFile>],
    number: usize,
    shelf: &Shelf,
    skipped: &mut Vec<Skipped>,
) -> Result<(Vec<Unit<'a>>, Vec<Option<UsedFile>>), Failure> {
    let mut records = Vec::new();
    let mut found = Vec::new();
    for (place, (member, copies)) in set.records.iter().zip(copies).enumerate() {
        let is_asked_for = |question: &Question| question.fit.contains(&place) || question.score == Some(place);
        if !set.questions.iter().any(is_asked_for) {
            found.push(None);
            records.push(None);
            continue;
        }
        match shelf.take(copies) {
            Ok(own) => {
                found.push(Some(own.file));
                records.push(Some(own.trial));
            }
            Err(reason) => {
                skipped.push(Skipped { set: set.name.clone(), record: member.name.clone(), reason });
                found.push(None);
                records.push(None);
            }
        }
    }
    let scales = Scales::among(records.iter().flatten()).map_err(|error| error.to_string());
    let several = match scales {
        Ok(None) => None,
        Ok(Some(scales)) => Some(format!("its records are of {} scales", scales.particulars.len())),
        Err(error) => Some(error),
    };
    if let Some(why) = several {
        return Err(Failure::input(format!("set {}: {why}; make a set for every scale", set.name)));
    }
    if records.iter().all(Option::is_none) {
        return Ok((Vec::new(), found));
    }
    let key = StreamKey { seed: 0, cell: number as u64, replicate: 0 };
    Ok((vec![Unit { set, trial: None, records, truth: None, key }], found))
}

fn simulated<'a>(set: &'a Set, skipped: &mut Vec<Skipped>) -> Vec<Unit<'a>> {
    let Source::Simulated { scenario, cell } = &set.source else { return Vec::new() };
    let trials: Vec<Result<Unit, Skipped>> = (0..scenario.replicates)
        .into_par_iter()
        .map(|replicate| {
            let task = Replicate { cell: *cell, replicate };
            let refused = |reason| Skipped { set: set.name.clone(), record: format!("trial {replicate}"), reason };
            let records = simulate(scenario, task).map_err(refused)?;
            let truth = match scenario.cells[*cell].is_first_order() {
                true => truths(scenario, task).map_err(refused)?.nearest,
                false => None,
            };
            let records = records.into_iter().map(|simulated| Some(simulated.trial)).collect();
            Ok(Unit { set, trial: Some(replicate), records, truth, key: crate::engine::key(scenario, task) })
        })
        .collect();
    let mut units = Vec::new();
    for trial in trials {
        match trial {
            Ok(unit) => units.push(unit),
            Err(refused) => skipped.push(refused),
        }
    }
    units
}

/// The questions of a unit whose records are there, those with one fit together.
fn fits_of<'a>(unit: &'a Unit<'a>) -> Vec<Fit<'a>> {
    let mut fits: Vec<(&[usize], Fit)> = Vec::new();
    let is_there = |record: &usize| unit.records[*record].is_some();
    for question in &unit.set.questions {
        if !question.fit.iter().chain(&question.score).all(is_there) {
            continue;
        }
        match fits.iter_mut().find(|(own, _)| *own == question.fit.as_slice()) {
            Some((_, fit)) => fit.questions.push(question),
            None => {
                let trials = question.fit.iter().filter_map(|&record| unit.records[record].clone()).collect();
                fits.push((&question.fit, Fit { unit, questions: vec![question], trials }));
            }
        }
    }
    fits.into_iter().map(|(_, fit)| fit).collect()
}

/// The answers of a method to the questions of a fit; none to what it does not answer at all.
fn answers(fit: &Fit, method: &Method) -> Vec<Option<Answer>> {
    let takes_part = |task: Task| match task {
        Task::Indices => method.has_indices(),
        Task::Name => method.names_effects(),
        _ => true,
    };
    if !fit.questions.iter().any(|question| takes_part(question.task)) {
        return vec![None; fit.questions.len()];
    }
    let model = method.fit(&fit.trials, &fit.unit.key);
    let answer = |question: &&Question| {
        let own = match &model {
            Err(failed) => failure(failed.clone()),
            Ok(model) => answered(fit.unit, question, model),
        };
        takes_part(question.task).then(|| Answer { method: method.label().to_owned(), ..own })
    };
    fit.questions.iter().map(answer).collect()
}

fn failure(Failed { kind, reason }: Failed) -> Answer {
    Answer { failure: Some(kind), reason: Some(reason), ..Answer::default() }
}

fn answered(unit: &Unit, question: &Question, model: &Model) -> Answer {
    match question.task {
        Task::Name => {
            let named = model.named().unwrap_or_default();
            Answer { naming: Some(Naming::of(missing(unit).as_deref(), &named)), named, ..Answer::default() }
        }
        Task::Indices => indices(unit, model).unwrap_or_else(|| {
            let reason = "K or T is not finite".to_owned();
            failure(Failed { kind: "not-finite".to_owned(), reason })
        }),
        _ => {
            let scored = question.score.and_then(|record| unit.records[record].as_ref());
            let fitted = question.score.and_then(|record| question.fit.iter().position(|own| *own == record));
            match scored.and_then(|trial| model.heading_error(trial, fitted)) {
                Some(error) => Answer { score: Some(stored(to_deg(error))), ..Answer::default() },
                None => {
                    let reason = "the replay leaves the range of numbers".to_owned();
                    failure(Failed { kind: "not-finite".to_owned(), reason })
                }
            }
        }
    }
}

/// Errors of K and T of a ship that is first order.
fn indices(unit: &Unit, model: &Model) -> Option<Answer> {
    let truth = unit.truth?;
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
    is_finite.then(|| Answer { score: Some(score), errors_percent: Some(errors), holds, ..Answer::default() })
}

/// The effect that the ship of a unit lacks.
fn missing(unit: &Unit) -> Option<String> {
    match &unit.set.source {
        Source::Simulated { scenario, cell } => scenario.cells[*cell].missing().into_iter().next(),
        Source::Measured { .. } => None,
    }
}

fn case(unit: &Unit, question: &Question, answers: Vec<Answer>) -> Case {
    let name = |record: usize| unit.set.records[record].name.clone();
    Case {
        task: question.task,
        field: if unit.trial.is_some() { unit.set.group.clone() } else { MEASURED.to_owned() },
        set: unit.set.name.clone(),
        trial: unit.trial,
        fitted: question.fit.iter().copied().map(name).collect(),
        scored: question.score.map(name),
        missing: if question.task == Task::Name { missing(unit) } else { None },
        answers,
    }
}

#[cfg(test)]
mod tests;
