//! A trial as tracing needs it: from its first to its last heading, every channel as a signal, and dense rows averaged.
//!
//! Averaging the same rows of all channels keeps the relation between rudder and heading, because a response that is
//! linear does not care whether it is filtered before or after. It is done only where headings are far denser than the
//! response, and only for the search; errors are always those of all rows. A heading that stands alone among rows of
//! the rudder is not averaged, and the rudder about it keeps its detail. Every heading counts: a row knows how many
//! readings it is the mean of, and stands at their mean time.

use std::f64::consts::{PI, TAU};

use ship::replay::Recorded;
use ship::{Polyline, Real, Regressor, Replayable};
use trial::{Channel, Trial};

/// Rows that are kept at least, however dense they are.
const FEWEST_ROWS: usize = 300;

/// Rows per time constant that are kept at least.
const ROWS_PER_TIME: f64 = 10.0;

/// Rows that are kept at most.
const MOST_ROWS: usize = 4000;

/// Rows of the rudder for one of the heading that are kept at most, where the rudder was recorded more often.
const FINER: usize = 5;

/// An interval of more than this many usual ones ends a group of rows that are averaged.
const GAP: f64 = 3.0;

/// Smallest share of rows in which a channel has to be there to be used.
const SMALLEST_SHARE: f64 = 0.5;

/// One record, ready to be replayed.
#[derive(Debug, Clone)]
pub struct PreparedRecord {
    /// Times of the rows, s.
    pub time: Vec<f64>,
    /// Heading of the rows, rad, the mean of their readings; NaN where it was not recorded.
    pub heading: Vec<f64>,
    /// Number of readings behind the heading of every row.
    pub readings: Vec<usize>,
    /// Number of readings behind the heading of a row in which none is missing.
    pub full_readings: usize,
    /// Rows with a heading.
    pub observed: Vec<usize>,
    /// Usual time between rows, s.
    pub spacing: f64,
    /// Usual time between values of the rudder, s.
    pub rudder_spacing: f64,
    /// Rudder angle, rad.
    pub rudder: Polyline,
    /// Speed, m/s.
    pub speed: Option<Polyline>,
    /// Sway velocity, m/s.
    pub sway: Option<Polyline>,
    /// Relative wind speed, m/s, measured or computed from the true one, where its direction is there as well.
    pub wind_speed: Option<Polyline>,
    /// Direction from which the relative wind comes, rad from the bow, where its speed is there as well.
    pub wind_from: Option<Polyline>,
    /// Propeller revolutions, 1/s.
    pub propeller: Option<Polyline>,
}

impl PreparedRecord {
    /// Takes a trial with its headings averaged down to twenty per `time` (s, the time constant of the base), but to no
    /// fewer than 400 and no more than 4000.
    pub fn averaged(trial: &Trial, time: f64) -> Self {
        let rows =
            trial.observed_rows().last().zip(trial.observed_rows().next()).map_or(0, |(last, first)| last - first + 1);
        let per_heading = (rows / trial.observed_rows().count().max(1)).max(1);
        let headings = trial.len() / per_heading;
        // Rows of the trial for one that is kept.
        let share = time.min(0.1 * trial.duration()) / (ROWS_PER_TIME * trial.sampling_period());
        let group = ((share / per_heading as f64) as usize).min(headings / FEWEST_ROWS).max(1);
        let group = group.max(headings.div_ceil(MOST_ROWS));
        let rudder = if group == 1 && per_heading > 1 {
            let fine = (share / FINER as f64) as usize;
            fine.max(trial.len().div_ceil(FINER * MOST_ROWS)).clamp(1, per_heading)
        } else {
            group * per_heading
        };
        Self::new(trial, group, group * per_heading, rudder)
    }

    /// Takes a trial with all its rows.
    pub fn whole(trial: &Trial) -> Self {
        Self::new(trial, 1, 1, 1)
    }

