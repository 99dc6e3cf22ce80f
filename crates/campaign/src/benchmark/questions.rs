//! What the rows of a study ask and answer: a case for every task of every trial.
//!
//! Tasks follow from the manoeuvres. A record that was fitted alone is replayed; a judging zig-zag is of the other side
//! or of another amplitude, whatever else judges is a turn. K and T are asked of ships that are first order. In a study
//! in which ships lack effects of the list, these are to be named, and nothing else is asked.

use std::collections::HashSet;

use simulate::Manoeuvre;
use trial::manoeuvre::whole_deg;
use trial::{Origin, Side, Trial, ZigZag};

use crate::benchmark::cases::{BenchCase, BenchTask, CaseAnswer, Naming, Present, PresentRecord, Skipped, stored};
use crate::engine::is_made;
use crate::rows::{NamedEffect, StudyRow, TraceAnswer};
use crate::scenario::records::RecordSet;
use crate::scenario::{DesignCell, HULL, Method, Procedure, Scenario};
use crate::statistics::distinct;

/// Cases of a study, and what was not there.
pub(super) struct StudyCases {
    pub cases: Vec<BenchCase>,
    pub sets: Vec<Present>,
    pub skipped: Vec<Skipped>,
}

/// A record as the tasks see it.
struct SteeredRecord {
    record: PresentRecord,
    /// Of a zig-zag the nominal angles, deg, where they are known, and the side of its first execute.
    zig_zag: Option<(Option<[f64; 2]>, Side)>,
}

impl SteeredRecord {
    fn new(
        name: Option<&str>,
        zig_zag: Option<(Option<[f64; 2]>, Side)>,
        turn: String,
        sha256: Option<String>,
    ) -> Self {
        let manoeuvre = match zig_zag {
            Some((Some([rudder, heading]), first)) => format!("zig-zag {rudder}/{heading}, {first} first"),
            Some((None, first)) => format!("zig-zag, {first} first"),
            None => turn,
        };
        let name = name.map_or_else(|| manoeuvre.clone(), str::to_owned);
        Self { record: PresentRecord { name, manoeuvre, sha256 }, zig_zag }
    }

    fn simulated(manoeuvre: &Manoeuvre) -> Self {
        let rudder = whole_deg(manoeuvre.rudder());
        let zig_zag = match manoeuvre {
            Manoeuvre::ZigZag { heading, first, .. } => Some((Some([rudder, whole_deg(*heading)]), *first)),
            _ => None,
        };
        Self::new(None, zig_zag, manoeuvre.to_string(), None)
    }

    fn measured(trial: &Trial) -> Self {
        let zig_zag = ZigZag::of(trial).ok().filter(|zig_zag| zig_zag.executes.len() > 1).map(|zig_zag| {
            let angles = zig_zag.pair.map(|pair| [pair.rudder, pair.heading].map(whole_deg));
            (angles, zig_zag.side.unwrap_or_else(|| zig_zag.executes[0].side()))
        });
        let sha256 = match trial.origin() {
            Origin::Measured { sha256, .. } => Some(sha256.clone()),
            _ => None,
        };
        Self::new(Some(trial.name()), zig_zag, "turn".to_owned(), sha256)
    }
}

/// The task of predicting a record from others; `None` where it repeats one of them, or turns are fitted.
fn prediction(fitted: &[&SteeredRecord], judge: &SteeredRecord) -> Option<BenchTask> {
    let fitted: Vec<_> = fitted.iter().map(|own| own.zig_zag).collect::<Option<_>>()?;
    let Some((angles, first)) = judge.zig_zag else { return Some(BenchTask::Circle) };
    if fitted.iter().all(|own| own.0 == angles && own.1 != first) {
        return Some(BenchTask::OtherSide);
    }
    fitted.iter().all(|own| own.0 != angles).then_some(BenchTask::OtherAmplitude)
}

/// What a study asks in a cell.
struct CellQuestions {
    set: String,
    /// The records, in order: those of the set, or of a simulated trial the fitted ones and the one that judges.
    records: Vec<SteeredRecord>,
    /// Number of fitted records of a simulated trial.
    fitted: usize,
    is_simulated: bool,
    /// Whether K and T are known.
    has_indices: bool,
    /// What the ship lacks, where it is to be named.
    missing: Option<Option<String>>,
}

