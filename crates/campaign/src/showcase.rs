//! Showcase of a cell: the first trial in detail, with its characteristics, Fourier fit, and the estimates and replays
//! of all methods, as plot data. It is computed in the run of a study, and plotted from the stored file.

use document::method::MethodEntry;
use identify::method_entry::method_entry;
use identify::{Estimate, IdentifierSettings};
use report::figures::ZigZagPlot;
use report::{CurveOrigin, PlotCurve};
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use simulate::Truth;
use trial::{Quantity, Trial, ZigZag};

use crate::curves::{angle_curve_deg, curve_origin, replay_curves, zigzag_plot_data};
use crate::engine;
use crate::scenario::{DesignCell, Method, MethodName, Procedure, Published, Scenario};
use crate::shard::TrialId;
use crate::stored_figures::{
    ConfidenceIntervals, DerivativeCurves, EstimateWithInterval, FourierFitCurves, MethodEstimate, MotionCurves,
    ReferenceIndices, Replays,
};

/// First trial of a cell in detail.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Showcase {
    /// Title of the cell.
    pub title: String,
    /// Trial with its characteristic points; absent if it is not a zig-zag.
    pub trial: Option<ZigZagPlot>,
    /// Fourier fit with its residual.
    pub fourier_fit: Option<FourierFitCurves>,
    /// Heading, yaw rate and yaw acceleration of the fits against the truth.
    pub derivatives: Option<DerivativeCurves>,
    /// Replays of the methods.
    pub replays: Replays,
    /// K and T of every method.
    pub intervals: ConfidenceIntervals,
    /// Results of the methods.
    pub methods: Vec<ShowcaseAnswer>,
}

/// Result of one method, with the texts of the warnings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ShowcaseAnswer {
    /// Entry of the method.
    #[serde(flatten)]
    pub entry: MethodEntry,
    /// Texts of the warnings.
    pub warnings: Vec<String>,
}

/// Number of points of a fitted curve per row of the record.
const POINTS_PER_ROW: usize = 4;

/// Showcase of a cell; `None` if its first trial cannot be simulated.
pub fn from_cell(scenario: &Scenario, index: usize) -> Option<Showcase> {
    let cell = &scenario.cells[index];
    let first = TrialId { cell: index, replicate: 0 };
    let simulated = engine::simulate(scenario, first).ok()?;
    let truth_of_ship = cell.trial_spec(&engine::stream_key(scenario, first)).ok()?.specification.true_response;
    let trials: Vec<Trial> = simulated.iter().map(|record| record.trial.clone()).collect();
    let (trial, truth) = (&trials[0], &simulated[0].truth);
    let answer = |method: &Method| {
        // A trace gives no first-order estimate; it has its own report.
        let answer = method.procedure.identify(&trials, &engine::stream_key(scenario, first))?;
        Some(method_entry(&method.label, answer, &trials))
    };
    let answers: Vec<(MethodEntry, Option<Estimate>)> = cell.methods.iter().filter_map(answer).collect();
    let shown = |(entry, estimate): (MethodEntry, Option<Estimate>)| {
        let warnings = estimate.into_iter().flat_map(|estimate| estimate.warnings).map(|warning| warning.text);
        ShowcaseAnswer { entry, warnings: warnings.collect() }
    };
    let names = scenario.method_names();
    let fits = FourierCurve::from_cell(cell, &names, trial);
    Some(Showcase {
        title: cell.title(),
        trial: ZigZag::from_trial(trial).ok().map(|zigzag| ZigZagPlot {
            truth: Some(angle_curve_deg(&truth.time, &truth.heading)),
            ..zigzag_plot_data(trial, &zigzag)
        }),
        fourier_fit: fits.first().map(|fit| fit.curve_fit()),
        derivatives: (!fits.is_empty()).then(|| DerivativeCurves {
            curves: std::iter::once(truth_curves(truth)).chain(fits.iter().map(FourierCurve::motion)).collect(),
        }),
        replays: Replays {
            record: angle_curve_deg(trial.time(), trial.heading()),
            truth: None,
            replays: replay_curves(trial, &answers, |label| curve_origin(&names, label)),
        },
        intervals: intervals(&answers, &names, truth_of_ship.as_ref(), &scenario.published),
        methods: answers.into_iter().map(shown).collect(),
    })
}

