//! Trials of measured records that share a fit: every method is fitted once, and each trial is judged by its record.

use std::time::{Duration, Instant};

use ::trace::Analysis;
use document::IdentifiedShip;
use identify::Estimate;
use predict::ShipMixture;
use trial::Trial;

use crate::engine::{self, TrialOutcome, TrialQuestion};
use crate::known::{self, RecordFacts};
use crate::reference::TrialReference;
use crate::rows::{PredictedFigure, StudyRow};
use crate::scenario::records::RecordSet;
use crate::scenario::{Predictions, Procedure, Scenario};
use crate::task::Task;
use crate::timings::TrialTiming;

/// What a method made of the records that were fitted together.
enum RecordFit {
    Response(Box<Estimate>),
    Trace(Box<Analysis>),
}

/// Runs trials that share a fit, in their order.
pub fn run(scenario: &Scenario, set: &RecordSet, tasks: &[Task]) -> Vec<TrialOutcome> {
    let cell = &scenario.cells[tasks[0].cell];
    let key = engine::key(scenario, tasks[0]);
    let question = |task: &Task| &set.questions[task.replicate as usize];
    let fitted: Vec<Trial> = question(&tasks[0]).fitted.iter().map(|&one| set.trials[one].clone()).collect();
    let judges: Vec<Option<&Trial>> =
        tasks.iter().map(|task| question(task).judge.map(|one| &set.trials[one])).collect();
    let held_out: Vec<Trial> = judges.iter().flatten().map(|trial| (*trial).clone()).collect();
    let mut outcomes: Vec<TrialOutcome> = tasks
        .iter()
        .map(|task| TrialOutcome {
            rows: Vec::with_capacity(cell.methods.len()),
            timing: TrialTiming { cell: task.cell as u64, simulation: Duration::ZERO, methods: Vec::new() },
        })
        .collect();
    for (place, method) in cell.methods.iter().enumerate() {
        let start = Instant::now();
        let shared = match &method.procedure {
            Procedure::Trace(settings) => Some(
                ::trace::trace(&fitted, &held_out, settings)
                    .map(|analysis| RecordFit::Trace(Box::new(analysis)))
                    .map_err(|error| engine::failure(&error).to_owned()),
            ),
            Procedure::Identify { .. } => response(&method.procedure, &fitted, &key),
            Procedure::Answers(_) => None,
        };
        let each = start.elapsed() / tasks.len() as u32;
        for (trial, (task, outcome)) in tasks.iter().zip(&mut outcomes).enumerate() {
            let own;
            let fit = match &shared {
                Some(fit) => fit,
                // Answers from elsewhere are looked up by their trial.
                None => {
                    own = response(&method.procedure, &fitted, &engine::key(scenario, *task));
                    own.as_ref().expect("it is no trace")
                }
            };
            let blank =
                StudyRow { cell: task.cell as u64, replicate: task.replicate, method: place, ..StudyRow::default() };
            let judge = judges[trial];
            let reference = TrialReference { validation: judge.cloned(), ..TrialReference::default() };
            let asked = TrialQuestion { trials: &fitted, key: &key, reference: &reference, missing: &[], check: None };
            let row = match fit {
                Err(reason) => StudyRow { failure: Some(reason.as_str().into()), ..blank },
                Ok(RecordFit::Response(estimate)) => asked.estimated(&blank, estimate),
                Ok(RecordFit::Trace(analysis)) => {
                    let validation = judge.and(analysis.validation.get(trial)).map(|one| &one.after);
                    asked.traced(&blank, analysis, validation)
                }
            };
            let predicted = scenario.predictions.as_ref().map(|predictions| match (fit, judge) {
                (Ok(fit), Some(judge)) => predicted(fit, &fitted, judge, predictions),
                _ => Box::default(),
            });
            outcome.rows.push(StudyRow { predicted, ..row });
            outcome.timing.methods.push(each);
        }
    }
    outcomes
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
