//! Errors of a least-squares estimate whose residual is coloured.

use nalgebra::{Matrix3, Vector3};

use crate::estimate::{Covariance, Uncertainty};

/// A residual whose neighbours are correlated by more than this is called coloured, if chance does not explain it.
const COLOURED: f64 = 0.2;

/// The error a method quotes: that of a white residual where it is white, else the robust one, with a sentence on it.
pub(crate) fn judge(white: Covariance, robust: &Covariance, lag1: f64, rows: usize) -> (Uncertainty, Option<String>) {
    if lag1.abs() <= COLOURED.max(3.0 / (rows as f64).sqrt()) {
        return (Uncertainty::Covariance(white), None);
    }
    let warning = format!(
        "the residual is coloured (lag-1 autocorrelation {lag1:.2}): intervals are from the Newey-West covariance, and \
         the model lacks an effect"
    );
    (Uncertainty::Covariance(robust.clone()), Some(warning))
}

/// Lag-1 autocorrelation of residuals, pooled over trials.
pub(crate) fn lag1_autocorrelation<'a>(residuals: impl Iterator<Item = &'a [f64]> + Clone) -> f64 {
    let square: f64 = residuals.clone().flatten().map(|e| e * e).sum();
    let cross: f64 = residuals.map(|trial| trial.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>()).sum();
    if square > 0.0 { cross / square } else { 0.0 }
}

/// Long-run covariance Σ_k w_k Γ_k of scores with Bartlett weights, summed over trials.
///
/// `scores[trial][row]` is residual times Jacobian row. The lag grows with the first-order autocorrelation of the scores
/// (Andrews 1991) up to a quarter of the record. The Bartlett sum equals the mean square of sums over all windows
/// of one length, which needs one pass.
///
/// Sources: Newey and West (1987); Andrews (1991).
pub(crate) fn newey_west(scores: &[Vec<[f64; 3]>]) -> Matrix3<f64> {
    scores.iter().map(|trial| window_covariance(trial, bandwidth(trial))).sum()
}

/// Window length (lags plus one) from the autocorrelation of the scores, the largest over the three parameters.
fn bandwidth(scores: &[[f64; 3]]) -> usize {
    let rows = scores.len();
    let longest = (rows / 4).max(1);
    (0..3)
        .map(|i| {
            let square: f64 = scores.iter().map(|g| g[i] * g[i]).sum();
            let cross: f64 = scores.windows(2).map(|pair| pair[0][i] * pair[1][i]).sum();
            let rho = if square > 0.0 { (cross / square).clamp(-0.999, 0.999) } else { 0.0 };
            let alpha = 4.0 * rho * rho / ((1.0 - rho).powi(2) * (1.0 + rho).powi(2));
            (1.1447 * (alpha * rows as f64).cbrt()).ceil() as usize + 1
        })
        .max()
        .unwrap_or(1)
        .min(longest)
}

fn window_covariance(scores: &[[f64; 3]], length: usize) -> Matrix3<f64> {
    let mut total = Matrix3::zeros();
    let mut window = Vector3::zeros();
    for end in 0..scores.len() + length - 1 {
        if let Some(&entering) = scores.get(end) {
            window += Vector3::from(entering);
        }
        if end >= length {
            window -= Vector3::from(scores[end - length]);
        }
        total += window * window.transpose();
    }
    total / length as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn windows_are_bartlett_weights() {
        let scores: Vec<[f64; 3]> =
            (0..40).map(|k| [(k as f64).sin(), (0.3 * k as f64).cos(), 0.1 * k as f64 - 2.0]).collect();
        let length = 6;
        let mut direct = Matrix3::zeros();
        for (i, gi) in scores.iter().enumerate() {
            for (j, gj) in scores.iter().enumerate() {
                let weight = 1.0 - i.abs_diff(j) as f64 / length as f64;
                if weight > 0.0 {
                    direct += Vector3::from(*gi) * Vector3::from(*gj).transpose() * weight;
                }
            }
        }
        let fast = window_covariance(&scores, length);
        for (fast, direct) in fast.iter().zip(direct.iter()) {
            assert_relative_eq!(*fast, *direct, max_relative = 1e-10, epsilon = 1e-10);
        }
    }
}
