//! Simplified refined instrumental variables for continuous time (SRIVC), with rudder bias and initial state.
//!
//! The ship is ψ'' + a ψ' = b (δ + δ_r) with a = 1/T, b = K/T, and the heading is measured with white noise. Divided by
//! s (s + â), the equation has no derivative,
//!
//! ψ = −(a − â) lp ψ + b F δ + b δ_r F 1/s + ψ₀ + (r₀ + (a − â) ψ₀) φ₁,  F = 1/(s (s + â)),  lp = 1/(s + â),
//!
//! and is linear in its unknowns. lp ψ is noisy, so an instrument replaces it on the left of the normal equations: the
//! filtered heading simulated with the last estimate. Then â is set to the new a, until it converges.
//!
//! Three properties follow. At the fixed point lp ψ drops out, so neither its noise nor the linear interpolation
//! between its samples biases the estimate; the instruments are the gradient of the simulated heading, so the estimate
//! is a stationary point of the output error and efficient for white noise. Without noise the equation holds for any â.
//! And a wrong noise model costs efficiency, not consistency, as long as the noise does not affect the rudder.
//!
//! The start is â = 0 with the regressors as instruments: there 1/s is an integral, and the equation is the
//! equation of motion integrated twice, solved by least squares. For a < 0 the filters would grow; such a record is
//! filtered backwards in time, which turns a into −a and keeps all other terms.
//!
//! Sources: Young and Jakeman (1980), refined instrumental variables part III; Garnier and Wang (2008), chapter 4;
//! equivalence to the output error at the fixed point: Pan, González, Welsh and Rojas (2020).

mod covariance;
mod filter;
mod record;
#[cfg(test)]
mod tests;

use document::WarningCode;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use ship::angle::to_deg;
use ship::first_order::YawState;
use ship::{FirstOrder, ShortNumber};
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason};
use crate::identifier::Identifier;
use crate::samples::Samples;
use crate::settings::{SettingsError, check_iterations, require};
use covariance::ResidualStatistics;
use filter::{InstrumentalEquations, LeftColumns, Point, SharedParameters};
use record::SrivcRecord;

/// Minimum number of headings of a trial: twice its unknowns.
const MIN_ROWS: usize = 10;

/// Minimum share of a step in an oscillating iteration.
const MIN_STEP_SHARE: f64 = 0.05;

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Settings {
    /// Maximum number of iterations after the start.
    pub max_iterations: usize,
    /// Maximum change of the simulated heading in a converged iteration, as a share of the heading explained by the
    /// rudder. Parameters are not compared: a ship with 1/T = 0 and a poorly determined K have no scale.
    pub relative_step: f64,
    /// Maximum accepted condition number of the scaled instruments, initial states eliminated.
    pub condition_limit: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { max_iterations: 50, relative_step: 1e-9, condition_limit: 1e6 }
    }
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if the number of iterations is zero or above a thousand, the step is not within 1e-12 and 0.1, or the
    /// condition limit is not above 1.
    pub fn build(self) -> Result<Srivc, SettingsError> {
        check_iterations("max-iterations", self.max_iterations)?;
        let (step, limit) = (self.relative_step, self.condition_limit);
        require((1e-12..=0.1).contains(&step), "relative-step", ShortNumber(step), "a number within 1e-12 and 0.1")?;
        require(limit.is_finite() && limit > 1.0, "condition-limit", ShortNumber(limit), "a number above 1")?;
        Ok(Srivc { settings: self })
    }
}

/// Method of simplified refined instrumental variables for continuous time; see the [module](self).
///
/// Fails with [`IdentifyError::NotConverged`] if the iteration does not converge, with [`IdentifyError::Singular`]
/// above the condition limit, and with [`IdentifyError::NotAShip`] if K/T is not positive.
#[derive(Debug, Clone, PartialEq)]
pub struct Srivc {
    settings: Settings,
}

/// Solution of the common normal equations of all records.
struct Solution {
    point: Point,
    condition: f64,
    blocks: Vec<InstrumentalEquations>,
}

impl Identifier for Srivc {
    fn id(&self) -> &'static str {
        "srivc"
    }

    fn summary(&self) -> &'static str {
        "refined instrumental variables for continuous time (Young and Jakeman 1980)"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        // Checks that all methods share.
        Samples::from_trials(trials, MIN_ROWS)?;
        let mut records: Vec<SrivcRecord> = trials.iter().map(SrivcRecord::new).collect();
        let mut start = self.integral_least_squares(&records)?;
        let backwards = start.point.shared.inverse_T < 0.0;
        let mut evaluations = 1;
        if backwards {
            records = records.iter().map(SrivcRecord::reversed).collect();
            start = self.integral_least_squares(&records)?;
            evaluations += 1;
        }
        let (solution, iterations) = self.iterate(&records, start)?;
        let SharedParameters { inverse_T: a, K_over_T: b, offset } = solution.point.shared;
        let sign = if backwards { -1.0 } else { 1.0 };
        let inverse_T = sign * a;
        if !(b > 0.0 && b.is_finite() && a.is_finite()) {
            return Err(IdentifyError::NotAShip { inverse_T, K_over_T: b });
        }
        let residuals = ResidualStatistics::new(&records, &solution.point, &solution.blocks)
            .ok_or(IdentifyError::Singular { condition: solution.condition, limit: self.settings.condition_limit })?;
        // (a, b, b δ_r) of the direction of the filters → (1/T, K/T, δ_r).
        let jacobian = Matrix3::new(sign, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -offset / (b * b), 1.0 / b);
        let covariance = |matrix: &Matrix3<f64>| Covariance {
            matrix: jacobian * matrix * jacobian.transpose(),
            degrees_of_freedom: Some(residuals.degrees_of_freedom),
        };
        let count = residuals.count as f64;
        let robust_covariance = covariance(&residuals.robust_covariance);
        let white = covariance(&residuals.white_covariance);
        let (uncertainty, warning) =
            crate::robust::reported_covariance(white, &robust_covariance, residuals.lag1_correlation, residuals.count);
        let mut warnings = Vec::from_iter(warning);
        if inverse_T < 0.0 {
            warnings.push(WarningCode::CourseUnstable.warning("course-unstable: 1/T is negative, and so are K and T"));
        }
        Ok(Estimate {
            response: FirstOrder { inverse_T, K_over_T: b, rudder_bias: offset / b },
            uncertainty,
            robust_covariance: Some(robust_covariance),
            stop: StopReason::Converged,
            evaluations: evaluations + iterations + 1,
            noise: None,
            diagnostics: vec![
                ("iterations", iterations as f64),
                ("r_squared", 1.0 - residuals.rss / residuals.total_sum_of_squares),
                ("condition", solution.condition),
                ("heading_rmse_deg", to_deg((residuals.rss / count).sqrt())),
                ("lag1_autocorrelation", residuals.lag1_correlation),
            ],
            warnings,
        })
    }
}

