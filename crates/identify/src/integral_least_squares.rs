//! The equation of motion integrated twice and solved by least squares: no derivative of the heading, no search.
//!
//! ψ(t) = c₀ + c₁ t − a ∫ψ + b ∫∫δ + b δ_r t²/2, with a = 1/T and b = K/T. The initial state hides in c₀ and c₁, which
//! every stretch between gaps has for itself; a, b and b δ_r are common to all stretches of all trials. The method is
//! nearly as good as output error for white heading noise; a yaw disturbance is outside it. For the iteration that
//! removes the rest of the loss see the output-error and instrumental-variable methods.

mod noise;

use std::ops::Range;

use lanes::column::{dot, gram, project, sum};
use nalgebra::{Matrix3, Matrix4, SymmetricEigen, Vector3};
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use ship::angle::to_deg;
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason, Uncertainty};
use crate::gaps::{longest_gap, pieces};
use crate::identifier::{Accuracy, Identifier, Promises};
use crate::robust::{judge, newey_west_of_three};
use crate::samples::Samples;
use crate::settings::{SettingsError, check_condition_limit, check_longest_gap};
use noise::Noise;

/// Fewest headings in a stretch between gaps that can say more than its own initial state.
const FEWEST_IN_PIECE: usize = 4;

/// Shared parameters a, b, b δ_r.
const SHARED: usize = 3;

/// Their columns and the heading.
const WIDTH: usize = SHARED + 1;

/// Settings of [`IntegralLeastSquares`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Settings {
    /// Longest interval between headings that is integrated across, s; without it five mean intervals of the record.
    pub longest_gap_s: Option<f64>,
    /// Largest accepted condition number of the equations (see [`IntegralLeastSquares`]).
    pub condition_limit: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { longest_gap_s: None, condition_limit: 1e5 }
    }
}

impl Settings {
    /// Checks the settings and makes the method.
    ///
    /// Fails when the gap is not positive or the condition limit is not above 1.
    pub fn build(self) -> Result<IntegralLeastSquares, SettingsError> {
        check_longest_gap(self.longest_gap_s)?;
        check_condition_limit(self.condition_limit)?;
        Ok(IntegralLeastSquares { settings: self })
    }
}

/// Least squares on the equation of motion integrated twice.
///
/// The rudder integrals are exact for a rudder that is linear between rows, the integral of the heading is that of a
/// cubic Hermite interpolation. The equations are solved in normal form, with c₀ and c₁ of every stretch projected
/// out; the condition number is the reciprocal of the smallest singular value of the projected columns, each divided
/// by its length before the projection.
///
/// The covariance is that of white heading noise n seen through the equation, e = n + a ∫n, with the variance of n
/// estimated from the residual. The robust covariance (Newey and West 1987) takes the noise that was found, row by row,
/// so it also holds for coloured heading noise; neither holds for a yaw disturbance that lasts. Nor does either count the
/// bias by the noise of ∫ψ, a regressor, which pulls 1/T towards zero where headings come too rarely: with an interval
/// beyond T / 2 the interval of T holds the truth in 85 of 100 records instead of 95, beyond 2 T in 65.
///
/// Fails with [`IdentifyError::Singular`] above the condition limit, and with [`IdentifyError::NotAShip`] when K/T is
/// not positive. A negative 1/T is an answer: the ship is course-unstable.
#[derive(Debug, Clone, PartialEq)]
pub struct IntegralLeastSquares {
    settings: Settings,
}

