//! One-step-ahead predicted motion of a ship, and the heading response to a moment.
//!
//! Heading and yaw rate are taken from the replay plus, under a random moment, the Kalman prediction from the rows
//! before. A shape of predicted states is exogenous to the row that it explains; one of smoothed states would contain
//! the random moment itself and always explain it.

use estimation::kalman::MAX_STATES;
use ship::Replayable;
use ship::dynamics::Dynamics;
use ship::first_order::{FirstOrderTransition, YawState};
use ship::replay::replay_states;

use crate::model::{Structure, solver_step};
use crate::record::PreparedRecord;

/// Solver steps per minimum time constant.
const STEPS: f64 = 2.0;

/// Window of the running median of the rudder, rows: a single deviating reading is not a motion.
const MEDIAN_ROWS: usize = 5;

/// Predicted motion of one record, with the first-order response to a moment.
#[derive(Debug, Clone)]
pub struct PredictedMotion<'a> {
    /// Record.
    pub record: &'a PreparedRecord,
    /// Index of the record.
    pub record_index: usize,
    /// First-order base: 1/T, 1/s, and K/T, 1/s².
    pub base: [f64; 2],
    /// Predicted heading minus the first heading at every row, rad.
    pub heading: Vec<f64>,
    /// Predicted yaw rate at every row, rad/s.
    pub yaw_rate: Vec<f64>,
    /// Rudder angle at every row, rad.
    pub rudder: Vec<f64>,
    /// Rudder rate at every row, rad/s.
    pub rudder_rate: Vec<f64>,
    /// Way to starboard of the initial course at every row, per m/s of speed: ∫ sin(ψ − ψ₀) dt, s.
    pub way: Vec<f64>,
    transitions: Vec<FirstOrderTransition>,
}

impl<'a> PredictedMotion<'a> {
    /// Motion of a record under a structure; `predicted` are the one-step predictions of the states of a random moment
    /// at the observed rows: heading (rad) and yaw rate (rad/s) come first.
    pub fn new(
        record: &'a PreparedRecord,
        record_index: usize,
        structure: &Structure,
        theta: &[f64],
        initial: [f64; 2],
        predicted: Option<&[[f64; MAX_STATES]]>,
    ) -> Self {
        let response = structure.response(Some(record_index), theta);
        let recorded = record.replay_signals(&response);
        let mut state = vec![0.0; response.dimension()];
        response.initialise(initial[0], initial[1], &recorded.input(record.time[0], response.dead_time()), &mut state);
        let (mut heading, mut yaw_rate) = (Vec::new(), Vec::new());
        let step = solver_step(&response, record.spacing, STEPS);
        replay_states(&response, &recorded, &record.time, step, &mut state, |_, state, _| {
            heading.push(state[0]);
            yaw_rate.push(state[1]);
        });
        if let Some(predicted) = predicted {
            for row in 0..record.time.len() {
                heading[row] += interpolated(record, row, |k| predicted[k][0]);
                yaw_rate[row] += interpolated(record, row, |k| predicted[k][1]);
            }
        }
        let first = heading[0];
        heading.iter_mut().for_each(|psi| *psi -= first);
        let rudder = medians(&record.time.iter().map(|&t| record.rudder.value_at(t)).collect::<Vec<_>>());
        let intervals = || record.time.windows(2).map(|pair| pair[1] - pair[0]);
        let mut way = vec![0.0];
        for (row, h) in intervals().enumerate() {
            way.push(way[row] + 0.5 * h * (heading[row].sin() + heading[row + 1].sin()));
        }
        Self {
            record,
            record_index,
            base: [theta[0], theta[1]],
            rudder_rate: slopes(&record.time, &rudder),
            transitions: intervals().map(|h| FirstOrderTransition::new(theta[0], h)).collect(),
            heading,
            yaw_rate,
            rudder,
            way,
        }
    }

