//! The first trial of a cell in detail: its characteristics, the Fourier fit, every method's answer and replay, as data
//! for figures. Made once when a study runs, stored, and drawn from the store.

use identify::replay::replay;
use identify::{Estimate, IdentifierSettings};
use report::figures::{
    CurveFit, Derivatives, Intervals, Mark, MethodEstimate, MotionCurves, Overshoot, PointEstimate, Reference, Replay,
    Replays, Span, ZigzagTrial,
};
use report::{Curve, Origin};
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::Truth;
use trial::{Trial, ZigZag};

use crate::engine;
use crate::json::{self, MethodEntry, Value};
use crate::plan::Task;
use crate::scenario::{Cell, Means, Method, MethodName, Published, Scenario, identify};

/// The first trial of one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Showcase {
    /// Title of the cell.
    pub title: String,
    /// The trial with its characteristic points; absent when it is not a zig-zag.
    pub trial: Option<ZigzagTrial>,
    /// The Fourier fit with its residual.
    pub fourier_fit: Option<CurveFit>,
    /// Heading, yaw rate and yaw acceleration of the fits against the truth.
    pub derivatives: Option<Derivatives>,
    /// Every method's replay.
    pub replays: Replays,
    /// K and T of every method.
    pub intervals: Intervals,
    /// The numbers behind the figures.
    pub methods: Vec<MethodEntry>,
}

/// Points of a fitted curve between two rows of the record.
const POINTS_PER_ROW: usize = 4;

/// The showcase of a cell; `None` when its first trial could not be simulated.
pub fn of_cell(scenario: &Scenario, index: usize) -> Option<Showcase> {
    let cell = &scenario.cells[index];
    let first = Task { cell: index, replicate: 0 };
    let simulated = engine::simulate(scenario, first).ok()?;
    let truth_of_ship = cell.specimen(&engine::key(scenario, first)).ok()?.specification.truth;
    let (trial, truth) = (&simulated.trial, &simulated.truth);
    let answers: Vec<(MethodEntry, Option<Estimate>)> = cell
        .methods
        .iter()
        .filter_map(|method| {
            // A trace is no first-order response; it has a report of its own.
            let Means::Identify { identifier, .. } = &method.means else { return None };
            let answer = identify(identifier.as_ref(), trial, &engine::key(scenario, first));
            Some(json::entry(&method.label, answer, std::slice::from_ref(trial)))
        })
        .collect();
    let title = |what: &str| match cell.labels.is_empty() {
        true => Some(what.to_owned()),
        false => Some(format!("{}: {what}", cell.title())),
    };
    let names = scenario.method_names();
    let fits = FourierFits::of(cell, &names, trial);
    Some(Showcase {
        title: cell.title(),
        trial: ZigZag::of(trial).ok().map(|zigzag| ZigzagTrial {
            title: title("zig-zag trial"),
            truth: Some(curve(&truth.time, &truth.heading)),
            ..zigzag_figure(trial, &zigzag)
        }),
        fourier_fit: fits.first().map(|fit| CurveFit { title: title("Fourier fit"), ..fit.curve_fit(trial) }),
        derivatives: (!fits.0.is_empty()).then(|| Derivatives {
            title: title("heading and its derivatives"),
            curves: std::iter::once(truth_curves(truth)).chain(fits.0.iter().map(|fit| fit.motion(trial))).collect(),
        }),
        replays: Replays {
            title: title("replay of every K and T"),
            record: curve(trial.time(), trial.heading()),
            truth: None,
            replays: replay_curves(trial, &answers, |label| origin(&names, label)),
        },
        intervals: intervals(title("K and T"), &answers, &names, truth_of_ship.as_ref(), &scenario.published),
        methods: answers.into_iter().map(|(entry, _)| entry).collect(),
    })
}