fn intervals(
    answers: &[(MethodEntry, Option<Estimate>)],
    names: &[MethodName],
    truth: Option<&FirstOrder>,
    published: &Published,
) -> ConfidenceIntervals {
    let point = |quantity: Quantity| {
        quantity.value.is_finite().then_some(EstimateWithInterval { value: quantity.value, interval: quantity.ci95 })
    };
    let estimate = |(entry, _): &(MethodEntry, Option<Estimate>)| MethodEstimate {
        origin: curve_origin(names, &entry.method),
        k_per_s: entry.parameters.and_then(|parameters| point(parameters.k_per_s)),
        t_s: entry.parameters.and_then(|parameters| point(parameters.t_s)),
    };
    ConfidenceIntervals {
        estimates: answers.iter().map(estimate).collect(),
        truth: truth.map(|truth| ReferenceIndices { k_per_s: truth.K(), t_s: truth.T() }),
        published: published.K_per_s.zip(published.T_s).map(|(k_per_s, t_s)| ReferenceIndices { k_per_s, t_s }),
    }
}

fn truth_curves(truth: &Truth) -> MotionCurves {
    MotionCurves {
        origin: CurveOrigin::Truth,
        name: None,
        heading: angle_curve_deg(&truth.time, &truth.heading),
        yaw_rate: angle_curve_deg(&truth.time, &truth.yaw_rate),
        yaw_acceleration: angle_curve_deg(&truth.time, &truth.yaw_acceleration),
    }
}

/// Fourier curve of the heading of a trial; its time begins at the first observed row.
struct FourierCurve<'a> {
    origin: CurveOrigin,
    trial: &'a Trial,
    curve: identify::fourier::FourierSeries,
    /// Begin and end of the plotted curve, s from the first observed row.
    window: [f64; 2],
}

impl<'a> FourierCurve<'a> {
    /// Fourier curves of the methods of a cell; of several variants of a method, the curve of the first.
    fn from_cell(cell: &DesignCell, names: &[MethodName], trial: &'a Trial) -> Vec<Self> {
        let mut seen = Vec::new();
        let fit = |method: &Method| {
            let Procedure::Identify { settings: Some(settings), .. } = &method.procedure else { return None };
            let (curve, window) = match settings {
                _ if seen.contains(&method.procedure.id()) => return None,
                IdentifierSettings::FourierPublished(settings) => {
                    (settings.clone().build().ok()?.curve(trial).ok()?.curve, [0.0, trial.duration()])
                }
                IdentifierSettings::FourierProjected(settings) => {
                    let curves = settings.clone().build().ok()?.curves(trial).ok()?;
                    (curves.heading.curve, curves.window)
                }
                _ => return None,
            };
            seen.push(method.procedure.id());
            Some(Self { origin: curve_origin(names, &method.label), trial, curve, window })
        };
        cell.methods.iter().filter_map(fit).collect()
    }

    /// Time of the first observed row, s.
    fn start(&self) -> f64 {
        self.trial.observed_rows().next().map_or(0.0, |row| self.trial.time()[row])
    }

    /// Curve, in deg, of a function of time (s) in rad over the window, dense enough for a smooth line.
    fn sampled(&self, value: impl Fn(f64) -> f64) -> PlotCurve {
        let [from, to] = self.window;
        let points = self.trial.len() * POINTS_PER_ROW;
        let times = (0..=points).map(|k| from + (to - from) * k as f64 / points as f64);
        let (times, values): (Vec<f64>, Vec<f64>) = times.map(|t| (t + self.start(), value(t))).unzip();
        angle_curve_deg(&times, &values)
    }

    fn motion(&self) -> MotionCurves {
        MotionCurves {
            origin: self.origin.clone(),
            name: None,
            heading: self.sampled(|t| self.curve.heading_at(t)),
            yaw_rate: self.sampled(|t| self.curve.yaw_rate_at(t)),
            yaw_acceleration: self.sampled(|t| self.curve.yaw_acceleration_at(t)),
        }
    }

    fn curve_fit(&self) -> FourierFitCurves {
        let (time, heading) = (self.trial.time(), self.trial.heading());
        let rows = time.iter().zip(heading);
        let residual: Vec<f64> = rows.map(|(t, psi)| psi - self.curve.heading_at(t - self.start())).collect();
        FourierFitCurves {
            measured: angle_curve_deg(time, heading),
            fitted: self.sampled(|t| self.curve.heading_at(t)),
            origin: Some(self.origin.clone()),
            fitted_name: format!("{}, {} harmonics", self.origin.label(), self.curve.cosine.len()),
            residual: angle_curve_deg(time, &residual),
            r_squared: Some(self.curve.r_squared),
            fundamental_rad_s: Some(self.curve.fundamental),
        }
    }
}
