//! The basis 1, cos n w t, sin n w t (n = 1..N) on the instants of one record, orthogonalised once and used for as many
//! signals as are wanted. It does not choose w: see [`super::fundamental`].

use nalgebra::{DMatrix, DVector, Dyn, QR, SVD};

use super::FourierFit;
use crate::error::IdentifyError;

/// The basis on given instants, with a stable decomposition of its design matrix X (rows × 2N+1).
///
/// Inside, time runs from the middle of the instants: moving the origin turns every pair (cos n, sin n) by an angle,
/// an orthogonal change that keeps condition number and residuals but makes cos and sin columns nearly orthogonal to
/// each other.
#[derive(Debug, Clone)]
pub struct Basis {
    fundamental: f64,
    harmonics: usize,
    centre: f64,
    design: DMatrix<f64>,
    qr: QR<f64, Dyn, Dyn>,
    /// Of the triangle of the QR decomposition.
    svd: SVD<f64, Dyn, Dyn>,
}

/// A signal on a [`Basis`]: coefficients in centred time and what is left over.
#[derive(Debug, Clone)]
pub struct Projection {
    /// Coefficients in the order 1, cos 1, sin 1, cos 2, …, in the time of the basis.
    pub coefficients: DVector<f64>,
    /// Signal less its projection, one value an instant.
    pub residual: Vec<f64>,
    /// Share of the variance that the projection carries; 1 for a constant signal.
    pub r_squared: f64,
}

impl Basis {
    /// The basis of `harmonics` harmonics of `fundamental` (rad/s, positive) on `time` (s, increasing).
    ///
    /// Fails with [`IdentifyError::TooFewPoints`] when there are not more instants than columns.
    pub fn new(time: &[f64], fundamental: f64, harmonics: usize) -> Result<Self, IdentifyError> {
        let width = 2 * harmonics + 1;
        if time.len() <= width {
            let (needed, found) = (width + 1, time.len());
            return Err(IdentifyError::TooFewPoints { what: "headings for the Fourier series", needed, found });
        }
        let centre = 0.5 * (time[0] + time[time.len() - 1]);
        let mut design = DMatrix::zeros(time.len(), width);
        let mut row = vec![0.0; width];
        for (i, t) in time.iter().enumerate() {
            fill_row(fundamental, harmonics, t - centre, 0, &mut row);
            for (column, value) in row.iter().enumerate() {
                design[(i, column)] = *value;
            }
        }
        let qr = design.clone().qr();
        let svd = qr.r().svd(true, true);
        Ok(Self { fundamental, harmonics, centre, design, qr, svd })
    }

    /// Fundamental w, rad/s.
    pub fn fundamental(&self) -> f64 {
        self.fundamental
    }

    /// Number of harmonics N.
    pub fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// Condition number of X, columns as they are (√2 for whole periods); infinite when X has no full rank.
    pub fn condition(&self) -> f64 {
        let (largest, smallest) = (self.svd.singular_values.max(), self.svd.singular_values.min());
        if smallest > 0.0 { largest / smallest } else { f64::INFINITY }
    }

    /// Least-squares projection of a signal given at the instants of the basis.
    ///
    /// Directions whose singular value is below 1e-14 of the largest are left out, so that a basis that is singular to
    /// rounding still gives the smallest of its solutions.
    pub fn project(&self, values: &[f64]) -> Projection {
        let y = DVector::from_column_slice(values);
        let mut rotated = y.clone();
        self.qr.q_tr_mul(&mut rotated);
        let head = rotated.rows(0, self.design.ncols()).into_owned();
        let floor = 1e-14 * self.svd.singular_values.max();
        let coefficients = self.svd.solve(&head, floor).expect("both sides of the decomposition were asked for");
        let residual: Vec<f64> = (&y - &self.design * &coefficients).iter().copied().collect();
        let mean = y.mean();
        let total: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let left: f64 = residual.iter().map(|e| e * e).sum();
        let r_squared = if total > 0.0 { 1.0 - left / total } else { 1.0 };
        Projection { coefficients, residual, r_squared }
    }

    /// Residual sums of squares of the series with 0, 1, .. N harmonics of the same fundamental.
    pub fn nested_rss(&self, values: &[f64]) -> Vec<f64> {
        let mut rotated = DVector::from_column_slice(values);
        self.qr.q_tr_mul(&mut rotated);
        let squares = |from: usize| rotated.rows_range(from..).norm_squared();
        // Columns come harmonic by harmonic, so that every leading block is a series of its own.
        (0..=self.harmonics).map(|harmonics| squares(2 * harmonics + 1)).collect()
    }

    /// (XᵀX)⁻¹ in the order of [`Projection::coefficients`]: times a white noise variance, their covariance.
    pub fn unscaled_covariance(&self) -> DMatrix<f64> {
        let v_t = self.svd.v_t.as_ref().expect("both sides of the decomposition were asked for");
        let inverse_squares = self.svd.singular_values.map(|s| 1.0 / (s * s));
        v_t.transpose() * DMatrix::from_diagonal(&inverse_squares) * v_t
    }