impl Identifier for IntegralLeastSquares {
    fn id(&self) -> &'static str {
        "integral-least-squares"
    }

    fn summary(&self) -> &'static str {
        "least squares on the equation of motion integrated twice: no derivatives, no search"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let samples = Samples::of_all(trials, Trial::FEWEST_ROWS)?;
        let mut pieces = self.stretches(&samples)?;
        let solution = Solution::of(&mut pieces, self.settings.condition_limit)?;
        let [a, b, beta] = solution.parameters.into();
        if b.is_nan() || b <= 0.0 {
            return Err(IdentifyError::NotAShip { inverse_time: a, gain: b });
        }
        let response = FirstOrder { inverse_T: a, K_over_T: b, rudder_bias: beta / b };
        let noise = Noise::of(&pieces, &solution);
        // δ_r = (b δ_r)/b.
        let to_base = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -beta / (b * b), 1.0 / b) * solution.inverse;
        let base = |matrix: Matrix3<f64>| to_base * matrix * to_base.transpose();
        let covariance =
            |matrix| Covariance { matrix: base(matrix), degrees_of_freedom: Some(noise.degrees_of_freedom) };
        let robust = noise.variance.map(|_| covariance(newey_west_of_three(&noise.scores) * noise.finite_sample));
        let equations = pieces.iter().map(|piece| piece.time.len()).sum::<usize>();
        let (uncertainty, warning) = match (noise.variance, &robust) {
            (Some(variance), Some(robust)) => {
                judge(covariance(noise.influence * variance), robust, noise.lag1, equations)
            }
            _ => (Uncertainty::None { reason: "no more equations than unknowns" }, None),
        };
        let mut diagnostics = vec![
            ("condition", solution.condition),
            ("equations", equations as f64),
            ("lag1_autocorrelation", noise.lag1),
            ("stretches_without_gap", pieces.len() as f64),
        ];
        diagnostics.extend(noise.variance.map(|variance| ("heading_noise_deg", to_deg(variance.sqrt()))));
        Ok(Estimate {
            response,
            uncertainty,
            robust,
            stop: StopReason::Direct,
            evaluations: 1,
            diagnostics,
            warnings: warnings(trials, pieces.len()).into_iter().chain(warning).collect(),
        })
    }

    fn promises(&self) -> Promises {
        // Where whole rows are lost the rudder between them is a straight line as well. An error of it grows with time in an
        // equation that is integrated twice, while it dies out in a simulation: 0.3 % of T against 0.1 %.
        Promises { with_gaps: Accuracy { K: 0.001, T: 0.005, rudder_bias_deg: 0.012 }, ..Promises::default() }
    }
}

impl IntegralLeastSquares {
    /// The stretches between gaps of all trials that are long enough to be of use.
    fn stretches<'a>(&self, samples: &'a [Samples]) -> Result<Vec<Piece<'a>>, IdentifyError> {
        let mut found = Vec::with_capacity(samples.len());
        for trial in samples {
            let gap = longest_gap(self.settings.longest_gap_s, &trial.time);
            let long_enough = |rows: &Range<usize>| rows.len() >= FEWEST_IN_PIECE;
            found.extend(pieces(&trial.time, gap).filter(long_enough).map(|rows| Piece::new(trial, rows)));
        }
        let equations: usize = found.iter().map(|piece| piece.time.len()).sum();
        // Initial states, the shared parameters, and as many equations left to tell their error from.
        let needed = 2 * SHARED + 2 * found.len().max(1);
        if equations < needed {
            return Err(IdentifyError::TooFewPoints {
                what: "headings in stretches without a gap",
                needed,
                found: equations,
            });
        }
        Ok(found)
    }
}

fn warnings(trials: &[Trial], pieces: usize) -> Vec<String> {
    let mut warnings = Vec::new();
    if pieces > trials.len() {
        warnings.push(format!(
            "gaps cut the record into {pieces} stretches, each with an initial state of its own; longest-gap-s moves the limit"
        ));
    }
    for trial in trials.iter().filter(|trial| trial.heading_from_yaw_rate()) {
        warnings.push(format!(
            "the heading of {} is the integral of its yaw rate, whose noise is not white as the covariance takes it to be",
            trial.name()
        ));
    }
    warnings
}

/// One stretch without a gap: its times and the columns of its equations.
#[derive(Debug)]
struct Piece<'a> {
    time: &'a [f64],
    /// The columns of a, b, b δ_r (rad s, rad s², s²) and the heading (rad).
    columns: [Vec<f64>; WIDTH],
}

impl<'a> Piece<'a> {
    /// Takes the rows of a stretch with origins of its own: what is linear in time belongs to the initial state, so
    /// that nothing but lost digits depends on them.
    fn new(samples: &'a Samples, range: Range<usize>) -> Self {
        let (time, heading) = (&samples.time[range.clone()], &samples.heading[range.clone()]);
        let once = samples.rudder_integral[range.start];
        let twice = &samples.rudder_double_integral[range];
        let (start, middle) = (time[0], 0.5 * (time[0] + time[time.len() - 1]));
        let half_square = |t: &f64| 0.5 * (t - middle) * (t - middle);
        let columns = [
            // The integral is that of the heading less its first value.
            minus_integral(time, heading),
            time.iter().zip(twice).map(|(t, integral)| integral - twice[0] - once * (t - start)).collect(),
            time.iter().map(half_square).collect(),
            heading.iter().map(|psi| psi - heading[0]).collect(),
        ];
        Self { time, columns }
    }

