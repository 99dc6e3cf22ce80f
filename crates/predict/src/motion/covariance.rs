//! Covariance of a least-squares fit whose residuals are coloured.

use nalgebra::DMatrix;

/// Long-run covariance Σ_k w_k Γ_k of the scores of one record with Bartlett weights.
///
/// `scores[unknown][row]` is a residual times its derivative. The number of lags follows from the autocorrelation of
/// each score (Andrews 1991), up to a quarter of the record; the longest is taken for all. The sum equals the mean of
/// squares over all windows of that length, those included that overlap an end.
///
/// Sources: Newey and West (1987); Andrews (1991).
pub(crate) fn newey_west(scores: &[Vec<f64>]) -> DMatrix<f64> {
    let rows = scores.first().map_or(0, Vec::len);
    let length = scores.iter().map(|score| window(score)).max().unwrap_or(1).clamp(1, (rows / 4).max(1));
    let sums: Vec<Vec<f64>> = scores.iter().map(|score| window_sums(score, length)).collect();
    DMatrix::from_fn(scores.len(), scores.len(), |i, j| {
        sums[i].iter().zip(&sums[j]).map(|(x, y)| x * y).sum::<f64>() / length as f64
    })
}

/// Lags plus one.
fn window(score: &[f64]) -> usize {
    let square: f64 = score.iter().map(|x| x * x).sum();
    let cross: f64 = score.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let rho = if square > 0.0 { (cross / square).clamp(-0.999, 0.999) } else { 0.0 };
    let alpha = 4.0 * rho * rho / ((1.0 - rho).powi(2) * (1.0 + rho).powi(2));
    (1.1447 * (alpha * score.len() as f64).cbrt()).ceil() as usize + 1
}

fn window_sums(score: &[f64], length: usize) -> Vec<f64> {
    let mut total = 0.0;
    let sums: Vec<f64> = std::iter::once(0.0)
        .chain(score.iter().map(|x| {
            total += x;
            total
        }))
        .collect();
    let rows = score.len();
    (1..rows + length).map(|end| sums[end.min(rows)] - sums[end.saturating_sub(length)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the definition, lag for lag.
    #[test]
    fn windows_give_the_bartlett_sum() {
        let score: Vec<f64> = (0..60).map(|i| (f64::from(i) * 0.7).sin() + 0.1 * f64::from(i % 7)).collect();
        let length = window(&score).clamp(1, 15);
        assert!(length > 3);
        let lag = |k: usize| score[k..].iter().zip(&score).map(|(x, y)| x * y).sum::<f64>();
        let weight = |k: usize| 1.0 - k as f64 / length as f64;
        let expected = lag(0) + (1..length).map(|k| 2.0 * weight(k) * lag(k)).sum::<f64>();
        approx::assert_relative_eq!(newey_west(&[score])[(0, 0)], expected, max_relative = 1e-9);
    }
}
