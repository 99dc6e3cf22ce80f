//! K, T and δ_r of an outside estimator, and their conversion to an [`Estimate`].

use document::{Warning, WarningCode};
use nalgebra::{Matrix3, Vector3};
use ship::FirstOrder;

use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason, Uncertainty};

/// K, T and δ_r of an outside estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutsideFit {
    /// K, 1/s.
    pub K: f64,
    /// T, s.
    pub T: f64,
    /// δ_r, rad.
    pub rudder_bias: f64,
    /// Errors of K, T and δ_r.
    pub errors: OutsideErrors,
}

/// Errors of K (1/s), T (s) and δ_r (rad), in this order, as an outside estimator reports them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OutsideErrors {
    /// Not reported.
    Unknown,
    /// Standard deviations; `None` where none is reported.
    Deviations([Option<f64>; 3]),
    /// Covariance of (K, T, δ_r).
    Covariance(Matrix3<f64>),
}

/// Warning if only standard deviations are reported.
const UNCORRELATED: &str = "errors of K and T are treated as independent, because no covariance was given; this \
                            affects predictions and the interval of K/T, not the intervals of K and T";

/// Maximum relative asymmetry of a covariance, and maximum excess of a correlation over 1, treated as rounding.
const ROUNDING: f64 = 1e-6;

impl OutsideFit {
    /// Estimate: a first-order response, and the covariance of (1/T, K/T, δ_r) to first order in the errors.
    ///
    /// With J = ∂(1/T, K/T, δ_r)/∂(K, T, δ_r) the covariance is J C Jᵀ; C is diagonal if only standard deviations are
    /// given. A δ_r without an error has no error in the estimate, either. Fails with [`IdentifyError::NotAShip`]
    /// unless K/T > 0, and with [`IdentifyError::Outside`] if δ_r is not finite.
    pub fn estimate(&self) -> Result<Estimate, IdentifyError> {
        let Self { K, T, rudder_bias, .. } = *self;
        let response = FirstOrder::from_indices(K, T, rudder_bias);
        let FirstOrder { inverse_T, K_over_T, .. } = response;
        if !(inverse_T.is_finite() && K_over_T.is_finite() && K_over_T > 0.0) {
            return Err(IdentifyError::NotAShip { inverse_T, K_over_T });
        }
        if !rudder_bias.is_finite() {
            return Err(IdentifyError::from_outside_message("the rudder bias is not a finite number"));
        }
        let (a, b) = (inverse_T, K_over_T);
        let jacobian = Matrix3::new(0.0, -a * a, 0.0, a, -a * b, 0.0, 0.0, 0.0, 1.0);
        let transformed = |(covariance, warning)| (jacobian * covariance * jacobian.transpose(), warning);
        let is_finite = |(matrix, _): &(Matrix3<f64>, _)| matrix.iter().all(|value| value.is_finite());
        let (uncertainty, warning) = match self.covariance().map(transformed).filter(is_finite) {
            None => {
                let reason = match self.errors {
                    OutsideErrors::Covariance(_) => "the covariance of the outside estimator is not positive definite",
                    _ => "the outside estimator gave no error of K or of T",
                };
                (Uncertainty::None { reason }, None)
            }
            Some((matrix, warning)) => {
                (Uncertainty::Covariance(Covariance { matrix, degrees_of_freedom: None }), warning)
            }
        };
        Ok(Estimate {
            response,
            uncertainty,
            robust_covariance: None,
            stop: StopReason::Outside,
            evaluations: 0,
            noise: None,
            diagnostics: Vec::new(),
            warnings: Vec::from_iter(warning),
        })
    }

    /// Covariance of (K, T, δ_r), and a warning on it; `None` if K or T has no error, or the given matrix is not a
    /// covariance.
    fn covariance(&self) -> Option<(Matrix3<f64>, Option<Warning>)> {
        match self.errors {
            OutsideErrors::Unknown => None,
            OutsideErrors::Deviations([K, T, rudder_bias]) => {
                let variance = |sd: Option<f64>| sd.filter(|sd| sd.is_finite() && *sd >= 0.0).map(|sd| sd * sd);
                let diagonal = Vector3::new(variance(K)?, variance(T)?, variance(rudder_bias).unwrap_or(0.0));
                Some((Matrix3::from_diagonal(&diagonal), Some(WarningCode::IndependentErrors.warning(UNCORRELATED))))
            }
            OutsideErrors::Covariance(matrix) => is_covariance(&matrix).then_some((matrix, None)),
        }
    }
}

