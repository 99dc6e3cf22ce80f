//! Engine: simulates one trial and runs every method on it, one row each. [`crate::plan`] determines which trials are
//! run and in what order, [`crate::block_store`] stores the rows.
//!
//! Random numbers depend on the key of the trial alone, so rows depend neither on threads nor on the order of trials.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use ::trace::comparison::ReplayResult;
use ::trace::{Analysis, TraceError};
use document::names;
use document::trace::LocatedMomentEntry;
use identify::replay::pooled_response_rms;
use identify::{Estimate, StopReason};
use ship::FirstOrder;
use ship::angle::{from_deg, to_deg};
use simulate::{PreparedSimulation, SimulateError, SimulatedTrial, StreamKey};
use trial::{Quantity, Trial};

use crate::identified_ship::{self, RecordFacts};
use crate::prediction_check::PredictionCheck;
use crate::reference::{TrialReference, nearest_first_order};
use crate::rows::{LocatedMoment, NamedEffect, StudyRow, TraceRow};
use crate::scenario::{Procedure, SampledSpecification, Scenario, Specification};
use crate::shard::TrialId;
use crate::statistics::Moments;
use crate::summary::effect_ids;
use crate::timings::TrialTiming;

/// Rows of one trial, and their timing.
pub struct TrialOutcome {
    /// One row per method, in the order of the scenario.
    pub rows: Vec<StudyRow>,
    /// Time of the simulation and of every method.
    pub timing: TrialTiming,
}

/// Prefixes of failures of the trial itself, not of a method.
const NO_TRIAL: [&str; 2] = ["specification:", "simulation:"];

/// `true` for the failure of a method on a trial that could be simulated.
pub fn is_method_failure(failure: &str) -> bool {
    !NO_TRIAL.iter().any(|begin| failure.starts_with(begin))
}

/// Key of all random numbers of one trial.
pub fn stream_key(scenario: &Scenario, task: TrialId) -> StreamKey {
    StreamKey { seed: scenario.seed, cell: task.cell as u64, replicate: task.replicate }
}

/// Simulated records of one trial, further records of the same ship included. Fails if it cannot be simulated.
pub fn simulate(scenario: &Scenario, task: TrialId) -> Result<Vec<SimulatedTrial>, String> {
    let key = stream_key(scenario, task);
    let trial_spec = scenario.cells[task.cell].trial_spec(&key).map_err(|refusal| refusal.to_string())?;
    let records = trial_spec.specification.records(&key).map(|(simulation, key)| simulation.run(&key));
    records.collect::<Result<_, _>>().map_err(|error| error.to_string())
}

/// True first-order responses of a trial, against which estimates are compared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueResponses {
    /// First-order response nearest to the ship, or the ship itself if it is first order; `None` if the fit fails.
    pub nearest: Option<FirstOrder>,
    /// First-order base of a response ship with effects; `None` for a first-order ship or a hull.
    pub base: Option<FirstOrder>,
}

/// True responses of one trial. Fails if its sampled values define no ship, and for measured records.
pub fn true_responses(scenario: &Scenario, task: TrialId) -> Result<TrueResponses, String> {
    let key = stream_key(scenario, task);
    let trial_spec = scenario.cells[task.cell].trial_spec(&key).map_err(|refusal| refusal.to_string())?;
    let Specification { true_response: truth, base_response: base, .. } = &*trial_spec.specification;
    let nearest = truth.or_else(|| Some(nearest_first_order(&trial_spec.specification, &key)?.response));
    Ok(TrueResponses { nearest, base: base.filter(|_| truth.is_none()) })
}

/// Runner of the trials of one study; references and prepared simulations are shared within a cell.
pub struct TrialRunner<'a> {
    scenario: &'a Scenario,
    first_cell: usize,
    references: Vec<OnceLock<TrialReference>>,
    /// Prepared simulations of cells whose trials differ by noise alone; empty above [`MAX_PREPARED_CELLS`] cells.
    prepared: Vec<OnceLock<Result<PreparedSimulation, SimulateError>>>,
}

/// Maximum number of cells with prepared simulations: in a batch with more cells, each cell has few trials, and a
/// record of 1000 rows takes 0.1 MB.
const MAX_PREPARED_CELLS: usize = 64;