impl CellQuestions {
    fn new(scenario: &Scenario, cell: &DesignCell, is_of_names: bool) -> Self {
        let records = match cell.record_set() {
            Some(set) => set.trials.iter().map(SteeredRecord::measured).collect(),
            None => cell.manoeuvres().into_iter().map(SteeredRecord::simulated).collect(),
        };
        let missing = cell.missing();
        let is_to_be_named = is_of_names && missing.len() <= 1 && missing.iter().all(|id| id != HULL);
        Self {
            set: match cell.labels.first() {
                Some(label) => format!("{}, {label}", scenario.name),
                None => scenario.name.clone(),
            },
            records,
            fitted: cell.records(),
            is_simulated: cell.record_set().is_none(),
            has_indices: cell.record_set().is_none() && !cell.is_nearest(),
            missing: is_to_be_named.then(|| missing.into_iter().next()),
        }
    }

    /// The fitted records of a trial, and the one that judges.
    fn of_trial(&self, set: Option<&RecordSet>, replicate: u64) -> (Vec<&SteeredRecord>, Option<&SteeredRecord>) {
        match set.map(|set| &set.questions[replicate as usize]) {
            Some(question) => {
                let fitted = question.fitted.iter().map(|&place| &self.records[place]).collect();
                (fitted, question.judge.map(|place| &self.records[place]))
            }
            None => (self.records[..self.fitted].iter().collect(), self.records.get(self.fitted)),
        }
    }

    /// The tasks of a trial, with the record that is scored.
    fn tasks(&self, fitted: &[&SteeredRecord], judge: Option<&SteeredRecord>) -> Vec<(BenchTask, Option<String>)> {
        if self.missing.is_some() {
            return vec![(BenchTask::Name, None)];
        }
        let name = |record: &SteeredRecord| record.record.name.clone();
        let alone = if fitted.len() == 1 { Some((BenchTask::Identify, Some(name(fitted[0])))) } else { None };
        let indices = self.has_indices.then_some((BenchTask::Indices, None));
        let predicted = judge.and_then(|judge| Some((prediction(fitted, judge)?, Some(name(judge)))));
        alone.into_iter().chain(indices).chain(predicted).collect()
    }
}

/// The cases of a study with these rows, which are in their order.
pub(super) fn cases(scenario: &Scenario, rows: &[StudyRow]) -> StudyCases {
    let lacks = |cell: &DesignCell| cell.missing().iter().any(|id| id != HULL);
    let is_of_names = scenario.cells.iter().any(lacks);
    let of_cell = |cell: &DesignCell| CellQuestions::new(scenario, cell, is_of_names);
    let cells: Vec<CellQuestions> = scenario.cells.iter().map(of_cell).collect();
    let (mut cases, mut skipped, mut asked) = (Vec::new(), absent(scenario, &cells), HashSet::new());
    for rows in rows.chunk_by(|row, next| (row.cell, row.replicate) == (next.cell, next.replicate)) {
        let (place, replicate) = (rows[0].cell as usize, rows[0].replicate);
        let (cell, questions) = (&scenario.cells[place], &cells[place]);
        if let Some(reason) = rows[0].failure.as_deref().filter(|failure| !is_made(failure)) {
            let record = format!("trial {replicate}");
            skipped.push(Skipped { set: questions.set.clone(), record, reason: reason.to_owned() });
            continue;
        }
        let (fitted, judge) = questions.of_trial(cell.record_set(), replicate);
        let fitted_names: Vec<String> = fitted.iter().map(|own| own.record.name.clone()).collect();
        for (task, scored) in questions.tasks(&fitted, judge) {
            let trial = questions.is_simulated.then_some(replicate);
            // A record is fitted for each that judges it, and asked about itself once.
            if !asked.insert((questions.set.clone(), task, trial, fitted_names.clone(), scored.clone())) {
                continue;
            }
            let missing = questions.missing.clone().flatten();
            let answer = |row: &StudyRow| answer(task, row, &cell.methods[row.method], missing.as_deref());
            cases.push(BenchCase {
                task,
                field: scenario.name.clone(),
                set: questions.set.clone(),
                trial,
                fitted: fitted_names.clone(),
                scored,
                answers: rows.iter().filter_map(answer).collect(),
                missing,
            });
        }
    }
    cases.retain(|case| !case.answers.is_empty());
    StudyCases { cases, sets: present(scenario, cells), skipped }
}

