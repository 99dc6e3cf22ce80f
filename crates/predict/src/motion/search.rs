//! Least squares by damped Gauss–Newton steps between bounds (Levenberg 1944; Marquardt 1963).

use nalgebra::{DMatrix, DVector};

/// Sum of squares about a point: normal matrix JᵀJ, gradient Jᵀr and rᵀr.
pub(crate) struct Local {
    pub normal: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub square: f64,
}

/// What is minimised.
pub(crate) trait Squares {
    /// Sum of squares; not finite where the model has no answer.
    fn square(&self, at: &DVector<f64>) -> f64;

    /// The same with its derivatives.
    fn local(&self, at: &DVector<f64>) -> Local;

    /// Least and largest value of an unknown.
    fn bounds(&self, unknown: usize) -> [f64; 2];
}

/// Iterations after which a search is given up.
pub(crate) const MOST_ITERATIONS: usize = 100;

/// Relative decrease of the sum of squares that is too little to go on for.
const ENOUGH: f64 = 1e-7;

/// Steps in a row of so little use that end a search.
const IN_A_ROW: usize = 2;

/// Decrease that a search without a better step may still have promised; the equations have kinks.
const STALLED: f64 = 1e-4;

/// Unknowns that are not held at a bound by a gradient that points beyond it.
pub(crate) fn free(problem: &impl Squares, at: &DVector<f64>, gradient: &DVector<f64>) -> Vec<usize> {
    let held = |i: usize| {
        let [least, most] = problem.bounds(i);
        (at[i] <= least && gradient[i] > 0.0) || (at[i] >= most && gradient[i] < 0.0)
    };
    (0..at.len()).filter(|&i| !held(i)).collect()
}

/// Rows and columns of a matrix.
pub(crate) fn part(matrix: &DMatrix<f64>, of: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(of.len(), of.len(), |i, j| matrix[(of[i], of[j])])
}

/// The place of the least sum of squares near a point, or the iterations after which the search was given up.
pub(crate) fn minimise(problem: &impl Squares, from: DVector<f64>) -> Result<DVector<f64>, usize> {
    let mut at = from;
    let (mut damping, mut slow) = (1e-3, 0);
    for iteration in 0..MOST_ITERATIONS {
        let Local { normal, gradient, square } = problem.local(&at);
        if !square.is_finite() {
            return Err(iteration);
        }
        let free = free(problem, &at, &gradient);
        let (own, slope) = (part(&normal, &free), DVector::from_fn(free.len(), |i, _| gradient[free[i]]));
        loop {
            let mut damped = own.clone();
            for i in 0..free.len() {
                // An unknown that nothing depends on stays where it is.
                damped[(i, i)] += if own[(i, i)] > 0.0 { damping * own[(i, i)] } else { 1.0 };
            }
            let Some(step) = damped.cholesky().map(|factor| -factor.solve(&slope)) else {
                damping *= 10.0;
                if damping > 1e12 {
                    return Err(iteration);
                }
                continue;
            };
            let mut next = at.clone();
            for (&i, step) in free.iter().zip(step.iter()) {
                let [least, most] = problem.bounds(i);
                next[i] = (at[i] + step).clamp(least, most);
            }
            let found = problem.square(&next);
            if found <= square {
                at = next;
                slow = if square - found <= ENOUGH * square { slow + 1 } else { 0 };
                if slow == IN_A_ROW {
                    return Ok(at);
                }
                damping = (damping * 0.2).max(1e-9);
                break;
            }
            damping *= 4.0;
            if damping > 1e12 {
                // No better point however short the step: at the bottom, or at a kink near it.
                let whole = (0..free.len()).filter(|&i| own[(i, i)] > 0.0).map(|i| slope[i].powi(2) / own[(i, i)]);
                return if whole.fold(0.0, f64::max) <= STALLED * square { Ok(at) } else { Err(iteration) };
            }
        }
    }
    Err(MOST_ITERATIONS)
}
