//! Once-integrated equation of motion at selected instants: T [r(t) − r(0)] + ψ(t) − ψ(0) = K [δ_r t + ∫δ].
//!
//! Source: Ge, Hu, Yin and Sun, Identification of Ship Maneuverability Indexes by Fourier Method, equation (8), with
//! the sign of r(0) corrected.

use nalgebra::Matrix3;

use super::points::rudder_integral;
use super::points_fit::{AnalysedTrial, PointsFit};
use crate::error::IdentifyError;
use crate::savitzky_golay::local_polynomial;
use estimation::least_squares::LeastSquares;

/// Columns of T, K, K δ_r and the right-hand side.
#[derive(Debug, Default)]
struct Equations {
    time_constant: Vec<f64>,
    rudder: Vec<f64>,
    duration: Vec<f64>,
    heading: Vec<f64>,
    /// Index after the last equation of each trial.
    ends: Vec<usize>,
}

/// Heading (rad) and yaw rate (rad/s) at `instant` of a cubic fitted to the rows within the half width of `centre`;
/// `None` if there are fewer than five rows.
fn local_fit(trial: &AnalysedTrial, centre: f64, instant: f64) -> Option<[f64; 2]> {
    let reach = trial.points.fit_half_width * (1.0 + 1e-9);
    let time = &trial.samples.time;
    let rows = time.partition_point(|t| *t < centre - reach)..time.partition_point(|t| *t <= centre + reach);
    // There must be more rows than coefficients, or the fit does not smooth.
    if rows.len() < 5 {
        return None;
    }
    local_polynomial(&time[rows.clone()], &trial.samples.heading[rows], instant, 3).map(|fit| [fit[0], fit[1]])
}

/// Solution at instants one window apart, so that no row serves two instants. ψ(0) + T r(0) is an unknown of every
/// trial, which avoids the one-sided slope at the first row. `bias` is a given δ_r, rad; `None` identifies it.
pub(super) fn identify_at_spaced_instants(
    trials: &[AnalysedTrial],
    bias: Option<f64>,
    condition_limit: f64,
) -> Result<PointsFit, IdentifyError> {
    let mut equations = Equations::default();
    for trial in trials {
        let (width, last) = (trial.points.fit_half_width, trial.samples.time[trial.samples.len() - 1]);
        // Windows must not touch: a row at the end of one window would belong to the next as well.
        let step = 2.0 * width + last / (trial.samples.len() - 1) as f64;
        let mut time = width;
        while time + width <= last {
            if let Some([heading, rate]) = local_fit(trial, time, time) {
                equations.push(-rate, rudder_integral(&trial.samples, time), time, heading, bias);
            }
            time += step;
        }
        equations.ends.push(equations.heading.len());
    }
    let origins: Vec<Vec<f64>> = (0..trials.len()).map(|index| equations.origin(index)).collect();
    equations.solve(&origins, bias, condition_limit)
}

/// Solution of the equation as printed, at the heading extrema: r(t) = 0, so that T multiplies only r(0). `bias` is a
/// given δ_r, rad; `None` identifies it.
pub(super) fn identify_at_extrema(
    trials: &[AnalysedTrial],
    bias: Option<f64>,
    condition_limit: f64,
) -> Result<PointsFit, IdentifyError> {
    let mut equations = Equations::default();
    for trial in trials {
        let [start_heading, start_rate] = if trial.points.starts_at_rest {
            let origin = trial.points.zero_rate_points[0];
            [origin.heading + trial.points.base_course, 0.0]
        } else {
            local_fit(trial, trial.points.fit_half_width, 0.0).ok_or(IdentifyError::TooFewPoints {
                kind: "headings in the first window",
                needed: 5,
                count: trial.samples.time.partition_point(|t| *t <= 2.0 * trial.points.fit_half_width),
            })?
        };
        for point in trial.points.extrema() {
            let heading = point.heading + trial.points.base_course - start_heading;
            equations.push(start_rate, point.rudder_integral, point.time, heading, bias);
        }
        equations.ends.push(equations.heading.len());
    }
    let fit = equations.solve(&[], bias, condition_limit)?;
    Ok(PointsFit { covariance: Err("T depends on a single slope, whose error the residuals do not show"), ..fit })
}

impl Equations {
    fn push(&mut self, time_constant: f64, rudder_integral: f64, duration: f64, heading: f64, bias: Option<f64>) {
        self.time_constant.push(time_constant);
        self.rudder.push(rudder_integral + bias.unwrap_or(0.0) * duration);
        self.duration.push(duration);
        self.heading.push(heading);
    }

    /// Column with 1 in the equations of a trial and 0 in all others.
    fn origin(&self, trial: usize) -> Vec<f64> {
        let start = if trial == 0 { 0 } else { self.ends[trial - 1] };
        (0..self.heading.len()).map(|row| if (start..self.ends[trial]).contains(&row) { 1.0 } else { 0.0 }).collect()
    }

    fn solve(self, origins: &[Vec<f64>], bias: Option<f64>, condition_limit: f64) -> Result<PointsFit, IdentifyError> {
        let mut columns: Vec<&[f64]> = vec![&self.rudder, &self.time_constant];
        if bias.is_none() {
            columns.push(&self.duration);
        }
        columns.extend(origins.iter().map(Vec::as_slice));
        let solution = LeastSquares::solve(&columns, &self.heading, condition_limit)?;
        let (gain, time) = (solution.parameters[0], solution.parameters[1]);
        let gain_bias = bias.map_or_else(|| solution.parameters[2], |bias| bias * gain);
        let covariance = solution.variance().ok_or("no more equations than unknowns").map(|variance| {
            // Order (K, K δ_r, T); with a given δ_r, K δ_r follows from K.
            let entry = |i: usize, j: usize| {
                let column = |index: usize| match (index, bias) {
                    (0, _) => (0, 1.0),
                    (1, Some(bias)) => (0, bias),
                    (1, None) => (2, 1.0),
                    _ => (1, 1.0),
                };
                let ((p, p_factor), (q, q_factor)) = (column(i), column(j));
                p_factor * q_factor * variance * solution.unscaled_covariance[(p, q)]
            };
            (Matrix3::from_fn(entry), solution.degrees_of_freedom)
        });
        Ok(PointsFit {
            parameters: [gain, gain_bias, time],
            covariance,
            diagnostics: vec![("condition", solution.condition_number), ("equations", self.heading.len() as f64)],
        })
    }
}