impl<'a> TrialRunner<'a> {
    /// Runner for the trials of a range of cells.
    pub fn new(scenario: &'a Scenario, cells: std::ops::RangeInclusive<usize>) -> Self {
        let count = cells.clone().count();
        let kept = if count <= MAX_PREPARED_CELLS { count } else { 0 };
        Self {
            scenario,
            first_cell: *cells.start(),
            references: (0..count).map(|_| OnceLock::new()).collect(),
            prepared: (0..kept).map(|_| OnceLock::new()).collect(),
        }
    }

    fn simulate(
        &self,
        cell: usize,
        trial_spec: &SampledSpecification,
        key: &StreamKey,
    ) -> Result<Vec<SimulatedTrial>, SimulateError> {
        let is_fixed = self.scenario.cells[cell].is_fixed();
        let mut records = trial_spec.specification.records(key);
        let (simulation, key) = records.next().expect("a trial has a record");
        let first = match self.prepared.get(cell - self.first_cell).filter(|_| is_fixed) {
            None => simulation.run(&key),
            Some(prepared) => match prepared.get_or_init(|| PreparedSimulation::new(simulation.clone())) {
                Ok(prepared) => prepared.run(&key),
                Err(error) => Err(error.clone()),
            },
        };
        std::iter::once(first).chain(records.map(|(simulation, key)| simulation.run(&key))).collect()
    }

    /// Runs one trial. A trial that cannot be simulated has a failed row for every method.
    pub fn run(&self, task: TrialId) -> TrialOutcome {
        let cell = &self.scenario.cells[task.cell];
        let key = stream_key(self.scenario, task);
        let start = Instant::now();
        let mut blank = StudyRow { cell: task.cell as u64, replicate: task.replicate, ..StudyRow::default() };
        let trial =
            cell.trial_spec(&key).map_err(|refusal| format!("{} {refusal}", NO_TRIAL[0])).and_then(|trial_spec| {
                blank.drawn_values = (!trial_spec.drawn.is_empty()).then(|| trial_spec.drawn.as_slice().into());
                let simulated = self.simulate(task.cell, &trial_spec, &key);
                Ok((simulated.map_err(|error| format!("{} {error}", NO_TRIAL[1]))?, trial_spec))
            });
        let simulation = start.elapsed();
        let (rows, methods) = match trial {
            Ok((simulated, trial_spec)) => self.answers(task.cell, &key, blank, simulated, &trial_spec),
            Err(reason) => {
                let blank = StudyRow { failure: Some(reason.into()), ..blank };
                ((0..cell.methods.len()).map(|method| StudyRow { method, ..blank.clone() }).collect(), Vec::new())
            }
        };
        TrialOutcome { rows, timing: TrialTiming { cell: task.cell as u64, simulation, methods } }
    }

    /// Rows of all methods on a trial, and their durations.
    fn answers(
        &self,
        index: usize,
        key: &StreamKey,
        blank: StudyRow,
        simulated: Vec<SimulatedTrial>,
        trial_spec: &SampledSpecification,
    ) -> (Vec<StudyRow>, Vec<Duration>) {
        let cell = &self.scenario.cells[index];
        let individual;
        let reference = if cell.is_fixed() {
            self.references[index - self.first_cell].get_or_init(|| self.shared(index))
        } else {
            individual = TrialReference::from_simulated(trial_spec, &simulated, key, cell.is_traced());
            &individual
        };
        let blank = StudyRow {
            true_k_per_s: reference.nearest.map(|nearest| nearest.K()),
            true_t_s: reference.nearest.map(|nearest| nearest.T()),
            base_k_per_s: reference.base.map(|base| base.K()),
            base_t_s: reference.base.map(|base| base.T()),
            cramer_rao_sd: reference.cramer_rao_bound.map(|bound| bound.sd),
            ..blank
        };
        let trials: Vec<Trial> = simulated.into_iter().map(|record| record.trial).collect();
        let Specification { simulation, missing_effects, .. } = &*trial_spec.specification;
        let asked = self.scenario.predictions.as_ref();
        let prediction_check = asked.map(|asked| PredictionCheck::new(asked, simulation, key, &trials));
        let input = TrialInput { trials: &trials, key, reference, missing_effects, prediction_check };
        let row = |(method, procedure)| input.row(procedure, StudyRow { method, ..blank.clone() });
        cell.methods.iter().map(|method| &method.procedure).enumerate().map(row).unzip()
    }

    /// Reference of a cell whose trials share one specification, computed from its first trial.
    fn shared(&self, cell: usize) -> TrialReference {
        let key = stream_key(self.scenario, TrialId { cell, replicate: 0 });
        let Ok(trial_spec) = self.scenario.cells[cell].trial_spec(&key) else { return TrialReference::default() };
        match self.simulate(cell, &trial_spec, &key) {
            Ok(all) => TrialReference::from_simulated(&trial_spec, &all, &key, self.scenario.cells[cell].is_traced()),
            Err(_) => TrialReference { nearest: trial_spec.specification.true_response, ..TrialReference::default() },
        }
    }
}