/// How a method of a scenario is drawn: as itself when it goes by its id, else as a variant of it.
pub fn origin(names: &[MethodName], label: &str) -> Origin {
    match names.iter().find(|name| name.label == label) {
        Some(own) if own.id != label => {
            let mut variants = names.iter().filter(|name| name.id == own.id && name.label != name.id);
            let number = variants.position(|name| name.label == label).unwrap_or(0);
            Origin::Variant { label: label.to_owned(), method: own.id.clone(), number }
        }
        _ => Origin::Method(label.to_owned()),
    }
}

/// Radians over seconds as degrees over seconds.
pub fn curve(time: &[f64], angle: &[f64]) -> Curve {
    Curve::new(time, angle.iter().map(|&angle| to_deg(angle)).collect::<Vec<_>>())
}

/// The trial with its characteristic points marked.
pub fn zigzag_figure(trial: &Trial, zigzag: &ZigZag) -> ZigzagTrial {
    let mark = |time: f64, heading: f64| Mark { t_s: time, heading_deg: to_deg(heading) };
    let span = |from: f64, length: f64| Span { from_s: from, to_s: from + length };
    let first = zigzag.executes.first();
    // The cycle that begins with the second execute of a trial holds the transient of the start: drawn only if alone.
    let settled = if zigzag.begins_within_trial() { 0 } else { 2 };
    let cycle_start = match zigzag.executes.len() > settled + 2 {
        true => zigzag.executes.get(settled),
        false => zigzag.executes.get(1),
    };
    ZigzagTrial {
        title: None,
        heading: curve(trial.time(), trial.heading()),
        // What is left of a thinned record are its extremes: as points they would be taken for the record.
        heading_as_points: trial.len() <= Curve::MOST_PAIRS && zigzag.heading_noise.is_some_and(|sd| to_deg(sd) > 0.02),
        rudder: curve(trial.time(), trial.rudder()),
        truth: None,
        executes: zigzag.executes.iter().map(|execute| mark(execute.time.value, execute.heading.value)).collect(),
        overshoots: zigzag
            .overshoots
            .iter()
            .map(|overshoot| {
                let execute = &zigzag.executes[overshoot.execute];
                Overshoot {
                    execute: mark(execute.time.value, execute.heading.value),
                    extremum: mark(overshoot.peak_time.value, overshoot.peak_heading.value),
                    angle_deg: to_deg(overshoot.angle.value),
                }
            })
            .collect(),
        initial_turning: first
            .zip(zigzag.initial_turning_time)
            .map(|(execute, time)| span(execute.time.value, time.value)),
        check_yaw: zigzag
            .overshoots
            .iter()
            .map(|overshoot| span(zigzag.executes[overshoot.execute].time.value, overshoot.time_to_check_yaw.value))
            .collect(),
        period: cycle_start.zip(zigzag.period).map(|(execute, period)| span(execute.time.value, period.value)),
    }
}

/// Replays of all answers, for a figure; methods that failed are left out.
pub fn replay_curves(
    trial: &Trial,
    answers: &[(MethodEntry, Option<Estimate>)],
    origin: impl Fn(&str) -> Origin,
) -> Vec<Replay> {
    answers
        .iter()
        .filter_map(|(entry, estimate)| {
            let replay = replay(trial, &estimate.as_ref()?.response)?;
            Some(Replay {
                origin: origin(&entry.method),
                heading: curve(&replay.time, &replay.heading),
                residual: curve(&replay.residual_time, &replay.residual),
                rms_deg: Some(replay.heading_rmse_deg),
            })
        })
        .collect()
}

fn intervals(
    title: Option<String>,
    answers: &[(MethodEntry, Option<Estimate>)],
    names: &[MethodName],
    truth: Option<&FirstOrder>,
    published: &Published,
) -> Intervals {
    let point = |value: &Value| value.value.map(|number| PointEstimate { value: number, interval: value.ci95 });
    Intervals {
        title,
        estimates: answers
            .iter()
            .map(|(entry, _)| MethodEstimate {
                origin: origin(names, &entry.method),
                k_per_s: entry.parameters.as_ref().and_then(|parameters| point(&parameters.k_per_s)),
                t_s: entry.parameters.as_ref().and_then(|parameters| point(&parameters.t_s)),
            })
            .collect(),
        truth: truth.map(|truth| Reference { k_per_s: truth.K(), t_s: truth.T() }),
        published: published.k_per_s.zip(published.t_s).map(|(k_per_s, t_s)| Reference { k_per_s, t_s }),
    }
}