    /// Projects c₀ and c₁ out of all columns; adds the squared lengths that the columns had before to `lengths` and
    /// the cross products they have after to `products`.
    fn project(&mut self, lengths: &mut Vector3<f64>, products: &mut Matrix4<f64>) {
        let count = self.time.len() as f64;
        let middle = sum(self.time) / count;
        let mut unit: Vec<f64> = self.time.iter().map(|t| t - middle).collect();
        let length = dot(&unit, &unit).sqrt();
        let scale = 1.0 / length;
        unit.iter_mut().for_each(|s| *s *= scale);
        let removed = self.columns.each_mut().map(|column| project(&unit, column));
        let [x0, x1, x2, y] = &self.columns;
        let sums = Matrix4::from(gram([x0, x1, x2, y]));
        for i in 0..SHARED {
            lengths[i] += sums[(i, i)] + count * removed[i].mean.powi(2) + removed[i].share.powi(2);
        }
        *products += sums;
    }
}

/// −∫(value − value₀) at every row: cubic Hermite interpolation, the slope of a row being that of the chord between its
/// neighbours.
///
/// The trapezoid rule would bias T by −(h/T)²/12; with equal steps this is the rule of weights (−1, 13, 13, −1)/24. On
/// unequal ones a parabola through three rows would give a smoother slope, but it leans on the shorter interval: where
/// two rows nearly coincide, the noise of their difference over next to nothing would be integrated over the long one.
/// `time` and `value` have the same length, at least 3.
fn minus_integral(time: &[f64], value: &[f64]) -> Vec<f64> {
    let last = time.len() - 1;
    let chord = |from: usize, to: usize| (value[to] - value[from]) / (time[to] - time[from]);
    // At the ends a parabola: its chord is the mean of its slopes.
    let beyond = |chord: f64, slope: f64| 2.0 * chord - slope;
    let mut slope = beyond(chord(0, 1), chord(0, 2));
    let mut total = 0.0;
    let mut integral = Vec::with_capacity(time.len());
    integral.push(total);
    for k in 0..last {
        let h = time[k + 1] - time[k];
        let next = if k + 1 < last { chord(k, k + 2) } else { beyond(chord(k, last), slope) };
        total -= h * (0.5 * (value[k] + value[k + 1]) - value[0] + h / 12.0 * (slope - next));
        integral.push(total);
        slope = next;
    }
    integral
}

/// The least-squares solution and what the noise needs of it.
#[derive(Debug)]
struct Solution {
    /// a, b, b δ_r.
    parameters: Vector3<f64>,
    /// (XᵀX)⁻¹ of the projected columns.
    inverse: Matrix3<f64>,
    condition: f64,
}

impl Solution {
    /// Solves, and leaves the rows of the pieces projected.
    fn of(pieces: &mut [Piece], condition_limit: f64) -> Result<Self, IdentifyError> {
        let (mut lengths, mut products) = (Vector3::zeros(), Matrix4::zeros());
        for piece in pieces {
            piece.project(&mut lengths, &mut products);
        }
        let scale = lengths.map(|squares: f64| 1.0 / squares.sqrt());
        let scaled = Matrix3::from_fn(|i, j| products[(i, j)] * scale[i] * scale[j]);
        let smallest: f64 = SymmetricEigen::new(scaled).eigenvalues.min();
        let condition = if smallest > 0.0 { 1.0 / smallest.sqrt() } else { f64::INFINITY };
        let singular = || IdentifyError::Singular { condition, limit: condition_limit };
        if condition.is_nan() || condition > condition_limit {
            return Err(singular());
        }
        let scaled_inverse = scaled.cholesky().ok_or_else(singular)?.inverse();
        let inverse = Matrix3::from_fn(|i, j| scaled_inverse[(i, j)] * scale[i] * scale[j]);
        Ok(Self { parameters: inverse * products.fixed_view::<SHARED, 1>(0, SHARED), inverse, condition })
    }
}

#[cfg(test)]
mod tests;
