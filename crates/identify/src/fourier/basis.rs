//! Basis 1, cos n w t, sin n w t (n = 1..N) on the instants of one record, orthogonalised once for any number of
//! signals. The choice of w is in [`super::fundamental`].

use nalgebra::{DMatrix, DVector, Dyn, QR, SVD};
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use super::curve::FourierSeries;
use super::folded_rows::{dot, has_even_steps};
use crate::error::IdentifyError;

/// Nested bases with 0, 1, .. N harmonics of one fundamental on given instants: leading columns of one design matrix X
/// (rows × 2N+1, in the order 1, cos 1, sin 1, cos 2, …), so that one orthogonal decomposition serves all bases.
///
/// Internally, time runs from the middle of the instants: moving the origin turns every pair (cos n, sin n) by an
/// angle, an orthogonal change that keeps condition number and residuals but makes cos and sin columns nearly
/// orthogonal to each other. On even steps they are orthogonal: every instant has a mirror image, and sum and
/// difference of the two, over √2, turn X into a part with the cosines and a part with the sines, each half as long.
#[derive(Debug, Clone)]
pub struct NestedBases {
    fundamental: f64,
    harmonics: usize,
    centre: f64,
    rows: usize,
    /// Design matrix X, or its two halves, column by column.
    columns: Vec<Vec<f64>>,
    parts: Vec<OrthogonalPart>,
}

/// Group of columns of X that is orthogonal to the other groups.
#[derive(Debug, Clone)]
struct OrthogonalPart {
    /// Column numbers, in increasing order.
    places: Vec<usize>,
    qr: QR<f64, Dyn, Dyn>,
}

/// Basis of a series with a fixed number of harmonics.
#[derive(Debug, Clone)]
pub struct Basis {
    harmonics: usize,
    series: NestedBases,
    /// Singular value decompositions of the triangles of the parts.
    svd: Vec<SVD<f64, Dyn, Dyn>>,
}

/// Projection of a signal on a [`Basis`]: coefficients in centred time and the residual.
#[derive(Debug, Clone)]
pub struct Projection {
    /// Coefficients in the order 1, cos 1, sin 1, cos 2, …, for time from the middle of the instants.
    pub coefficients: DVector<f64>,
    /// Signal minus its projection, one value per instant.
    pub residual: Vec<f64>,
    /// Share of the variance explained by the projection; 1 for a constant signal.
    pub r_squared: f64,
}

impl OrthogonalPart {
    fn new(places: Vec<usize>, columns: &[Vec<f64>]) -> Self {
        let values: Vec<f64> = places.iter().flat_map(|&place| &columns[place]).copied().collect();
        let qr = DMatrix::from_vec(columns[0].len(), places.len(), values).qr();
        Self { places, qr }
    }

    /// Columns of this part in a series of `harmonics` harmonics: those with a number up to 2 `harmonics`.
    fn places(&self, harmonics: usize) -> &[usize] {
        &self.places[..self.places.partition_point(|&place| place <= 2 * harmonics)]
    }

    /// Qᵀy of the part y of a signal; the squares of its rows from m on add up to the RSS of m columns.
    fn rotated(&self, mut signal: DVector<f64>) -> DVector<f64> {
        self.qr.q_tr_mul(&mut signal);
        signal
    }
}

impl NestedBases {
    /// Bases with up to `harmonics` harmonics of `fundamental` (rad/s, positive) on `time` (s, increasing).
    ///
    /// Fails with [`IdentifyError::TooFewPoints`] if there are not more instants than columns of the widest basis.
    pub fn new(time: &[f64], fundamental: f64, harmonics: usize) -> Result<Self, IdentifyError> {
        let (rows, width) = (time.len(), 2 * harmonics + 1);
        if rows <= width {
            let (needed, count) = (width + 1, rows);
            return Err(IdentifyError::TooFewPoints { kind: "headings for the Fourier series", needed, count });
        }
        let centre = 0.5 * (time[0] + time[rows - 1]);
        // Without harmonics there are no sine columns.
        let folded = harmonics > 0 && has_even_steps(time);
        let instants = &time[if folded { rows / 2 } else { 0 }..];
        let first: Vec<(f64, f64)> = instants.iter().map(|t| (fundamental * (t - centre)).sin_cos()).collect();
        let (mut c, mut s) = (vec![if folded { SQRT_2 } else { 1.0 }; instants.len()], vec![0.0; instants.len()]);
        if folded && rows % 2 == 1 {
            // The middle row is its own mirror image.
            c[0] = 1.0;
        }
        let mut columns = Vec::with_capacity(width);
        columns.push(c.clone());
        for _ in 1..=harmonics {
            for ((c, s), (s1, c1)) in c.iter_mut().zip(&mut s).zip(&first) {
                (*s, *c) = (*s * c1 + *c * s1, *c * c1 - *s * s1);
            }
            columns.push(c.clone());
            columns.push(s.clone());
        }
        let places = |includes: fn(usize) -> bool| (0..width).filter(|&place| includes(place)).collect::<Vec<_>>();
        let parts = if folded {
            let [even, odd] =
                [places(|place| place == 0 || place % 2 == 1), places(|place| place > 0 && place % 2 == 0)];
            [even, odd].into_iter().map(|places| OrthogonalPart::new(places, &columns)).collect()
        } else {
            vec![OrthogonalPart::new(places(|_| true), &columns)]
        };
        Ok(Self { fundamental, harmonics, centre, rows, columns, parts })
    }

