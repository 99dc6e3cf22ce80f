//! Trials of measured records that share a fit: every method is fitted once, and each trial is judged by its record.

use std::ops::Range;
use std::time::{Duration, Instant};

use ::trace::Analysis;
use document::IdentifiedShip;
use identify::Estimate;
use predict::ShipMixture;
use simulate::StreamKey;
use trial::Trial;

use crate::engine::{self, TrialOutcome, TrialQuestion, TrialRunner};
use crate::known::{self, RecordFacts};
use crate::reference::TrialReference;
use crate::rows::{PredictedFigure, StudyRow};
use crate::scenario::records::RecordSet;
use crate::scenario::{Predictions, Procedure, Scenario};
use crate::task::Task;
use crate::timings::TrialTiming;

/// Places of tasks, in order, that are run together: trials of measured records that share a fit.
pub fn units(scenario: &Scenario, tasks: &[Task]) -> Vec<Range<usize>> {
    let fit = |task: &Task| {
        let set = scenario.cells[task.cell].record_set()?;
        Some((task.cell, &set.questions[task.replicate as usize].fitted))
    };
    let share = |one: &Task, other: &Task| fit(one).is_some() && fit(one) == fit(other);
    let mut start = 0;
    let of = |unit: &[Task]| {
        let place = start..start + unit.len();
        start = place.end;
        place
    };
    tasks.chunk_by(share).map(of).collect()
}

/// Runs the tasks of one unit.
pub fn run_unit(runner: &TrialRunner, scenario: &Scenario, tasks: &[Task]) -> Vec<TrialOutcome> {
    match scenario.cells[tasks[0].cell].record_set() {
        Some(set) => run(scenario, set, tasks),
        None => tasks.iter().map(|&task| runner.run(task)).collect(),
    }
}

/// What a method made of the records that were fitted together.
enum RecordFit {
    Response(Box<Estimate>),
    Trace(Box<Analysis>),
}

/// Trials that share a fit.
struct SharedTrials<'a> {
    scenario: &'a Scenario,
    tasks: &'a [Task],
    fitted: Vec<Trial>,
    /// The record that judges each of them.
    judges: Vec<Option<&'a Trial>>,
}

/// Runs trials that share a fit, in their order.
fn run(scenario: &Scenario, set: &RecordSet, tasks: &[Task]) -> Vec<TrialOutcome> {
    let question = |task: &Task| &set.questions[task.replicate as usize];
    let trials = SharedTrials {
        scenario,
        tasks,
        fitted: question(&tasks[0]).fitted.iter().map(|&one| set.trials[one].clone()).collect(),
        judges: tasks.iter().map(|task| question(task).judge.map(|one| &set.trials[one])).collect(),
    };
    let blank = |task: &Task| TrialOutcome {
        rows: Vec::new(),
        timing: TrialTiming { cell: task.cell as u64, simulation: Duration::ZERO, methods: Vec::new() },
    };
    let mut outcomes: Vec<TrialOutcome> = tasks.iter().map(blank).collect();
    for (place, method) in scenario.cells[tasks[0].cell].methods.iter().enumerate() {
        let start = Instant::now();
        let rows = trials.rows(place, &method.procedure);
        let each = start.elapsed() / tasks.len() as u32;
        for (outcome, row) in outcomes.iter_mut().zip(rows) {
            outcome.rows.push(row);
            outcome.timing.methods.push(each);
        }
    }
    outcomes
}

impl SharedTrials<'_> {
    /// The rows of a method, one a trial.
    fn rows(&self, method: usize, procedure: &Procedure) -> Vec<StudyRow> {
        let key = |task: &Task| engine::key(self.scenario, *task);
        let shared = match procedure {
            Procedure::Trace(settings) => {
                let held_out: Vec<Trial> = self.judges.iter().flatten().map(|trial| (*trial).clone()).collect();
                let analysis = ::trace::trace(&self.fitted, &held_out, settings);
                Some(
                    analysis.map(|own| RecordFit::Trace(Box::new(own))).map_err(|error| engine::failure(&error).into()),
                )
            }
            Procedure::Identify { .. } => response(procedure, &self.fitted, &key(&self.tasks[0])),
            // Answers from elsewhere are looked up by their trial.
            Procedure::Answers(_) => None,
        };
        let row = |(trial, task): (usize, &Task)| {
            let own = if shared.is_none() { response(procedure, &self.fitted, &key(task)) } else { None };
            let fit = shared.as_ref().or(own.as_ref()).expect("a trace is shared");
            let blank = StudyRow { cell: task.cell as u64, replicate: task.replicate, method, ..StudyRow::default() };
            match fit {
                Ok(fit) => self.row(trial, fit, &blank, &key(task)),
                Err(reason) => StudyRow { failure: Some(reason.as_str().into()), ..blank },
            }
        };
        self.tasks.iter().enumerate().map(row).collect()
    }

    /// The row of a fit on a trial.
    fn row(&self, trial: usize, fit: &RecordFit, blank: &StudyRow, key: &StreamKey) -> StudyRow {
        let judge = self.judges[trial];
        let reference = TrialReference { validation: judge.cloned(), ..TrialReference::default() };
        let asked = TrialQuestion { trials: &self.fitted, key, reference: &reference, missing: &[], check: None };
        let row = match fit {
            RecordFit::Response(estimate) => asked.estimated(blank, estimate),
            RecordFit::Trace(analysis) => {
                let validation = judge.and(analysis.validation.get(trial)).map(|one| &one.after);
                asked.traced(blank, analysis, validation)
            }
        };
        let predicted = self.scenario.predictions.as_ref().map(|asked| match judge {
            Some(judge) => predicted(fit, &self.fitted, judge, asked),
            None => Box::default(),
        });
        StudyRow { predicted, ..row }
    }
}

/// The first-order response of records; `None` for a trace.
fn response(procedure: &Procedure, fitted: &[Trial], key: &simulate::StreamKey) -> Option<Result<RecordFit, String>> {
    let answer = procedure.identify(fitted, key)?;
    Some(answer.map(|estimate| RecordFit::Response(Box::new(estimate))).map_err(|error| error.in_a_row().into_owned()))
}

/// Figures of the record that judges, predicted by replaying its helm with drawn ships; empty where the answer has no
/// covariance.
fn predicted(fit: &RecordFit, fitted: &[Trial], judge: &Trial, predictions: &Predictions) -> Box<[PredictedFigure]> {
    let facts = RecordFacts::of(fitted);
    let known: Option<IdentifiedShip> = match fit {
        RecordFit::Response(estimate) => known::of_estimate(estimate, &facts),
        RecordFit::Trace(analysis) => Some(known::of_analysis(analysis, &facts.with_motion(Some(analysis), &[]))),
    };
    let mixture = known.and_then(|known| ShipMixture::new(vec![(known, 1.0)]).ok());
    let replay = mixture.and_then(|mixture| mixture.replay(judge, predictions.draws, None).ok().flatten());
    let figures = replay.into_iter().flat_map(|replay| replay.figures);
    let figure = |(name, own): (String, predict::replay::Compared)| PredictedFigure {
        name: name.into(),
        truth: own.measured,
        median: own.interval.median,
        ci90: own.interval.ci90,
    };
    figures.map(figure).collect()
}