/// Input of every method on a trial: records, random key, reference, missing effects, and check of predictions, if any.
pub(crate) struct TrialInput<'a> {
    pub trials: &'a [Trial],
    pub key: &'a StreamKey,
    pub reference: &'a TrialReference,
    pub missing_effects: &'a [String],
    pub prediction_check: Option<PredictionCheck<'a>>,
}

impl TrialInput<'_> {
    /// Row of a method on the trial, with the reason if it failed, and the duration of its fit without the scores.
    fn row(&self, procedure: &Procedure, blank: StudyRow) -> (StudyRow, Duration) {
        let start = Instant::now();
        let (row, time) = match procedure {
            Procedure::Trace(settings) => {
                let answer = ::trace::trace(self.trials, &[], settings);
                let time = start.elapsed();
                (
                    answer
                        .map(|analysis| self.row_of_validated_trace(&blank, &analysis))
                        .map_err(|error| trace_failure_kind(&error).into()),
                    time,
                )
            }
            Procedure::StraightOn => (Ok(self.straight_course_row(&blank)), start.elapsed()),
            first_order => {
                let answer = first_order.identify(self.trials, self.key).expect("it is no trace");
                let time = start.elapsed();
                let row = answer.map(|estimate| self.estimate_row(&blank, &estimate));
                (row.map_err(|error| error.row_text().into()), time)
            }
        };
        (row.unwrap_or_else(|reason| StudyRow { failure: Some(reason), ..blank }), time)
    }

    /// Row of a first-order estimate.
    pub fn estimate_row(&self, blank: &StudyRow, estimate: &Estimate) -> StudyRow {
        let error = |trials: &[Trial]| pooled_response_rms(trials, &estimate.response).map(to_deg);
        let validation = self.reference.validation.as_ref();
        let ship = |facts: &RecordFacts| identified_ship::from_estimate(estimate, facts);
        StudyRow {
            heading_rmse_deg: error(self.trials),
            validation_rmse_deg: validation.and_then(|trial| error(std::slice::from_ref(trial))),
            evaluations: Some(estimate.evaluations as f64),
            stop_reason: Some(estimate.stop.as_str()),
            predictions: self.prediction_check.as_ref().map(|check| check.characteristics(ship)),
            ..with_indices(blank, [estimate.K(), estimate.T(), estimate.rudder_bias()])
        }
    }

    /// Row of the null model, a ship that keeps her heading; the initial heading is fitted, as in every method.
    pub fn straight_course_row(&self, blank: &StudyRow) -> StudyRow {
        let error = |trials: &[Trial]| {
            let headings = |trial: &Trial| trial.observed_rows().map(|row| trial.heading()[row]).collect::<Moments>();
            let sums = |sums: [f64; 2], x: Moments| [sums[0] + x.squared_deviation_sum, sums[1] + x.count];
            let [square, rows] = trials.iter().map(headings).fold([0.0; 2], sums);
            finite(to_deg((square / rows).sqrt()))
        };
        let validation = self.reference.validation.as_ref();
        StudyRow {
            heading_rmse_deg: error(self.trials),
            validation_rmse_deg: validation.and_then(|trial| error(std::slice::from_ref(trial))),
            ..blank.clone()
        }
    }

    /// Row of a trace, validated on the undisturbed second manoeuvre.
    fn row_of_validated_trace(&self, blank: &StudyRow, analysis: &Analysis) -> StudyRow {
        let validation = self.reference.validation.as_ref();
        let validation = validation.and_then(|trial| analysis.replay_in_calm(trial, [trial.heading()[0], 0.0]));
        self.trace_row(blank, analysis, validation.as_ref())
    }

    /// Row of a trace: K, T and δ_r of the augmented model, replay errors, and named effects.
    pub fn trace_row(&self, blank: &StudyRow, analysis: &Analysis, validation: Option<&ReplayResult>) -> StudyRow {
        let document = &analysis.document;
        let end = self.trials.iter().filter_map(|trial| trial.time().last().copied()).fold(0.0, f64::max);
        let probability =
            |id: &str| document.candidates.iter().find(|entry| entry.id == id).map_or(0.0, |entry| entry.probability);
        let indices = &document.model.indices;
        let band_coverage = |replay: &ReplayResult| replay.band_coverage().map(|band| band.share());
        // An effect may require speed and sway.
        let identified = |facts: &RecordFacts| {
            Some(identified_ship::from_analysis(analysis, &facts.clone().with_motion(Some(analysis), &[])))
        };
        StudyRow {
            heading_rmse_deg: finite(to_deg(misfit(analysis, self.trials))),
            validation_rmse_deg: validation.and_then(|on| finite(to_deg(on.errors.heading_rmse))),
            stop_reason: Some(StopReason::Converged.as_str()),
            predictions: self.prediction_check.as_ref().map(|check| check.characteristics(identified)),
            traced: Some(Box::new(TraceRow {
                verdict: document.verdict,
                named_effects: document.effects.iter().map(NamedEffect::from_entry).collect(),
                located_moments: document.located.iter().map(|entry| located(entry, end)).collect(),
                probabilities: effect_ids()
                    .map(|id| (Box::from(id), (PROBABILITY_STEPS * probability(id)).round() / PROBABILITY_STEPS))
                    .filter(|(_, probability)| *probability >= MIN_PROBABILITY)
                    .collect(),
                evidence_margin: margin(analysis, self.missing_effects),
                expected_2_ln_lambda: self.reference.expected_2_ln_lambda,
                fitted_band_coverage: band_coverage(&analysis.identification[0].average_replay),
                validation_band_coverage: validation.and_then(band_coverage),
            })),
            ..with_indices(blank, [indices.K_per_s, indices.T_s, indices.delta_r_deg.scaled(from_deg(1.0))])
        }
    }
}

