//! Prepared record of a trial: from its first to its last heading, channels as signals, dense rows averaged.
//!
//! Averaging the same rows of all channels keeps the relation between rudder and heading, because a linear filter
//! commutes with a linear response. Rows are averaged only if headings are far denser than the response, and only for
//! the search; reported errors use all rows. A single heading among several rows of the rudder is not averaged, and the
//! rudder there keeps a finer resolution. Every row stores the number of its readings and has their mean time.

use std::f64::consts::{PI, TAU};

use ship::replay::RecordedSignals;
use ship::{Polyline, Real, RegressorChannel, Replayable};
use trial::{Channel, Trial};

/// Minimum number of rows after averaging.
const MIN_ROWS: usize = 300;

/// Minimum number of rows after averaging per ship time L/U, or per tenth of the record if that is shorter.
const MIN_ROWS_PER_TIME: f64 = 10.0;

/// Maximum number of rows after averaging.
const MAX_ROWS: usize = 4000;

/// Maximum number of rudder rows per heading row, if the rudder was recorded more often.
const MAX_RUDDER_ROWS_PER_HEADING: usize = 5;

/// Maximum interval within a group of averaged rows, in usual sampling periods.
const MAX_GAP_PERIODS: f64 = 3.0;

/// Minimum share of finite rows of a usable channel.
const MIN_FINITE_SHARE: f64 = 0.5;

/// Record ready to be replayed.
#[derive(Debug, Clone)]
pub struct PreparedRecord {
    /// Times of the rows, s.
    pub time: Vec<f64>,
    /// Heading of the rows, rad, the mean of their readings; NaN if it was not recorded.
    pub heading: Vec<f64>,
    /// Number of heading readings averaged in every row.
    pub row_readings: Vec<usize>,
    /// Number of heading readings of a complete row.
    pub full_readings: usize,
    /// Indices of the rows with a heading.
    pub observed_rows: Vec<usize>,
    /// Usual time between rows, s.
    pub spacing: f64,
    /// Usual time between values of the rudder, s.
    pub rudder_spacing: f64,
    /// Rudder angle, rad.
    pub rudder: Polyline,
    /// Speed, m/s, measured or computed from surge and sway velocity; `None` if fewer than half of the rows have it.
    pub speed: Option<Polyline>,
    /// Sway velocity, m/s; `None` if fewer than half of the rows have it.
    pub sway_velocity: Option<Polyline>,
    /// Relative wind speed, m/s, measured or computed from the true wind; `None` unless at least half of the rows have
    /// speed and direction.
    pub wind_speed: Option<Polyline>,
    /// Direction from which the relative wind comes, rad from the bow, unwrapped; `None` as for the wind speed.
    pub wind_from: Option<Polyline>,
    /// Propeller revolutions, 1/s; `None` if fewer than half of the rows have them.
    pub propeller_rate: Option<Polyline>,
}

impl PreparedRecord {
    /// Record averaged to about `MIN_ROWS_PER_TIME` rows per `ship_length_time` (L/U, s), within `MIN_ROWS` and
    /// `MAX_ROWS`.
    pub fn averaged(trial: &Trial, ship_length_time: f64) -> Self {
        let rows =
            trial.observed_rows().last().zip(trial.observed_rows().next()).map_or(0, |(last, first)| last - first + 1);
        let per_heading = (rows / trial.observed_rows().count().max(1)).max(1);
        let headings = trial.len() / per_heading;
        // Trial rows per averaged row.
        let share = ship_length_time.min(0.1 * trial.duration()) / (MIN_ROWS_PER_TIME * trial.sampling_period());
        let group = ((share / per_heading as f64) as usize).min(headings / MIN_ROWS).max(1);
        let group = group.max(headings.div_ceil(MAX_ROWS));
        let rudder = if group == 1 && per_heading > 1 {
            let fine = (share / MAX_RUDDER_ROWS_PER_HEADING as f64) as usize;
            fine.max(trial.len().div_ceil(MAX_RUDDER_ROWS_PER_HEADING * MAX_ROWS)).clamp(1, per_heading)
        } else {
            group * per_heading
        };
        Self::new(trial, group, group * per_heading, rudder)
    }

