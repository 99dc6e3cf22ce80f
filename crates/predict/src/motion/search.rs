//! Least squares over groups of rows, each of which depends on some of the unknowns, and the covariance of what is
//! found.

use estimation::covariance::newey_west;
use estimation::levenberg_marquardt::{End, Minimum, Normal, Objective, Rules, minimise};
use nalgebra::{DMatrix, DVector};

use super::error::MotionError;

/// Least eigenvalue of a normal matrix with a diagonal of ones.
const OPEN: f64 = 1e-11;

/// A search ends after two steps that lower the sum of squares by less than 10⁻⁷ of it.
const RULES: Rules = Rules {
    steps: 100,
    damping: 1e-3,
    shrink: 0.2,
    trusted: 0.0,
    grow: 4.0,
    least: [1e-9, 0.0],
    tries: 36,
    promise: 0.0,
    enough: [0.0, 1e-7],
    in_a_row: 2,
};

/// Decrease that a search without a better step may still have promised; the equations have kinks.
const STALLED: f64 = 1e-4;

/// Width of a difference, as a share of the value or its scale.
const STEP: f64 = 1e-6;

/// Residuals of a group, over their deviations, where the unknowns have some values: a row a time, a column an output,
/// zero where nothing was read, not finite where the model has no answer.
type GroupResiduals<'a> = Box<dyn Fn(usize, &[f64]) -> DMatrix<f64> + 'a>;

/// A sum of squares over groups of rows, each of which depends on some of the unknowns.
pub(crate) struct GroupedSquares<'a> {
    /// Unknowns of every group.
    pub groups: Vec<Vec<usize>>,
    /// Least and largest value of every unknown.
    pub bounds: Vec<[f64; 2]>,
    /// A usual size of every unknown.
    pub scales: Vec<f64>,
    pub residuals: GroupResiduals<'a>,
}

/// Rows and columns of a matrix.
fn part(matrix: &DMatrix<f64>, of: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(of.len(), of.len(), |i, j| matrix[(of[i], of[j])])
}

impl GroupedSquares<'_> {
    /// Derivatives of the residuals of a group by its unknowns: central differences, one-sided at a bound.
    fn derivatives(&self, group: usize, at: &[f64]) -> Vec<DMatrix<f64>> {
        let by = |&unknown: &usize| {
            let [least, most] = self.bounds[unknown];
            let step = STEP * at[unknown].abs().max(self.scales[unknown]);
            let ends = [-step, step].map(|step| (at[unknown] + step).clamp(least, most));
            let [below, above] = ends.map(|value| {
                let mut moved = at.to_vec();
                moved[unknown] = value;
                (self.residuals)(group, &moved)
            });
            (above - below) / (ends[1] - ends[0])
        };
        self.groups[group].iter().map(by).collect()
    }

    /// The unknowns that are at no bound, and the inverse of their normal matrix.
    ///
    /// Fails with [`MotionError::Undetermined`] and the symbol of the coefficient that weighs most in what is open;
    /// `symbols` are those of the first unknowns.
    fn inverse(&self, at: &[f64], symbols: &[&'static str]) -> Result<(Vec<usize>, DMatrix<f64>), MotionError> {
        let mut normal = Normal::zeros(at.len());
        (&mut &*self).linearise(at, &mut normal);
        let free: Vec<usize> = (0..at.len()).filter(|&i| !normal.is_held(i, at[i], self.bounds[i])).collect();
        let normal = normal.matrix;
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

    /// A⁻¹ S A⁻¹ of all unknowns, zero of those at a bound, with A the normal matrix and S the long-run covariance of
    /// the scores.
    ///
    /// Fails as [`inverse`](Self::inverse) does.
    pub fn covariance(&self, at: &[f64], symbols: &[&'static str]) -> Result<DMatrix<f64>, MotionError> {
        let (free, inverse) = self.inverse(at, symbols)?;
        let mut middle = DMatrix::zeros(at.len(), at.len());
        for (group, unknowns) in self.groups.iter().enumerate() {
            let residuals = (self.residuals)(group, at);
            let slopes = unknowns.iter().zip(self.derivatives(group, at));
            let (places, scores): (Vec<usize>, Vec<Vec<f64>>) = slopes
                .map(|(&unknown, slope)| (unknown, slope.component_mul(&residuals).column_sum().as_slice().to_vec()))
                .unzip();
            let long_run = newey_west(&[scores]);
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
    pub fn minimise(&self, from: &[f64]) -> Result<Vec<f64>, MotionError> {
        let Minimum { at, value, normal, steps, end } = minimise(&mut &*self, DVector::from_row_slice(from), &RULES);
        // No better point however short the step: at the bottom, or at a kink near it.
        let promised = |i: usize| normal.gradient[i].powi(2) / normal.matrix[(i, i)];
        let moves = |i: &usize| normal.matrix[(*i, *i)] > 0.0 && !normal.is_held(*i, at[*i], self.bounds[*i]);
        let is_kink = || (0..at.len()).filter(moves).map(promised).fold(0.0, f64::max) <= STALLED * value;
        match end {
            End::Settled => Ok(at.as_slice().to_vec()),
            End::Stalled if is_kink() => Ok(at.as_slice().to_vec()),
            _ => Err(MotionError::NoConvergence { iterations: steps }),
        }
    }
}

impl Objective for &GroupedSquares<'_> {
    fn bounds(&self, unknown: usize) -> [f64; 2] {
        self.bounds[unknown]
    }

    fn value(&mut self, at: &[f64]) -> f64 {
        (0..self.groups.len()).map(|group| (self.residuals)(group, at).norm_squared()).sum()
    }

    fn linearise(&mut self, at: &[f64], normal: &mut Normal) -> f64 {
        *normal = Normal::zeros(at.len());
        let mut square = 0.0;
        for (group, unknowns) in self.groups.iter().enumerate() {
            let (residuals, slopes) = ((self.residuals)(group, at), self.derivatives(group, at));
            square += residuals.norm_squared();
            for (slope, &row) in slopes.iter().zip(unknowns) {
                normal.gradient[row] -= slope.dot(&residuals);
                for (other, &column) in slopes.iter().zip(unknowns) {
                    normal.matrix[(row, column)] += slope.dot(other);
                }
            }
        }
        square
    }
}