    /// Residual sums of squares of the series with 0, 1, .. N harmonics.
    pub fn rss(&self, values: &[f64]) -> Vec<f64> {
        let mut rss = vec![0.0; self.harmonics + 1];
        for (part, signal) in self.parts.iter().zip(self.split(values)) {
            let rotated = part.rotated(signal);
            for (harmonics, rss) in rss.iter_mut().enumerate() {
                *rss += rotated.rows_range(part.places(harmonics).len()..).norm_squared();
            }
        }
        rss
    }

    /// Basis with the first `harmonics` harmonics: at most N, and at least 1 unless N is 0.
    pub fn basis(self, harmonics: usize) -> Basis {
        let triangle = |part: &OrthogonalPart| {
            let width = part.places(harmonics).len();
            part.qr.r().view((0, 0), (width, width)).into_owned().svd(true, true)
        };
        Basis { svd: self.parts.iter().map(triangle).collect(), harmonics, series: self }
    }

    /// Even and odd halves of a signal given at the instants, or the signal itself without folding.
    fn split(&self, values: &[f64]) -> Vec<DVector<f64>> {
        if self.parts.len() == 1 {
            return vec![DVector::from_column_slice(values)];
        }
        let half = self.columns[0].len();
        let (mut even, mut odd) = (DVector::zeros(half), DVector::zeros(half));
        for k in 0..half {
            let (here, there) = (values[self.rows - half + k], values[half - 1 - k]);
            (even[k], odd[k]) = if self.is_middle(k) {
                (here, 0.0)
            } else {
                (FRAC_1_SQRT_2 * (here + there), FRAC_1_SQRT_2 * (here - there))
            };
        }
        vec![even, odd]
    }

    /// Signal at the instants from its even and odd halves: the inverse of [`Self::split`].
    fn join(&self, parts: &[DVector<f64>]) -> Vec<f64> {
        let [even, odd] = parts else { return parts[0].as_slice().to_vec() };
        let half = even.len();
        let mut values = vec![0.0; self.rows];
        for k in 0..half {
            let there = FRAC_1_SQRT_2 * (even[k] - odd[k]);
            values[half - 1 - k] = there;
            values[self.rows - half + k] = if self.is_middle(k) { even[k] } else { FRAC_1_SQRT_2 * (even[k] + odd[k]) };
        }
        values
    }

    fn is_middle(&self, k: usize) -> bool {
        k == 0 && self.rows % 2 == 1
    }
}

impl Basis {
    /// Basis of `harmonics` harmonics of `fundamental` (rad/s, positive) on `time` (s, increasing).
    ///
    /// Fails with [`IdentifyError::TooFewPoints`] if there are not more instants than columns.
    pub fn new(time: &[f64], fundamental: f64, harmonics: usize) -> Result<Self, IdentifyError> {
        Ok(NestedBases::new(time, fundamental, harmonics)?.basis(harmonics))
    }

    /// Number of harmonics N.
    pub fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// Condition number of X, columns unscaled (√2 for whole periods); infinite if X is rank-deficient.
    pub fn condition(&self) -> f64 {
        let largest = self.largest_singular_value();
        let smallest = self.svd.iter().map(|svd| svd.singular_values.min()).fold(f64::INFINITY, f64::min);
        if smallest > 0.0 { largest / smallest } else { f64::INFINITY }
    }

    fn largest_singular_value(&self) -> f64 {
        self.svd.iter().map(|svd| svd.singular_values.max()).fold(0.0, f64::max)
    }