    /// Takes a trial with `of_heading` rows averaged for a heading, in which there are `full_readings` of them, and
    /// `of_rudder` rows for a value of every other channel.
    fn new(trial: &Trial, full_readings: usize, of_heading: usize, of_rudder: usize) -> Self {
        let first = trial.observed_rows().next().unwrap_or(0);
        let last = trial.observed_rows().last().unwrap_or(0);
        let period = trial.sampling_period();
        let grouped = |count| groups(&trial.time()[first..=last], count, GAP * period);
        let (mut time, mut heading, mut readings) = (Vec::new(), Vec::new(), Vec::new());
        for (from, to) in grouped(of_heading) {
            let rows = first + from..first + to;
            let read: Vec<usize> = rows.clone().filter(|&row| trial.heading()[row].is_finite()).collect();
            let mean_of = |values: &[f64]| read.iter().map(|&row| values[row]).sum::<f64>() / read.len() as f64;
            // Without any, a row stands at the mean of all times.
            time.push(if read.is_empty() { mean(&trial.time()[rows]) } else { mean_of(trial.time()) });
            heading.push(if read.is_empty() { f64::NAN } else { mean_of(trial.heading()) });
            readings.push(read.len());
        }
        let observed = (0..time.len()).filter(|&row| heading[row].is_finite()).collect();

        let signals = grouped(of_rudder);
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
            readings,
            full_readings,
            observed,
            spacing: period * of_heading as f64,
            rudder_spacing: period * of_rudder as f64,
            speed: signal(speed),
            sway: signal(channel(Channel::Sway)),
            wind_speed,
            wind_from,
            propeller: signal(channel(Channel::PropellerRate)),
            rudder: Polyline::new(signal_time, take(trial.rudder())).expect("means of increasing times increase"),
            time,
            heading,
        }
    }

    /// The signals that drive a replay of a ship: those it needs.
    pub fn recorded<R: Real>(&self, ship: &(impl Replayable<R> + ?Sized)) -> Recorded<'_> {
        let needed = |channel| ship.needs(channel);
        Recorded {
            rudder: &self.rudder,
            speed: self.speed.as_ref().filter(|_| needed(Regressor::Speed)),
            sway: self.sway.as_ref().filter(|_| needed(Regressor::Sway)),
            wind_speed: self.wind_speed.as_ref().filter(|_| needed(Regressor::Wind)),
            wind_from: self.wind_from.as_ref().filter(|_| needed(Regressor::Wind)),
            propeller: self.propeller.as_ref().filter(|_| needed(Regressor::Propeller)),
        }
    }

    /// Length in time, s.
    pub fn duration(&self) -> f64 {
        self.time[self.time.len() - 1] - self.time[0]
    }
}

/// Ranges of rows that are averaged: `group` of them, fewer before a gap.
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

/// Mean of the values that are there; NaN when fewer than half are.
fn mean(values: &[f64]) -> f64 {
    let (sum, count) = values.iter().filter(|x| x.is_finite()).fold((0.0, 0usize), |(sum, n), x| (sum + x, n + 1));
    if 2 * count > values.len() { sum / count as f64 } else { f64::NAN }
}

fn signal(time: &[f64], values: &[f64]) -> Option<Polyline> {
    let there: Vec<usize> = (0..time.len()).filter(|&row| values[row].is_finite()).collect();
    if (there.len() as f64) < SMALLEST_SHARE * time.len() as f64 {
        return None;
    }
    let pick = |from: &[f64]| there.iter().map(|&row| from[row]).collect::<Vec<_>>();
    Polyline::new(pick(time), pick(values)).ok()
}

/// Angles without jumps of a whole turn; a missing one keeps the turn of the last.
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

    /// A mean of what was read stands at the mean of the times at which it was read, and knows how many they were.
    #[test]
    fn every_heading_counts() {
        let time: Vec<f64> = (0..6000).map(|k| 0.1 * f64::from(k)).collect();
        let heading = time.iter().enumerate().map(|(k, t)| if k % 4 == 1 { f64::NAN } else { 0.01 * t }).collect();
        let rudder = time.iter().map(|t| 0.1 * (0.1 * t).sin()).collect();
        let record = PreparedRecord::averaged(&of_columns(time, heading, rudder), 10.0);
        assert_eq!((record.full_readings, record.readings.iter().sum::<usize>()), (9, 4500));
        for (&time, &heading) in record.time.iter().zip(&record.heading) {
            assert!((heading - 0.01 * time).abs() < 1e-12);
        }
    }

    /// Headings that stand alone are kept as they are, with a finer rudder between them.
    #[test]
    fn a_heading_among_rows_of_the_rudder_is_no_mean() {
        let time: Vec<f64> = (0..6001).map(|k| 0.1 * f64::from(k)).collect();
        let heading = time.iter().enumerate().map(|(k, t)| if k % 10 == 0 { 0.01 * t } else { f64::NAN }).collect();
        let rudder = time.iter().map(|t| 0.1 * (0.1 * t).sin()).collect();
        let record = PreparedRecord::averaged(&of_columns(time, heading, rudder), 16.0);
        assert_eq!((record.full_readings, record.observed.len(), record.rudder.values().len()), (1, 601, 2001));
        assert!(record.observed.iter().all(|&row| record.readings[row] == 1));
    }

    #[test]
    fn angles_do_not_jump() {
        let back = unwrapped(&[3.0, -3.0, f64::NAN, 3.1]);
        assert!((back[1] - (TAU - 3.0)).abs() < 1e-12 && (back[3] - 3.1).abs() < 1e-12);
    }
}
