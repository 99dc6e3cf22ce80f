//! The engine: one trial simulated, every method on that same trial, one row each. Which trials there are, and in what
//! order, is decided in [`crate::plan`]; where rows go in [`crate::unfinished`].
//!
//! Everything random follows from the key of a trial, so rows do not depend on threads, order or company.

use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use ::trace::analysis::{OnRecord, Traced};
use ::trace::{Analysis, TraceError};
use identify::replay::replay;
use identify::{Estimate, Identifier, StopReason, output_error};
use nalgebra::Matrix2;
use predict::KnownShip;
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::recording::RudderColumn;
use simulate::{Disturbances, Prepared, Recording, Sensors, SimulateError, Simulated, Simulation, StreamKey};
use trial::{Quantity, Trial};

use crate::design::CellFacts;
use crate::known::{self, Shown};
use crate::rows::{Bound, NamedEffect, Row, TraceAnswer};
use crate::summary::effect_ids;
use crate::task::Task;
use crate::timings::Timing;
use crate::{bound, foretell};
use scenario::{Cell, Procedure, Scenario, Specification, Specimen, identify};

/// Rows of one trial, and what they took.
pub struct Outcome {
    /// One row per method, in the order of the scenario.
    pub rows: Vec<Row>,
    /// Time to simulate, and of every method.
    pub timing: Timing,
}

/// Key of all that is random in one trial.
pub fn key(scenario: &Scenario, task: Task) -> StreamKey {
    StreamKey { seed: scenario.seed, cell: task.cell as u64, replicate: task.replicate }
}

/// Simulates one trial.
pub fn simulate(scenario: &Scenario, task: Task) -> Result<Simulated, String> {
    let key = key(scenario, task);
    let specimen = scenario.cells[task.cell].specimen(&key).map_err(|refusal| refusal.to_string())?;
    specimen.specification.simulation.run(&key).map_err(|error| error.to_string())
}

/// The responses that answers to a trial are held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truths {
    /// The first-order response nearest to the ship, which is the ship itself where that is first order.
    pub nearest: Option<FirstOrder>,
    /// The ship's own base, where it has effects beside it.
    pub own: Option<FirstOrder>,
}

/// The truths of one trial. Fails when its drawn values make no ship.
pub fn truths(scenario: &Scenario, task: Task) -> Result<Truths, String> {
    let key = key(scenario, task);
    let specimen = scenario.cells[task.cell].specimen(&key).map_err(|refusal| refusal.to_string())?;
    let Specification { simulation, truth, base, .. } = &*specimen.specification;
    let nearest = truth.or_else(|| Some(nearest_first_order(simulation, &key)?.response));
    Ok(Truths { nearest, own: base.filter(|_| truth.is_none()) })
}

/// What the trials of a cell are held against.
struct Yardstick {
    /// The first-order response that comes nearest to the ship: the ship itself where it is exactly first order.
    nearest: Option<FirstOrder>,
    /// The base of a response ship with effects, where that is another one.
    own: Option<FirstOrder>,
    /// Best covariance of (1/T, K/T, δ_r) on this trial, as [`Bound`] and as covariance of relative errors of K and T,
    /// %².
    bound: Option<(Bound, Matrix2<f64>)>,
    /// Undisturbed second manoeuvre, perfectly recorded.
    validation: Option<Trial>,
    /// What a likelihood ratio of the whole truth against the nearest first-order response would be on average.
    expected: Option<f64>,
}

impl Yardstick {
    fn of(specimen: &Specimen, simulated: &Simulated, key: &StreamKey, traces: bool) -> Self {
        let Specification { simulation, validation, truth, base, .. } = &*specimen.specification;
        let near = if truth.is_none() || traces { nearest_first_order(simulation, key) } else { None };
        let nearest = truth.or_else(|| near.as_ref().map(|near| near.response));
        let own = base.filter(|_| truth.is_none());
        let sd = simulation.sensors.declared_noise().heading;
        let bound = nearest.and_then(|nearest| bound::of(simulation, simulated, &nearest));
        let validation = validation.as_ref().and_then(|simulation| simulation.run(key).ok());
        // Of a likelihood with white heading noise: what has a colour is another one.
        let compass = simulation.sensors.heading;
        let white = sd.filter(|_| compass.wander.is_none());
        let ratio =
            |(near, sd): (Nearest, f64)| near.mean_square / (sd * sd) * near.rows.div_ceil(compass.every_rows) as f64;
        let expected = near.filter(|_| traces).zip(white).map(ratio);
        Self { nearest, own, bound, validation: validation.map(|simulated| simulated.trial), expected }
    }
}

