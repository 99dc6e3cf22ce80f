//! Errors of a least-squares estimate whose residual is coloured.

use estimation::column::{dot, gram};
use nalgebra::{DMatrix, Matrix3};

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
    let square: f64 = residuals.clone().map(|trial| dot(trial, trial)).sum();
    let cross: f64 = residuals.map(|trial| dot(trial.get(1..).unwrap_or(&[]), trial)).sum();
    if square > 0.0 { cross / square } else { 0.0 }
}

/// Long-run covariance Σ_k w_k Γ_k of scores with Bartlett weights, summed over trials.
///
/// `scores[trial][unknown]` is the column of residual times Jacobian. The lag grows with the first-order
/// autocorrelation of the scores (Andrews 1991) up to a quarter of the record. The Bartlett sum equals the mean square
/// of sums over all windows of one length, which needs one pass.
///
/// Sources: Newey and West (1987); Andrews (1991).
pub fn newey_west(scores: &[Vec<Vec<f64>>]) -> DMatrix<f64> {
    let unknowns = scores.first().map_or(0, Vec::len);
    let mut sum = DMatrix::zeros(unknowns, unknowns);
    for trial in scores {
        let length = bandwidth(trial);
        let windows: Vec<Vec<f64>> = trial.iter().map(|column| window_sums(column, length)).collect();
        for i in 0..unknowns {
            for j in 0..=i {
                let product = dot(&windows[i], &windows[j]) / length as f64;
                sum[(i, j)] += product;
                if i != j {
                    sum[(j, i)] += product;
                }
            }
        }
    }
    sum
}

/// The same of three unknowns.
pub(crate) fn newey_west_of_three(scores: &[[Vec<f64>; 3]]) -> Matrix3<f64> {
    let mut sum = Matrix3::zeros();
    for trial in scores {
        let length = bandwidth(trial);
        let [x, y, z] = [0, 1, 2].map(|unknown| window_sums(&trial[unknown], length));
        sum += Matrix3::from(gram([&x, &y, &z])) / length as f64;
    }
    sum
}

/// Window length (lags plus one) from the autocorrelation of the scores, the largest over the unknowns.
fn bandwidth(scores: &[Vec<f64>]) -> usize {
    let rows = scores.first().map_or(0, Vec::len);
    let longest = (rows / 4).max(1);
    let of_column = |column: &Vec<f64>| {
        let square = dot(column, column);
        let cross = dot(column.get(1..).unwrap_or(&[]), column);
        let rho = if square > 0.0 { (cross / square).clamp(-0.999, 0.999) } else { 0.0 };
        let alpha = 4.0 * rho * rho / ((1.0 - rho).powi(2) * (1.0 + rho).powi(2));
        (1.1447 * (alpha * rows as f64).cbrt()).ceil() as usize + 1
    };
    scores.iter().map(of_column).max().unwrap_or(1).min(longest)
}

/// Sums of a column over all windows of `length` rows, those that overlap an end only partly included; an empty column
/// has none.
fn window_sums(column: &[f64], length: usize) -> Vec<f64> {
    let mut sums = Vec::with_capacity(column.len() + length);
    let mut window = 0.0;
    let full = length.min(column.len());
    sums.extend(column[..full].iter().map(|entering| {
        window += entering;
        window
    }));
    sums.extend(column[full..].iter().zip(column).map(|(entering, leaving)| {
        window += entering - leaving;
        window
    }));
    // The last row never leaves alone.
    sums.extend(column[column.len() - full..].iter().take(full.saturating_sub(1)).map(|leaving| {
        window -= leaving;
        window
    }));
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::DVector;

    #[test]
    fn a_trial_without_scores_adds_nothing() {
        let some = [(); 3].map(|()| vec![1.0, -2.0, 0.5, 3.0, -1.0]);
        let alone = newey_west_of_three(std::slice::from_ref(&some));
        assert_eq!(newey_west_of_three(&[some.clone(), Default::default()]), alone);
        let of_any_number = newey_west(&[some.to_vec()]);
        assert_eq!(newey_west(&[some.to_vec(), vec![Vec::new(); 3]]), of_any_number);
    }

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
        let columns = [0, 1, 2].map(|unknown| scores.iter().map(|row| row[unknown]).collect::<Vec<f64>>());
        let [x, y, z] = [0, 1, 2].map(|unknown| window_sums(&columns[unknown], length));
        let fast = Matrix3::from(gram([&x, &y, &z])) / length as f64;
        for (fast, direct) in fast.iter().zip(direct.iter()) {
            assert_relative_eq!(*fast, *direct, max_relative = 1e-10, epsilon = 1e-10);
        }
        let of_any_number = newey_west(&[columns.to_vec()]);
        for (three, any) in newey_west_of_three(&[columns]).iter().zip(of_any_number.iter()) {
            assert_relative_eq!(*three, *any, max_relative = 1e-12);
        }
    }
}
