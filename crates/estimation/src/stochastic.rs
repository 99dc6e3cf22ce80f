//! Linear stochastic systems driven by white noise: exact discretisation, and sample paths.
//!
//! Source: Van Loan (1978), IEEE Transactions on Automatic Control 23:395-404.

use nalgebra::DMatrix;

use crate::kalman::whitener::Whitener;
use crate::kalman::{KalmanFilter, LinearStep, LinearSystem, MAX_STATES, StateSensor};
use crate::with_states;

impl<const N: usize> LinearStep<N> {
    /// Exact step over `h` seconds of x' = G x + w with white noise w on the last state of G (Van Loan 1978).
    /// `intensity` is the spectral density of w: the variance that it adds to the last state per second. G has 1 to `N`
    /// states; states beyond are zero.
    pub fn from_generator(generator: &DMatrix<f64>, intensity: f64, h: f64) -> Self {
        let m = generator.nrows();
        let mut block = DMatrix::<f64>::zeros(2 * m, 2 * m);
        block.view_mut((0, 0), (m, m)).copy_from(&(-generator * h));
        block[(m - 1, 2 * m - 1)] = h;
        block.view_mut((m, m), (m, m)).copy_from(&(generator.transpose() * h));
        let exponential = block.exp();
        let transition = exponential.view((m, m), (m, m)).transpose();
        let added = &transition * exponential.view((0, m), (m, m)) * intensity;
        let mut step = Self { transition: [[0.0; N]; N], process_noise: [[0.0; N]; N] };
        for i in 0..m {
            for j in 0..m {
                step.transition[i][j] = transition[(i, j)];
                step.process_noise[i][j] = 0.5 * (added[(i, j)] + added[(j, i)]);
            }
        }
        step
    }

    /// Step whose process-noise covariance is multiplied by `level`.
    pub fn with_scaled_noise(&self, level: f64) -> Self {
        Self { process_noise: self.process_noise.map(|row| row.map(|x| level * x)), ..*self }
    }
}

impl<const N: usize> LinearSystem<N> {
    /// Readings along a random sample path, without sensor noise; `normal` draws standard normal numbers.
    pub fn sample_path(&self, normal: &mut impl FnMut() -> f64) -> Vec<f64> {
        let roots: Vec<[[f64; N]; N]> = self.steps.iter().map(|step| root(&step.process_noise)).collect();
        let mut draw = |root: &[[f64; N]; N]| -> [f64; N] {
            let numbers: [f64; N] = std::array::from_fn(|_| normal());
            std::array::from_fn(|i| (0..N).map(|j| root[i][j] * numbers[j]).sum())
        };
        let mut state = draw(&root(&self.initial_covariance));
        let read = self.readings.iter().map(|reading| {
            if let Some(step) = reading.step() {
                let (added, f) = (draw(&roots[step]), &self.steps[step].transition);
                state = std::array::from_fn(|i| added[i] + (0..N).map(|j| f[i][j] * state[j]).sum::<f64>());
            }
            let StateSensor { state: first, second_state: beside, .. } = self.sensors[reading.sensor()];
            state[first] + beside.map_or(0.0, |beside| state[beside])
        });
        read.collect()
    }
}

impl LinearSystem<MAX_STATES> {
    /// Whitener of the first `states` states, with the remaining states zero; `tolerance` is the relative change below
    /// which a gain is stationary.
    pub fn whitener(&self, states: usize, tolerance: f64) -> Whitener {
        with_states!(states, N => {
            let first = |wide: &[[f64; MAX_STATES]; MAX_STATES]| -> [[f64; N]; N] {
                std::array::from_fn(|i| std::array::from_fn(|j| wide[i][j]))
            };
            let steps = self.steps.iter().map(|step| LinearStep {
                transition: first(&step.transition),
                process_noise: first(&step.process_noise),
            });
            let system = LinearSystem {
                steps: steps.collect(),
                sensors: self.sensors.clone(),
                readings: self.readings.clone(),
                initial_covariance: first(&self.initial_covariance),
            };
            KalmanFilter::with_tolerance(system, tolerance).into_whitener()
        })
    }
}

/// Cholesky factor L, L Lᵀ = P, of a covariance P that may be singular.
fn root<const N: usize>(covariance: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut l = [[0.0; N]; N];
    for i in 0..N {
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
