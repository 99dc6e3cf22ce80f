//! Least squares over groups of rows by damped Gauss–Newton steps between bounds (Levenberg 1944; Marquardt 1963), and
//! the covariance of what is found.

use nalgebra::{DMatrix, DVector};

use super::covariance::newey_west;
use super::error::MotionError;

/// Least eigenvalue of a normal matrix with a diagonal of ones.
const OPEN: f64 = 1e-11;

/// Iterations after which a search is given up.
const MOST_ITERATIONS: usize = 100;

/// Relative decrease of the sum of squares that is too little to go on for.
const ENOUGH: f64 = 1e-7;

/// Steps in a row of so little use that end a search.
const IN_A_ROW: usize = 2;

/// Decrease that a search without a better step may still have promised; the equations have kinks.
const STALLED: f64 = 1e-4;

/// Width of a difference, as a share of the value or its scale.
const STEP: f64 = 1e-6;

/// Residuals of a group, over their deviations, where the unknowns have some values: a row a time, a column an output,
/// zero where nothing was read, not finite where the model has no answer.
type Residuals<'a> = Box<dyn Fn(usize, &[f64]) -> DMatrix<f64> + 'a>;

/// A sum of squares over groups of rows, each of which depends on some of the unknowns.
pub(crate) struct GroupedSquares<'a> {
    /// Unknowns of every group.
    pub groups: Vec<Vec<usize>>,
    /// Least and largest value of every unknown.
    pub bounds: Vec<[f64; 2]>,
    /// A usual size of every unknown.
    pub scales: Vec<f64>,
    pub residuals: Residuals<'a>,
}

/// Rows and columns of a matrix.
fn part(matrix: &DMatrix<f64>, of: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(of.len(), of.len(), |i, j| matrix[(of[i], of[j])])
}

