//! White heading noise as the doubly integrated equation sees it, e = n + a ∫n, and what it does to the estimate.

use nalgebra::{Matrix3, Vector3};

use super::{Piece, SHARED, Solution};

/// Heading noise found in the residual and its way into the parameters.
#[derive(Debug)]
pub(super) struct Noise {
    /// Variance of the heading noise, rad²; `None` without degrees of freedom.
    pub variance: Option<f64>,
    /// Equations less unknowns.
    pub degrees_of_freedom: f64,
    /// Equations over degrees of freedom: what the fit took from the noise it left.
    pub finite_sample: f64,
    /// Lag-1 autocorrelation of the heading noise.
    pub lag1: f64,
    /// Σ z zᵀ, where z is the derivative of Xᵀe with respect to the noise of one heading; times the variance it is
    /// the covariance of Xᵀe.
    pub influence: Matrix3<f64>,
    /// z n row by row of every piece, for a covariance that does not take n to be white.
    pub scores: Vec<Vec<[f64; SHARED]>>,
}

impl Noise {
    /// From projected pieces and their solution.
    pub fn of(pieces: &[Piece], solution: &Solution) -> Self {
        let count: usize = pieces.iter().map(|piece| piece.rows.len()).sum();
        let degrees_of_freedom = count as f64 - (SHARED + 2 * pieces.len()) as f64;
        let (mut squares, mut products) = (0.0, 0.0);
        let mut influence = Matrix3::zeros();
        let mut scores = Vec::with_capacity(pieces.len());
        let mut noise = Vec::with_capacity(count);
        for piece in pieces {
            noise.clear();
            heading_noise(piece, solution, &mut noise);
            squares += noise.iter().map(|n| n * n).sum::<f64>();
            products += noise.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>();
            scores.push(add_influence(piece, solution, &noise, &mut influence));
        }
        let variance = (degrees_of_freedom > 0.0).then(|| squares / degrees_of_freedom);
        let finite_sample = count as f64 / degrees_of_freedom;
        let lag1 = if squares > 0.0 { products / squares } else { 0.0 };
        Self { variance, degrees_of_freedom, finite_sample, lag1, influence, scores }
    }
}

/// Solves e = n + a ∫n (trapezoid) for n, in the direction of time in which errors die out.
fn heading_noise(piece: &Piece, solution: &Solution, noise: &mut Vec<f64>) {
    let [a, b, beta] = solution.parameters.into();
    noise.extend(piece.rows.iter().map(|&[x0, x1, x2, y]| y - a * x0 - b * x1 - beta * x2));
    let last = noise.len() - 1;
    let half = |k: usize| 0.5 * a * (piece.time[k] - piece.time[k - 1]);
    if a >= 0.0 {
        let mut error = noise[0];
        for k in 1..=last {
            let (half, change) = (half(k), noise[k] - error);
            error = noise[k];
            noise[k] = noise[k - 1] * ((1.0 - half) / (1.0 + half)) + change / (1.0 + half);
        }
    } else {
        let mut error = noise[last];
        for k in (1..=last).rev() {
            let (half, change) = (half(k), error - noise[k - 1]);
            error = noise[k - 1];
            noise[k - 1] = noise[k] * ((1.0 + half) / (1.0 - half)) - change / (1.0 - half);
        }
    }
}

/// Adds a stretch to Σ z zᵀ and returns its z n, last row first.
///
/// A heading enters its own equation with weight 1 + a h/2 and every later one with a (h + h')/2, where h and h' are
/// the intervals before and after it; hence one pass backwards with the sum of the later columns.
fn add_influence(
    piece: &Piece,
    solution: &Solution,
    noise: &[f64],
    influence: &mut Matrix3<f64>,
) -> Vec<[f64; SHARED]> {
    let half_a = 0.5 * solution.parameters[0];
    let mut later = Vector3::zeros();
    let mut after = 0.0;
    let mut scores = Vec::with_capacity(noise.len());
    for (k, &[x0, x1, x2, _]) in piece.rows.iter().enumerate().rev() {
        let before = if k > 0 { piece.time[k] - piece.time[k - 1] } else { 0.0 };
        let x = Vector3::new(x0, x1, x2);
        let z = x * (1.0 + half_a * before) + later * (half_a * (before + after));
        *influence += z * z.transpose();
        scores.push((z * noise[k]).into());
        later += x;
        after = before;
    }
    scores
}