    /// Parts of the series, with the indices of their columns in this basis and the decomposition of their triangle.
    fn parts(&self) -> impl Iterator<Item = (&OrthogonalPart, &[usize], &SVD<f64, Dyn, Dyn>)> {
        self.series.parts.iter().zip(&self.svd).map(|(part, svd)| (part, part.places(self.harmonics), svd))
    }

    /// Least-squares projection of a signal given at the instants of the basis.
    ///
    /// Directions with a singular value below 1e-14 of the largest are left out, so that a basis that is singular to
    /// rounding gives its minimum-norm solution.
    pub fn project(&self, values: &[f64]) -> Projection {
        let floor = 1e-14 * self.largest_singular_value();
        let mut coefficients = DVector::zeros(2 * self.harmonics + 1);
        let mut residual = self.series.split(values);
        for ((part, places, svd), signal) in self.parts().zip(&mut residual) {
            let head = part.rotated(signal.clone()).rows(0, places.len()).into_owned();
            let solution = svd.solve(&head, floor).expect("both sides of the decomposition were asked for");
            for (&place, &coefficient) in places.iter().zip(&solution) {
                coefficients[place] = coefficient;
                add(signal.as_mut_slice(), -coefficient, &self.series.columns[place]);
            }
        }
        let residual = self.series.join(&residual);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let total: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        let left: f64 = residual.iter().map(|e| e * e).sum();
        let r_squared = if total > 0.0 { 1.0 - left / total } else { 1.0 };
        Projection { coefficients, residual, r_squared }
    }

    /// (XᵀX)⁻¹ in the order of [`Projection::coefficients`]; times a white noise variance it is their covariance.
    pub fn unscaled_covariance(&self) -> DMatrix<f64> {
        let width = 2 * self.harmonics + 1;
        let mut covariance = DMatrix::zeros(width, width);
        for (_, places, svd) in self.parts() {
            let v_t = svd.v_t.as_ref().expect("both sides of the decomposition were asked for");
            let mut scaled = v_t.clone();
            for (mut row, s) in scaled.row_iter_mut().zip(&svd.singular_values) {
                row /= *s;
            }
            let part = scaled.tr_mul(&scaled);
            for (i, &row) in places.iter().enumerate() {
                for (j, &column) in places.iter().enumerate() {
                    covariance[(row, column)] = part[(i, j)];
                }
            }
        }
        covariance
    }

    /// Values Xθ at the instants of a series with `coefficients` θ.
    pub fn values(&self, coefficients: &DVector<f64>) -> Vec<f64> {
        let sum = |places: &[usize]| {
            let mut values = DVector::zeros(self.series.columns[0].len());
            places.iter().for_each(|&p| add(values.as_mut_slice(), coefficients[p], &self.series.columns[p]));
            values
        };
        self.series.join(&self.parts().map(|(_, places, _)| sum(places)).collect::<Vec<_>>())
    }

    /// Moments Xᵀy: the sums of the products of `values` y, one per instant, with every function of the basis.
    pub fn moments(&self, values: &[f64]) -> DVector<f64> {
        let mut moments = DVector::zeros(2 * self.harmonics + 1);
        for ((_, places, _), signal) in self.parts().zip(self.series.split(values)) {
            places.iter().for_each(|&place| moments[place] = dot(&self.series.columns[place], signal.as_slice()));
        }
        moments
    }

    /// Coefficients D θ of the derivative of a series, n w (bₙ cos n w t − aₙ sin n w t).
    pub fn derivative(&self, coefficients: &DVector<f64>) -> DVector<f64> {
        let mut derivative = DVector::zeros(coefficients.len());
        for n in 1..=self.harmonics {
            let rate = n as f64 * self.series.fundamental;
            derivative[2 * n - 1] = rate * coefficients[2 * n];
            derivative[2 * n] = -rate * coefficients[2 * n - 1];
        }
        derivative
    }

    /// Moments (X D)ᵀy with the derivatives of the functions, from the [`moments`](Self::moments) Xᵀy: Dᵀ = −D, because
    /// the derivative of a cosine is its sine and the reverse, with opposite signs.
    pub fn derivative_moments(&self, moments: &DVector<f64>) -> DVector<f64> {
        -self.derivative(moments)
    }

    /// Curve of a projection, with coefficients in the time of the record.
    pub fn fourier_series(&self, projection: &Projection) -> FourierSeries {
        let (n, fundamental) = (self.harmonics, self.series.fundamental);
        let theta = &projection.coefficients;
        let (mut cosine, mut sine) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for harmonic in 1..=n {
            let (s, c) = (harmonic as f64 * fundamental * self.series.centre).sin_cos();
            let (a, b) = (theta[2 * harmonic - 1], theta[2 * harmonic]);
            cosine.push(a * c - b * s);
            sine.push(a * s + b * c);
        }
        FourierSeries {
            fundamental,
            mean: theta[0],
            cosine,
            sine,
            r_squared: projection.r_squared,
            condition: self.condition(),
        }
    }
}