impl GroupedSquares<'_> {
    fn square(&self, at: &DVector<f64>) -> f64 {
        (0..self.groups.len()).map(|group| (self.residuals)(group, at.as_slice()).norm_squared()).sum()
    }

    /// Derivatives of the residuals of a group by its unknowns: central differences, one-sided at a bound.
    fn derivatives(&self, group: usize, at: &DVector<f64>) -> Vec<DMatrix<f64>> {
        let by = |&unknown: &usize| {
            let [least, most] = self.bounds[unknown];
            let step = STEP * at[unknown].abs().max(self.scales[unknown]);
            let ends = [-step, step].map(|step| (at[unknown] + step).clamp(least, most));
            let [below, above] = ends.map(|value| {
                let mut moved = at.clone();
                moved[unknown] = value;
                (self.residuals)(group, moved.as_slice())
            });
            (above - below) / (ends[1] - ends[0])
        };
        self.groups[group].iter().map(by).collect()
    }

    /// Normal matrix JᵀJ, gradient Jᵀr and rᵀr.
    fn normal(&self, at: &DVector<f64>) -> (DMatrix<f64>, DVector<f64>, f64) {
        let (mut normal, mut gradient) = (DMatrix::zeros(at.len(), at.len()), DVector::zeros(at.len()));
        let mut square = 0.0;
        for (group, unknowns) in self.groups.iter().enumerate() {
            let (residuals, slopes) = ((self.residuals)(group, at.as_slice()), self.derivatives(group, at));
            square += residuals.norm_squared();
            for (slope, &row) in slopes.iter().zip(unknowns) {
                gradient[row] += slope.dot(&residuals);
                for (other, &column) in slopes.iter().zip(unknowns) {
                    normal[(row, column)] += slope.dot(other);
                }
            }
        }
        (normal, gradient, square)
    }

    /// Unknowns that are not held at a bound by a gradient that points beyond it.
    fn not_held(&self, at: &DVector<f64>, gradient: &DVector<f64>) -> Vec<usize> {
        let held = |&i: &usize| {
            let [least, most] = self.bounds[i];
            (at[i] <= least && gradient[i] > 0.0) || (at[i] >= most && gradient[i] < 0.0)
        };
        (0..at.len()).filter(|i| !held(i)).collect()
    }

    /// The unknowns that are at no bound, and the inverse of their normal matrix.
    ///
    /// Fails with [`MotionError::Undetermined`] and the symbol of the coefficient that weighs most in what is open;
    /// `symbols` are those of the first unknowns.
    pub fn inverse(
        &self,
        at: &DVector<f64>,
        symbols: &[&'static str],
    ) -> Result<(Vec<usize>, DMatrix<f64>), MotionError> {
        let (normal, gradient, _) = self.normal(at);
        let free = self.not_held(at, &gradient);
        let open = |place: usize| MotionError::Undetermined {
            symbol: symbols.get(free[place]).copied().unwrap_or("a record"),
        };
        let scale: Vec<f64> = free.iter().map(|&i| normal[(i, i)].sqrt()).collect();
        if let Some(place) = scale.iter().position(|scale| scale.is_nan() || *scale <= 0.0) {
            return Err(open(place));
        }
        let scaled = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(free.len(), free.len(), |i, j| matrix[(i, j)] / (scale[i] * scale[j]))
        };
        let eigen = scaled(&part(&normal, &free)).symmetric_eigen();
        let (least, value) = eigen.eigenvalues.argmin();
        if value.is_nan() || value < OPEN {
            let direction = eigen.eigenvectors.column(least);
            let named = (0..free.len()).filter(|&i| free[i] < symbols.len());
            return Err(open(named.max_by(|&i, &j| direction[i].abs().total_cmp(&direction[j].abs())).unwrap_or(0)));
        }
        let vectors = &eigen.eigenvectors;
        let inverse =
            scaled(&(vectors * DMatrix::from_diagonal(&eigen.eigenvalues.map(f64::recip)) * vectors.transpose()));
        Ok((free, inverse))
    }

    /// A⁻¹ S A⁻¹ of all unknowns, zero of those at a bound, with A the normal matrix and S the long-run covariance of the
    /// scores, whose lags follow from all unknowns or only from those that are at no bound.
    ///
    /// Fails as [`inverse`](Self::inverse) does.
    pub fn covariance(
        &self,
        at: &DVector<f64>,
        symbols: &[&'static str],
        all_score: bool,
    ) -> Result<DMatrix<f64>, MotionError> {
        let (free, inverse) = self.inverse(at, symbols)?;
        let mut middle = DMatrix::zeros(at.len(), at.len());
        for (group, unknowns) in self.groups.iter().enumerate() {
            let residuals = (self.residuals)(group, at.as_slice());
            let slopes = unknowns.iter().zip(self.derivatives(group, at));
            let (places, scores): (Vec<usize>, Vec<Vec<f64>>) = slopes
                .filter(|(unknown, _)| all_score || free.contains(unknown))
                .map(|(&unknown, slope)| (unknown, slope.component_mul(&residuals).column_sum().as_slice().to_vec()))
                .unzip();
            let long_run = newey_west(&scores);
            for (i, &row) in places.iter().enumerate() {
                for (j, &column) in places.iter().enumerate() {
                    middle[(row, column)] += long_run[(i, j)];
                }
            }
        }
        let own = &inverse * part(&middle, &free) * &inverse;
        let mut covariance = DMatrix::zeros(at.len(), at.len());
        for (i, &row) in free.iter().enumerate() {
            for (j, &column) in free.iter().enumerate() {
                covariance[(row, column)] = 0.5 * (own[(i, j)] + own[(j, i)]);
            }
        }
        Ok(covariance)
    }

    /// The place of the least sum of squares near a point.
    pub fn minimise(&self, from: DVector<f64>) -> Result<DVector<f64>, MotionError> {
        let mut at = from;
        let (mut damping, mut slow) = (1e-3, 0);
        let failed = |iterations| Err(MotionError::NoConvergence { iterations });
        for iteration in 0..MOST_ITERATIONS {
            let (normal, gradient, square) = self.normal(&at);
            if !square.is_finite() {
                return failed(iteration);
            }
            let free = self.not_held(&at, &gradient);
            let (own, slope) = (part(&normal, &free), DVector::from_fn(free.len(), |i, _| gradient[free[i]]));
            loop {
                let mut damped = own.clone();
                for i in 0..free.len() {
                    // An unknown that nothing depends on stays where it is.
                    damped[(i, i)] += if own[(i, i)] > 0.0 { damping * own[(i, i)] } else { 1.0 };
                }
                let next = damped.cholesky().map(|factor| {
                    let mut next = at.clone();
                    for (&i, step) in free.iter().zip(factor.solve(&slope).iter()) {
                        next[i] = (at[i] - step).clamp(self.bounds[i][0], self.bounds[i][1]);
                    }
                    next
                });
                let found = next.as_ref().map_or(f64::NAN, |next| self.square(next));
                if let Some(next) = next.filter(|_| found <= square) {
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
                    return if whole.fold(0.0, f64::max) <= STALLED * square { Ok(at) } else { failed(iteration) };
                }
            }
        }
        failed(MOST_ITERATIONS)
    }
}
