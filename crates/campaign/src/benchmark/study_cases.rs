//! Cases from the rows of a study: one per task and trial.
//!
//! The manoeuvres determine the tasks. A record that was fitted alone is replayed. A zig-zag as validation record is to
//! the opposite side or of another amplitude; any other validation record is a turn. K and T are scored for first-order
//! ships. In a study in which ships lack listed effects, the only task of a cell with at most one of them is to name
//! it.

use std::collections::HashSet;

use simulate::Manoeuvre;
use trial::manoeuvre::rounded_deg;
use trial::{RecordOrigin, Side, Trial, ZigZag};

use crate::benchmark::cases::{
    BenchCase, BenchRecord, BenchSet, BenchTask, CaseAnswer, Naming, SkippedRecord, rounded,
};
use crate::engine::is_method_failure;
use crate::rows::{NamedEffect, StudyRow, TraceRow};
use crate::scenario::records::RecordSet;
use crate::scenario::{DesignCell, HULL_ID, Method, Procedure, Scenario};
use crate::statistics::distinct;

/// Cases of a study, its sets, and the skipped records and trials.
pub(super) struct StudyCases {
    pub cases: Vec<BenchCase>,
    pub sets: Vec<BenchSet>,
    pub skipped: Vec<SkippedRecord>,
}

/// Record with the steering that determines its task.
struct SteeredRecord {
    record: BenchRecord,
    /// Nominal rudder and heading angle of a zig-zag, deg, if known, and the side of the first execute; `None` for any
    /// other manoeuvre.
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
        Self { record: BenchRecord { name, manoeuvre, sha256 }, zig_zag }
    }

    fn simulated(manoeuvre: &Manoeuvre) -> Self {
        let rudder = rounded_deg(manoeuvre.max_rudder());
        let zig_zag = match manoeuvre {
            Manoeuvre::ZigZag { heading, first, .. } => Some((Some([rudder, rounded_deg(*heading)]), *first)),
            _ => None,
        };
        Self::new(None, zig_zag, manoeuvre.to_string(), None)
    }

    fn measured(trial: &Trial) -> Self {
        let zig_zag = ZigZag::from_trial(trial).ok().filter(|zig_zag| zig_zag.executes.len() > 1).map(|zig_zag| {
            let angles = zig_zag.nominal_angles.map(|pair| [pair.rudder, pair.heading].map(rounded_deg));
            (angles, zig_zag.first_side.unwrap_or_else(|| zig_zag.executes[0].side()))
        });
        let sha256 = match trial.origin() {
            RecordOrigin::Measured { sha256, .. } => Some(sha256.clone()),
            _ => None,
        };
        Self::new(Some(trial.name()), zig_zag, "turn".to_owned(), sha256)
    }
}

/// Task of predicting a record from the fitted records; `None` if a turn is fitted, and for a zig-zag that is neither
/// to the opposite side of all fitted zig-zags nor of another amplitude than all.
fn prediction(fitted: &[&SteeredRecord], judge: &SteeredRecord) -> Option<BenchTask> {
    let fitted: Vec<_> = fitted.iter().map(|record| record.zig_zag).collect::<Option<_>>()?;
    let Some((angles, first)) = judge.zig_zag else { return Some(BenchTask::Circle) };
    if fitted.iter().all(|zig_zag| zig_zag.0 == angles && zig_zag.1 != first) {
        return Some(BenchTask::OtherSide);
    }
    fitted.iter().all(|zig_zag| zig_zag.0 != angles).then_some(BenchTask::OtherAmplitude)
}

/// Tasks of one cell.
struct CellTasks {
    set: String,
    /// Records of the set; for simulated trials the fitted records and then the validation record.
    records: Vec<SteeredRecord>,
    /// Number of fitted records of a simulated trial.
    fitted: usize,
    is_simulated: bool,
    /// `true` if K and T are known.
    has_indices: bool,
    /// Missing effect, the inner `None` if no effect is missing; the outer `None` if the effect is not to be named.
    missing: Option<Option<String>>,
}

