//! Regression of the equation of motion, r' = −a r + b δ + c, on differentiated heading or on the yaw rate of a rate
//! gyro.
//!
//! a = 1/T, b = K/T, c = b δ_r. This is the textbook method and a baseline: noise in r, a regressor, biases a towards
//! zero (errors in variables), smoothing biases it too, and the rate gyro helps only as far as its noise is small.
//! Methods that do not differentiate, such as the integral and output-error methods, are better with visible noise.
//! Sources: Ljung (1999), System Identification: Theory for the User, chapter 7 on linear regression; Söderström
//! (2007), Errors-in-variables methods in system identification, Automatica 43, 939–958.

use document::WarningCode;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use trial::Trial;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason, Uncertainty};
use crate::gaps::{gap_free_ranges, gap_threshold};
use crate::identifier::Identifier;
use crate::robust::newey_west_three;
use crate::samples::Samples;
use crate::savitzky_golay::{SavitzkyGolay, WindowWeights};
use crate::settings::{SettingsError, check_condition_limit, check_longest_gap};
use estimation::least_squares::LeastSquares;

/// Maximum relative bias of 1/T by noise without a warning.
const MAX_QUIET_BIAS: f64 = 0.02;

/// Minimum number of equations: twice the unknowns, which leaves as many degrees of freedom for the error.
const MIN_EQUATIONS: usize = 6;

/// Signal that is differentiated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Signal {
    /// Heading, differentiated twice.
    #[default]
    Heading,
    /// Recorded yaw rate, differentiated once.
    YawRate,
}

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Settings {
    /// Signal that is differentiated.
    pub signal: Signal,
    /// Local polynomials that smooth before differentiating; without them central differences.
    pub smoothing: Option<SavitzkyGolay>,
    /// `true` if the same local polynomials smooth the rudder; without effect on central differences.
    pub smooth_rudder: bool,
    /// Maximum interval between rows for differentiation, s; without it five mean intervals of the record.
    pub longest_gap_s: Option<f64>,
    /// Maximum accepted condition number of the equations.
    pub condition_limit: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            signal: Signal::Heading,
            smoothing: None,
            smooth_rudder: false,
            longest_gap_s: None,
            condition_limit: 1e6,
        }
    }
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if window and order do not match, the gap is not positive or the condition limit is not above 1.
    pub fn build(self) -> Result<MotionRegression, SettingsError> {
        if let Some(smoothing) = &self.smoothing {
            smoothing.check()?;
        }
        check_longest_gap(self.longest_gap_s)?;
        check_condition_limit(self.condition_limit)?;
        Ok(MotionRegression { settings: self })
    }
}

/// Least squares on r' = −a r + b δ + c.
///
/// The covariance is for white noise in the signal, propagated through the differentiating filters; its variance is
/// estimated from the residual. The robust covariance (Newey and West 1987) also holds for a coloured residual. If
/// noise dominates the differentiated signal (`r_squared` far below 1) both covariances are several times too large,
/// because they neglect the correlation of the errors of r and r'. **Neither contains the bias caused by noise in r**
/// (errors in variables); to first order it is the diagnostic `noise_bias_of_inverse_T_percent`. Smoothing adds another
/// bias, for which there is no diagnostic.
///
/// Fails with [`IdentifyError::NoChannel`] if the yaw rate is selected but not recorded, with
/// [`IdentifyError::TooFewPoints`] if no window fits between gaps, and with [`IdentifyError::NotAShip`] if K/T is not
/// positive. A negative 1/T is a valid estimate: the ship is course-unstable.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionRegression {
    settings: Settings,
}

/// Part of a record without a gap.
#[derive(Debug)]
struct GapFreePart {
    time: Vec<f64>,
    /// Rows with an equation; at least one.
    rows: Vec<usize>,
}

/// Equations of all gap-free parts, column by column.
#[derive(Debug, Default)]
struct Equations {
    /// −r, rad/s.
    minus_rate: Vec<f64>,
    /// δ, rad.
    rudder: Vec<f64>,
    /// r', rad/s².
    acceleration: Vec<f64>,
    parts: Vec<GapFreePart>,
}

