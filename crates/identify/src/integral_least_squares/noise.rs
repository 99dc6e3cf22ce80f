//! White heading noise in the doubly integrated equation, e = n + a ∫n, and its effect on the estimate.

use estimation::column::{dot, gram};
use nalgebra::Matrix3;

use super::equations::{IntegratedStretch, SHARED_PARAMETERS, Solution};

/// Heading noise estimated from the residual, and its propagation to the parameters.
#[derive(Debug)]
pub(super) struct ResidualNoise {
    /// Variance of the heading noise, rad²; `None` without degrees of freedom.
    pub variance: Option<f64>,
    /// Number of equations minus number of unknowns.
    pub degrees_of_freedom: f64,
    /// Ratio of equations to degrees of freedom: the correction for the noise absorbed by the fit.
    pub small_sample_factor: f64,
    /// Lag-1 autocorrelation of the heading noise.
    pub lag1_correlation: f64,
    /// Σ z zᵀ, with z the derivative of Xᵀe with respect to the noise of one heading; times the variance it is the
    /// covariance of Xᵀe.
    pub influence: Matrix3<f64>,
    /// Scores z n of every piece, for a covariance that does not assume white n.
    pub scores: Vec<[Vec<f64>; SHARED_PARAMETERS]>,
}

impl ResidualNoise {
    /// Noise from projected pieces and their solution.
    pub fn from_stretches(pieces: &[IntegratedStretch], solution: &Solution) -> Self {
        let count: usize = pieces.iter().map(|piece| piece.time.len()).sum();
        let degrees_of_freedom = count as f64 - (SHARED_PARAMETERS + 2 * pieces.len()) as f64;
        let (mut squares, mut products) = (0.0, 0.0);
        let mut influence = Matrix3::zeros();
        let mut scores = Vec::with_capacity(pieces.len());
        for piece in pieces {
            let noise = heading_noise(piece, solution);
            squares += dot(&noise, &noise);
            products += dot(&noise[1..], &noise);
            let mut columns = influences(piece, solution);
            let [z0, z1, z2] = &columns;
            influence += Matrix3::from(gram([z0, z1, z2]));
            columns.iter_mut().for_each(|z| z.iter_mut().zip(&noise).for_each(|(z, n)| *z *= n));
            scores.push(columns);
        }
        let variance = (degrees_of_freedom > 0.0).then(|| squares / degrees_of_freedom);
        let finite_sample = count as f64 / degrees_of_freedom;
        let lag1 = if squares > 0.0 { products / squares } else { 0.0 };
        Self {
            variance,
            degrees_of_freedom,
            small_sample_factor: finite_sample,
            lag1_correlation: lag1,
            influence,
            scores,
        }
    }
}

/// Solves e = n + a ∫n (trapezoid) for n, in the direction of time in which errors decay.
fn heading_noise(piece: &IntegratedStretch, solution: &Solution) -> Vec<f64> {
    let [a, b, beta] = solution.parameters.into();
    let [x0, x1, x2, y] = &piece.columns;
    let columns = y.iter().zip(x0.iter().zip(x1.iter().zip(x2)));
    let mut noise: Vec<f64> = columns.map(|(y, (x0, (x1, x2)))| y - a * x0 - b * x1 - beta * x2).collect();
    let last = noise.len() - 1;
    let half = |k: usize| 0.5 * a * (piece.time[k] - piece.time[k - 1]);
    // Behind the sweep `noise` holds n, ahead of it e.
    if a >= 0.0 {
        let (mut before, mut error) = (noise[0], noise[0]);
        for (k, noise) in noise.iter_mut().enumerate().skip(1) {
            let (half, change) = (half(k), *noise - error);
            let share = 1.0 / (1.0 + half);
            error = *noise;
            before = before * ((1.0 - half) * share) + change * share;
            *noise = before;
        }
    } else {
        let (mut after, mut error) = (noise[last], noise[last]);
        for k in (1..=last).rev() {
            let (half, change) = (half(k), error - noise[k - 1]);
            let share = 1.0 / (1.0 - half);
            error = noise[k - 1];
            after = after * ((1.0 + half) * share) - change * share;
            noise[k - 1] = after;
        }
    }
    noise
}

/// Derivatives z of Xᵀe with respect to the noise of each heading, one column per shared parameter, for e = n + a ∫n by
/// the trapezoidal rule.
///
/// A heading enters the equation of its row with weight 1 + a h/2 and every later equation with a (h + h')/2, with h
/// and h' the intervals before and after it; hence one backward pass with the sum of the later columns.
fn influences(piece: &IntegratedStretch, solution: &Solution) -> [Vec<f64>; SHARED_PARAMETERS] {
    let half_a = 0.5 * solution.parameters[0];
    let [x0, x1, x2, _] = &piece.columns;
    let rows = piece.time.len();
    let mut columns = [(); SHARED_PARAMETERS].map(|()| vec![0.0; rows]);
    let [z0, z1, z2] = &mut columns;
    let (mut later0, mut later1, mut later2) = (0.0, 0.0, 0.0);
    let mut after = 0.0;
    for k in (0..rows).rev() {
        let before = if k > 0 { piece.time[k] - piece.time[k - 1] } else { 0.0 };
        let (current, later) = (1.0 + half_a * before, half_a * (before + after));
        z0[k] = x0[k] * current + later0 * later;
        z1[k] = x1[k] * current + later1 * later;
        z2[k] = x2[k] * current + later2 * later;
        (later0, later1, later2) = (later0 + x0[k], later1 + x1[k], later2 + x2[k]);
        after = before;
    }
    columns
}
