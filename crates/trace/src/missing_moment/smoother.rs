//! Heading, yaw rate and missing moment of a first-order ship as a linear stochastic system: filter and smoother.
//!
//! ψ' = r, r' = −a r + b (δ + δ_r + m), m' = w, with a = 1/T, b = K/T, the moment m in rad of rudder and white w of
//! density λσ² (rad²/s), where σ is the standard deviation of the heading noise of a full row, in whose square all
//! variances here are counted. Steps between rows are exact. The state begins with a large variance, so that the first
//! heading, rate and moment are the smoother's.
//!
//! The mean and the variance given all rows are those of Rauch, Tung and Striebel (1965), here by the adjoint recursion
//! of Bryson and Frazier (1963), which inverts no matrix: x = x⁻ + P⁻ s, V = P⁻ − P⁻ N P⁻ with the score s of all later
//! innovations and its variance N.

use nalgebra::{DMatrix, Matrix3, Vector3};
use ship::first_order::{State, Transition};
use ship::{FirstOrder, Polyline};

use crate::noise::{Matrix, van_loan};

/// Standard deviations with which heading (rad), yaw rate (rad/s) and moment (rad of rudder) begin.
const LARGE: f64 = 1.0;

/// States that are not known in the beginning.
pub(super) const STATES: usize = 3;

/// Headings of all rows, rad, and what a known input adds to heading (rad) and yaw rate (rad/s) in the step before
/// each.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub heading: Vec<f64>,
    pub forced: Vec<[f64; 2]>,
}

/// The rows of one record for a known base.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    base: FirstOrder,
    pub time: Vec<f64>,
    /// Variance of the noise of every row, in units of that of a full one.
    variance: Vec<f64>,
    /// Transition and covariance for λ = 1 of every distinct step.
    steps: Vec<(f64, Matrix3<f64>, Matrix3<f64>)>,
    /// The step before every row; the first has none.
    of_row: Vec<usize>,
    /// Large initial variances over σ².
    prior: f64,
}

fn three(matrix: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| matrix[i][j])
}

impl Rows {
    /// Rows at increasing times (s) with the given variances; `sd` is about σ, rad.
    pub fn new(base: FirstOrder, time: Vec<f64>, variance: Vec<f64>, sd: f64) -> Self {
        let mut generator = DMatrix::<f64>::zeros(STATES, STATES);
        generator[(0, 1)] = 1.0;
        generator[(1, 1)] = -base.inverse_T;
        generator[(1, 2)] = base.K_over_T;
        let mut steps: Vec<(f64, Matrix3<f64>, Matrix3<f64>)> = Vec::new();
        let mut of_row = vec![0];
        for pair in time.windows(2) {
            let h = pair[1] - pair[0];
            let known = steps.iter().rposition(|step| (step.0 - h).abs() <= 1e-9 * h);
            of_row.push(known.unwrap_or_else(|| {
                let (f, q) = van_loan(&generator, 1.0, h);
                steps.push((h, three(&f), three(&q)));
                steps.len() - 1
            }));
        }
        Self { base, time, variance, steps, of_row, prior: (LARGE / sd).powi(2) }
    }

    /// Number of rows.
    pub fn count(&self) -> usize {
        self.time.len()
    }

    /// What the recorded rudder and δ_r do to a ship at rest in the step before every row.
    pub fn steered(&self, rudder: &Polyline) -> Vec<[f64; 2]> {
        let (a, b) = (self.base.inverse_T, self.base.K_over_T);
        let input = |t: f64| b * (rudder.at(t) + self.base.rudder_bias);
        let mut forced = vec![[0.0; 2]];
        for pair in self.time.windows(2) {
            let from = rudder.times().partition_point(|&corner| corner <= pair[0]);
            let to = rudder.times().partition_point(|&corner| corner < pair[1]).max(from);
            let corners = rudder.times()[from..to].iter().chain(&pair[1..]);
            let (mut state, mut at, mut u) = (State::default(), pair[0], input(pair[0]));
            for &corner in corners {
                let (h, next) = (corner - at, input(corner));
                state = Transition::new(a, h).advance(state, u, (next - u) / h);
                (at, u) = (corner, next);
            }
            forced.push([state.heading, state.yaw_rate]);
        }
        forced
    }