impl CellTasks {
    fn new(scenario: &Scenario, cell: &DesignCell, is_of_names: bool) -> Self {
        let records = match cell.record_set() {
            Some(set) => set.trials.iter().map(SteeredRecord::measured).collect(),
            None => cell.manoeuvres().into_iter().map(SteeredRecord::simulated).collect(),
        };
        let missing = cell.missing_effects();
        let is_to_be_named = is_of_names && missing.len() <= 1 && missing.iter().all(|id| id != HULL_ID);
        Self {
            set: match cell.labels.first() {
                Some(label) => format!("{}, {label}", scenario.name),
                None => scenario.name.clone(),
            },
            records,
            fitted: cell.record_count(),
            is_simulated: cell.record_set().is_none(),
            has_indices: cell.record_set().is_none() && !cell.is_compared_with_nearest(),
            missing: is_to_be_named.then(|| missing.into_iter().next()),
        }
    }

    /// Fitted records of a trial, and its validation record.
    fn of_trial(&self, set: Option<&RecordSet>, replicate: u64) -> (Vec<&SteeredRecord>, Option<&SteeredRecord>) {
        match set.map(|set| &set.splits[replicate as usize]) {
            Some(split) => {
                let fitted = split.fitted_indices.iter().map(|&place| &self.records[place]).collect();
                (fitted, split.validation_index.map(|place| &self.records[place]))
            }
            None => (self.records[..self.fitted].iter().collect(), self.records.get(self.fitted)),
        }
    }

