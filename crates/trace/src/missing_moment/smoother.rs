//! Kalman filter and smoother of heading, yaw rate and missing moment of a first-order ship.
//!
//! ψ' = r, r' = −a r + b (δ + δ_r + m), m' = w, with a = 1/T, b = K/T, the moment m in rad of rudder and white w of
//! density λσ² (rad²/s), with σ the standard deviation of the heading noise of a full row. All variances are in units
//! of σ². Steps between rows are exact. The initial state has a large variance, so the data determine it.
//!
//! Source of the smoother: Bryson and Frazier (1963).

use estimation::kalman::smoother::KalmanSmoother;
use estimation::kalman::{LinearStep, LinearSystem};
use nalgebra::DMatrix;
use ship::first_order::{FirstOrderTransition, YawState};
use ship::{FirstOrder, Polyline};

/// Initial standard deviations of heading (rad), yaw rate (rad/s) and moment (rad of rudder).
const INITIAL_SD: f64 = 1.0;

/// Number of states.
pub(super) const STATES: usize = 3;

/// Headings of all rows (rad), with the responses of heading (rad) and yaw rate (rad/s) to an input in the step before
/// each row.
#[derive(Debug, Clone)]
pub(super) struct HeadingRows {
    pub heading: Vec<f64>,
    pub forced: Vec<[f64; 2]>,
}

/// Rows of one record for a fixed base.
#[derive(Debug, Clone)]
pub(super) struct MomentRows {
    base: FirstOrder,
    pub time: Vec<f64>,
    /// Variance of the noise of every row, in units of the variance of a full row.
    variance: Vec<f64>,
    /// Duration (s) of every distinct step, with its transition and its covariance for λ = 1.
    steps: Vec<(f64, LinearStep<STATES>)>,
    /// Index of the step before every row; the first is unused.
    of_row: Vec<usize>,
    /// Initial variance of every state, in units of σ².
    prior: f64,
}

impl MomentRows {
    /// Rows at increasing times (s) with the given variances; `sd` is about σ, rad.
    pub fn new(base: FirstOrder, time: Vec<f64>, variance: Vec<f64>, sd: f64) -> Self {
        let mut generator = DMatrix::<f64>::zeros(STATES, STATES);
        generator[(0, 1)] = 1.0;
        generator[(1, 1)] = -base.inverse_T;
        generator[(1, 2)] = base.K_over_T;
        let mut steps: Vec<(f64, LinearStep<STATES>)> = Vec::new();
        let mut of_row = vec![0];
        for pair in time.windows(2) {
            let h = pair[1] - pair[0];
            let equal = steps.iter().rposition(|step| (step.0 - h).abs() <= 1e-9 * h);
            of_row.push(equal.unwrap_or_else(|| {
                steps.push((h, LinearStep::from_generator(&generator, 1.0, h)));
                steps.len() - 1
            }));
        }
        Self { base, time, variance, steps, of_row, prior: (INITIAL_SD / sd).powi(2) }
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.time.len()
    }

    /// Heading (rad) and yaw rate (rad/s) at every row, from rest at the row before, under the recorded rudder and δ_r;
    /// zero at the first row.
    pub fn rudder_response(&self, rudder: &Polyline) -> Vec<[f64; 2]> {
        let (a, b) = (self.base.inverse_T, self.base.K_over_T);
        let input = |t: f64| b * (rudder.value_at(t) + self.base.rudder_bias);
        let mut forced = vec![[0.0; 2]];
        for pair in self.time.windows(2) {
            let from = rudder.times().partition_point(|&corner| corner <= pair[0]);
            let to = rudder.times().partition_point(|&corner| corner < pair[1]).max(from);
            let corners = rudder.times()[from..to].iter().chain(&pair[1..]);
            let (mut state, mut at, mut u) = (YawState::default(), pair[0], input(pair[0]));
            for &corner in corners {
                let (h, next) = (corner - at, input(corner));
                state = FirstOrderTransition::new(a, h).advance(state, u, (next - u) / h);
                (at, u) = (corner, next);
            }
            forced.push([state.heading, state.yaw_rate]);
        }
        forced
    }

    /// Heading (rad) and yaw rate (rad/s) at every row, from rest at the row before, under a moment in rad of rudder
    /// that is linear between rows; zero at the first row.
    pub fn moment_response(&self, moment: &[f64]) -> Vec<[f64; 2]> {
        let steps: Vec<FirstOrderTransition> =
            self.steps.iter().map(|step| FirstOrderTransition::new(self.base.inverse_T, step.0)).collect();
        let step = |row: usize| {
            let (before, after) = (self.base.K_over_T * moment[row - 1], self.base.K_over_T * moment[row]);
            let transition = &steps[self.of_row[row]];
            let state = transition.advance(YawState::default(), before, (after - before) / transition.time_step);
            [state.heading, state.yaw_rate]
        };
        (0..self.count()).map(|row| if row == 0 { [0.0; 2] } else { step(row) }).collect()
    }

    /// Filter for a random walk of the moment with λ, 1/s.
    pub fn filter(&self, intensity: f64) -> MomentFilter {
        let steps = self.steps.iter().map(|(_, step)| step.with_scaled_noise(intensity)).collect();
        let initial = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { self.prior } else { 0.0 }));
        MomentFilter(KalmanSmoother::new(LinearSystem::from_rows(steps, initial, &self.of_row, &self.variance, None)))
    }
}

/// Filter for one intensity of the walk.
#[derive(Debug, Clone)]
pub(super) struct MomentFilter(KalmanSmoother<STATES>);

impl MomentFilter {
    /// Σ log S, the log determinant of the covariance over σ².
    pub fn log_determinant(&self) -> f64 {
        self.0.filter.log_determinant()
    }

    /// Innovations over the square root of S.
    pub fn whitened(&self, column: &HeadingRows) -> Vec<f64> {
        self.0.whitened(&column.heading, forced(column))
    }

    /// Heading (rad), yaw rate (rad/s) and moment (rad of rudder) of every row given all rows.
    pub fn smoothed(&self, column: &HeadingRows) -> Vec<[f64; STATES]> {
        self.0.smoothed(&column.heading, forced(column))
    }

    /// Variance of the moment (rad² of rudder) of every row given all rows, divided by σ² (rad²).
    pub fn moment_variance(&self) -> Vec<f64> {
        self.0.variances(2)
    }
}

/// State response to the input of a column in the step before a row.
fn forced(column: &HeadingRows) -> impl Fn(usize) -> [f64; STATES] {
    |row| {
        let [heading, rate] = column.forced[row];
        [heading, rate, 0.0]
    }
}
