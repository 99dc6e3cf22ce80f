//! Least squares for K, T and δ_r on T r' + r = K (δ + δ_r), with r and r' of fitted Fourier curves, and their
//! covariance under white heading noise. Source of the equation: Ge, Hu, Yin and Sun, equation (10).

use std::ops::Range;

use nalgebra::{DMatrix, DVector, Matrix3, RowVector3, Vector3};
use serde::{Deserialize, Serialize};
use ship::FirstOrder;

use super::basis::{Basis, Projection};
use crate::error::IdentifyError;
use estimation::least_squares::LeastSquares;

/// Left side of the regression of the equation of motion.
///
/// Noise of a regressor biases its coefficient towards zero (errors in variables). The relative noise of r is smaller
/// than that of r', by about the ratio of the highest frequency of the series to the frequency of the zig-zag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RegressionForm {
    /// r' = −(1/T) r + (K/T) δ + (K/T) δ_r: the less biased form.
    #[default]
    YawAcceleration,
    /// r = −T r' + K δ + K δ_r: the equation as in the paper.
    YawRate,
}

/// Equations of motion of one or several trials; K, T and δ_r are common to all.
#[derive(Debug, Clone, Default)]
pub struct RegressionEquations {
    yaw_acceleration: Vec<f64>,
    yaw_rate: Vec<f64>,
    rudder: Vec<f64>,
    trials: Vec<Block>,
}

/// Index of the rudder among the signals of [`Block::moments`].
const RUDDER: usize = 2;

/// Index of the constant 1 among the signals of [`Block::moments`].
const ONE: usize = 3;

/// Sensitivity of the equations of one trial to noise on its heading.
#[derive(Debug, Clone)]
struct Block {
    /// Σ f ∂r/∂θ and Σ f ∂r'/∂θ over the equations, θ the 2N+1 coefficients, for f = r, r', δ and 1.
    moments: [[DVector<f64>; 4]; 2],
    /// Covariance of the coefficients, (2N+1) × (2N+1), rad².
    covariance: DMatrix<f64>,
}

/// Solution of [`RegressionEquations`].
#[derive(Debug, Clone)]
pub struct RegressionSolution {
    /// First-order response.
    pub response: FirstOrder,
    /// Covariance of (1/T, K/T, δ_r) for white heading noise of the variance given with every trial.
    pub covariance: Matrix3<f64>,
    /// Condition number of the scaled equations.
    pub condition: f64,
}

impl RegressionEquations {
    /// Adds the equations of a trial at the given rows: r and r' from `heading`, the projection of the heading on
    /// `basis`, and δ from `rudder` (rad, a value for every instant of the basis).
    ///
    /// `noise_variance`, rad², is the variance of white noise on the heading.
    pub fn add(
        &mut self,
        basis: &Basis,
        heading: &Projection,
        rows: Range<usize>,
        rudder: &[f64],
        noise_variance: f64,
    ) {
        let rate = basis.derivative(&heading.coefficients);
        let acceleration = basis.derivative(&rate);
        let signals = [basis.values(&rate), basis.values(&acceleration), rudder.to_vec(), vec![1.0; rudder.len()]];
        for (column, signal) in
            [&mut self.yaw_rate, &mut self.yaw_acceleration, &mut self.rudder].into_iter().zip(&signals)
        {
            column.extend_from_slice(&signal[rows.clone()]);
        }
        let by_heading = signals.map(|mut signal| {
            signal[..rows.start].fill(0.0);
            signal[rows.end..].fill(0.0);
            basis.moments(&signal)
        });
        let by_rate = by_heading.each_ref().map(|moments| basis.derivative_moments(moments));
        let by_acceleration = by_rate.each_ref().map(|moments| basis.derivative_moments(moments));
        let covariance = basis.unscaled_covariance() * noise_variance;
        self.trials.push(Block { moments: [by_rate, by_acceleration], covariance });
    }

    /// Number of equations.
    pub fn len(&self) -> usize {
        self.rudder.len()
    }

    /// `true` if there are no equations.
    pub fn is_empty(&self) -> bool {
        self.rudder.is_empty()
    }

    /// Solution for the response of the ship, with `response` as the left side.
    ///
    /// Fails with [`IdentifyError::Singular`] if the condition number of the scaled equations exceeds
    /// `condition_limit`, with [`IdentifyError::TooFewPoints`] below three equations, and with
    /// [`IdentifyError::NotAShip`] if K/T is not positive.
    pub fn solve(&self, response: RegressionForm, condition_limit: f64) -> Result<RegressionSolution, IdentifyError> {
        let constant = vec![1.0; self.len()];
        let (left, right) = self.sides(response);
        let minus_right: Vec<f64> = right.iter().map(|x| -x).collect();
        let fit = LeastSquares::solve(&[&minus_right, &self.rudder, &constant], left, condition_limit)?;
        let parameters = Vector3::new(fit.parameters[0], fit.parameters[1], fit.parameters[2]);
        let (p, q, s) = (parameters[0], parameters[1], parameters[2]);
        // (1/T, K/T, δ_r) and its derivative with respect to the parameters.
        let (a, b, to_response) = match response {
            RegressionForm::YawAcceleration => (p, q, [RowVector3::new(1.0, 0.0, 0.0), RowVector3::new(0.0, 1.0, 0.0)]),
            RegressionForm::YawRate => {
                let by_T = -1.0 / (p * p);
                (1.0 / p, q / p, [RowVector3::new(by_T, 0.0, 0.0), RowVector3::new(q * by_T, 1.0 / p, 0.0)])
            }
        };
        // The condition also refuses NaN.
        if !(b > 0.0 && a.is_finite() && b.is_finite()) {
            return Err(IdentifyError::NotAShip { inverse_T: a, K_over_T: b });
        }
        let bias = RowVector3::new(0.0, -s / (q * q), 1.0 / q);
        let jacobian = Matrix3::from_rows(&[to_response[0], to_response[1], bias]);
        let inverse = Matrix3::from_fn(|i, j| fit.unscaled_covariance[(i, j)]);
        let spread = self.spread_of_moments(response, &parameters);
        let covariance = jacobian * inverse * spread * inverse * jacobian.transpose();
        Ok(RegressionSolution {
            response: FirstOrder { inverse_T: a, K_over_T: b, rudder_bias: s / q },
            covariance: 0.5 * (covariance + covariance.transpose()),
            condition: fit.condition_number,
        })
    }