/// Records that are not there.
fn absent(scenario: &Scenario, cells: &[CellQuestions]) -> Vec<Skipped> {
    let sets = scenario.cells.iter().zip(cells).filter_map(|(cell, own)| Some((cell.record_set()?, &own.set)));
    let of = |(records, set): (&RecordSet, &String)| -> Vec<Skipped> {
        let skipped = |(record, reason): &(String, String)| Skipped {
            set: set.clone(),
            record: record.clone(),
            reason: reason.clone(),
        };
        records.absent.iter().map(skipped).collect()
    };
    distinct(sets.flat_map(of))
}

/// The sets of a study with their records.
fn present(scenario: &Scenario, cells: Vec<CellQuestions>) -> Vec<Present> {
    let mut sets: Vec<Present> = Vec::new();
    for (place, cell) in cells.into_iter().enumerate() {
        let trials = scenario.trials_of(place);
        let records = cell.records.into_iter().map(|own| own.record);
        match sets.iter_mut().find(|set| set.name == cell.set) {
            Some(set) => {
                set.trials += trials;
                set.records = distinct(set.records.drain(..).chain(records));
            }
            None => sets.push(Present { name: cell.set, trials, records: records.collect() }),
        }
    }
    sets
}

/// What a row answers to a task; `None` where its method takes no part.
fn answer(task: BenchTask, row: &StudyRow, method: &Method, missing: Option<&str>) -> Option<CaseAnswer> {
    let takes_part = match task {
        BenchTask::Indices => !matches!(method.procedure, Procedure::StraightOn),
        BenchTask::Name => matches!(method.procedure, Procedure::Trace(_)),
        _ => true,
    };
    let blank = || CaseAnswer { method: method.label.clone(), ..CaseAnswer::default() };
    let answered = match task {
        BenchTask::Name => row.traced.as_deref().map(|said| {
            let named = named(said);
            CaseAnswer { naming: Some(Naming::of(missing, &named)), named, ..blank() }
        }),
        BenchTask::Indices => indices(row).map(|own| CaseAnswer { method: method.label.clone(), ..own }),
        BenchTask::Identify => row.heading_rmse_deg.map(|error| CaseAnswer { score: Some(stored(error)), ..blank() }),
        _ => row.validation_rmse_deg.map(|error| CaseAnswer { score: Some(stored(error)), ..blank() }),
    };
    let failed = || {
        let failure = row.failure.as_deref().unwrap_or("not-finite");
        CaseAnswer { failure: Some(failure.to_owned()), ..blank() }
    };
    takes_part.then(|| answered.filter(|_| row.failure.is_none()).unwrap_or_else(failed))
}

/// The effects that a trace named, each followed by those that the record cannot tell from it.
fn named(said: &TraceAnswer) -> Vec<Vec<String>> {
    let group = |own: &NamedEffect| std::iter::once(&own.id).chain(&own.aliases).map(|id| id.to_string()).collect();
    said.named.iter().map(group).collect()
}

/// Errors of K and T of a ship that is first order.
fn indices(row: &StudyRow) -> Option<CaseAnswer> {
    let [k, t, _] = row.errors();
    let errors = [k?, t?].map(|error| stored(100.0 * error));
    let [true_k, true_t] = row.truth();
    let holds = |ends: Option<[f64; 2]>, truth: Option<f64>| Some((ends?[0]..=ends?[1]).contains(&truth?));
    let holds = holds(row.k_ci95_per_s, true_k).zip(holds(row.t_ci95_s, true_t)).map(|(k, t)| [k, t]);
    let score = Some(errors[0].abs().max(errors[1].abs()));
    Some(CaseAnswer { score, errors_percent: Some(errors), holds, ..CaseAnswer::default() })
}

#[cfg(test)]
mod tests;
