//! What wanders and waves as one linear system over the observed rows of a record.

use estimation::kalman::MOST;
use nalgebra::DMatrix;
use ship::narrow_band::NarrowBand;

type Vector = [f64; MOST];
pub(crate) type Matrix = [[f64; MOST]; MOST];

/// x ← F x + q before every observed row but the first; the heading is the first state, or the sum of it and another.
#[derive(Debug, Clone)]
pub(crate) struct System {
    /// Number of states; the others are zero.
    pub states: usize,
    /// The state that is added to the first one: the waves, beside what wanders.
    pub beside: Option<usize>,
    /// Transition F and covariance of q of every distinct step.
    pub steps: Vec<(Matrix, Matrix)>,
    /// The step before every observed row.
    pub of_row: Vec<usize>,
    /// Covariance of the state at the first row.
    pub initial: Matrix,
}

impl System {
    /// The heading of a sample path at the observed rows, from standard normal numbers.
    pub(crate) fn sample(&self, normal: &mut impl FnMut() -> f64) -> Vec<f64> {
        let roots: Vec<Matrix> = self.steps.iter().map(|(_, added)| root(added)).collect();
        let draw = |root: &Matrix, normal: &mut dyn FnMut() -> f64| -> Vector {
            let numbers: Vector = std::array::from_fn(|_| normal());
            std::array::from_fn(|i| (0..MOST).map(|j| root[i][j] * numbers[j]).sum())
        };
        let mut state = draw(&root(&self.initial), normal);
        let mut path = Vec::with_capacity(self.of_row.len());
        for (row, &step) in self.of_row.iter().enumerate() {
            if row > 0 {
                let added = draw(&roots[step], normal);
                state = std::array::from_fn(|i| {
                    added[i] + (0..MOST).map(|j| self.steps[step].0[i][j] * state[j]).sum::<f64>()
                });
            }
            path.push(state[0] + self.beside.map_or(0.0, |beside| state[beside]));
        }
        path
    }
}

/// A lower triangle L with L Lᵀ = a covariance that may be singular.
fn root(covariance: &Matrix) -> Matrix {
    let mut l = [[0.0; MOST]; MOST];
    for i in 0..MOST {
        for j in 0..=i {
            let sum: f64 = covariance[i][j] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
            l[i][j] = match (i == j, l[j][j] > 0.0) {
                (true, _) => sum.max(0.0).sqrt(),
                (false, true) => sum / l[j][j],
                (false, false) => 0.0,
            };
        }
    }
    l
}

/// Transition and added covariance of what wanders and waves together.
pub(super) fn joint(
    drift: Option<(&(Matrix, Matrix), f64, usize)>,
    waves: &Option<NarrowBand>,
    h: f64,
) -> (Matrix, Matrix) {
    let (mut f, mut q): (Matrix, Matrix) = ([[0.0; MOST]; MOST], [[0.0; MOST]; MOST]);
    let mut own = 0;
    if let Some(((transition, added), level, states)) = drift {
        own = states;
        for i in 0..states {
            for j in 0..states {
                (f[i][j], q[i][j]) = (transition[i][j], level * added[i][j]);
            }
        }
    }
    if let Some(waves) = waves {
        let step = waves.step(h);
        let (a, b) = (step.advance([1.0, 0.0], [0.0; 2]), step.advance([0.0, 1.0], [0.0; 2]));
        let (c, d) = (step.advance([0.0; 2], [1.0, 0.0]), step.advance([0.0; 2], [0.0, 1.0]));
        for i in 0..2 {
            (f[own + i][own], f[own + i][own + 1]) = (a[i], b[i]);
            for j in 0..2 {
                q[own + i][own + j] = c[i] * c[j] + d[i] * d[j];
            }
        }
    }
    (f, q)
}

/// Transition and added covariance over h for white noise of the given intensity on the last state (Van Loan 1978).
pub(crate) fn van_loan(generator: &DMatrix<f64>, intensity: f64, h: f64) -> (Matrix, Matrix) {
    let m = generator.nrows();
    let mut block = DMatrix::<f64>::zeros(2 * m, 2 * m);
    block.view_mut((0, 0), (m, m)).copy_from(&(-generator * h));
    block[(m - 1, 2 * m - 1)] = h;
    block.view_mut((m, m), (m, m)).copy_from(&(generator.transpose() * h));
    let exponential = block.exp();
    let transition = exponential.view((m, m), (m, m)).transpose();
    let added = &transition * exponential.view((0, m), (m, m)) * intensity;
    let mut result = ([[0.0; MOST]; MOST], [[0.0; MOST]; MOST]);
    for i in 0..m {
        for j in 0..m {
            result.0[i][j] = transition[(i, j)];
            result.1[i][j] = 0.5 * (added[(i, j)] + added[(j, i)]);
        }
    }
    result
}