/// Propagation of white noise of unit variance in the signal into the equations.
#[derive(Debug)]
struct NoisePath {
    /// Covariance of Xᵀe.
    influence: Matrix3<f64>,
    /// Sum of the variances of e.
    error: f64,
    /// Sum of the covariances of r and e.
    rate_and_error: f64,
}

impl Identifier for MotionRegression {
    fn id(&self) -> &'static str {
        "least-squares"
    }

    fn summary(&self) -> &'static str {
        "regression of the yaw acceleration on yaw rate and rudder, by differentiated heading or gyro"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let equations = self.equations(trials)?;
        let Equations { minus_rate, rudder, acceleration, .. } = &equations;
        let ones = vec![1.0; acceleration.len()];
        let solution = LeastSquares::solve(&[minus_rate, rudder, &ones], acceleration, self.settings.condition_limit)?;
        let [a, b, c] = [0, 1, 2].map(|i| solution.parameters[i]);
        if b.is_nan() || b <= 0.0 {
            return Err(IdentifyError::NotAShip { inverse_T: a, K_over_T: b });
        }
        let unscaled = Matrix3::from_fn(|i, j| solution.unscaled_covariance[(i, j)]);
        // δ_r = c/b.
        let to_base = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -c / (b * b), 1.0 / b) * unscaled;
        let base = |scores: Matrix3<f64>| to_base * scores * to_base.transpose();
        let noise = self.noise_path(&equations, a);
        let noise_variance = solution.variance().map(|variance| variance * acceleration.len() as f64 / noise.error);
        let uncertainty = match noise_variance {
            Some(variance) => Uncertainty::Covariance(Covariance {
                matrix: base(noise.influence * variance),
                degrees_of_freedom: Some(solution.degrees_of_freedom),
            }),
            None => Uncertainty::None { reason: "no more equations than unknowns" },
        };
        let robust_covariance = solution.variance().map(|_| {
            let finite_sample = acceleration.len() as f64 / solution.degrees_of_freedom;
            Covariance {
                matrix: base(newey_west_three(&equations.scores([a, b, c])) * finite_sample),
                degrees_of_freedom: Some(solution.degrees_of_freedom),
            }
        });
        let mut diagnostics = vec![
            ("r_squared", 1.0 - solution.residual_sum_of_squares / total_squares(acceleration)),
            ("condition", solution.condition_number),
            ("equations", acceleration.len() as f64),
        ];
        let mut warnings = Vec::new();
        if let Some(variance) = noise_variance {
            // Noise n_r in the regressor −r makes E[Xᵀe] = −(cov(n_r, e), 0, 0).
            let bias = -unscaled[(0, 0)] * noise.rate_and_error * variance / a;
            diagnostics.push(("noise_bias_of_inverse_T_percent", 100.0 * bias));
            if bias.abs() > MAX_QUIET_BIAS {
                warnings.push(WarningCode::NoiseBias.warning(format!(
                    "noise in the differentiated signal biases 1/T by about {:+.0} %, and K with it; the standard \
                     deviations do not include this bias",
                    100.0 * bias
                )));
            }
        }
        Ok(Estimate {
            response: FirstOrder { inverse_T: a, K_over_T: b, rudder_bias: c / b },
            uncertainty,
            robust_covariance,
            stop: StopReason::Direct,
            evaluations: 1,
            noise: None,
            diagnostics,
            warnings,
        })
    }
}

impl MotionRegression {
    fn polynomial(&self) -> &SavitzkyGolay {
        self.settings.smoothing.as_ref().unwrap_or(&SavitzkyGolay::CENTRAL_DIFFERENCES)
    }

    /// r and r' from the coefficients of the local polynomial, or from the weights of one row in them.
    fn rate_and_acceleration(&self, [value, first, half_second]: [f64; 3]) -> (f64, f64) {
        match self.settings.signal {
            Signal::Heading => (first, 2.0 * half_second),
            Signal::YawRate => (value, first),
        }
    }

