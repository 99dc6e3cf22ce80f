//! Piecewise-linear signal of time: a recorded rudder, a measured wind, the path of a steering gear.

use thiserror::Error;

/// Error of a list of points that is not a signal.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SignalError {
    /// No points.
    #[error("a signal needs at least one point, found none")]
    Empty,
    /// Different numbers of times and values.
    #[error("a signal needs as many values as times, found {times} times and {values} values")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// Point with a time or value that is not finite, or a time that does not increase.
    #[error("a signal needs finite values at increasing times, point {index} is ({time}, {value})")]
    Point {
        /// Index of the offending point.
        index: usize,
        /// Time of the point before, s; −∞ for the first point.
        before: f64,
        /// Time of the point, s.
        time: f64,
        /// Value of the point.
        value: f64,
    },
}

/// Piecewise-linear signal: linear between its points, constant before the first and after the last.
///
/// Times in seconds, strictly increasing; values in the unit of the quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    time: Vec<f64>,
    value: Vec<f64>,
}

impl Polyline {
    /// Signal through these points.
    ///
    /// Fails if there are no points, lengths differ, a number is not finite or time does not increase.
    pub fn new(time: Vec<f64>, value: Vec<f64>) -> Result<Self, SignalError> {
        if time.len() != value.len() {
            return Err(SignalError::Lengths { times: time.len(), values: value.len() });
        }
        if time.is_empty() {
            return Err(SignalError::Empty);
        }
        // Increasing numbers between two finite numbers are finite.
        let increasing = time.windows(2).all(|pair| pair[0] < pair[1]);
        let sound = increasing && time[0].is_finite() && time[time.len() - 1].is_finite();
        if !sound || !value.iter().all(|value| value.is_finite()) {
            let before = |index: usize| if index == 0 { f64::NEG_INFINITY } else { time[index - 1] };
            let offends =
                |&index: &usize| !(time[index] > before(index) && time[index].is_finite() && value[index].is_finite());
            let index = (0..time.len()).find(offends).unwrap_or(0);
            let point = SignalError::Point { index, before: before(index), time: time[index], value: value[index] };
            return Err(point);
        }
        Ok(Self { time, value })
    }

    /// Constant signal.
    pub fn constant(value: f64) -> Self {
        Self { time: vec![0.0], value: vec![value] }
    }

    /// Times of the points, s.
    pub fn times(&self) -> &[f64] {
        &self.time
    }

    /// Values at the points.
    pub fn values(&self) -> &[f64] {
        &self.value
    }

    /// Index of the piece that holds `t`: the last point not after it (0 before the first point).
    pub fn piece_index(&self, t: f64) -> usize {
        self.time.partition_point(|&point| point <= t).saturating_sub(1)
    }

    /// Value at time `t`.
    pub fn value_at(&self, t: f64) -> f64 {
        self.value_at_with_hint(t, self.piece_index(t))
    }

    /// Value at time `t`; the search starts at the piece `hint`, and is O(1) when the hint is near.
    pub fn value_at_with_hint(&self, t: f64, hint: usize) -> f64 {
        let last = self.time.len() - 1;
        let mut piece = hint.min(last);
        while piece < last && self.time[piece + 1] <= t {
            piece += 1;
        }
        while piece > 0 && self.time[piece] > t {
            piece -= 1;
        }
        if piece == last || t <= self.time[piece] {
            return self.value[piece];
        }
        let share = (t - self.time[piece]) / (self.time[piece + 1] - self.time[piece]);
        self.value[piece] + share * (self.value[piece + 1] - self.value[piece])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_and_holds_its_ends() {
        let ramp = Polyline::new(vec![1.0, 3.0, 4.0], vec![0.0, 4.0, 4.0]).expect("valid points");
        for hint in 0..4 {
            assert_eq!(ramp.value_at_with_hint(0.0, hint), 0.0);
            assert_eq!(ramp.value_at_with_hint(2.0, hint), 2.0);
            assert_eq!(ramp.value_at_with_hint(3.0, hint), 4.0);
            assert_eq!(ramp.value_at_with_hint(9.0, hint), 4.0);
        }
        assert_eq!(ramp.value_at(2.5), 3.0);
    }

    #[test]
    fn refuses_time_that_runs_backwards() {
        let error = Polyline::new(vec![0.0, 2.0, 1.0], vec![0.0; 3]).expect_err("time runs back");
        assert_eq!(error, SignalError::Point { index: 2, before: 2.0, time: 1.0, value: 0.0 });
    }
}
