//! Schedule of the readings of a record: their order and the time steps between them, each kind of step stored once.

use estimation::kalman::SensorReading;

use super::track::{TrialSignals, durations_differ};

/// Index of the compass among the sensors.
pub const COMPASS_SENSOR: usize = 0;

/// Index of the rate gyro among the sensors.
pub const GYRO_SENSOR: usize = 1;

/// Time from one reading to the next, in pieces between rows of the rudder.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadingInterval {
    /// Durations of the pieces, s.
    pub pieces: Vec<f64>,
}

impl ReadingInterval {
    /// Duration of the interval, s.
    pub fn duration(&self) -> f64 {
        self.pieces.iter().sum()
    }

    fn has_pieces(&self, pieces: &[f64]) -> bool {
        self.pieces.len() == pieces.len() && self.pieces.iter().zip(pieces).all(|(a, b)| !durations_differ(*a, *b))
    }
}

/// Sequence of the compass and rate-gyro readings of a record, with the intervals between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Schedule {
    /// Distinct intervals between readings, which the readings refer to by index.
    pub intervals: Vec<ReadingInterval>,
    /// Readings in order.
    pub readings: Vec<SensorReading>,
}

/// Number of recent kinds of steps that are compared with the next step: steps of a clock repeat soon or not at all.
const MAX_RECENT_KINDS: usize = 16;

impl Schedule {
    /// Readings of a trial; with `by_row` an interval between readings is divided at the rows of the rudder in it.
    pub fn new(signals: &TrialSignals, by_row: bool) -> Self {
        let time = &signals.time;
        let mut schedule = Self { intervals: Vec::new(), readings: Vec::new() };
        let mut last = None;
        let (mut headings, mut rates) =
            (signals.heading_rows.iter().peekable(), signals.yaw_rate_rows.iter().peekable());
        let mut pieces = Vec::new();
        while let Some(row) = [headings.peek(), rates.peek()].into_iter().flatten().min().map(|&&row| row) {
            let step = last.map(|last: usize| {
                pieces.clear();
                if by_row {
                    pieces.extend(time[last..=row].windows(2).map(|pair| pair[1] - pair[0]));
                } else {
                    pieces.push(time[row] - time[last]);
                }
                schedule.kind(&pieces)
            });
            last = Some(row);
            let both = headings.peek() == rates.peek();
            if headings.next_if(|&&next| next == row).is_some() {
                schedule.readings.push(SensorReading::new(step, COMPASS_SENSOR));
            }
            if rates.next_if(|&&next| next == row).is_some() {
                schedule.readings.push(SensorReading::new(step.filter(|_| !both), GYRO_SENSOR));
            }
        }
        schedule
    }

    /// Index of the step over these pieces, s, stored if none of the last [`MAX_RECENT_KINDS`] steps has them.
    fn kind(&mut self, pieces: &[f64]) -> usize {
        let recent = self.intervals.len().saturating_sub(MAX_RECENT_KINDS);
        if let Some(place) = self.intervals[recent..].iter().rposition(|interval| interval.has_pieces(pieces)) {
            return recent + place;
        }
        self.intervals.push(ReadingInterval { pieces: pieces.to_vec() });
        self.intervals.len() - 1
    }

    /// Column of all readings from the columns of the two instruments.
    pub fn stacked(&self, heading: &[f64], yaw_rate: &[f64]) -> Vec<f64> {
        if self.readings.len() == heading.len() {
            return heading.to_vec();
        }
        let (mut heading, mut yaw_rate) = (heading.iter(), yaw_rate.iter());
        let next =
            |entry: &SensorReading| if entry.sensor() == COMPASS_SENSOR { heading.next() } else { yaw_rate.next() };
        let mut column = Vec::with_capacity(self.readings.len());
        column.extend(self.readings.iter().filter_map(next).copied());
        column
    }
}