    /// Writes the basis functions, differentiated `order` times (0, 1 or 2), at time `t` (s) into `row` (2N+1 long).
    pub fn row(&self, t: f64, order: u8, row: &mut [f64]) {
        fill_row(self.fundamental, self.harmonics, t - self.centre, order, row);
    }

    /// The curve of a projection, with coefficients in the time of the record.
    pub fn curve(&self, projection: &Projection) -> FourierFit {
        let n = self.harmonics;
        let theta = &projection.coefficients;
        let (mut cosine, mut sine) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for harmonic in 1..=n {
            let (s, c) = (harmonic as f64 * self.fundamental * self.centre).sin_cos();
            let (a, b) = (theta[2 * harmonic - 1], theta[2 * harmonic]);
            cosine.push(a * c - b * s);
            sine.push(a * s + b * c);
        }
        FourierFit {
            fundamental: self.fundamental,
            mean: theta[0],
            cosine,
            sine,
            r_squared: projection.r_squared,
            condition: self.condition(),
        }
    }
}

/// Basis functions or their derivatives at `u`: order 0, 1 or 2.
fn fill_row(fundamental: f64, harmonics: usize, u: f64, order: u8, row: &mut [f64]) {
    let (s1, c1) = (fundamental * u).sin_cos();
    let (mut s, mut c) = (s1, c1);
    row[0] = if order == 0 { 1.0 } else { 0.0 };
    for harmonic in 1..=harmonics {
        let rate = harmonic as f64 * fundamental;
        (row[2 * harmonic - 1], row[2 * harmonic]) = match order {
            0 => (c, s),
            1 => (-rate * s, rate * c),
            _ => (-rate * rate * c, -rate * rate * s),
        };
        (s, c) = (s * c1 + c * s1, c * c1 - s * s1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    fn signal(t: f64) -> f64 {
        3.0 + 2.0 * (0.05 * t).cos() - 1.5 * (0.1 * t).sin()
    }

    #[test]
    fn a_series_is_recovered_on_uneven_instants() {
        let time: Vec<f64> = (0..90).map(|i| 3.0 * i as f64 + (i as f64).sin()).collect();
        let values: Vec<f64> = time.iter().map(|&t| signal(t)).collect();
        let basis = Basis::new(&time, 0.05, 3).expect("enough instants");
        let curve = basis.curve(&basis.project(&values));
        assert_relative_eq!(curve.mean, 3.0, max_relative = 1e-10);
        assert_relative_eq!(curve.cosine[0], 2.0, max_relative = 1e-10);
        assert_relative_eq!(curve.sine[1], -1.5, max_relative = 1e-10);
        assert_abs_diff_eq!(curve.sine[2], 0.0, epsilon = 1e-10);
        for t in [0.0, 17.0, 200.0] {
            assert_relative_eq!(curve.heading(t), signal(t), max_relative = 1e-10);
            let rate = -0.1 * (0.05 * t).sin() - 0.15 * (0.1 * t).cos();
            assert_abs_diff_eq!(curve.yaw_rate(t), rate, epsilon = 1e-11);
            let acceleration = -0.005 * (0.05 * t).cos() + 0.015 * (0.1 * t).sin();
            assert_abs_diff_eq!(curve.yaw_acceleration(t), acceleration, epsilon = 1e-12);
        }
    }

    #[test]
    fn nested_residuals_are_those_of_the_shorter_series() {
        let time: Vec<f64> = (0..120).map(f64::from).collect();
        let values: Vec<f64> = time.iter().map(|t| (0.002 * t * t).sin()).collect();
        let nested = Basis::new(&time, 0.045, 6).expect("enough instants").nested_rss(&values);
        assert_eq!(nested.len(), 7);
        for (harmonics, rss) in nested.into_iter().enumerate() {
            let alone = Basis::new(&time, 0.045, harmonics).expect("enough instants").project(&values);
            assert_relative_eq!(rss, alone.residual.iter().map(|e| e * e).sum(), max_relative = 1e-9);
        }
    }

    #[test]
    fn whole_periods_give_orthogonal_columns() {
        let time: Vec<f64> = (0..200).map(f64::from).collect();
        let basis = Basis::new(&time, std::f64::consts::TAU / 100.0, 8).expect("enough instants");
        assert_relative_eq!(basis.condition(), 2f64.sqrt(), max_relative = 1e-10);
    }

    #[test]
    fn refuses_as_many_coefficients_as_instants() {
        let time: Vec<f64> = (0..17).map(f64::from).collect();
        let error = Basis::new(&time, 0.1, 8).expect_err("17 columns on 17 rows");
        assert_eq!(
            error,
            IdentifyError::TooFewPoints { what: "headings for the Fourier series", needed: 18, found: 17 }
        );
    }
}
