mod figures;
mod made_up;
mod made_up_hull;
mod measured;
mod measured_hull;
mod steered;

use super::{IdentifiedHull, SYMBOLS, YAW_SYMBOLS};

/// Standard deviation of a coefficient.
fn sd(covariance: &[impl AsRef<[f64]>], place: usize) -> f64 {
    covariance[place].as_ref()[place].max(0.0).sqrt()
}

/// Coefficients of a hull with their symbols.
fn coefficients(hull: &IdentifiedHull) -> Vec<(&'static str, f64)> {
    let symbols = SYMBOLS.into_iter().chain(YAW_SYMBOLS);
    symbols.zip(hull.planar.coefficients.to_array().into_iter().chain(hull.yaw.to_array())).collect()
}
