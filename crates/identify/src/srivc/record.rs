//! Rows of a trial with their intervals, as the filters of this method step over them, in either direction of time.

use trial::Trial;

/// Relative tolerance of equal intervals: rows at 0.1 s differ in the last bits of their time, and every new interval
/// requires new filter coefficients.
const INTERVAL_TOLERANCE: f64 = 1e-9;

/// Row of a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FilterRow {
    /// Time since the row before, s; unused in the first row.
    pub interval: f64,
    /// Rudder δ, rad.
    pub rudder: f64,
    /// Heading relative to the first row, rad; interpolated if it was not observed.
    pub heading: f64,
    /// `true` if the heading was observed.
    pub is_observed: bool,
}

/// Rows of a trial from the first to the last observed heading, including rows without a heading, and one row without a
/// heading for every corner of the rudder between rows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SrivcRecord {
    /// Rows, in the order in which the filters run.
    pub rows: Vec<FilterRow>,
    /// Number of observed headings.
    pub observed_headings: usize,
}

impl SrivcRecord {
    /// Rows of `trial`, with time running forwards. A missing heading is interpolated linearly between its neighbours;
    /// it affects the iteration but not the estimate.
    pub fn new(trial: &Trial) -> Self {
        let (time, rudder, heading) = (trial.time(), trial.rudder(), trial.heading());
        let mut rows: Vec<FilterRow> = Vec::with_capacity(trial.len() + trial.rudder_corners().len());
        let mut corners = trial.rudder_corners().iter().peekable();
        let (mut first, mut last, mut next) = (0, 0, 0);
        let mut observed_headings = 0;
        let (mut interval, mut before) = (0.0, 0.0);
        for row in trial.observed_rows() {
            if observed_headings == 0 {
                (first, last, next, before) = (row, row, row, time[row]);
            }
            let (from, to) = (heading[last], heading[row]);
            let mut push = |t: f64, share: f64, rudder: f64, is_observed: bool| {
                let elapsed = t - before;
                if (elapsed - interval).abs() > INTERVAL_TOLERANCE * interval {
                    interval = elapsed;
                }
                before = t;
                rows.push(FilterRow {
                    interval,
                    rudder,
                    heading: from + share * (to - from) - heading[first],
                    is_observed,
                });
            };
            let share = |t: f64| (t - time[last]) / (time[row] - time[last]);
            while next <= row {
                while let Some(corner) = corners.next_if(|corner| corner.row_before < next) {
                    if corner.row_before >= first {
                        let angle =
                            rudder[corner.row_before] + corner.rate_before * (corner.time - time[corner.row_before]);
                        push(corner.time, share(corner.time), angle, false);
                    }
                }
                push(time[next], if next == row { 1.0 } else { share(time[next]) }, rudder[next], next == row);
                next += 1;
            }
            last = row;
            observed_headings += 1;
        }
        Self { rows, observed_headings }
    }

    /// Record with time running backwards: ψ'' + a ψ' = b (δ + δ_r) keeps b and δ_r and turns a into −a.
    pub fn reversed(&self) -> Self {
        // The interval before a row is the interval after it in the new order.
        let intervals = std::iter::once(0.0).chain(self.rows[1..].iter().rev().map(|row| row.interval));
        let rows =
            self.rows.iter().rev().zip(intervals).map(|(row, interval)| FilterRow { interval, ..*row }).collect();
        Self { rows, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::record;
    use approx::assert_abs_diff_eq;

    #[test]
    fn rows_without_a_heading_keep_their_rudder_and_ends_are_cut() {
        let mut heading: Vec<f64> = (0..12).map(|row| 0.01 * f64::from(row)).collect();
        for row in [0, 5, 6, 11] {
            heading[row] = f64::NAN;
        }
        let time: Vec<f64> = (0..12).map(|row| 7.0 + 0.1 * f64::from(row)).collect();
        let rudder = (0..12).map(|row| 0.1 * f64::from(row)).collect();
        let record = SrivcRecord::new(&record("gaps", time, heading, rudder));
        assert_eq!((record.rows.len(), record.observed_headings), (10, 8));
        for (index, row) in record.rows.iter().enumerate() {
            assert_abs_diff_eq!(row.rudder, 0.1 * (index + 1) as f64, epsilon = 1e-12);
            assert_abs_diff_eq!(row.heading, 0.01 * index as f64, epsilon = 1e-12);
            assert_eq!(row.is_observed, ![4, 5].contains(&index));
        }
        // Equal except for rounding: a single interval.
        assert!(record.rows[2..].iter().all(|row| row.interval == record.rows[1].interval));
    }

    #[test]
    fn reversing_twice_gives_the_record_back() {
        let time = vec![0.0, 1.0, 1.5, 3.0, 4.0, 6.0, 6.5, 7.0, 9.0];
        let heading = (0..9).map(|row| 0.02 * f64::from(row)).collect();
        let rudder = (0..9).map(|row| 0.1 * f64::from(row % 3)).collect();
        let record = SrivcRecord::new(&record("uneven", time, heading, rudder));
        let reversed = record.reversed();
        assert_eq!(reversed.rows[1].interval, 2.0);
        assert_eq!(reversed.reversed(), record);
    }
}
