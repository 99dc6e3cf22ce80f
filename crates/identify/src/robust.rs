//! Errors of a least-squares estimate whose residual is coloured.

use nalgebra::{DMatrix, DVector, Matrix3};

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
/// `scores[trial][row]` is residual times Jacobian row, one entry per unknown. The lag grows with the first-order
/// autocorrelation of the scores (Andrews 1991) up to a quarter of the record. The Bartlett sum equals the mean square of sums
/// over all windows of one length, which needs one pass.
///
/// Sources: Newey and West (1987); Andrews (1991).
pub fn newey_west<S: AsRef<[f64]>>(scores: &[Vec<S>]) -> DMatrix<f64> {
    let unknowns = scores.iter().flatten().next().map_or(0, |row| row.as_ref().len());
    let covariances = scores.iter().map(|trial| window_covariance(trial, bandwidth(trial, unknowns), unknowns));
    covariances.fold(DMatrix::zeros(unknowns, unknowns), |sum, one| sum + one)
}

/// The same of three unknowns.
pub(crate) fn newey_west_of_three(scores: &[Vec<[f64; 3]>]) -> Matrix3<f64> {
    Matrix3::from_iterator(newey_west(scores).iter().copied())
}

/// Window length (lags plus one) from the autocorrelation of the scores, the largest over the unknowns.
fn bandwidth<S: AsRef<[f64]>>(scores: &[S], unknowns: usize) -> usize {
    let rows = scores.len();
    let longest = (rows / 4).max(1);
    (0..unknowns)
        .map(|i| {
            let at = |row: &S| row.as_ref()[i];
            let square: f64 = scores.iter().map(|g| at(g) * at(g)).sum();
            let cross: f64 = scores.windows(2).map(|pair| at(&pair[0]) * at(&pair[1])).sum();
            let rho = if square > 0.0 { (cross / square).clamp(-0.999, 0.999) } else { 0.0 };
            let alpha = 4.0 * rho * rho / ((1.0 - rho).powi(2) * (1.0 + rho).powi(2));
            (1.1447 * (alpha * rows as f64).cbrt()).ceil() as usize + 1
        })
        .max()
        .unwrap_or(1)
        .min(longest)
}

fn window_covariance<S: AsRef<[f64]>>(scores: &[S], length: usize, unknowns: usize) -> DMatrix<f64> {
    let mut total = DMatrix::zeros(unknowns, unknowns);
    let mut window = DVector::<f64>::zeros(unknowns);
    for end in 0..scores.len() + length - 1 {
        if let Some(entering) = scores.get(end) {
            window.iter_mut().zip(entering.as_ref()).for_each(|(sum, g)| *sum += g);
        }
        if end >= length {
            window.iter_mut().zip(scores[end - length].as_ref()).for_each(|(sum, g)| *sum -= g);
        }
        total.ger(1.0, &window, &window, 1.0);
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
        let mut direct = DMatrix::<f64>::zeros(3, 3);
        for (i, gi) in scores.iter().enumerate() {
            for (j, gj) in scores.iter().enumerate() {
                let weight = 1.0 - i.abs_diff(j) as f64 / length as f64;
                if weight > 0.0 {
                    direct += DVector::from_row_slice(gi) * DVector::from_row_slice(gj).transpose() * weight;
                }
            }
        }
        let fast = window_covariance(&scores, length, 3);
        for (fast, direct) in fast.iter().zip(direct.iter()) {
            assert_relative_eq!(*fast, *direct, max_relative = 1e-10, epsilon = 1e-10);
        }
    }
}
