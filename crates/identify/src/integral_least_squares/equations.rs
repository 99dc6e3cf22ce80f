//! Equations of stretches of a record, with their initial states projected out, and their solution.

use std::ops::Range;

use estimation::column::{dot, gram, subtract_projection, sum};
use nalgebra::{Matrix3, Matrix4, SymmetricEigen, Vector3};

use crate::error::IdentifyError;
use crate::samples::Samples;

/// Number of shared parameters a, b, b δ_r.
pub(super) const SHARED_PARAMETERS: usize = 3;

/// Number of columns: one per shared parameter, and the heading.
const WIDTH: usize = SHARED_PARAMETERS + 1;

/// Stretch without a gap: times and columns of its equations.
#[derive(Debug)]
pub(super) struct IntegratedStretch<'a> {
    pub(super) time: &'a [f64],
    /// Columns of a, b, b δ_r (rad s, rad s², s²) and the heading (rad).
    pub(super) columns: [Vec<f64>; WIDTH],
}

impl<'a> IntegratedStretch<'a> {
    /// Equations of a stretch. Time and heading have their origins within it: terms linear in time belong to the
    /// initial state, so the origins affect only rounding.
    pub(super) fn new(samples: &'a Samples, range: Range<usize>) -> Self {
        let (time, heading) = (&samples.time[range.clone()], &samples.heading[range.clone()]);
        let once = samples.rudder_integral[range.start];
        let twice = &samples.rudder_double_integral[range];
        let (start, middle) = (time[0], 0.5 * (time[0] + time[time.len() - 1]));
        let half_square = |t: &f64| 0.5 * (t - middle) * (t - middle);
        let columns = [
            // The heading is integrated minus its first value.
            minus_integral(time, heading),
            time.iter().zip(twice).map(|(t, integral)| integral - twice[0] - once * (t - start)).collect(),
            time.iter().map(half_square).collect(),
            heading.iter().map(|psi| psi - heading[0]).collect(),
        ];
        Self { time, columns }
    }

    /// Projects c₀ and c₁ out of all columns; adds the squared lengths of the columns before the projection to
    /// `lengths` and their cross products after it to `products`.
    pub(super) fn project(&mut self, lengths: &mut Vector3<f64>, products: &mut Matrix4<f64>) {
        let count = self.time.len() as f64;
        let middle = sum(self.time) / count;
        let mut unit: Vec<f64> = self.time.iter().map(|t| t - middle).collect();
        let length = dot(&unit, &unit).sqrt();
        let scale = 1.0 / length;
        unit.iter_mut().for_each(|s| *s *= scale);
        let removed = self.columns.each_mut().map(|column| subtract_projection(&unit, column));
        let [x0, x1, x2, y] = &self.columns;
        let sums = Matrix4::from(gram([x0, x1, x2, y]));
        for i in 0..SHARED_PARAMETERS {
            lengths[i] += sums[(i, i)] + count * removed[i].mean.powi(2) + removed[i].component.powi(2);
        }
        *products += sums;
    }
}

/// −∫(value − value₀) at every row by cubic Hermite interpolation; the slope at a row is that of the chord between its
/// neighbours.
///
/// The trapezoid rule would make T too small by the share (h/T)²/12; with equal steps this is the rule of weights
/// (−1, 13, 13, −1)/24. On unequal steps a parabola through three rows would give a smoother slope, but it depends
/// mainly on the shorter interval: if two rows nearly coincide, the noise of their slope would be integrated over the
/// long interval. `time` and `value` have the same length, at least 3.
pub(super) fn minus_integral(time: &[f64], value: &[f64]) -> Vec<f64> {
    let last = time.len() - 1;
    let chord = |from: usize, to: usize| (value[to] - value[from]) / (time[to] - time[from]);
    // At the ends a parabola is used: its chord is the mean of the end slopes.
    let beyond = |chord: f64, slope: f64| 2.0 * chord - slope;
    let mut slope = beyond(chord(0, 1), chord(0, 2));
    let mut total = 0.0;
    let mut integral = vec![0.0; time.len()];
    let mut add = |times: &[f64], values: &[f64], next: f64, slope: f64, integral: &mut f64| {
        let h = times[1] - times[0];
        total -= h * (0.5 * (values[0] + values[1]) - value[0] + h / 12.0 * (slope - next));
        *integral = total;
    };
    for ((t, values), integral) in time.windows(3).zip(value.windows(3)).zip(&mut integral[1..last]) {
        let next = (values[2] - values[0]) / (t[2] - t[0]);
        add(t, values, next, slope, integral);
        slope = next;
    }
    let next = beyond(chord(last - 1, last), slope);
    add(&time[last - 1..], &value[last - 1..], next, slope, &mut integral[last]);
    integral
}

/// Least-squares solution, with the inverse of the normal matrix and the condition number.
#[derive(Debug)]
pub(super) struct Solution {
    /// a, b, b δ_r.
    pub(super) parameters: Vector3<f64>,
    /// (XᵀX)⁻¹ of the projected columns.
    pub(super) inverse: Matrix3<f64>,
    /// Condition number, as in [`IntegralLeastSquares`](super::IntegralLeastSquares).
    pub(super) condition: f64,
}

impl Solution {
    /// Solution of the equations; the columns of the pieces stay projected. Fails with [`IdentifyError::Singular`]
    /// above `max_condition`.
    pub(super) fn from_stretches(pieces: &mut [IntegratedStretch], max_condition: f64) -> Result<Self, IdentifyError> {
        let (mut lengths, mut products) = (Vector3::zeros(), Matrix4::zeros());
        for piece in pieces {
            piece.project(&mut lengths, &mut products);
        }
        let scale = lengths.map(|squares: f64| 1.0 / squares.sqrt());
        let scaled = Matrix3::from_fn(|i, j| products[(i, j)] * scale[i] * scale[j]);
        let smallest: f64 = SymmetricEigen::new(scaled).eigenvalues.min();
        let condition = if smallest > 0.0 { 1.0 / smallest.sqrt() } else { f64::INFINITY };
        let singular = || IdentifyError::Singular { condition, limit: max_condition };
        if condition.is_nan() || condition > max_condition {
            return Err(singular());
        }
        let scaled_inverse = scaled.cholesky().ok_or_else(singular)?.inverse();
        let inverse = Matrix3::from_fn(|i, j| scaled_inverse[(i, j)] * scale[i] * scale[j]);
        Ok(Self {
            parameters: inverse * products.fixed_view::<SHARED_PARAMETERS, 1>(0, SHARED_PARAMETERS),
            inverse,
            condition,
        })
    }
}