/// The first-order response that comes nearest to an undisturbed, perfectly recorded trial, and how near.
struct Nearest {
    response: FirstOrder,
    /// Mean square heading error, rad².
    mean_square: f64,
    rows: usize,
}

/// The first-order response nearest to the trial of a ship that is none.
fn nearest_first_order(simulation: &Simulation, key: &StreamKey) -> Option<Nearest> {
    let calm = Simulation {
        disturbances: Disturbances::default(),
        sensors: Sensors::default(),
        recording: Recording { rudder: RudderColumn::Feedback, ..simulation.recording },
        ..simulation.clone()
    };
    let trial = calm.run(key).ok()?.trial;
    let method = output_error::Settings::default().build().ok()?;
    let response = method.identify(std::slice::from_ref(&trial)).ok()?.response;
    let residual = replay(&trial, &response)?.residual;
    let rows = residual.len();
    Some(Nearest { response, mean_square: residual.iter().map(|e| e * e).sum::<f64>() / rows as f64, rows })
}

/// Runs trials of one study; what all trials of a cell share is made once.
pub struct Bench<'a> {
    scenario: &'a Scenario,
    first_cell: usize,
    yardsticks: Vec<OnceLock<Yardstick>>,
    /// The simulations of cells whose trials differ in nothing but chance; empty where that would not pay.
    prepared: Vec<OnceLock<Result<Prepared, SimulateError>>>,
}

/// Most cells of a bench whose simulations are kept: with more, each has few trials, and a record of 1000 rows takes a
/// tenth of a megabyte.
const MOST_PREPARED: usize = 64;

impl<'a> Bench<'a> {
    /// A bench for trials of these cells.
    pub fn new(scenario: &'a Scenario, cells: std::ops::RangeInclusive<usize>) -> Self {
        let count = cells.clone().count();
        let kept = if count <= MOST_PREPARED { count } else { 0 };
        Self {
            scenario,
            first_cell: *cells.start(),
            yardsticks: (0..count).map(|_| OnceLock::new()).collect(),
            prepared: (0..kept).map(|_| OnceLock::new()).collect(),
        }
    }

    fn simulate(&self, cell: usize, specimen: &Specimen, key: &StreamKey) -> Result<Simulated, SimulateError> {
        let simulation = &specimen.specification.simulation;
        let is_fixed = self.scenario.cells[cell].is_fixed();
        match self.prepared.get(cell - self.first_cell).filter(|_| is_fixed) {
            None => simulation.run(key),
            Some(prepared) => match prepared.get_or_init(|| Prepared::new(simulation.clone())) {
                Ok(prepared) => prepared.run(key),
                Err(error) => Err(error.clone()),
            },
        }
    }

    /// Runs one trial.
    pub fn run(&self, task: Task) -> Outcome {
        let cell = &self.scenario.cells[task.cell];
        let key = key(self.scenario, task);
        let start = Instant::now();
        let specimen = match cell.specimen(&key) {
            Ok(specimen) => specimen,
            Err(refusal) => return nothing(cell, task, None, start.elapsed(), &format!("specification: {refusal}")),
        };
        let simulated = self.simulate(task.cell, &specimen, &key);
        let simulation = start.elapsed();
        let drawn: Option<Arc<[f64]>> = (!specimen.drawn.is_empty()).then(|| specimen.drawn.as_slice().into());
        let simulated = match simulated {
            Ok(simulated) => simulated,
            Err(error) => return nothing(cell, task, drawn, simulation, &format!("simulation: {error}")),
        };
        let own;
        let yardstick = if cell.is_fixed() {
            self.yardsticks[task.cell - self.first_cell].get_or_init(|| self.shared(task.cell))
        } else {
            own = Yardstick::of(&specimen, &simulated, &key, cell.traces());
            &own
        };
        let blank = Row {
            true_k_per_s: yardstick.nearest.map(|nearest| nearest.K()),
            true_t_s: yardstick.nearest.map(|nearest| nearest.T()),
            own_k_per_s: yardstick.own.map(|own| own.K()),
            own_t_s: yardstick.own.map(|own| own.T()),
            bound: yardstick.bound.map(|(bound, _)| bound),
            ..empty(task, drawn)
        };
        let predictions = self.scenario.predictions.as_ref();
        let deeds = predictions.map(|asked| foretell::deeds(asked, &specimen.specification.simulation, &key));
        let trials = std::slice::from_ref(&simulated.trial);
        let shown = predictions.map(|_| Shown::of(trials));
        let predicted = |known: &dyn Fn(&Shown) -> Option<KnownShip>| {
            let ((asked, deeds), shown) = predictions.zip(deeds.as_ref()).zip(shown.as_ref())?;
            Some(known(shown).map(|known| foretell::foretold(asked, known, deeds)).unwrap_or_default())
        };
        let mut rows = Vec::with_capacity(cell.methods.len());
        let mut methods = Vec::with_capacity(cell.methods.len());
        for (index, method) in cell.methods.iter().enumerate() {
            let start = Instant::now();
            let blank = Row { method: index, ..blank.clone() };
            let validation = yardstick.validation.as_ref();
            rows.push(match &method.procedure {
                Procedure::Identify { identifier, .. } => {
                    let answer = identify(identifier.as_ref(), &simulated.trial, &key);
                    methods.push(start.elapsed());
                    match answer {
                        Err(error) => Row { failure: Some(error.kind().into()), ..blank },
                        Ok(estimate) => Row {
                            predicted: predicted(&|shown| known::of_estimate(&estimate, shown)),
                            ..answered(blank, &simulated.trial, validation, &estimate)
                        },
                    }
                }
                Procedure::Trace(settings) => {
                    let answer = ::trace::trace(trials, &[], settings);
                    methods.push(start.elapsed());
                    match answer {
                        Err(error) => Row { failure: Some(reason(&error).into()), ..blank },
                        Ok(analysis) => {
                            let missing = &specimen.specification.missing;
                            Row {
                                // Effects may ask for a speed and a sway.
                                predicted: predicted(&|shown| {
                                    Some(known::of_analysis(&analysis, &shown.clone().with_motion()))
                                }),
                                ..traced(blank, validation, &analysis, missing, yardstick.expected)
                            }
                        }
                    }
                }
            });
        }
        Outcome { rows, timing: Timing { cell: task.cell as u64, simulation, methods } }
    }