/// `true` if a matrix is finite and symmetric, with non-negative variances and consistent correlations: no combination
/// of K, T and δ_r may have a negative variance. A parameter without an error may have a variance of zero.
fn is_covariance(matrix: &Matrix3<f64>) -> bool {
    let is_plausible = (0..3).all(|i| {
        (0..3).all(|j| {
            let (upper, lower) = (matrix[(i, j)], matrix[(j, i)]);
            let most = (matrix[(i, i)] * matrix[(j, j)]).sqrt() * (1.0 + ROUNDING);
            // The condition also refuses NaN.
            upper.abs() <= most && most.is_finite() && (upper - lower).abs() <= ROUNDING * most && matrix[(i, i)] >= 0.0
        })
    });
    let scaled = Matrix3::from_fn(|i, j| match (matrix[(i, i)] * matrix[(j, j)]).sqrt() {
        0.0 => 0.0,
        scale => matrix[(i, j)] / scale,
    });
    is_plausible && scaled.symmetric_eigenvalues().min() >= -ROUNDING
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn answer(errors: OutsideErrors) -> OutsideFit {
        OutsideFit { K: 0.1, T: 16.0, rudder_bias: 0.01, errors }
    }

    fn estimate(errors: OutsideErrors) -> Estimate {
        answer(errors).estimate().expect("a ship")
    }

    /// Standard deviations are unchanged by the conversion: the transformation to 1/T and K/T and the delta method back
    /// are inverse to one another.
    #[test]
    fn errors_survive_the_change_of_parameters() {
        let sd = [0.004, 0.9, 0.002];
        let check = |estimate: &Estimate| {
            for (estimate, expected) in [estimate.K(), estimate.T(), estimate.rudder_bias()].iter().zip(sd) {
                assert_relative_eq!(estimate.sd.expect("given"), expected, max_relative = 1e-12);
                assert!(estimate.ci95.is_some());
            }
        };
        let alone = estimate(OutsideErrors::Deviations(sd.map(Some)));
        check(&alone);
        assert_eq!(alone.warnings, [WarningCode::IndependentErrors.warning(UNCORRELATED)]);
        let mut matrix = Matrix3::from_diagonal(&Vector3::from(sd.map(|sd| sd * sd)));
        (matrix[(0, 1)], matrix[(1, 0)]) = (0.9 * sd[0] * sd[1], 0.9 * sd[0] * sd[1]);
        let correlated = estimate(OutsideErrors::Covariance(matrix));
        check(&correlated);
        assert!(correlated.warnings.is_empty());
        // K/T is far more precise if the errors are correlated.
        let gain = |estimate: &Estimate| match &estimate.uncertainty {
            Uncertainty::Covariance(covariance) => covariance.matrix[(1, 1)],
            _ => f64::NAN,
        };
        assert!(gain(&correlated) < 0.3 * gain(&alone), "{} {}", gain(&correlated), gain(&alone));
    }

    #[test]
    fn missing_errors_stay_missing() {
        let half = estimate(OutsideErrors::Deviations([Some(0.004), Some(0.9), None]));
        assert!(half.K().sd.is_some() && half.T().sd.is_some());
        assert_eq!((half.rudder_bias().sd, half.rudder_bias().ci95), (None, None));
        let bad = Matrix3::from_diagonal(&Vector3::new(1e-6, -1.0, 1e-6));
        let skew = Matrix3::new(1e-4, 5e-3, 0.0, -5e-3, 1.0, 0.0, 0.0, 0.0, 1e-6);
        let beyond = Matrix3::new(1e-4, 5e-2, 0.0, 5e-2, 1.0, 0.0, 0.0, 0.0, 1e-6);
        // Every pair of correlations is possible, all three together are not.
        let contradiction = Matrix3::new(1.0, 0.9, 0.9, 0.9, 1.0, -0.9, 0.9, -0.9, 1.0) * 1e-6;
        match estimate(OutsideErrors::Covariance(contradiction)).uncertainty {
            Uncertainty::None { reason } => assert!(reason.contains("not positive definite"), "{reason}"),
            other => panic!("{other:?}"),
        }
        let none = [
            OutsideErrors::Unknown,
            OutsideErrors::Deviations([Some(0.004), None, Some(0.1)]),
            OutsideErrors::Deviations([Some(f64::INFINITY), Some(1.0), None]),
            OutsideErrors::Deviations([Some(-0.1), Some(1.0), None]),
            OutsideErrors::Deviations([Some(1e200), Some(1.0), None]),
            OutsideErrors::Covariance(bad),
            OutsideErrors::Covariance(skew),
            OutsideErrors::Covariance(beyond),
        ];
        for errors in none {
            let estimate = estimate(errors);
            assert_eq!([estimate.K().sd, estimate.T().sd, estimate.rudder_bias().sd], [None; 3], "{errors:?}");
        }
    }

    #[test]
    fn no_ship_is_made_of_nonsense() {
        let of = |K, T| OutsideFit { K, T, ..answer(OutsideErrors::Unknown) }.estimate();
        for (K, T) in [(0.1, 0.0), (-0.1, 16.0), (0.1, -16.0), (0.0, 16.0), (1e300, 1e-300), (0.1, f64::INFINITY)] {
            assert_eq!(of(K, T).expect_err("no ship").kind(), "not-a-ship", "{K} {T}");
        }
        assert!(of(-0.1, -16.0).expect("unstable on course").response.is_course_unstable());
    }
}
