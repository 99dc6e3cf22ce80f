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
struct RecordFit {
    answer: FitAnswer,
    /// The ship that predicts; none where nothing is predicted, and where the answer has no covariance.
    ship: Option<ShipMixture>,
}

/// The answer of a method.
enum FitAnswer {
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
                let fit = |analysis| self.fit(FitAnswer::Trace(Box::new(analysis)));
                Some(analysis.map(fit).map_err(|error| engine::failure(&error).into()))
            }
            Procedure::Identify { .. } => self.response(procedure, &key(&self.tasks[0])),
            // Answers from elsewhere are looked up by their trial.
            Procedure::Answers(_) => None,
        };
        let row = |(trial, task): (usize, &Task)| {
            let own = if shared.is_none() { self.response(procedure, &key(task)) } else { None };
            let fit = shared.as_ref().or(own.as_ref()).expect("a trace is shared");
            let blank = StudyRow { cell: task.cell as u64, replicate: task.replicate, method, ..StudyRow::default() };
            match fit {
                Ok(fit) => self.row(trial, fit, &blank, &key(task)),
                Err(reason) => StudyRow { failure: Some(reason.as_str().into()), ..blank },
            }
        };
        self.tasks.iter().enumerate().map(row).collect()
    }

    /// The first-order response of the records; `None` for a trace.
    fn response(&self, procedure: &Procedure, key: &StreamKey) -> Option<Result<RecordFit, String>> {
        let answer = procedure.identify(&self.fitted, key)?;
        let fit = |estimate| self.fit(FitAnswer::Response(Box::new(estimate)));
        Some(answer.map(fit).map_err(|error| error.in_a_row().into_owned()))
    }

    /// An answer with the ship that predicts, where anything is predicted.
    fn fit(&self, answer: FitAnswer) -> RecordFit {
        let is_asked = self.scenario.predictions.is_some() && self.judges.iter().any(Option::is_some);
        RecordFit { ship: if is_asked { ship(&answer, &self.fitted) } else { None }, answer }
    }

    /// The row of a fit on a trial.
    fn row(&self, trial: usize, fit: &RecordFit, blank: &StudyRow, key: &StreamKey) -> StudyRow {
        let judge = self.judges[trial];
        let reference = TrialReference { validation: judge.cloned(), ..TrialReference::default() };
        let asked = TrialQuestion { trials: &self.fitted, key, reference: &reference, missing: &[], check: None };
        let row = match &fit.answer {
            FitAnswer::Response(estimate) => asked.estimated(blank, estimate),
            FitAnswer::Trace(analysis) => {
                let validation = judge.and(analysis.validation.get(trial)).map(|one| &one.after);
                asked.traced(blank, analysis, validation)
            }
        };
        let predicted = self.scenario.predictions.as_ref().map(|asked| match (judge, &fit.ship) {
            (Some(judge), Some(ship)) => predicted(ship, judge, asked),
            _ => Box::default(),
        });
        StudyRow { predicted, ..row }
    }
}

/// The ship of an answer; none where it has no covariance.
fn ship(answer: &FitAnswer, fitted: &[Trial]) -> Option<ShipMixture> {
    let facts = RecordFacts::of(fitted);
    let known: IdentifiedShip = match answer {
        FitAnswer::Response(estimate) => known::of_estimate(estimate, &facts)?,
        FitAnswer::Trace(analysis) => known::of_analysis(analysis, &facts.with_motion(Some(analysis), &[])),
    };
    ShipMixture::new(vec![(known, 1.0)]).ok()
}

/// Figures of the record that judges, predicted by replaying its helm with drawn ships.
fn predicted(ship: &ShipMixture, judge: &Trial, predictions: &Predictions) -> Box<[PredictedFigure]> {
    let replay = ship.replay(judge, predictions.draws, None).ok().flatten();
    let figures = replay.into_iter().flat_map(|replay| replay.figures);
    let figure = |(name, own): (String, predict::replay::Compared)| PredictedFigure {
        name: name.into(),
        truth: own.measured,
        median: own.interval.median,
        ci90: own.interval.ci90,
    };
    figures.map(figure).collect()
}