    /// Prepared record with all rows of a trial, without averaging.
    pub fn unaveraged(trial: &Trial) -> Self {
        Self::new(trial, 1, 1, 1)
    }

    /// Averages `heading_rows` rows per heading, which hold `full_readings` readings when complete, and `signal_rows`
    /// rows per value of every other channel.
    fn new(trial: &Trial, full_readings: usize, heading_rows: usize, signal_rows: usize) -> Self {
        let first = trial.observed_rows().next().unwrap_or(0);
        let last = trial.observed_rows().last().unwrap_or(0);
        let period = trial.sampling_period();
        let grouped = |count| groups(&trial.time()[first..=last], count, MAX_GAP_PERIODS * period);
        let (mut time, mut heading, mut readings) = (Vec::new(), Vec::new(), Vec::new());
        for (from, to) in grouped(heading_rows) {
            let rows = first + from..first + to;
            let read: Vec<usize> = rows.clone().filter(|&row| trial.heading()[row].is_finite()).collect();
            let mean_of = |values: &[f64]| read.iter().map(|&row| values[row]).sum::<f64>() / read.len() as f64;
            // A row without readings has the mean of all its times.
            time.push(if read.is_empty() { mean(&trial.time()[rows]) } else { mean_of(trial.time()) });
            heading.push(if read.is_empty() { f64::NAN } else { mean_of(trial.heading()) });
            readings.push(read.len());
        }
        let observed = (0..time.len()).filter(|&row| heading[row].is_finite()).collect();

        let signals = grouped(signal_rows);
        let take = |values: &[f64]| -> Vec<f64> {
            signals.iter().map(|&(from, to)| mean(&values[first + from..first + to])).collect()
        };
        let signal_time = take(trial.time());
        let channel = |channel| trial.channel(channel).map(&take);
        let signal = |values: Option<Vec<f64>>| values.and_then(|values| signal(&signal_time, &values));
        let speed = channel(Channel::Speed).or_else(|| {
            let (surge, sway) = (channel(Channel::Surge)?, channel(Channel::Sway)?);
            Some(surge.iter().zip(&sway).map(|(u, v)| u.hypot(*v)).collect())
        });
        let relative = trial.relative_wind();
        let wind = relative
            .and_then(|[speed, from]| Some((signal(Some(take(&speed)))?, signal(Some(take(&unwrapped(&from))))?)));
        let (wind_speed, wind_from) = wind.unzip();
        Self {
            row_readings: readings,
            full_readings,
            observed_rows: observed,
            spacing: period * heading_rows as f64,
            rudder_spacing: period * signal_rows as f64,
            speed: signal(speed),
            sway_velocity: signal(channel(Channel::Sway)),
            wind_speed,
            wind_from,
            propeller_rate: signal(channel(Channel::PropellerRate)),
            rudder: Polyline::new(signal_time, take(trial.rudder())).expect("means of increasing times increase"),
            time,
            heading,
        }
    }

    /// Input signals of the replay of a ship, reduced to the required signals.
    pub fn replay_signals<R: Real>(&self, ship: &(impl Replayable<R> + ?Sized)) -> RecordedSignals<'_> {
        let needed = |channel| ship.needs(channel);
        RecordedSignals {
            rudder: &self.rudder,
            speed: self.speed.as_ref().filter(|_| needed(RegressorChannel::Speed)),
            sway: self.sway_velocity.as_ref().filter(|_| needed(RegressorChannel::Sway)),
            wind_speed: self.wind_speed.as_ref().filter(|_| needed(RegressorChannel::Wind)),
            wind_from: self.wind_from.as_ref().filter(|_| needed(RegressorChannel::Wind)),
            propeller_rate: self.propeller_rate.as_ref().filter(|_| needed(RegressorChannel::Propeller)),
        }
    }

    /// Duration, s.
    pub fn duration(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }
}

