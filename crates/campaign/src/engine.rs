//! The engine: one trial simulated, every method on that same trial, one row each. Which trials there are, and in what
//! order, is decided in [`crate::plan`]; where rows go in [`crate::unfinished`].
//!
//! Everything random follows from the key of a trial, so rows do not depend on threads, order or company.

use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use ::trace::document::EffectEntry;
use ::trace::judge::ReplayResult;
use ::trace::{Analysis, TraceError};
use identify::{Estimate, StopReason};
use predict::IdentifiedShip;
use ship::FirstOrder;
use ship::angle::{from_deg, to_deg};
use simulate::{Prepared, SimulateError, Simulated, StreamKey};
use trial::{Quantity, Trial};

use crate::answer::pooled_rmse_deg;
use crate::design::CellFacts;
use crate::foretell;
use crate::known::{self, Shown};
use crate::rows::{NamedEffect, Row, TraceAnswer};
use crate::summary::effect_ids;
use crate::task::Task;
use crate::timings::Timing;
use crate::yardstick::{Yardstick, nearest_first_order};
use scenario::{Cell, Procedure, Scenario, Specification, Specimen};

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

/// Simulates one trial: its record, and further ones of the same ship where the scenario asks for them.
pub fn simulate(scenario: &Scenario, task: Task) -> Result<Vec<Simulated>, String> {
    let key = key(scenario, task);
    let specimen = scenario.cells[task.cell].specimen(&key).map_err(|refusal| refusal.to_string())?;
    let records = specimen.specification.records(&key).map(|(simulation, key)| simulation.run(&key));
    records.collect::<Result<_, _>>().map_err(|error| error.to_string())
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
    let Specification { truth, base, .. } = &*specimen.specification;
    let nearest = truth.or_else(|| Some(nearest_first_order(&specimen.specification, &key)?.response));
    Ok(Truths { nearest, own: base.filter(|_| truth.is_none()) })
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

    fn simulate(&self, cell: usize, specimen: &Specimen, key: &StreamKey) -> Result<Vec<Simulated>, SimulateError> {
        let is_fixed = self.scenario.cells[cell].is_fixed();
        let mut records = specimen.specification.records(key);
        let (simulation, key) = records.next().expect("a trial has a record");
        let first = match self.prepared.get(cell - self.first_cell).filter(|_| is_fixed) {
            None => simulation.run(&key),
            Some(prepared) => match prepared.get_or_init(|| Prepared::new(simulation.clone())) {
                Ok(prepared) => prepared.run(&key),
                Err(error) => Err(error.clone()),
            },
        };
        std::iter::once(first).chain(records.map(|(simulation, key)| simulation.run(&key))).collect()
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
        let trials: Vec<Trial> = simulated.into_iter().map(|record| record.trial).collect();
        let trials = trials.as_slice();
        let shown = predictions.map(|_| Shown::of(trials));
        let predicted = |known: &dyn Fn(&Shown) -> Option<IdentifiedShip>| {
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
                                ..traced(blank, trials, validation, &analysis, missing, yardstick.expected)
                            }
                        }
                    }
                }
                first_order => {
                    let answer = first_order.identify(trials, &key).expect("it is no trace");
                    methods.push(start.elapsed());
                    match answer {
                        Err(error) => Row { failure: Some(error.in_a_row().into()), ..blank },
                        Ok(estimate) => Row {
                            predicted: predicted(&|shown| known::of_estimate(&estimate, shown)),
                            ..answered(blank, trials, validation, &estimate)
                        },
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

/// Root mean square heading error of a traced model over all rows of its records, rad.
fn misfit(analysis: &Analysis, trials: &[Trial]) -> f64 {
    let errors = analysis.identification.iter().map(|judged| judged.after.errors.heading);
    let mut errors = errors.zip(trials.iter().map(|trial| trial.len() as f64));
    match errors.len() {
        1 => errors.next().map_or(f64::NAN, |(error, _)| error),
        _ => {
            let (square, rows) = errors.fold((0.0, 0.0), |(square, rows), (e, n)| (square + e * e * n, rows + n));
            (square / rows).sqrt()
        }
    }
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
    trials: &[Trial],
    validation: Option<&Trial>,
    analysis: &Analysis,
    missing: &[String],
    expected: Option<f64>,
) -> Row {
    let elsewhere = validation.and_then(|trial| analysis.in_a_calm(trial, [trial.heading()[0], 0.0]));
    let document = &analysis.document;
    let named = |effect: &EffectEntry| {
        let aliases = effect.aliases.iter().filter(|alias| **alias != effect.id);
        NamedEffect { id: effect.id.as_str().into(), aliases: aliases.map(|id| id.as_str().into()).collect() }
    };
    let probability = |id: &str| document.candidates.iter().find(|one| one.id == id).map_or(0.0, |one| one.probability);
    let indices = &document.model.indices;
    Row {
        heading_rmse_deg: finite(to_deg(misfit(analysis, trials))),
        validation_rmse_deg: elsewhere.as_ref().and_then(|on| finite(to_deg(on.errors.heading))),
        stop: Some(StopReason::Converged.as_str()),
        traced: Some(Box::new(TraceAnswer {
            verdict: document.verdict,
            named: document.effects.iter().map(named).collect(),
            probabilities: effect_ids()
                .map(|id| (Box::from(id), (DIGITS * probability(id)).round() / DIGITS))
                .filter(|(_, probability)| *probability >= NEXT_TO_NOTHING)
                .collect(),
            margin: margin(analysis, missing),
            expected,
            band_fitted: analysis.identification[0].after.coverage(),
            band_held_out: elsewhere.as_ref().and_then(ReplayResult::coverage),
        })),
        ..with_indices(blank, [indices.K_per_s, indices.T_s, indices.delta_r_deg.scaled(from_deg(1.0))])
    }
}

/// A smaller probability is not stored.
const NEXT_TO_NOTHING: f64 = 0.005;

/// Probabilities are stored in multiples of one over this, so that a stored row is the one that was computed.
const DIGITS: f64 = 1000.0;

/// By how much more log evidence speaks for the one missing effect than for the best other one.
fn margin(analysis: &Analysis, missing: &[String]) -> Option<f64> {
    let [truth] = missing else { return None };
    let best = |is_truth: bool| {
        let candidates = analysis.document.candidates.iter().filter(|one| (one.id == *truth) == is_truth);
        candidates.filter_map(|one| one.delta_bic).map(|delta| -0.5 * delta).max_by(f64::total_cmp)
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

fn answered(blank: Row, trials: &[Trial], validation: Option<&Trial>, estimate: &Estimate) -> Row {
    let error = |trials: &[Trial]| pooled_rmse_deg(trials, estimate);
    Row {
        heading_rmse_deg: error(trials),
        validation_rmse_deg: validation.and_then(|trial| error(std::slice::from_ref(trial))),
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
        is_nearest: !about.is_first_order(),
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

    /// Information of separate records adds up: the bound of two is that of 1/(1/a + 1/b) where they tell alike, and
    /// what a method makes of both is nearer than what it makes of one.
    #[test]
    fn further_records_of_the_ship_are_identified_together() {
        let further = "[[also]]\nmanoeuvre.zig-zag = { rudder-deg = 20.0, heading-deg = 20.0 }\n";
        let linear = TEXT.replace("[[effect]]\nnonlinear_damping.n3-s2-per-deg2 = 1.0\n", "");
        let of = |text: &str, trials: u64| -> Vec<Row> {
            let scenario = Scenario::parse(Path::new("s.toml"), "s", text.to_owned(), None).expect("it is right");
            let bench = Bench::new(&scenario, 0..=0);
            (0..trials).map(|replicate| bench.run(Task { cell: 0, replicate }).rows.remove(0)).collect()
        };
        let (one, both) = (of(&linear, 60), of(&format!("{linear}{further}"), 60));
        let bound = |rows: &[Row]| rows[0].bound.expect("white noise").k_per_s;
        let share = bound(&both) / bound(&one);
        assert!((share - 0.5f64.sqrt()).abs() < 0.01, "two records of one manoeuvre: {share}");
        let spread = |rows: &[Row]| {
            let square = rows.iter().map(|row| row.k_error().expect("an answer").powi(2)).sum::<f64>();
            (square / rows.len() as f64).sqrt() * 0.1
        };
        assert!((0.8..1.25).contains(&(spread(&both) / bound(&both))), "{} {}", spread(&both), bound(&both));
        let first = |text: &str| {
            let scenario = Scenario::parse(Path::new("s.toml"), "s", text.to_owned(), None).expect("it is right");
            simulate(&scenario, Task { cell: 0, replicate: 0 }).expect("records").into_iter().map(|one| one.trial)
        };
        let records: Vec<Trial> = first(&format!("{linear}{further}")).collect();
        let alone = first(&linear).next().expect("a record");
        assert_eq!(alone.heading(), records[0].heading(), "a further record does not change the first");
        assert_ne!(records[0].heading(), records[1].heading(), "each has a chance of its own");
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