fn truth_curves(truth: &Truth) -> MotionCurves {
    MotionCurves {
        origin: Origin::Truth,
        name: None,
        heading: curve(&truth.time, &truth.heading),
        yaw_rate: curve(&truth.time, &truth.yaw_rate),
        yaw_acceleration: curve(&truth.time, &truth.yaw_acceleration),
    }
}

/// A Fourier curve of the heading; its time runs from the first observed row.
struct FourierFit {
    origin: Origin,
    curve: identify::fourier::FourierFit,
    window: [f64; 2],
}

/// The Fourier curves of the methods of a cell that have one.
struct FourierFits(Vec<FourierFit>);

impl FourierFits {
    fn of(cell: &Cell, names: &[MethodName], trial: &Trial) -> Self {
        let mut seen = Vec::new();
        let fit = |method: &Method| {
            // One curve for each kind of method: variants differ in what they do with it.
            if seen.contains(&method.id) {
                return None;
            }
            let origin = origin(names, &method.label);
            let Means::Identify { settings, .. } = &method.means else { return None };
            let fit = match settings {
                IdentifierSettings::FourierPublished(settings) => {
                    let curve = settings.clone().build().ok()?.curve(trial).ok()?.curve;
                    FourierFit { origin, curve, window: [0.0, trial.duration()] }
                }
                IdentifierSettings::FourierProjected(settings) => {
                    let curves = settings.clone().build().ok()?.curves(trial).ok()?;
                    FourierFit { origin, curve: curves.heading.curve, window: curves.window }
                }
                _ => return None,
            };
            seen.push(method.id);
            Some(fit)
        };
        Self(cell.methods.iter().filter_map(fit).collect())
    }

    fn first(&self) -> Option<&FourierFit> {
        self.0.first()
    }
}

impl FourierFit {
    /// Times within the window, dense enough to look smooth, from the first observed row.
    fn times(&self, trial: &Trial) -> Vec<f64> {
        let [from, to] = self.window;
        let points = trial.len() * POINTS_PER_ROW;
        (0..=points).map(|k| from + (to - from) * k as f64 / points as f64).collect()
    }

    fn sampled(&self, trial: &Trial, value: impl Fn(f64) -> f64) -> Curve {
        let start = start_of(trial);
        let times = self.times(trial);
        let values: Vec<f64> = times.iter().map(|&t| value(t)).collect();
        curve(&times.iter().map(|t| t + start).collect::<Vec<_>>(), &values)
    }

    fn motion(&self, trial: &Trial) -> MotionCurves {
        MotionCurves {
            origin: self.origin.clone(),
            name: None,
            heading: self.sampled(trial, |t| self.curve.heading(t)),
            yaw_rate: self.sampled(trial, |t| self.curve.yaw_rate(t)),
            yaw_acceleration: self.sampled(trial, |t| self.curve.yaw_acceleration(t)),
        }
    }

    fn curve_fit(&self, trial: &Trial) -> CurveFit {
        let start = start_of(trial);
        let residual: Vec<f64> =
            trial.time().iter().zip(trial.heading()).map(|(t, psi)| psi - self.curve.heading(t - start)).collect();
        CurveFit {
            title: None,
            measured: curve(trial.time(), trial.heading()),
            fitted: self.sampled(trial, |t| self.curve.heading(t)),
            fitted_name: format!("{}, {} harmonics", self.origin.label(), self.curve.cosine.len()),
            residual: curve(trial.time(), &residual),
            r_squared: Some(self.curve.r_squared),
            fundamental_rad_s: Some(self.curve.fundamental),
        }
    }
}

/// Time of the first observed row, s.
fn start_of(trial: &Trial) -> f64 {
    trial.observed_rows().next().map_or(0.0, |row| trial.time()[row])
}