    /// Tasks of a trial, with the scored record of each.
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

/// Cases of a study from its rows, which are in the order of the design.
pub(super) fn cases(scenario: &Scenario, rows: &[StudyRow]) -> StudyCases {
    let lacks = |cell: &DesignCell| cell.missing_effects().iter().any(|id| id != HULL_ID);
    let is_of_names = scenario.cells.iter().any(lacks);
    let of_cell = |cell: &DesignCell| CellTasks::new(scenario, cell, is_of_names);
    let cells: Vec<CellTasks> = scenario.cells.iter().map(of_cell).collect();
    let (mut cases, mut skipped, mut asked) = (Vec::new(), absent(scenario, &cells), HashSet::new());
    for rows in rows.chunk_by(|row, next| (row.cell, row.replicate) == (next.cell, next.replicate)) {
        let (place, replicate) = (rows[0].cell as usize, rows[0].replicate);
        let (cell, questions) = (&scenario.cells[place], &cells[place]);
        if let Some(reason) = rows[0].failure.as_deref().filter(|failure| !is_method_failure(failure)) {
            let record = format!("trial {replicate}");
            skipped.push(SkippedRecord { set: questions.set.clone(), record, reason: reason.to_owned() });
            continue;
        }
        let (fitted, judge) = questions.of_trial(cell.record_set(), replicate);
        let fitted_names: Vec<String> = fitted.iter().map(|steered| steered.record.name.clone()).collect();
        for (task, scored) in questions.tasks(&fitted, judge) {
            let trial = questions.is_simulated.then_some(replicate);
            // A fit recurs with every validation record; the replay of the fitted record is scored once.
            if !asked.insert((questions.set.clone(), task, trial, fitted_names.clone(), scored.clone())) {
                continue;
            }
            let missing = questions.missing.clone().flatten();
            let answer = |row: &StudyRow| answer(task, row, &cell.methods[row.method], missing.as_deref());
            cases.push(BenchCase {
                task,
                study: scenario.name.clone(),
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
    StudyCases { cases, sets: bench_sets(scenario, cells), skipped }
}

/// Absent records of every set with the reason, each once.
fn absent(scenario: &Scenario, cells: &[CellTasks]) -> Vec<SkippedRecord> {
    let sets = scenario.cells.iter().zip(cells).filter_map(|(cell, entry)| Some((cell.record_set()?, &entry.set)));
    let of_set = |(records, set): (&RecordSet, &String)| -> Vec<SkippedRecord> {
        let skipped = |(record, reason): &(String, String)| SkippedRecord {
            set: set.clone(),
            record: record.clone(),
            reason: reason.clone(),
        };
        records.absent_files.iter().map(skipped).collect()
    };
    distinct(sets.flat_map(of_set))
}

/// Sets of a study, the cells of one set joined: number of trials, and records, each once.
fn bench_sets(scenario: &Scenario, cells: Vec<CellTasks>) -> Vec<BenchSet> {
    let mut sets: Vec<BenchSet> = Vec::new();
    for (place, cell) in cells.into_iter().enumerate() {
        let trials = scenario.max_cell_trials(place);
        let records = cell.records.into_iter().map(|steered| steered.record);
        match sets.iter_mut().find(|set| set.name == cell.set) {
            Some(set) => {
                set.trials += trials;
                set.records = distinct(set.records.drain(..).chain(records));
            }
            None => sets.push(BenchSet { name: cell.set, trials, records: records.collect() }),
        }
    }
    sets
}

/// Result of a row in a task; `None` if its method takes no part.
fn answer(task: BenchTask, row: &StudyRow, method: &Method, missing: Option<&str>) -> Option<CaseAnswer> {
    let takes_part = match task {
        BenchTask::Indices => !matches!(method.procedure, Procedure::StraightOn),
        BenchTask::Name => matches!(method.procedure, Procedure::Trace(_)),
        _ => true,
    };
    let blank = || CaseAnswer { method: method.label.clone(), ..CaseAnswer::default() };
    let answered = match task {
        BenchTask::Name => row.traced.as_deref().map(|trace| {
            let named = named(trace);
            CaseAnswer { naming: Some(Naming::from_named_effects(missing, &named)), named, ..blank() }
        }),
        BenchTask::Indices => indices(row).map(|answer| CaseAnswer { method: method.label.clone(), ..answer }),
        BenchTask::Identify => row.heading_rmse_deg.map(|error| CaseAnswer { score: Some(rounded(error)), ..blank() }),
        _ => row.validation_rmse_deg.map(|error| CaseAnswer { score: Some(rounded(error)), ..blank() }),
    };
    let failed = || {
        let failure = row.failure.as_deref().unwrap_or("not-finite");
        CaseAnswer { failure: Some(failure.to_owned()), ..blank() }
    };
    takes_part.then(|| answered.filter(|_| row.failure.is_none()).unwrap_or_else(failed))
}

/// Effects named by a trace, each followed by its aliases.
fn named(trace: &TraceRow) -> Vec<Vec<String>> {
    let group = |term: &NamedEffect| std::iter::once(&term.id).chain(&term.aliases).map(|id| id.to_string()).collect();
    trace.named_effects.iter().map(group).collect()
}

/// Result with the relative errors of K and T of a first-order ship, %, the larger as score, and whether the intervals
/// contain the truth; `None` unless both have an estimate.
fn indices(row: &StudyRow) -> Option<CaseAnswer> {
    let [k, t, _] = row.errors();
    let errors = [k?, t?].map(|error| rounded(100.0 * error));
    let [true_k, true_t] = row.true_indices();
    let contains = |ends: Option<[f64; 2]>, truth: Option<f64>| Some((ends?[0]..=ends?[1]).contains(&truth?));
    let contains_truth = contains(row.k_ci95_per_s, true_k).zip(contains(row.t_ci95_s, true_t)).map(|(k, t)| [k, t]);
    let score = Some(errors[0].abs().max(errors[1].abs()));
    Some(CaseAnswer { score, errors_percent: Some(errors), contains_truth, ..CaseAnswer::default() })
}

#[cfg(test)]
mod tests;
