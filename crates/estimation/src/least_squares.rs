//! Linear least squares with scaled columns, covariance and condition number.
//!
//! Source: Golub and Van Loan (2013), Matrix Computations, fourth edition, chapter 5.

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// Error of a linear least-squares problem without a unique solution.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum LeastSquaresError {
    /// Fewer rows than columns.
    #[error("needs at least {columns} equations, found {rows}")]
    TooFewRows {
        /// Number of columns.
        columns: usize,
        /// Number of rows.
        rows: usize,
    },
    /// Columns that are nearly linearly dependent, or a column that is zero or not finite.
    #[error("the equations are singular (condition number {condition:.1e}, limit {limit:.0e})")]
    Singular {
        /// Condition number of the scaled columns.
        condition: f64,
        /// Maximum condition number accepted.
        limit: f64,
    },
}

/// Solution of min ‖y − X θ‖².
#[derive(Debug, Clone)]
pub struct LeastSquares {
    /// Estimate θ, one value per column.
    pub parameters: DVector<f64>,
    /// Unscaled covariance (XᵀX)⁻¹; multiplied by the noise variance it is the covariance of θ.
    pub unscaled_covariance: DMatrix<f64>,
    /// Residual sum of squares.
    pub residual_sum_of_squares: f64,
    /// Number of rows minus number of columns.
    pub degrees_of_freedom: f64,
    /// Ratio of the maximum to the minimum singular value of X with its columns scaled to unit length.
    pub condition_number: f64,
}

impl LeastSquares {
    /// Solution by singular values of the scaled columns; every column has as many rows as `y`.
    ///
    /// Fails with [`LeastSquaresError::TooFewRows`] for fewer rows than columns, and with
    /// [`LeastSquaresError::Singular`] if the condition number of the scaled columns exceeds `condition_limit`, or if a
    /// column is zero or not finite.
    pub fn solve(columns: &[&[f64]], y: &[f64], condition_limit: f64) -> Result<Self, LeastSquaresError> {
        let (rows, width) = (y.len(), columns.len());
        if rows < width {
            return Err(LeastSquaresError::TooFewRows { columns: width, rows });
        }
        let singular = |condition| LeastSquaresError::Singular { condition, limit: condition_limit };
        let norm = |column: &&[f64]| column.iter().map(|x| x * x).sum::<f64>().sqrt();
        let scale: Vec<f64> = columns.iter().map(norm).collect();
        if scale.iter().any(|&length| !(length.is_finite() && length > 0.0)) {
            return Err(singular(f64::INFINITY));
        }
        let design = DMatrix::from_fn(rows, width, |row, column| columns[column][row] / scale[column]);
        let target = DVector::from_column_slice(y);
        // QR first: R has the singular values of X, and R is small.
        let qr = design.clone().qr();
        let mut rotated = target.clone();
        qr.q_tr_mul(&mut rotated);
        let svd = qr.r().svd(true, true);
        let (largest, smallest) = (svd.singular_values.max(), svd.singular_values.min());
        let condition = if smallest > 0.0 { largest / smallest } else { f64::INFINITY };
        if condition.is_nan() || condition > condition_limit {
            return Err(singular(condition));
        }
        let head = rotated.rows(0, width).into_owned();
        let scaled = svd.solve(&head, 0.0).map_err(|_| singular(condition))?;
        let v_t = svd.v_t.as_ref().ok_or_else(|| singular(condition))?;
        let inverse_squares = svd.singular_values.map(|s| 1.0 / (s * s));
        let scaled_covariance = v_t.transpose() * DMatrix::from_diagonal(&inverse_squares) * v_t;
        let residual = &target - &design * &scaled;
        Ok(Self {
            parameters: DVector::from_fn(width, |i, _| scaled[i] / scale[i]),
            unscaled_covariance: DMatrix::from_fn(width, width, |i, j| {
                scaled_covariance[(i, j)] / (scale[i] * scale[j])
            }),
            residual_sum_of_squares: residual.norm_squared(),
            degrees_of_freedom: (rows - width) as f64,
            condition_number: condition,
        })
    }

    /// Noise variance rss/(rows − columns); `None` without degrees of freedom.
    pub fn variance(&self) -> Option<f64> {
        (self.degrees_of_freedom > 0.0).then(|| self.residual_sum_of_squares / self.degrees_of_freedom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn recovers_a_line_over_columns_of_very_different_size() {
        let x: Vec<f64> = (0..50).map(|i| 1e6 * i as f64).collect();
        let constant = vec![1e-3; 50];
        let y: Vec<f64> = x.iter().map(|x| 2.0 + 3e-6 * x).collect();
        let fit = LeastSquares::solve(&[&constant, &x], &y, 1e6).expect("well conditioned");
        assert_relative_eq!(fit.parameters[0], 2000.0, max_relative = 1e-10);
        assert_relative_eq!(fit.parameters[1], 3e-6, max_relative = 1e-10);
        assert!(fit.residual_sum_of_squares < 1e-20);
    }

    #[test]
    fn refuses_parallel_columns() {
        let x: Vec<f64> = (0..9).map(f64::from).collect();
        let twice: Vec<f64> = x.iter().map(|x| 2.0 * x).collect();
        let error = LeastSquares::solve(&[&x, &twice], &x, 1e8).expect_err("parallel");
        assert!(matches!(error, LeastSquaresError::Singular { .. }), "{error}");
    }
}