impl Srivc {
    /// Start of the iteration: filters with their pole at 0 and the regressors as instruments.
    fn integral_least_squares(&self, records: &[SrivcRecord]) -> Result<Solution, IdentifyError> {
        let zero = Point {
            shared: SharedParameters { inverse_T: 0.0, K_over_T: 0.0, offset: 0.0 },
            starts: vec![YawState::default(); records.len()],
        };
        self.solve(records, &zero, LeftColumns::Regressors)
    }

    /// Iterates to the fixed point; also returns the number of iterations.
    ///
    /// With a large deterministic residual, as after a rudder put over between two rows, full steps oscillate about the
    /// fixed point and decay slowly or not at all. After the first reversal that exceeds half of the previous step,
    /// steps are shortened by their secant in a (Irons and Tuck 1969).
    fn iterate(&self, records: &[SrivcRecord], start: Solution) -> Result<(Solution, usize), IdentifyError> {
        let mut solution = start;
        let mut step = f64::INFINITY;
        let (mut share, mut before, mut oscillates): (f64, f64, bool) = (1.0, 0.0, false);
        for iteration in 1..=self.settings.max_iterations {
            let last = solution.point;
            solution = self.solve(records, &last, LeftColumns::Instruments)?;
            let now = solution.point.shared;
            let change = now.inverse_T - last.shared.inverse_T;
            oscillates |= change * before < -0.5 * before * before;
            if oscillates {
                share = (share * before / (before - change)).clamp(MIN_STEP_SHARE, 1.0);
            }
            before = change;
            let gram = solution.blocks.iter().map(|block| block.instruments).sum::<Matrix3<f64>>();
            let size = |theta: Vector3<f64>| theta.dot(&(gram * theta)).max(0.0).sqrt();
            step = size(Vector3::new(change, now.K_over_T - last.shared.K_over_T, now.offset - last.shared.offset))
                / size(Vector3::new(0.0, now.K_over_T, now.offset));
            if step <= self.settings.relative_step {
                return Ok((solution, iteration));
            }
            if share < 1.0 {
                solution.point = last.towards(&solution.point, share);
            }
        }
        Err(IdentifyError::NotConverged { iterations: self.settings.max_iterations, step })
    }

    /// Solution of the common normal equations after one pass over all records.
    fn solve(&self, records: &[SrivcRecord], at: &Point, left: LeftColumns) -> Result<Solution, IdentifyError> {
        let limit = self.settings.condition_limit;
        let singular = |condition| IdentifyError::Singular { condition, limit };
        let blocks: Option<Vec<InstrumentalEquations>> = records
            .iter()
            .zip(&at.starts)
            .map(|(record, &start)| InstrumentalEquations::new(record, at.shared, start, left))
            .collect();
        let blocks = blocks.ok_or_else(|| singular(f64::INFINITY))?;
        let sum = |part: fn(&InstrumentalEquations) -> Matrix3<f64>| blocks.iter().map(part).sum::<Matrix3<f64>>();
        let gram = sum(|block| block.instruments);
        let scale = Vector3::from_fn(|i, _| 1.0 / gram[(i, i)].sqrt());
        let scaled = |matrix: Matrix3<f64>| Matrix3::from_fn(|i, j| matrix[(i, j)] * scale[i] * scale[j]);
        let correlation = scaled(gram);
        // With overflowed filters or a column of zeros the eigenvalue iteration would not end.
        if correlation.iter().any(|value| !value.is_finite()) {
            return Err(singular(f64::INFINITY));
        }
        let spread = correlation.symmetric_eigenvalues();
        let condition = (spread.max() / spread.min()).sqrt();
        // NaN if the smallest eigenvalue is negative by rounding.
        if condition.is_nan() || condition > limit {
            return Err(singular(if condition.is_nan() { f64::INFINITY } else { condition }));
        }
        let target: Vector3<f64> = blocks.iter().map(|block| block.target).sum();
        let theta = scaled(sum(|block| block.regressors))
            .lu()
            .solve(&target.component_mul(&scale))
            .ok_or_else(|| singular(f64::INFINITY))?
            .component_mul(&scale);
        let shared =
            SharedParameters { inverse_T: at.shared.inverse_T + theta[0], K_over_T: theta[1], offset: theta[2] };
        let starts = blocks.iter().map(|block| block.start(&theta)).collect();
        Ok(Solution { point: Point { shared, starts }, condition, blocks })
    }
}