    /// Heading response at the observed rows to a moment that is linear between rows, rad per rad of rudder.
    pub fn heading_response(&self, moment: &[f64]) -> Vec<f64> {
        let gain = self.base[1];
        let (mut state, mut row) = (YawState::default(), 0);
        let at = |&observed: &usize| {
            while row < observed {
                let (transition, [from, to]) = (&self.transitions[row], [gain * moment[row], gain * moment[row + 1]]);
                state = transition.advance(state, from, (to - from) / transition.time_step);
                row += 1;
            }
            state.heading
        };
        self.record.observed_rows.iter().map(at).collect()
    }

    /// Signal at the rows after a first-order lag of time constant `lag` (s).
    pub fn lagged(&self, signal: impl Fn(usize) -> f64, lag: f64) -> Vec<f64> {
        let mut all = vec![signal(0)];
        for (row, transition) in self.transitions.iter().enumerate() {
            let kept = (-transition.time_step / lag).exp();
            all.push(kept * all[row] + (1.0 - kept) * 0.5 * (signal(row) + signal(row + 1)));
        }
        all
    }

    /// Heading response to an initial unit yaw rate after a time (s), s.
    pub fn rate_response(&self, time: f64) -> f64 {
        FirstOrderTransition::new(self.base[0], time).phi1
    }

    /// Start and duration, s.
    pub fn span(&self) -> [f64; 2] {
        [self.record.time[0], self.record.duration()]
    }
}

/// Value at a row, linear between the `value`s of the observed rows, and constant before the first and after the last.
fn interpolated(record: &PreparedRecord, row: usize, value: impl Fn(usize) -> f64) -> f64 {
    let after = record.observed_rows.partition_point(|&observed| observed < row);
    let last = record.observed_rows.len() - 1;
    if after > last {
        return value(last);
    }
    if after == 0 || record.observed_rows[after] == row {
        return value(after);
    }
    let [from, to] = [after - 1, after].map(|k| record.time[record.observed_rows[k]]);
    let share = (record.time[row] - from) / (to - from);
    value(after - 1) * (1.0 - share) + value(after) * share
}

/// Running median over [`MEDIAN_ROWS`] rows; at the ends the first and the last value are repeated.
fn medians(values: &[f64]) -> Vec<f64> {
    let half = MEDIAN_ROWS / 2;
    let at = |row: usize| {
        let mut near: [f64; MEDIAN_ROWS] =
            std::array::from_fn(|k| values[(row + k).saturating_sub(half).min(values.len() - 1)]);
        near.sort_by(f64::total_cmp);
        near[half]
    };
    (0..values.len()).map(at).collect()
}

/// Derivative of a signal: central differences, one-sided at both ends.
fn slopes(time: &[f64], values: &[f64]) -> Vec<f64> {
    let last = time.len() - 1;
    let at = |row: usize| {
        let (from, to) = (row.saturating_sub(1), (row + 1).min(last));
        (values[to] - values[from]) / (time[to] - time[from])
    };
    (0..time.len()).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{TrialPlan, of_columns, record, ship};

    #[test]
    fn a_row_without_a_heading_has_the_value_between_its_neighbours() {
        let clean = record(&ship(Vec::new()), TrialPlan::default());
        let is_lost = |row: usize| (20..25).contains(&row);
        let read = |(row, psi): (usize, &f64)| if is_lost(row) { f64::NAN } else { *psi };
        let heading = clean.heading().iter().enumerate().map(read).collect();
        let record = PreparedRecord::unaveraged(&of_columns(clean.time().to_vec(), heading, clean.rudder().to_vec()));
        let at = |row: usize| interpolated(&record, row, |observed| record.observed_rows[observed] as f64);
        assert_eq!([0, 19, 25].map(at), [0.0, 19.0, 25.0]);
        (20..25).for_each(|row| assert!((at(row) - row as f64).abs() < 1e-9, "{row}: {}", at(row)));
    }
}