    /// The yardstick of a cell whose trials all have one specification: made with its first trial, whichever trial
    /// asks.
    fn shared(&self, cell: usize) -> Yardstick {
        let key = key(self.scenario, Task { cell, replicate: 0 });
        let nothing = Yardstick { nearest: None, own: None, bound: None, validation: None, expected: None };
        let Ok(specimen) = self.scenario.cells[cell].specimen(&key) else { return nothing };
        match self.simulate(cell, &specimen, &key) {
            Ok(simulated) => Yardstick::of(&specimen, &simulated, &key, self.scenario.cells[cell].traces()),
            Err(_) => Yardstick { nearest: specimen.specification.truth, ..nothing },
        }
    }
}

fn empty(task: Task, drawn: Option<Arc<[f64]>>) -> Row {
    Row { cell: task.cell as u64, replicate: task.replicate, drawn, ..Row::default() }
}

/// A trial that could not be made: a row for every method all the same.
fn nothing(cell: &Cell, task: Task, drawn: Option<Arc<[f64]>>, simulation: Duration, reason: &str) -> Outcome {
    let blank = Row { failure: Some(reason.into()), ..empty(task, drawn) };
    let rows = (0..cell.methods.len()).map(|method| Row { method, ..blank.clone() }).collect();
    Outcome { rows, timing: Timing { cell: task.cell as u64, simulation, methods: Vec::new() } }
}

/// Why there is no trace, in a word.
fn reason(error: &TraceError) -> &'static str {
    match error {
        TraceError::Settings(_) => "settings",
        TraceError::Base(error) => error.kind(),
        TraceError::Asked { .. } => "settings",
        TraceError::Replay { .. } => "not-finite",
    }
}

/// The row of a trace: K, T and δ_r of the augmented model, its errors, and what was named.
fn traced(
    blank: Row,
    validation: Option<&Trial>,
    analysis: &Analysis,
    missing: &[String],
    expected: Option<f64>,
) -> Row {
    let elsewhere = validation.and_then(|trial| analysis.in_a_calm(trial, [trial.heading()[0], 0.0]));
    let named = |effect: &Traced| {
        let mut ids = vec![effect.id];
        ids.extend(effect.aliases.iter().map(|(id, _)| *id));
        ids.dedup();
        NamedEffect { id: effect.id.into(), aliases: ids[1..].iter().map(|&id| id.into()).collect() }
    };
    let [k, t] = analysis.indices;
    let bias = analysis.rudder_bias.expect("one record has one rudder bias");
    Row {
        heading_rmse_deg: finite(to_deg(analysis.identification[0].after.errors.heading)),
        validation_rmse_deg: elsewhere.as_ref().and_then(|on| finite(to_deg(on.errors.heading))),
        stop: Some(StopReason::Converged.as_str()),
        traced: Some(Box::new(TraceAnswer {
            verdict: analysis.verdict,
            named: analysis.effects.iter().map(named).collect(),
            probabilities: effect_ids()
                .map(|id| (Box::from(id), (DIGITS * analysis.weights.of_effect(id)).round() / DIGITS))
                .filter(|(_, probability)| *probability >= NEXT_TO_NOTHING)
                .collect(),
            margin: margin(analysis, missing),
            expected,
            band_fitted: analysis.identification[0].after.coverage(),
            band_held_out: elsewhere.as_ref().and_then(OnRecord::coverage),
        })),
        ..with_indices(blank, [k, t, bias])
    }
}