/// Ranges of averaged rows: `group` rows each, fewer before a gap.
fn groups(time: &[f64], group: usize, gap: f64) -> Vec<(usize, usize)> {
    let mut groups = Vec::new();
    let mut from = 0;
    for row in 1..=time.len() {
        if row == time.len() || row - from == group || time[row] - time[row - 1] > gap {
            groups.push((from, row));
            from = row;
        }
    }
    groups
}

/// Mean of the finite values; NaN unless more than half are finite.
fn mean(values: &[f64]) -> f64 {
    let (sum, count) = values.iter().filter(|x| x.is_finite()).fold((0.0, 0usize), |(sum, n), x| (sum + x, n + 1));
    if 2 * count > values.len() { sum / count as f64 } else { f64::NAN }
}

/// Signal through the finite values; `None` if too few are finite.
fn signal(time: &[f64], values: &[f64]) -> Option<Polyline> {
    let finite: Vec<usize> = (0..time.len()).filter(|&row| values[row].is_finite()).collect();
    if (finite.len() as f64) < MIN_FINITE_SHARE * time.len() as f64 {
        return None;
    }
    let pick = |from: &[f64]| finite.iter().map(|&row| from[row]).collect::<Vec<_>>();
    Polyline::new(pick(time), pick(values)).ok()
}

/// Angles without jumps of 2π, rad; NaN values are kept and skipped.
fn unwrapped(angles: &[f64]) -> Vec<f64> {
    let mut last = None;
    angles
        .iter()
        .map(|&angle| {
            if !angle.is_finite() {
                return angle;
            }
            let near = last.map_or(angle, |last: f64| last + (angle - last + PI).rem_euclid(TAU) - PI);
            last = Some(near);
            near
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::of_columns;

    #[test]
    fn groups_end_at_gaps() {
        assert_eq!(groups(&[0.0, 1.0, 2.0, 9.0, 10.0], 2, 3.0), [(0, 2), (2, 3), (3, 5)]);
        assert_eq!(groups(&[0.0, 1.0], 1, 3.0), [(0, 1), (1, 2)]);
    }

    /// A mean of readings has the mean of their times and stores their number.
    #[test]
    fn every_heading_counts() {
        let time: Vec<f64> = (0..6000).map(|k| 0.1 * f64::from(k)).collect();
        let heading = time.iter().enumerate().map(|(k, t)| if k % 4 == 1 { f64::NAN } else { 0.01 * t }).collect();
        let rudder = time.iter().map(|t| 0.1 * (0.1 * t).sin()).collect();
        let record = PreparedRecord::averaged(&of_columns(time, heading, rudder), 10.0);
        assert_eq!((record.full_readings, record.row_readings.iter().sum::<usize>()), (9, 4500));
        for (&time, &heading) in record.time.iter().zip(&record.heading) {
            assert!((heading - 0.01 * time).abs() < 1e-12);
        }
    }

    /// Single headings are not averaged, and the rudder between them keeps a finer resolution.
    #[test]
    fn a_heading_among_rows_of_the_rudder_is_no_mean() {
        let time: Vec<f64> = (0..6001).map(|k| 0.1 * f64::from(k)).collect();
        let heading = time.iter().enumerate().map(|(k, t)| if k % 10 == 0 { 0.01 * t } else { f64::NAN }).collect();
        let rudder = time.iter().map(|t| 0.1 * (0.1 * t).sin()).collect();
        let record = PreparedRecord::averaged(&of_columns(time, heading, rudder), 16.0);
        assert_eq!((record.full_readings, record.observed_rows.len(), record.rudder.values().len()), (1, 601, 2001));
        assert!(record.observed_rows.iter().all(|&row| record.row_readings[row] == 1));
    }

    #[test]
    fn angles_do_not_jump() {
        let back = unwrapped(&[3.0, -3.0, f64::NAN, 3.1]);
        assert!((back[1] - (TAU - 3.0)).abs() < 1e-12 && (back[3] - 3.1).abs() < 1e-12);
    }
}
