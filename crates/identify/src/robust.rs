//! Errors of a least-squares estimate whose residual is coloured.

use document::{Code, Warning};
use estimation::column::dot;
use estimation::covariance::newey_west;
use nalgebra::Matrix3;

use crate::estimate::{Covariance, Uncertainty};

/// A residual whose neighbours are correlated by more than this is called coloured, if chance does not explain it.
const COLOURED: f64 = 0.2;

/// The error a method quotes: that of a white residual where it is white, else the robust one, with a warning.
/// Where neighbours differ in sign the robust error would be smaller than the white one, which a record of two
/// instruments read in turn does not deserve: the white one stays.
pub(crate) fn judge(white: Covariance, robust: &Covariance, lag1: f64, rows: usize) -> (Uncertainty, Option<Warning>) {
    if !is_coloured(lag1, rows) {
        return (Uncertainty::Covariance(white), None);
    }
    if lag1 > 0.0 {
        let warning = format!(
            "errors of the replay last from reading to reading (correlation {lag1:.2}): the model lacks an effect, or the compass \
             has a memory; intervals allow for it"
        );
        return (Uncertainty::Covariance(robust.clone()), Some(Code::ColouredResidual.warning(warning)));
    }
    let warning = format!(
        "the residual alternates from reading to reading (lag-1 autocorrelation {lag1:.2}), as where two instruments that \
         disagree are read in turn: intervals take it for white; look at the heading"
    );
    (Uncertainty::Covariance(white), Some(Code::ColouredResidual.warning(warning)))
}

/// Whether neighbours are correlated by more than is usual, and by more than chance.
pub(crate) fn is_coloured(lag1: f64, rows: usize) -> bool {
    lag1.abs() > COLOURED.max(3.0 / (rows as f64).sqrt())
}

/// Lag-1 autocorrelation of residuals, pooled over trials.
pub(crate) fn lag1_autocorrelation<'a>(residuals: impl Iterator<Item = &'a [f64]> + Clone) -> f64 {
    let square: f64 = residuals.clone().map(|trial| dot(trial, trial)).sum();
    let cross: f64 = residuals.map(|trial| dot(trial.get(1..).unwrap_or(&[]), trial)).sum();
    if square > 0.0 { cross / square } else { 0.0 }
}

/// Long-run covariance of the scores of three unknowns, summed over trials.
pub(crate) fn newey_west_of_three(scores: &[[Vec<f64>; 3]]) -> Matrix3<f64> {
    newey_west(scores).fixed_view::<3, 3>(0, 0).into_owned()
}
