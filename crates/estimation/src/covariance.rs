//! Long-run covariance of scores that are correlated in time (heteroskedasticity and autocorrelation consistent).
//!
//! Sources: Newey and West (1987), Econometrica 55:703-708; Andrews (1991), Econometrica 59:817-858.

use nalgebra::DMatrix;

use crate::column::{dot, gram};

/// Long-run covariance Σ_k w_k Γ_k of scores with Bartlett weights, summed over records.
///
/// `scores[record][unknown]` is the column of residual times Jacobian; the result has one row and column per unknown.
/// The maximum lag increases with the first-order autocorrelation of the scores (Andrews 1991) up to a quarter of the
/// record. The Bartlett sum equals the mean square of sums over all windows of one length, which needs one pass.
pub fn newey_west<S: AsRef<[Vec<f64>]>>(scores: &[S]) -> DMatrix<f64> {
    let unknowns = scores.first().map_or(0, |record| record.as_ref().len());
    let mut sum = DMatrix::zeros(unknowns, unknowns);
    for record in scores.iter().map(AsRef::as_ref) {
        let length = bandwidth(record);
        let windows: Vec<Vec<f64>> = record.iter().map(|column| window_sums(column, length)).collect();
        if let [x, y, z] = &windows[..] {
            // Three unknowns are the usual case; all products in one pass.
            let products = gram([x, y, z]);
            sum += DMatrix::from_fn(3, 3, |i, j| products[i][j] / length as f64);
            continue;
        }
        for i in 0..unknowns {
            for j in 0..=i {
                sum[(i, j)] += dot(&windows[i], &windows[j]) / length as f64;
                sum[(j, i)] = sum[(i, j)];
            }
        }
    }
    sum
}

/// Window length (lags plus one) from the autocorrelation of the scores; the maximum over the unknowns.
fn bandwidth(scores: &[Vec<f64>]) -> usize {
    let rows = scores.first().map_or(0, Vec::len);
    let max_length = (rows / 4).max(1);
    let column_length = |column: &Vec<f64>| {
        let square = dot(column, column);
        let cross = dot(column.get(1..).unwrap_or(&[]), column);
        let rho = if square > 0.0 { (cross / square).clamp(-0.999, 0.999) } else { 0.0 };
        let alpha = 4.0 * rho * rho / ((1.0 - rho).powi(2) * (1.0 + rho).powi(2));
        (1.1447 * (alpha * rows as f64).cbrt()).ceil() as usize + 1
    };
    scores.iter().map(column_length).max().unwrap_or(1).min(max_length)
}

/// Moving sums of a column over windows of `length` rows, also windows that overlap an end; empty for no rows.
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
    // The window with only the last row is the last window.
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
    fn a_record_without_scores_adds_nothing() {
        let some = vec![vec![1.0, -2.0, 0.5, 3.0, -1.0]; 3];
        assert_eq!(newey_west(&[some.clone(), vec![Vec::new(); 3]]), newey_west(&[some]));
    }

    #[test]
    fn windows_are_bartlett_weights() {
        let rows: Vec<[f64; 3]> =
            (0..40).map(|k| [(k as f64).sin(), (0.3 * k as f64).cos(), 0.1 * k as f64 - 2.0]).collect();
        let columns = [0, 1, 2].map(|unknown| rows.iter().map(|row| row[unknown]).collect::<Vec<f64>>());
        let length = bandwidth(&columns);
        assert!(length > 3);
        let mut direct = DMatrix::<f64>::zeros(3, 3);
        for (i, gi) in rows.iter().enumerate() {
            for (j, gj) in rows.iter().enumerate() {
                let weight = 1.0 - i.abs_diff(j) as f64 / length as f64;
                if weight > 0.0 {
                    direct += DVector::from_row_slice(gi) * DVector::from_row_slice(gj).transpose() * weight;
                }
            }
        }
        for (fast, direct) in newey_west(&[columns]).iter().zip(direct.iter()) {
            assert_relative_eq!(*fast, *direct, max_relative = 1e-10, epsilon = 1e-10);
        }
    }
}