/// `values` + `factor` `column`, in place.
fn add(values: &mut [f64], factor: f64, column: &[f64]) {
    values.iter_mut().zip(column).for_each(|(value, x)| *value += factor * x);
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
        let curve = basis.fourier_series(&basis.project(&values));
        assert_relative_eq!(curve.mean, 3.0, max_relative = 1e-10);
        assert_relative_eq!(curve.cosine[0], 2.0, max_relative = 1e-10);
        assert_relative_eq!(curve.sine[1], -1.5, max_relative = 1e-10);
        assert_abs_diff_eq!(curve.sine[2], 0.0, epsilon = 1e-10);
        for t in [0.0, 17.0, 200.0] {
            assert_relative_eq!(curve.heading_at(t), signal(t), max_relative = 1e-10);
            let rate = -0.1 * (0.05 * t).sin() - 0.15 * (0.1 * t).cos();
            assert_abs_diff_eq!(curve.yaw_rate_at(t), rate, epsilon = 1e-11);
            let acceleration = -0.005 * (0.05 * t).cos() + 0.015 * (0.1 * t).sin();
            assert_abs_diff_eq!(curve.yaw_acceleration_at(t), acceleration, epsilon = 1e-12);
        }
    }

    #[test]
    fn nested_residuals_are_those_of_the_shorter_series() {
        let time: Vec<f64> = (0..120).map(f64::from).collect();
        let values: Vec<f64> = time.iter().map(|t| (0.002 * t * t).sin()).collect();
        let nested = NestedBases::new(&time, 0.045, 6).expect("enough instants").rss(&values);
        assert_eq!(nested.len(), 7);
        for (harmonics, rss) in nested.into_iter().enumerate() {
            let alone = Basis::new(&time, 0.045, harmonics).expect("enough instants").project(&values);
            assert_relative_eq!(rss, alone.residual.iter().map(|e| e * e).sum(), max_relative = 1e-9);
        }
    }

    /// Residuals are orthogonal to every function of the basis, and derivatives agree with the curve.
    #[test]
    fn residuals_are_orthogonal_and_derivatives_agree_with_the_curve() {
        let even = |rows: i32| (0..rows).map(|i| 1.5 * f64::from(i)).collect::<Vec<f64>>();
        let uneven = (0..157).map(|i| 1.5 * i as f64 + (i as f64).sin()).collect();
        for time in [even(156), even(157), uneven] {
            let values: Vec<f64> = time.iter().map(|t| (0.0004 * t * t).sin()).collect();
            let basis = NestedBases::new(&time, 0.03, 7).expect("enough instants").basis(5);
            let projection = basis.project(&values);
            let left = basis.moments(&projection.residual);
            assert_abs_diff_eq!(left.norm(), 0.0, epsilon = 1e-11);
            let curve = basis.fourier_series(&projection);
            let rate = basis.derivative(&projection.coefficients);
            let (fitted, rates) = (basis.values(&projection.coefficients), basis.values(&rate));
            let accelerations = basis.values(&basis.derivative(&rate));
            for (i, t) in time.iter().enumerate() {
                assert_abs_diff_eq!(fitted[i] + projection.residual[i], values[i], epsilon = 1e-13);
                assert_abs_diff_eq!(fitted[i], curve.heading_at(*t), epsilon = 1e-12);
                assert_abs_diff_eq!(rates[i], curve.yaw_rate_at(*t), epsilon = 1e-12);
                assert_abs_diff_eq!(accelerations[i], curve.yaw_acceleration_at(*t), epsilon = 1e-13);
            }
            let by_coefficients = basis.derivative_moments(&basis.moments(&values));
            let sum: f64 = rates.iter().zip(&values).map(|(r, y)| r * y).sum();
            assert_relative_eq!(by_coefficients.dot(&projection.coefficients), sum, max_relative = 1e-11);
            let covariance = basis.unscaled_covariance();
            let back = basis.moments(&basis.values(&(&covariance * &left.map(|_| 1.0))));
            assert_abs_diff_eq!((back - left.map(|_| 1.0)).norm(), 0.0, epsilon = 1e-11);
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
            IdentifyError::TooFewPoints { kind: "headings for the Fourier series", needed: 18, count: 17 }
        );
    }
}