    /// Left side y and regressor x of y = −p x + q δ + s.
    fn sides(&self, response: RegressionForm) -> (&[f64], &[f64]) {
        match response {
            RegressionForm::YawAcceleration => (&self.yaw_acceleration, &self.yaw_rate),
            RegressionForm::YawRate => (&self.yaw_rate, &self.yaw_acceleration),
        }
    }

    /// Covariance of Zᵀe to first order in the noise of the coefficients, Z = [−x, δ, 1], e = y − Z (p, q, s)ᵀ.
    ///
    /// d(Zᵀe) = Zᵀ(dy + p dx) − (eᵀdx, 0, 0)ᵀ: the noise of the equations, and the noise of the regressor times their
    /// truncation residual. dx and dy are linear in the coefficients, whose covariance is σ²(XᵀX)⁻¹.
    fn spread_of_moments(&self, response: RegressionForm, parameters: &Vector3<f64>) -> Matrix3<f64> {
        let (p, q, s) = (parameters[0], parameters[1], parameters[2]);
        let mut total = Matrix3::zeros();
        for Block { moments: [by_rate, by_acceleration], covariance } in &self.trials {
            // Indices of y and x among the signals.
            let (dy, dx, y, x) = match response {
                RegressionForm::YawAcceleration => (by_acceleration, by_rate, 1, 0),
                RegressionForm::YawRate => (by_rate, by_acceleration, 0, 1),
            };
            let with_equation = |signal: usize| &dy[signal] + p * &dx[signal];
            let noise = &dx[y] + p * &dx[x] - q * &dx[RUDDER] - s * &dx[ONE];
            let gradient =
                DMatrix::from_columns(&[-with_equation(x) - noise, with_equation(RUDDER), with_equation(ONE)]);
            let spread = gradient.transpose() * covariance * &gradient;
            total += Matrix3::from_fn(|i, j| spread[(i, j)]);
        }
        total
    }
}

/// Variance of the white part of a residual that may also have a smooth part: mean square of the distances of values
/// from the straight line through their neighbours, per unit variance (Gasser, Sroka and Jennen-Steinmetz 1986).
///
/// For even steps it has 18/35 degrees of freedom per value. `time` and `residual` have the same length, at least 3.
pub fn white_variance(time: &[f64], residual: &[f64]) -> f64 {
    let mut total = 0.0;
    for (t, e) in time.windows(3).zip(residual.windows(3)) {
        let share = (t[1] - t[0]) / (t[2] - t[0]);
        let gap = (1.0 - share) * e[0] + share * e[2] - e[1];
        total += gap * gap / ((1.0 - share).powi(2) + share * share + 1.0);
    }
    total / (time.len() - 2) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Case, Truth};
    use approx::assert_relative_eq;

    /// With exact r and r' both forms return the truth, bias included.
    #[test]
    fn the_algebra_is_exact() {
        let case = Case { bias_deg: 1.0, ..Case::default() };
        let Truth { yaw_rate, yaw_acceleration, rudder, .. } = case.truth();
        let equations = RegressionEquations { yaw_acceleration, yaw_rate, rudder, trials: Vec::new() };
        for response in [RegressionForm::YawAcceleration, RegressionForm::YawRate] {
            let solved = equations.solve(response, 1e4).expect("well conditioned").response;
            assert_relative_eq!(solved.K(), case.K, max_relative = 1e-9);
            assert_relative_eq!(solved.T(), case.T, max_relative = 1e-9);
            assert_relative_eq!(solved.rudder_bias, case.ship().rudder_bias, max_relative = 1e-8);
        }
    }

    #[test]
    fn a_smooth_residual_is_not_counted_as_noise() {
        let quiet = Case::default().trial();
        let noisy = Case { noise_deg: 0.1, samples: 1201, ..Case::default() };
        let noise: Vec<f64> =
            noisy.trial().heading().iter().zip(noisy.truth().heading).map(|(psi, truth)| psi - truth).collect();
        let smooth: Vec<f64> = (0..1201).map(|i| 0.02 * (0.05 * i as f64).sin()).collect();
        let both: Vec<f64> = noise.iter().zip(&smooth).map(|(x, y)| x + y).collect();
        let time: Vec<f64> = (0..1201).map(f64::from).collect();
        let expected = ship::angle::from_deg(0.1).powi(2);
        // 18/35 of 1200 degrees of freedom: a standard deviation of 6 %.
        assert_relative_eq!(white_variance(&time, &both), expected, max_relative = 0.18);
        assert!(white_variance(quiet.time(), quiet.heading()) < 0.1 * expected);
    }
}
