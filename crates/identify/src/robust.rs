//! Covariance of a least-squares estimate with a coloured residual. Source: Newey and West (1987), A simple, positive
//! semi-definite, heteroskedasticity and autocorrelation consistent covariance matrix, Econometrica 55, 703–708.

use document::{Warning, WarningCode};
use estimation::column::dot;
use estimation::covariance::newey_west;
use nalgebra::Matrix3;

use crate::estimate::{Covariance, Uncertainty};

/// Minimum magnitude of the lag-1 autocorrelation of a coloured residual, which must also exceed the range of white
/// noise.
const MAX_WHITE_CORRELATION: f64 = 0.2;

/// Covariance that a method reports: for a white residual the white covariance, for a coloured residual the robust
/// covariance, with a warning. A negative correlation keeps the white covariance: the robust covariance would be
/// smaller, which is not justified for a record of two instruments read in turn.
pub(crate) fn reported_covariance(
    white: Covariance,
    robust: &Covariance,
    lag1: f64,
    rows: usize,
) -> (Uncertainty, Option<Warning>) {
    if !is_coloured(lag1, rows) {
        return (Uncertainty::Covariance(white), None);
    }
    if lag1 > 0.0 {
        let warning = format!(
            "successive errors of the replay are alike (correlation {lag1:.2}): the model lacks an effect, or the compass \
             error lasts; the intervals allow for it"
        );
        return (Uncertainty::Covariance(robust.clone()), Some(WarningCode::ColouredResidual.warning(warning)));
    }
    let warning = format!(
        "successive errors of the replay alternate (correlation {lag1:.2}), as if two instruments that disagree were \
         read in turn; the intervals do not allow for it; check the heading column"
    );
    (Uncertainty::Covariance(white), Some(WarningCode::ColouredResidual.warning(warning)))
}

/// `true` if the lag-1 autocorrelation is relevant and outside three standard deviations of white noise.
pub(crate) fn is_coloured(lag1: f64, rows: usize) -> bool {
    lag1.abs() > MAX_WHITE_CORRELATION.max(3.0 / (rows as f64).sqrt())
}

/// Lag-1 autocorrelation Σ eₖ eₖ₊₁ / Σ eₖ² of residuals over all trials; 0 for a residual of zero.
pub(crate) fn lag1_autocorrelation<'a>(residuals: impl Iterator<Item = &'a [f64]> + Clone) -> f64 {
    let square: f64 = residuals.clone().map(|trial| dot(trial, trial)).sum();
    let cross: f64 = residuals.map(|trial| dot(trial.get(1..).unwrap_or(&[]), trial)).sum();
    if square > 0.0 { cross / square } else { 0.0 }
}

/// Long-run covariance of the scores of three unknowns, summed over trials.
pub(crate) fn newey_west_three(scores: &[[Vec<f64>; 3]]) -> Matrix3<f64> {
    newey_west(scores).fixed_view::<3, 3>(0, 0).into_owned()
}