/// A smaller probability is not stored.
const NEXT_TO_NOTHING: f64 = 0.005;

/// Probabilities are stored in multiples of one over this, so that a stored row is the one that was computed.
const DIGITS: f64 = 1000.0;

/// By how much the one missing effect gains more in BIC than the best other one, each added alone.
fn margin(analysis: &Analysis, missing: &[String]) -> Option<f64> {
    let [truth] = missing else { return None };
    let best = |is_truth: bool| {
        let gains = analysis.candidates.iter().filter(|one| (one.id == truth) == is_truth);
        gains.filter_map(|one| one.gain_alone).max_by(f64::total_cmp)
    };
    Some(best(true)? - best(false)?)
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// A row with K (1/s), T (s) and δ_r (rad) and their intervals.
fn with_indices(blank: Row, [k, t, bias]: [Quantity; 3]) -> Row {
    Row {
        k_per_s: finite(k.value),
        k_ci95_per_s: k.ci95,
        t_s: finite(t.value),
        t_ci95_s: t.ci95,
        rudder_bias_deg: finite(to_deg(bias.value)),
        rudder_bias_ci95_deg: bias.ci95.map(|ends| ends.map(to_deg)),
        ..blank
    }
}

fn answered(blank: Row, trial: &Trial, validation: Option<&Trial>, estimate: &Estimate) -> Row {
    let error = |trial: &Trial| replay(trial, &estimate.response).map(|replay| to_deg(replay.rms()));
    Row {
        heading_rmse_deg: error(trial),
        validation_rmse_deg: validation.and_then(error),
        evaluations: Some(estimate.evaluations as u64),
        stop: Some(estimate.stop.as_str()),
        ..with_indices(blank, [estimate.K(), estimate.T(), estimate.rudder_bias()])
    }
}

/// What is known of a cell without its rows.
pub fn facts(scenario: &Scenario, cell: usize) -> CellFacts {
    let bound = || Bench::new(scenario, cell..=cell).shared(cell).bound;
    let about = &scenario.cells[cell];
    let bound = about.is_fixed().then(bound).flatten();
    CellFacts {
        labels: about.labels.clone(),
        values: about.values.clone(),
        trials: 0..0,
        missing: about.missing(),
        has_own_indices: about.has_own_indices(),
        bound_percent2: bound
            .map(|(_, relative)| [[relative[(0, 0)], relative[(0, 1)]], [relative[(1, 0)], relative[(1, 1)]]]),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    const TEXT: &str = r#"
question = "?"
seed = 8
[ship.first-order]
K-per-s = 0.1
T-s = 25.0
[[effect]]
nonlinear_damping.n3-s2-per-deg2 = 1.0
[manoeuvre.zig-zag]
rudder-deg = 20.0
heading-deg = 20.0
[steering-gear]
rate-deg-s = 2.5
[recording]
sampling-s = 1.0
duration-s = 300.0
[sensor]
heading-noise-deg = 0.1
[[identifier]]
method.output-error = {}
"#;

    fn rows(more: &str) -> Vec<Row> {
        let scenario = Scenario::parse(Path::new("s.toml"), "s", format!("{TEXT}{more}"), None)
            .unwrap_or_else(|failure| panic!("{failure}"));
        Bench::new(&scenario, 0..=0).run(Task { cell: 0, replicate: 0 }).rows
    }

    /// The ship is the same whoever asks: a trace beside a method changes nothing of what the method is held against.
    #[test]
    fn a_ship_has_one_truth_whoever_asks() {
        let alone = &rows("")[0];
        let [beside, traced] = &rows("[[identifier]]\ntrace = {}\n")[..] else { panic!("two methods") };
        assert_eq!(alone, beside);
        assert_eq!([alone.own_k_per_s, alone.own_t_s], [Some(0.1), Some(25.0)]);
        let nearest = alone.true_t_s.expect("a response is nearest");
        assert!(nearest < 24.0, "the damping shortens T: {nearest}");
        assert_eq!(alone.truth()[1], Some(nearest), "output error fits a first-order response");
        assert_eq!(traced.truth(), [Some(0.1), Some(25.0)], "a trace models the damping");
        assert!(alone.t_error().expect("an answer").abs() < 0.01 && traced.t_error().expect("an answer").abs() < 0.2);
    }
}