/// Located moment of a row; a moment that ends at or after `end` (s), the end of the records, has no end.
fn located(entry: &LocatedMomentEntry, end: f64) -> LocatedMoment {
    let is_named = |id: &&str| {
        let name = names::effect_name(id);
        let is_of_name = |label: &String| label.split(" (").next() == Some(&name);
        entry.alternatives.iter().any(is_of_name)
    };
    LocatedMoment {
        depends_on: entry.depends_on,
        form: entry.form.as_str().into(),
        from_s: entry.from_s,
        until_s: entry.until_s.filter(|until| *until < end),
        alternatives: effect_ids().filter(is_named).map(Box::from).collect(),
    }
}

/// Root mean square heading error of a traced model over all rows of the records, rad.
fn misfit(analysis: &Analysis, trials: &[Trial]) -> f64 {
    let errors = analysis.identification.iter().map(|judged| judged.average_replay.errors.heading_rmse);
    let rows = trials.iter().map(|trial| trial.len() as f64);
    let (square, rows) =
        errors.clone().zip(rows).fold((0.0, 0.0), |(square, rows), (e, n)| (square + e * e * n, rows + n));
    match analysis.identification.len() {
        1 => errors.sum(),
        _ => (square / rows).sqrt(),
    }
}

/// Kind of a failed trace, for its row: `settings`, `not-finite`, or the kind of the failed fit of its base.
pub(crate) fn trace_failure_kind(error: &TraceError) -> &'static str {
    match error {
        TraceError::Settings(_) | TraceError::NoCandidate { .. } => "settings",
        TraceError::Base(error) => error.kind(),
        TraceError::Replay { .. } => "not-finite",
    }
}

/// Minimum probability that is stored.
const MIN_PROBABILITY: f64 = 0.005;

/// Reciprocal of the step to which probabilities are rounded, so that a stored row equals the computed one.
const PROBABILITY_STEPS: f64 = 1000.0;

