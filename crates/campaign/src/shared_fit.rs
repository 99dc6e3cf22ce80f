//! Trials of measured records that share a fit: every method is fitted once and scored on each validation record.

use std::ops::Range;
use std::time::{Duration, Instant};

use ::trace::Analysis;
use ::trace::comparison::replay_base as of_base;
use ::trace::record::PreparedRecord;
use ::trace::replay_errors::{HORIZONS_S, ReplayDepth};
use document::IdentifiedShip;
use identify::Estimate;
use predict::ShipMixture;
use predict::turn::without_current;
use ship::angle::to_deg;
use simulate::StreamKey;
use trial::{Channel, Trial};

use crate::engine::{self, TrialInput, TrialOutcome, TrialRunner};
use crate::identified_ship::{self, RecordFacts};
use crate::prediction_check::is_repeated_in_lengths;
use crate::reference::TrialReference;
use crate::rows::{PredictedCharacteristic, StudyRow};
use crate::scenario::records::RecordSet;
use crate::scenario::{PredictionSettings, Procedure, Scenario};
use crate::shard::TrialId;
use crate::timings::TrialTiming;

/// Maximum relative difference of the ship lengths of fitted and validation records of one scale.
const SCALE: f64 = 0.01;

/// Index ranges of tasks that are run together: trials of measured records that share a fit.
pub fn fit_groups(scenario: &Scenario, tasks: &[TrialId]) -> Vec<Range<usize>> {
    let fit = |task: &TrialId| {
        let set = scenario.cells[task.cell].record_set()?;
        Some((task.cell, &set.splits[task.replicate as usize].fitted_indices))
    };
    let share = |task: &TrialId, next: &TrialId| fit(task).is_some() && fit(task) == fit(next);
    let mut start = 0;
    let range = |unit: &[TrialId]| {
        let place = start..start + unit.len();
        start = place.end;
        place
    };
    tasks.chunk_by(share).map(range).collect()
}

/// Runs every method on one group of trials that share a fit; one outcome per trial, in order.
pub fn run_group(runner: &TrialRunner, scenario: &Scenario, tasks: &[TrialId]) -> Vec<TrialOutcome> {
    match scenario.cells[tasks[0].cell].record_set() {
        Some(set) => run(scenario, set, tasks),
        None => tasks.iter().map(|&task| runner.run(task)).collect(),
    }
}

/// Fit of one method to the fitted records of a group of trials.
struct RecordFit {
    answer: FitAnswer,
    /// Identified ship for predictions; `None` without predictions or validation records, and if no ship can be drawn
    /// from the fit.
    ship: Option<IdentifiedShip>,
}

/// Result of a method on the fitted records.
enum FitAnswer {
    Response(Box<Estimate>),
    Trace(Box<Analysis>),
    StraightOn,
}

/// Trials that share a fit.
struct SharedTrials<'a> {
    scenario: &'a Scenario,
    tasks: &'a [TrialId],
    fitted: &'a [Trial],
    /// Fitted records without heading spikes, which are excluded from all errors.
    cleaned: &'a [Trial],
    /// Validation record of each trial, as read and without heading spikes; `None` without validation.
    validation_records: Vec<Option<[&'a Trial; 2]>>,
}

