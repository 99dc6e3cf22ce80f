//! The first trial of a cell in detail: its characteristics, the Fourier fit, every method's answer and replay, as data
//! for figures. Made once when a study runs, stored, and drawn from the store.

use identify::{Estimate, IdentifierSettings};
use report::figures::{
    CurveFit, DerivativeCurves, Intervals, MethodEstimate, MotionCurves, PointEstimate, Reference, Replays, ZigzagTrial,
};
use report::{CurveOrigin, PlotCurve};
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use simulate::Truth;
use trial::{Quantity, Trial, ZigZag};

use crate::answer::{MethodEntry, entry};
use crate::curves::{curve, origin, replay_curves, zigzag_figure};
use crate::engine;
use crate::task::Task;
use scenario::{Cell, Method, MethodName, Procedure, Published, Scenario};

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
    pub derivatives: Option<DerivativeCurves>,
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
    let trials: Vec<Trial> = simulated.iter().map(|record| record.trial.clone()).collect();
    let (trial, truth) = (&trials[0], &simulated[0].truth);
    let answers: Vec<(MethodEntry, Option<Estimate>)> = cell
        .methods
        .iter()
        .filter_map(|method| {
            // A trace is no first-order response; it has a report of its own.
            let answer = method.procedure.identify(&trials, &engine::key(scenario, first))?;
            Some(entry(&method.label, answer, &trials))
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
        derivatives: (!fits.0.is_empty()).then(|| DerivativeCurves {
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

fn intervals(
    title: Option<String>,
    answers: &[(MethodEntry, Option<Estimate>)],
    names: &[MethodName],
    truth: Option<&FirstOrder>,
    published: &Published,
) -> Intervals {
    let point = |quantity: &Quantity| {
        quantity.value.is_finite().then_some(PointEstimate { value: quantity.value, interval: quantity.ci95 })
    };
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
        origin: CurveOrigin::Truth,
        name: None,
        heading: curve(&truth.time, &truth.heading),
        yaw_rate: curve(&truth.time, &truth.yaw_rate),
        yaw_acceleration: curve(&truth.time, &truth.yaw_acceleration),
    }
}

/// A Fourier curve of the heading; its time runs from the first observed row.
struct FourierFit {
    origin: CurveOrigin,
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
            let Procedure::Identify { settings, .. } = &method.procedure else { return None };
            let fit = match settings {
                Some(IdentifierSettings::FourierPublished(settings)) => {
                    let curve = settings.clone().build().ok()?.curve(trial).ok()?.curve;
                    FourierFit { origin, curve, window: [0.0, trial.duration()] }
                }
                Some(IdentifierSettings::FourierProjected(settings)) => {
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

    fn sampled(&self, trial: &Trial, value: impl Fn(f64) -> f64) -> PlotCurve {
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
