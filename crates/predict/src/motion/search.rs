//! Least squares by damped Gauss–Newton steps between bounds (Levenberg 1944; Marquardt 1963), and the covariance of what
//! is found.

use nalgebra::{DMatrix, DVector, Dyn, SymmetricEigen};

use super::error::MotionError;
use estimation::covariance::newey_west;

/// One column of residuals, zero where nothing was read.
pub(crate) type ResidualColumn = Vec<f64>;

/// Sum of squares about a point: normal matrix JᵀJ, gradient Jᵀr and rᵀr.
pub(crate) struct NormalEquations {
    pub normal: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub square: f64,
}

/// What is minimised: residuals in groups, each of some of the unknowns.
pub(crate) trait Squares {
    /// Residuals of one row that follow one another in a column.
    const WIDTH: usize;

    /// Number of unknowns.
    fn unknowns(&self) -> usize;

    /// Number of groups: records, or windows of records.
    fn groups(&self) -> usize;

    /// Residuals of a group over their deviations, column by column; not finite where the model has no answer.
    fn residuals(&self, group: usize, at: &[f64]) -> Vec<ResidualColumn>;

    /// Residuals of a group and their derivatives by its unknowns.
    fn derivatives(&self, group: usize, at: &[f64]) -> (Vec<ResidualColumn>, Vec<Vec<ResidualColumn>>);

    /// The unknown of the whole problem behind one of a group.
    fn global(&self, group: usize, unknown: usize) -> usize;

    /// Least and largest value of an unknown.
    fn bounds(&self, unknown: usize) -> [f64; 2];

    /// Sum of squares.
    fn square(&self, at: &DVector<f64>) -> f64 {
        let of = |group| -> f64 { self.residuals(group, at.as_slice()).iter().flatten().map(|x| x * x).sum() };
        (0..self.groups()).map(of).sum()
    }

    /// The same with its derivatives.
    fn local(&self, at: &DVector<f64>) -> NormalEquations {
        let mut normal = DMatrix::zeros(self.unknowns(), self.unknowns());
        let mut gradient = DVector::zeros(self.unknowns());
        let mut square = 0.0;
        let dot = |x: &[ResidualColumn], y: &[ResidualColumn]| -> f64 {
            x.iter().zip(y).map(|(x, y)| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>()).sum()
        };
        for group in 0..self.groups() {
            let (residuals, slopes) = self.derivatives(group, at.as_slice());
            square += dot(&residuals, &residuals);
            for (i, slope) in slopes.iter().enumerate() {
                let row = self.global(group, i);
                gradient[row] += dot(slope, &residuals);
                for (j, other) in slopes[..=i].iter().enumerate() {
                    let (column, product) = (self.global(group, j), dot(slope, other));
                    normal[(row, column)] += product;
                    if row != column {
                        normal[(column, row)] += product;
                    }
                }
            }
        }
        NormalEquations { normal, gradient, square }
    }

    /// Sum of the long-run covariances of the scores of all groups, of the unknowns that are wanted.
    fn long_run(&self, at: &DVector<f64>, is_wanted: impl Fn(usize) -> bool) -> DMatrix<f64> {
        let mut middle = DMatrix::zeros(self.unknowns(), self.unknowns());
        for group in 0..self.groups() {
            let (residuals, slopes) = self.derivatives(group, at.as_slice());
            let rows = residuals[0].len() / Self::WIDTH;
            let score = |slope: &Vec<ResidualColumn>| -> Vec<f64> {
                let of_row = |row: usize| -> f64 {
                    let own = row * Self::WIDTH..(row + 1) * Self::WIDTH;
                    let product =
                        |(r, s): (&ResidualColumn, &ResidualColumn)| -> f64 { own.clone().map(|k| r[k] * s[k]).sum() };
                    residuals.iter().zip(slope).map(product).sum()
                };
                (0..rows).map(of_row).collect()
            };
            let places: Vec<usize> =
                (0..slopes.len()).map(|i| self.global(group, i)).filter(|place| is_wanted(*place)).collect();
            let own = (0..slopes.len()).filter(|&i| is_wanted(self.global(group, i)));
            let long_run = newey_west(&[own.map(|i| score(&slopes[i])).collect::<Vec<_>>()]);
            for (i, &row) in places.iter().enumerate() {
                for (j, &column) in places.iter().enumerate() {
                    middle[(row, column)] += long_run[(i, j)];
                }
            }
        }
        middle
    }
}

/// Least eigenvalue of a normal matrix with a diagonal of ones.
const OPEN: f64 = 1e-11;

/// The normal matrix of the free unknowns with a diagonal of ones: its scales and its eigenvalues.
///
/// Fails with [`MotionError::Undetermined`] and the symbol of the coefficient that weighs most in what is open.
pub(crate) fn determined(
    normal: &DMatrix<f64>,
    free: &[usize],
    symbol: impl Fn(usize) -> Option<&'static str>,
) -> Result<(Vec<f64>, SymmetricEigen<f64, Dyn>), MotionError> {
    let scale: Vec<f64> = free.iter().map(|&i| normal[(i, i)].sqrt()).collect();
    let unknown = |open: usize| MotionError::Undetermined { symbol: symbol(free[open]).unwrap_or("a record") };
    if let Some(open) = scale.iter().position(|scale| scale.is_nan() || *scale <= 0.0) {
        return Err(unknown(open));
    }
    let unit = DMatrix::from_fn(free.len(), free.len(), |i, j| normal[(free[i], free[j])] / (scale[i] * scale[j]));
    let eigen = unit.symmetric_eigen();
    let (least, value) = eigen.eigenvalues.argmin();
    if value.is_nan() || value < OPEN {
        let direction = eigen.eigenvectors.column(least);
        let weighs = (0..free.len())
            .filter(|&i| symbol(free[i]).is_some())
            .max_by(|&i, &j| direction[i].abs().total_cmp(&direction[j].abs()));
        return Err(unknown(weighs.unwrap_or(0)));
    }
    Ok((scale, eigen))
}

/// A⁻¹ S A⁻¹ of all unknowns from the inverse A⁻¹ of those that are free; zero of the others.
pub(crate) fn sandwich(inverse: &DMatrix<f64>, middle: &DMatrix<f64>, free: &[usize]) -> DMatrix<f64> {
    let own = inverse * part(middle, free) * inverse;
    let mut covariance = DMatrix::zeros(middle.nrows(), middle.ncols());
    for (i, &row) in free.iter().enumerate() {
        for (j, &column) in free.iter().enumerate() {
            covariance[(row, column)] = 0.5 * (own[(i, j)] + own[(j, i)]);
        }
    }
    covariance
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
        let NormalEquations { normal, gradient, square } = problem.local(&at);
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