/// Outcomes, in order, of trials that share their fitted records; a method is fitted once, and each trial has an equal
/// part of its duration.
fn run(scenario: &Scenario, set: &RecordSet, tasks: &[TrialId]) -> Vec<TrialOutcome> {
    let split = |task: &TrialId| &set.splits[task.replicate as usize];
    let both = [&set.trials, set.without_spikes()];
    let of_fit = |all: &[Trial]| split(&tasks[0]).fitted_indices.iter().map(|&place| all[place].clone()).collect();
    let [fitted, cleaned]: [Vec<Trial>; 2] = both.map(of_fit);
    let validation_records =
        tasks.iter().map(|task| split(task).validation_index.map(|place| both.map(|all| &all[place]))).collect();
    let trials = SharedTrials { scenario, tasks, fitted: &fitted, cleaned: &cleaned, validation_records };
    let blank = |task: &TrialId| TrialOutcome {
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
    /// Rows of a method, one per trial: one fit, scored on the validation record of each trial.
    fn rows(&self, method: usize, procedure: &Procedure) -> Vec<StudyRow> {
        let key = |task: &TrialId| engine::stream_key(self.scenario, *task);
        let shared = match procedure {
            Procedure::Trace(settings) => {
                let as_read = |trial| self.replayable_validation_record(trial).map(|[record, _]| record.clone());
                let held_out: Vec<Trial> = (0..self.validation_records.len()).filter_map(as_read).collect();
                let settings = ::trace::Settings { fits_hulls: true, ..settings.clone() };
                let analysis = ::trace::trace(self.fitted, &held_out, &settings);
                let fit = |analysis| self.fit(FitAnswer::Trace(Box::new(analysis)), Some(&settings));
                Some(analysis.map(fit).map_err(|error| engine::trace_failure_kind(&error).into()))
            }
            Procedure::StraightOn => Some(Ok(self.fit(FitAnswer::StraightOn, None))),
            Procedure::Identify { .. } => self.response(procedure, &key(&self.tasks[0])),
            // Estimates of outside estimators are looked up by trial.
            Procedure::OutsideEstimates(_) => None,
        };
        let row = |(trial, task): (usize, &TrialId)| {
            let separate = if shared.is_none() { self.response(procedure, &key(task)) } else { None };
            let fit = shared.as_ref().or(separate.as_ref()).expect("a trace is shared");
            let blank = StudyRow { cell: task.cell as u64, replicate: task.replicate, method, ..StudyRow::default() };
            match fit {
                Ok(fit) => self.row(trial, fit, &blank, &key(task)),
                Err(reason) => StudyRow { failure: Some(reason.as_str().into()), ..blank },
            }
        };
        self.tasks.iter().enumerate().map(row).collect()
    }

    /// Validation record of a trial, as read and without heading spikes; `None` without validation, and if its ship
    /// length differs from that of the fitted records, since responses of another scale are not replayed.
    fn replayable_validation_record(&self, trial: usize) -> Option<[&Trial; 2]> {
        let length = |trial: &Trial| trial.particulars().map(|particulars| particulars.length);
        let fitted = self.fitted.iter().find_map(length);
        let are_alike = |(length, fitted): (f64, f64)| (length / fitted - 1.0).abs() < SCALE;
        self.validation_records[trial].filter(|[record, _]| length(record).zip(fitted).is_none_or(are_alike))
    }

    /// First-order fit to the records, or the reason of its failure; `None` for a trace and for the null model.
    fn response(&self, procedure: &Procedure, key: &StreamKey) -> Option<Result<RecordFit, String>> {
        let answer = procedure.identify(self.fitted, key)?;
        let fit = |estimate| self.fit(FitAnswer::Response(Box::new(estimate)), None);
        Some(answer.map(fit).map_err(|error| error.row_text().into_owned()))
    }

    /// Fit with the identified ship for predictions; `settings` are the settings of a trace.
    fn fit(&self, answer: FitAnswer, settings: Option<&::trace::Settings>) -> RecordFit {
        let is_asked = self.scenario.predictions.is_some() && self.validation_records.iter().any(Option::is_some);
        RecordFit { ship: if is_asked { ship(&answer, self.fitted, settings) } else { None }, answer }
    }

    /// Row of a fit for one trial, with the errors on its validation record.
    fn row(&self, trial: usize, fit: &RecordFit, blank: &StudyRow, key: &StreamKey) -> StudyRow {
        let record = self.replayable_validation_record(trial).map(|[_, cleaned]| cleaned);
        let reference = TrialReference { validation: record.cloned(), ..TrialReference::default() };
        let input = TrialInput {
            trials: self.cleaned,
            key,
            reference: &reference,
            missing_effects: &[],
            prediction_check: None,
        };
        let (row, errors) = match &fit.answer {
            FitAnswer::Response(estimate) => {
                let replayed = |record| {
                    of_base(record, &PreparedRecord::unaveraged(record), &estimate.response, ReplayDepth::Windows).ok()
                };
                (input.estimate_row(blank, estimate), record.and_then(replayed).map(|on| on.errors))
            }
            FitAnswer::StraightOn => (input.straight_course_row(blank), None),
            FitAnswer::Trace(analysis) => {
                let before = (0..trial).filter_map(|earlier| self.replayable_validation_record(earlier)).count();
                let validation = record.and(analysis.validation.get(before)).map(|compared| &compared.average_replay);
                (input.trace_row(blank, analysis, validation), validation.map(|on| on.errors.clone()))
            }
        };
        let windows = errors.and_then(|errors| errors.restarted_heading_rmse(HORIZONS_S[1]));
        let predicted =
            self.scenario.predictions.as_ref().map(|asked| match (&self.validation_records[trial], &fit.ship) {
                (Some([record, _]), Some(ship)) => predicted(ship, record, asked),
                _ => Box::default(),
            });
        StudyRow { predictions: predicted, validation_60_s_rmse_deg: windows.map(to_deg), ..row }
    }
}

/// Identified ship of a fit; `None` for the null model, and if no ship can be drawn from the fit.
///
/// A trace whose model requires measured speed or sway gives no prediction; the records are then traced without them.
fn ship(answer: &FitAnswer, fitted: &[Trial], settings: Option<&::trace::Settings>) -> Option<IdentifiedShip> {
    let sound = |ship: &IdentifiedShip| ShipMixture::new(vec![(ship.clone(), 1.0)]).is_ok();
    let traced = |analysis: &Analysis, trials: &[Trial]| {
        let shared = RecordFacts::from_trials(trials).with_motion(Some(analysis), &[]);
        identified_ship::from_analysis(analysis, &shared)
    };
    match answer {
        FitAnswer::StraightOn => None,
        FitAnswer::Response(estimate) => {
            identified_ship::from_estimate(estimate, &RecordFacts::from_trials(fitted)).filter(sound)
        }
        FitAnswer::Trace(analysis) => Some(traced(analysis, fitted)).filter(sound).or_else(|| {
            let withheld = [Channel::Speed, Channel::Surge, Channel::Sway];
            let without: Vec<Trial> = fitted.iter().map(|trial| trial.clone().without_channels(&withheld)).collect();
            let analysis = ::trace::trace(&without, &[], settings?).ok()?;
            Some(traced(&analysis, &without)).filter(sound)
        }),
    }
}

/// Characteristics of the validation record, predicted by replaying its rudder with drawn ships at its scale, after
/// removing the current determined from its track.
fn predicted(
    ship: &IdentifiedShip,
    record: &Trial,
    predictions: &PredictionSettings,
) -> Box<[PredictedCharacteristic]> {
    let scaled = match (ship.length_m.zip(ship.speed_m_s), record.particulars()) {
        (Some(_), Some(of_record)) => ship.scaled_to(of_record.length, Some(of_record.speed)).ok(),
        _ => Some(ship.clone()),
    };
    let mixture = scaled.and_then(|ship| ShipMixture::new(vec![(ship, 1.0)]).ok());
    let (record, current) = without_current(record.clone(), None);
    let replay = mixture.and_then(|ships| ships.replay(&record, predictions.draws, current).ok().flatten());
    let Some(replay) = replay else { return Box::default() };
    let is_counted = |name: &str| !is_repeated_in_lengths(name, |lengths| replay.figures.contains_key(lengths));
    let figures = replay.figures.iter().filter(|(name, _)| is_counted(name));
    let figure = |(name, compared): (&String, &predict::replay::ComparedFigure)| PredictedCharacteristic {
        name: name.as_str().into(),
        truth: compared.measured,
        median: compared.interval.median,
        ci90: compared.interval.ci90,
    };
    figures.map(figure).collect()
}