    fn equations(&self, trials: &[Trial]) -> Result<Equations, IdentifyError> {
        let mut equations = Equations::default();
        // Also refuses records that are not a manoeuvre.
        for (trial, samples) in trials.iter().zip(Samples::from_trials(trials, Trial::MIN_ROWS)?) {
            match self.settings.signal {
                Signal::Heading => self.add(&samples.time, &samples.heading, &samples.rudder, &mut equations),
                Signal::YawRate => {
                    let rate = trial
                        .yaw_rate()
                        .ok_or_else(|| IdentifyError::NoChannel { trial: trial.name().into(), channel: "yaw rate" })?;
                    let seen = |column: &[f64]| -> Vec<f64> {
                        column.iter().zip(rate).filter(|(_, r)| r.is_finite()).map(|(&x, _)| x).collect()
                    };
                    self.add(&seen(trial.time()), &seen(rate), &seen(trial.rudder()), &mut equations);
                }
            }
        }
        let count = equations.acceleration.len();
        if count < MIN_EQUATIONS {
            return Err(IdentifyError::TooFewPoints { kind: "windows without a gap", needed: MIN_EQUATIONS, count });
        }
        Ok(equations)
    }

    /// Adds an equation for every row with a complete window without a gap.
    fn add(&self, time: &[f64], signal: &[f64], rudder: &[f64], equations: &mut Equations) {
        let mut weights = WindowWeights::new(self.polynomial());
        for range in gap_free_ranges(time, gap_threshold(self.settings.longest_gap_s, time)) {
            let (time, signal, rudder) = (&time[range.clone()], &signal[range.clone()], &rudder[range]);
            let mut rows = Vec::with_capacity(time.len());
            for k in 0..time.len() {
                let Some(coefficients) = weights.apply(time, signal, k) else { continue };
                let (rate, acceleration) = self.rate_and_acceleration(coefficients);
                let smooth = self.settings.smooth_rudder.then(|| weights.apply(time, rudder, k)).flatten();
                equations.minus_rate.push(-rate);
                equations.rudder.push(smooth.map_or(rudder[k], |[value, ..]| value));
                equations.acceleration.push(acceleration);
                rows.push(k);
            }
            if !rows.is_empty() {
                equations.parts.push(GapFreePart { time: time.to_vec(), rows });
            }
        }
    }

    /// Propagates unit white noise through the filters into the equation error e = n_r' + a n_r.
    fn noise_path(&self, equations: &Equations, a: f64) -> NoisePath {
        let mut weights = WindowWeights::new(self.polynomial());
        let mut path = NoisePath { influence: Matrix3::zeros(), error: 0.0, rate_and_error: 0.0 };
        let mut equation = 0;
        let mut influence = Vec::new();
        for part in &equations.parts {
            influence.clear();
            influence.resize(part.time.len(), Vector3::zeros());
            for &k in &part.rows {
                let row = equations.row(equation);
                equation += 1;
                let Some((window, weights)) = weights.weights_at(&part.time, k) else { continue };
                for (j, &weights) in window.zip(weights) {
                    let (rate_weight, acceleration_weight) = self.rate_and_acceleration(weights);
                    let error_weight = acceleration_weight + a * rate_weight;
                    influence[j] += row * error_weight;
                    path.error += error_weight * error_weight;
                    path.rate_and_error += rate_weight * error_weight;
                }
            }
            path.influence += influence.iter().fold(Matrix3::zeros(), |sum, z| sum + z * z.transpose());
        }
        path
    }
}

impl Equations {
    fn row(&self, equation: usize) -> Vector3<f64> {
        Vector3::new(self.minus_rate[equation], self.rudder[equation], 1.0)
    }

    /// Scores of every part of the record: each regressor times the residual at the parameters a, b, c.
    fn scores(&self, [a, b, c]: [f64; 3]) -> Vec<[Vec<f64>; 3]> {
        let mut equation = 0;
        let mut part_scores = |rows: usize| {
            let mut columns = [(); 3].map(|()| Vec::with_capacity(rows));
            for equation in equation..equation + rows {
                let row = self.row(equation);
                let error = self.acceleration[equation] - row.dot(&Vector3::new(a, b, c));
                columns.iter_mut().zip(&row).for_each(|(column, x): (&mut Vec<f64>, _)| column.push(x * error));
            }
            equation += rows;
            columns
        };
        self.parts.iter().map(|part| part_scores(part.rows.len())).collect()
    }
}

fn total_squares(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().map(|x| (x - mean) * (x - mean)).sum()
}

#[cfg(test)]
mod tests;
