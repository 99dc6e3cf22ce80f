//! Input and result of the variants: a trial with its characteristic points, and the fit to them.

use nalgebra::Matrix3;

use super::points::TrialPoints;
use crate::samples::Samples;

/// Trial with its characteristic points.
#[derive(Debug)]
pub(super) struct AnalysedTrial {
    pub(super) samples: Samples,
    pub(super) points: TrialPoints,
}

/// Result of a variant, in the parameters of the integrated equation.
#[derive(Debug)]
pub(super) struct PointsFit {
    /// K (1/s), K δ_r (rad/s), T (s).
    pub(super) parameters: [f64; 3],
    /// Covariance and degrees of freedom, or the reason why there is none.
    pub(super) covariance: Result<(Matrix3<f64>, f64), &'static str>,
    pub(super) diagnostics: Vec<(&'static str, f64)>,
}
