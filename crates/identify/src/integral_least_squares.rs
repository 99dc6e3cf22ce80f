//! Least squares on the equation of motion integrated twice: no derivative of the heading, no search.
//!
//! ψ(t) = c₀ + c₁ t − a ∫ψ + b ∫∫δ + b δ_r t²/2, with a = 1/T and b = K/T. The initial state enters through c₀ and c₁,
//! which differ between the stretches between gaps; a, b and b δ_r are common to all stretches of all trials. The
//! method is nearly as precise as output error for white heading noise; it does not model a yaw disturbance. The
//! output-error and instrumental-variable methods iterate, which removes the remaining loss of precision. Source of
//! the integral-equation approach: Unbehauen and Rao (1987), Identification of Continuous Systems.

mod equations;
mod noise;

use std::ops::Range;

use document::{Warning, WarningCode};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use ship::angle::to_deg;
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason, Uncertainty};
use crate::gaps::{gap_free_ranges, gap_threshold};
use crate::identifier::Identifier;
use crate::robust::{newey_west_three, reported_covariance};
use crate::samples::Samples;
use crate::settings::{SettingsError, check_condition_limit, check_longest_gap};
use equations::{IntegratedStretch, SHARED_PARAMETERS, Solution};
use noise::ResidualNoise;

/// Minimum number of headings of a stretch between gaps that determines more than the initial state.
const MIN_PIECE_ROWS: usize = 4;

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Settings {
    /// Maximum interval between headings that is integrated across, s; without it five mean intervals of the record.
    pub longest_gap_s: Option<f64>,
    /// Maximum accepted condition number of the equations.
    pub condition_limit: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { longest_gap_s: None, condition_limit: 1e5 }
    }
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if the gap is not positive or the condition limit is not above 1.
    pub fn build(self) -> Result<IntegralLeastSquares, SettingsError> {
        check_longest_gap(self.longest_gap_s)?;
        check_condition_limit(self.condition_limit)?;
        Ok(IntegralLeastSquares { settings: self })
    }
}

/// Method of least squares on the equation of motion integrated twice.
///
/// The rudder integrals are exact for a rudder that is linear between rows, the heading is integrated by cubic Hermite
/// interpolation. The equations are solved in normal form, with c₀ and c₁ of every stretch projected out; the condition
/// number is the reciprocal of the smallest singular value of the projected columns, each divided by its length before
/// the projection.
///
/// The covariance is for white heading noise n propagated through the equation, e = n + a ∫n, with the variance of n
/// estimated from the residual. The robust covariance (Newey and West 1987) takes the estimated noise row by row, so it
/// is also valid for coloured heading noise; neither is valid for a lasting yaw disturbance. Neither includes the bias
/// by the noise of ∫ψ, a regressor, which biases 1/T towards zero if headings are too sparse: with more than T/2
/// between headings the 95 % interval of T contains the truth in 85 of 100 records, with more than 2 T in 65.
///
/// Fails with [`IdentifyError::Singular`] above the condition limit, and with [`IdentifyError::NotAShip`] if K/T is not
/// positive. A negative 1/T is a valid estimate: the ship is course-unstable.
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
        let samples = Samples::from_trials(trials, Trial::MIN_ROWS)?;
        let mut pieces = self.stretches(&samples)?;
        let solution = Solution::from_stretches(&mut pieces, self.settings.condition_limit)?;
        let [a, b, beta] = solution.parameters.into();
        if b.is_nan() || b <= 0.0 {
            return Err(IdentifyError::NotAShip { inverse_T: a, K_over_T: b });
        }
        let response = FirstOrder { inverse_T: a, K_over_T: b, rudder_bias: beta / b };
        let noise = ResidualNoise::from_stretches(&pieces, &solution);
        // δ_r = (b δ_r)/b.
        let to_base = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -beta / (b * b), 1.0 / b) * solution.inverse;
        let base = |matrix: Matrix3<f64>| to_base * matrix * to_base.transpose();
        let covariance =
            |matrix| Covariance { matrix: base(matrix), degrees_of_freedom: Some(noise.degrees_of_freedom) };
        let robust_covariance =
            noise.variance.map(|_| covariance(newey_west_three(&noise.scores) * noise.small_sample_factor));
        let equations = pieces.iter().map(|piece| piece.time.len()).sum::<usize>();
        let (uncertainty, warning) = match (noise.variance, &robust_covariance) {
            (Some(variance), Some(robust)) => {
                reported_covariance(covariance(noise.influence * variance), robust, noise.lag1_correlation, equations)
            }
            _ => (Uncertainty::None { reason: "no more equations than unknowns" }, None),
        };
        let mut diagnostics = vec![
            ("condition", solution.condition),
            ("equations", equations as f64),
            ("lag1_autocorrelation", noise.lag1_correlation),
            ("stretches_without_gap", pieces.len() as f64),
        ];
        diagnostics.extend(noise.variance.map(|variance| ("heading_noise_deg", to_deg(variance.sqrt()))));
        Ok(Estimate {
            response,
            uncertainty,
            robust_covariance,
            stop: StopReason::Direct,
            evaluations: 1,
            noise: None,
            diagnostics,
            warnings: warnings(trials, pieces.len()).into_iter().chain(warning).collect(),
        })
    }
}

impl IntegralLeastSquares {
    /// Stretches between gaps of all trials that are long enough for use.
    fn stretches<'a>(&self, samples: &'a [Samples]) -> Result<Vec<IntegratedStretch<'a>>, IdentifyError> {
        let mut all = Vec::with_capacity(samples.len());
        for trial in samples {
            let gap = gap_threshold(self.settings.longest_gap_s, &trial.time);
            let long_enough = |rows: &Range<usize>| rows.len() >= MIN_PIECE_ROWS;
            all.extend(
                gap_free_ranges(&trial.time, gap).filter(long_enough).map(|rows| IntegratedStretch::new(trial, rows)),
            );
        }
        let count: usize = all.iter().map(|piece| piece.time.len()).sum();
        // Initial states, the shared parameters, and as many degrees of freedom for their error.
        let needed = 2 * SHARED_PARAMETERS + 2 * all.len().max(1);
        if count < needed {
            return Err(IdentifyError::TooFewPoints { kind: "headings in stretches without a gap", needed, count });
        }
        Ok(all)
    }
}

fn warnings(trials: &[Trial], pieces: usize) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if pieces > trials.len() {
        warnings.push(WarningCode::Gap.warning(format!(
            "gaps cut the record into {pieces} stretches, each with its own initial state; longest-gap-s sets the limit"
        )));
    }
    for trial in trials.iter().filter(|trial| trial.is_heading_integrated()) {
        warnings.push(WarningCode::HeadingFromYawRate.warning(format!(
            "the heading of {} is the integral of its yaw rate, so its noise is not white and the intervals are too narrow",
            trial.title()
        )));
    }
    warnings
}

#[cfg(test)]
mod tests;