/// Log evidence, −ΔBIC/2, of the missing effect less that of the best other effect; `None` unless exactly one effect is
/// missing and both have a ΔBIC.
fn margin(analysis: &Analysis, missing: &[String]) -> Option<f64> {
    let [truth] = missing else { return None };
    let best = |is_truth: bool| {
        let candidates = analysis.document.candidates.iter().filter(|candidate| (candidate.id == *truth) == is_truth);
        candidates.filter_map(|candidate| candidate.delta_bic).map(|delta| -0.5 * delta).max_by(f64::total_cmp)
    };
    Some(best(true)? - best(false)?)
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Row with estimates of K (1/s), T (s) and δ_r (rad) and their intervals.
fn with_indices(blank: &StudyRow, [k, t, bias]: [Quantity; 3]) -> StudyRow {
    StudyRow {
        k_per_s: finite(k.value),
        k_ci95_per_s: k.ci95,
        t_s: finite(t.value),
        t_ci95_s: t.ci95,
        rudder_bias_deg: finite(to_deg(bias.value)),
        rudder_bias_ci95_deg: bias.ci95.map(|ends| ends.map(to_deg)),
        ..blank.clone()
    }
}

/// Cramér–Rao covariance of the relative errors of K and T in a cell, %²; `None` if the bound varies between trials, or
/// if there is no bound.
pub fn cramer_rao_percent2(scenario: &Scenario, cell: usize) -> Option<[[f64; 2]; 2]> {
    let bound = || TrialRunner::new(scenario, cell..=cell).shared(cell).cramer_rao_bound;
    scenario.cells[cell].is_fixed().then(bound).flatten().map(|bound| bound.relative_covariance_percent2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::scenario;

    const TEXT: &str = r#"
question = "?"
seed = 8
ship.first-order = { K-per-s = 0.1, T-s = 25.0 }
manoeuvre.zig-zag = { rudder-deg = 20.0, heading-deg = 20.0 }
steering-gear.rate-deg-s = 2.5
recording = { sampling-s = 1.0, duration-s = 300.0 }
sensor.heading-noise-deg = 0.1
[[effect]]
nonlinear_damping.n3-s2-per-deg2 = 1.0
[[identifier]]
method.output-error = {}
"#;

    fn rows(more: &str) -> Vec<StudyRow> {
        let scenario = scenario(format!("{TEXT}{more}"));
        TrialRunner::new(&scenario, 0..=0).run(TrialId { cell: 0, replicate: 0 }).rows
    }

    /// Information of separate records adds up: two records of one manoeuvre divide the bound, and the spread of the
    /// estimates from both, by √2.
    #[test]
    fn further_records_of_the_ship_are_identified_together() {
        let further = "[[also]]\nmanoeuvre.zig-zag = { rudder-deg = 20.0, heading-deg = 20.0 }\n";
        let linear = TEXT.replace("[[effect]]\nnonlinear_damping.n3-s2-per-deg2 = 1.0\n", "");
        let of = |text: &str, trials: u64| -> Vec<StudyRow> {
            let scenario = scenario(text);
            let runner = TrialRunner::new(&scenario, 0..=0);
            (0..trials).map(|replicate| runner.run(TrialId { cell: 0, replicate }).rows.remove(0)).collect()
        };
        let (single, both) = (of(&linear, 60), of(&format!("{linear}{further}"), 60));
        let bound = |rows: &[StudyRow]| rows[0].cramer_rao_sd.expect("white noise")[0];
        let share = bound(&both) / bound(&single);
        assert!((share - 0.5f64.sqrt()).abs() < 0.01, "two records of one manoeuvre: {share}");
        let spread = |rows: &[StudyRow]| {
            let square = rows.iter().map(|row| row.errors()[0].expect("an answer").powi(2)).sum::<f64>();
            (square / rows.len() as f64).sqrt() * 0.1
        };
        assert!((0.8..1.25).contains(&(spread(&both) / bound(&both))), "{} {}", spread(&both), bound(&both));
        let first = |text: &str| {
            let scenario = scenario(text);
            simulate(&scenario, TrialId { cell: 0, replicate: 0 })
                .expect("records")
                .into_iter()
                .map(|record| record.trial)
        };
        let records: Vec<Trial> = first(&format!("{linear}{further}")).collect();
        let alone = first(&linear).next().expect("a record");
        assert_eq!(alone.heading(), records[0].heading(), "a further record does not change the first");
        assert_ne!(records[0].heading(), records[1].heading(), "each has a chance of its own");
    }

    /// The true response does not depend on the methods: with a trace in addition, the reference of a method is
    /// unchanged.
    #[test]
    fn a_ship_has_one_truth_whoever_asks() {
        let alone = &rows("")[0];
        let [beside, traced] = &rows("[[identifier]]\ntrace = {}\n")[..] else { panic!("two methods") };
        assert_eq!(alone, beside);
        assert_eq!([alone.base_k_per_s, alone.base_t_s], [Some(0.1), Some(25.0)]);
        let nearest = alone.true_t_s.expect("a response is nearest");
        assert!(nearest < 24.0, "the damping shortens T: {nearest}");
        assert_eq!(alone.true_indices()[1], Some(nearest), "output error fits a first-order response");
        assert_eq!(traced.true_indices(), [Some(0.1), Some(25.0)], "a trace models the damping");
        assert!(
            alone.errors()[1].expect("an answer").abs() < 0.01 && traced.errors()[1].expect("an answer").abs() < 0.2
        );
    }
}