    /// What a moment, rad of rudder, known at the rows and linear between them, does in the step before every row.
    pub fn pushed(&self, moment: &[f64]) -> Vec<[f64; 2]> {
        let steps: Vec<Transition> =
            self.steps.iter().map(|step| Transition::new(self.base.inverse_T, step.0)).collect();
        let step = |row: usize| {
            let (before, after) = (self.base.K_over_T * moment[row - 1], self.base.K_over_T * moment[row]);
            let transition = &steps[self.of_row[row]];
            let state = transition.advance(State::default(), before, (after - before) / transition.h);
            [state.heading, state.yaw_rate]
        };
        (0..self.count()).map(|row| if row == 0 { [0.0; 2] } else { step(row) }).collect()
    }

    /// The filter for a moment that walks with λ, 1/s.
    pub fn filter(&self, intensity: f64) -> Filter<'_> {
        let mut rows: Vec<Row> = Vec::with_capacity(self.count());
        let mut covariance = Matrix3::from_diagonal_element(self.prior);
        for (row, &noise) in self.variance.iter().enumerate() {
            if row > 0 {
                let (_, f, q) = &self.steps[self.of_row[row]];
                covariance = f * covariance * f.transpose() + q * intensity;
                covariance = 0.5 * (covariance + covariance.transpose());
            }
            let seen: Vector3<f64> = covariance.column(0).into();
            let variance = seen[0] + noise;
            rows.push(Row { predicted: covariance, gain: seen / variance, variance });
            covariance -= seen * seen.transpose() / variance;
        }
        let log_variance = rows.iter().map(|row| row.variance.ln()).sum();
        Filter { of: self, rows, log_variance }
    }
}

/// One row of a filter.
#[derive(Debug, Clone)]
struct Row {
    /// Variance of the state before the heading of the row is known.
    predicted: Matrix3<f64>,
    gain: Vector3<f64>,
    /// Predicted variance of the heading.
    variance: f64,
}

/// The filter for one size of the walk.
#[derive(Debug, Clone)]
pub(super) struct Filter<'a> {
    of: &'a Rows,
    rows: Vec<Row>,
    /// Σ log S.
    pub log_variance: f64,
}

impl Filter<'_> {
    /// Predicted states and innovations of every row.
    fn run<'b>(&'b self, column: &'b Column) -> impl Iterator<Item = (Vector3<f64>, f64)> + 'b {
        let mut state = Vector3::zeros();
        self.rows.iter().enumerate().map(move |(row, own)| {
            if row > 0 {
                let [heading, rate] = column.forced[row];
                state = self.of.steps[self.of.of_row[row]].1 * state + Vector3::new(heading, rate, 0.0);
            }
            let predicted = state;
            let innovation = column.heading[row] - predicted[0];
            state += own.gain * innovation;
            (predicted, innovation)
        })
    }

    /// The innovations in units of their standard deviation over σ.
    pub fn whitened(&self, column: &Column) -> Vec<f64> {
        self.run(column).zip(&self.rows).map(|((_, innovation), row)| innovation / row.variance.sqrt()).collect()
    }

    /// Heading, yaw rate and moment of every row given all rows.
    pub fn smoothed(&self, column: &Column) -> Vec<Vector3<f64>> {
        let forward: Vec<(Vector3<f64>, f64)> = self.run(column).collect();
        let mut score = Vector3::zeros();
        let mut states = vec![Vector3::zeros(); self.rows.len()];
        for row in (0..self.rows.len()).rev() {
            let (own, (predicted, innovation)) = (&self.rows[row], forward[row]);
            // Through the correction of the row, then its own innovation.
            score[0] += innovation / own.variance - own.gain.dot(&score);
            states[row] = predicted + own.predicted * score;
            score = self.of.steps.get(self.of.of_row[row]).map_or(score, |step| step.1.transpose() * score);
        }
        states
    }

    /// Variance of the moment of every row given all rows, rad² over σ².
    pub fn moment_variance(&self) -> Vec<f64> {
        let mut information = Matrix3::<f64>::zeros();
        let mut variances = vec![0.0; self.rows.len()];
        for row in (0..self.rows.len()).rev() {
            let own = &self.rows[row];
            let mut through = Matrix3::identity();
            through.column_mut(0).axpy(-1.0, &own.gain, 1.0);
            information = through.transpose() * information * through;
            information[(0, 0)] += own.variance.recip();
            let column: Vector3<f64> = own.predicted.column(2).into();
            variances[row] = (own.predicted[(2, 2)] - column.dot(&(information * column))).max(0.0);
            if let Some((_, f, _)) = self.of.steps.get(self.of.of_row[row]) {
                information = f.transpose() * information * f;
            }
        }
        variances
    }
}
