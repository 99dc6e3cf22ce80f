//! A trial as tracing needs it: from its first to its last heading, every channel as a signal, and dense rows averaged.
//!
//! Averaging the same rows of all channels keeps the relation between rudder and heading, because a response that is
//! linear does not care whether it is filtered before or after. It is done only where rows are far denser than the
//! response, and only for the search; errors are always those of all rows.

use std::f64::consts::{PI, TAU};

use ship::replay::Recorded;
use ship::{Polyline, Real, Regressor, Response};
use trial::{Channel, Trial};

/// Rows that are kept at least, however dense they are.
const FEWEST_ROWS: usize = 400;

/// Rows per time constant that are kept at least.
const ROWS_PER_TIME: f64 = 20.0;

/// Rows that are kept at most.
const MOST_ROWS: usize = 4000;

/// An interval of more than this many usual ones ends a group of rows that are averaged.
const GAP: f64 = 3.0;

/// Smallest share of rows in which a channel has to be there to be used.
const SMALLEST_SHARE: f64 = 0.5;

/// One record, ready to be replayed.
#[derive(Debug, Clone)]
pub struct Record {
    /// Name of the trial.
    pub name: String,
    /// Times of the rows, s.
    pub time: Vec<f64>,
    /// Heading of the rows, rad; NaN where it was not recorded.
    pub heading: Vec<f64>,
    /// Rows with a heading.
    pub observed: Vec<usize>,
    /// Usual time between rows, s.
    pub spacing: f64,
    rudder: Polyline,
    speed: Option<Polyline>,
    sway: Option<Polyline>,
    wind_speed: Option<Polyline>,
    wind_from: Option<Polyline>,
    propeller: Option<Polyline>,
}

impl Record {
    /// Takes a trial with its rows averaged down to twenty per `time` (s, the time constant of the base), but to no fewer
    /// than 400 and no more than 4000.
    pub fn averaged(trial: &Trial, time: f64) -> Self {
        let longest = time.min(0.1 * trial.duration()) / (ROWS_PER_TIME * trial.sampling_period());
        let group = (longest as usize).min(trial.len() / FEWEST_ROWS).max(1);
        Self::new(trial, group.max(trial.len().div_ceil(MOST_ROWS)))
    }

    /// Takes a trial with all its rows.
    pub fn whole(trial: &Trial) -> Self {
        Self::new(trial, 1)
    }

    fn new(trial: &Trial, group: usize) -> Self {
        let first = trial.observed_rows().next().unwrap_or(0);
        let last = trial.observed_rows().last().unwrap_or(0);
        let spacing = trial.sampling_period();
        let groups = groups(&trial.time()[first..=last], group, GAP * spacing);
        let take = |values: &[f64]| -> Vec<f64> {
            groups.iter().map(|&(from, to)| mean(&values[first + from..first + to])).collect()
        };
        let time = take(trial.time());
        let heading = take(trial.heading());
        let channel = |channel| trial.channel(channel).map(&take);
        let signal = |values: Option<Vec<f64>>| values.and_then(|values| signal(&time, &values));
        let speed = channel(Channel::Speed).or_else(|| {
            let (surge, sway) = (channel(Channel::Surge)?, channel(Channel::Sway)?);
            Some(surge.iter().zip(&sway).map(|(u, v)| u.hypot(*v)).collect())
        });
        let relative = match (trial.channel(Channel::WindRelativeSpeed), trial.channel(Channel::WindRelativeFrom)) {
            (Some(speed), Some(from)) => Some((take(speed), take(&unwrapped(from)))),
            _ => relative_wind(trial).map(|(speed, from)| (take(&speed), take(&unwrapped(&from)))),
        };
        let (wind_speed, wind_from) = relative.unzip();
        let observed = (0..time.len()).filter(|&row| heading[row].is_finite()).collect();
        Self {
            name: trial.name().into(),
            observed,
            spacing: spacing * group as f64,
            rudder: Polyline::new(time.clone(), take(trial.rudder())).expect("means of increasing times increase"),
            speed: signal(speed),
            sway: signal(channel(Channel::Sway)),
            wind_speed: signal(wind_speed),
            wind_from: signal(wind_from),
            propeller: signal(channel(Channel::PropellerRate)),
            time,
            heading,
        }
    }

    /// The same record with the headings of a range of times taken away.
    pub fn without(&self, from: f64, to: f64) -> Self {
        let mut other = self.clone();
        other.observed.retain(|&row| !(from..to).contains(&self.time[row]));
        other
    }

    /// The signals that drive a replay of a response: those it needs.
    pub fn recorded<R: Real>(&self, response: &Response<R>) -> Recorded<'_> {
        let needed = |channel| response.needs(channel);
        Recorded {
            rudder: &self.rudder,
            speed: self.speed.as_ref().filter(|_| needed(Regressor::Speed)),
            sway: self.sway.as_ref().filter(|_| needed(Regressor::Sway)),
            wind_speed: self.wind_speed.as_ref().filter(|_| needed(Regressor::Wind)),
            wind_from: self.wind_from.as_ref().filter(|_| needed(Regressor::Wind)),
            propeller: self.propeller.as_ref().filter(|_| needed(Regressor::Propeller)),
        }
    }

    /// Rudder angle of the rows, rad.
    pub fn rudder(&self) -> &[f64] {
        self.rudder.values()
    }

    /// Speed, m/s, as a signal.
    pub fn speed(&self) -> Option<&Polyline> {
        self.speed.as_ref()
    }

    /// Propeller revolutions, 1/s, as a signal.
    pub fn propeller(&self) -> Option<&Polyline> {
        self.propeller.as_ref()
    }

    /// Relative wind speed, m/s, as a signal, where its direction is there as well; measured, or computed from the true one.
    pub fn wind_speed(&self) -> Option<&Polyline> {
        self.wind_speed.as_ref().filter(|_| self.wind_from.is_some())
    }

    /// Sway velocity, m/s, as a signal.
    pub fn sway(&self) -> Option<&Polyline> {
        self.sway.as_ref()
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

/// Relative wind (speed, direction from the bow) from the true one, the heading and the speed of the ship.
fn relative_wind(trial: &Trial) -> Option<(Vec<f64>, Vec<f64>)> {
    let speed = trial.channel(Channel::WindTrueSpeed)?;
    let from = trial.channel(Channel::WindTrueFrom)?;
    let ship = trial.channel(Channel::Speed)?;
    let rows = (0..trial.len()).map(|row| {
        let angle = from[row] - trial.heading()[row];
        let (across, ahead) = (speed[row] * angle.sin(), speed[row] * angle.cos() + ship[row]);
        (across.hypot(ahead), across.atan2(ahead))
    });
    Some(rows.unzip())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_end_at_gaps() {
        assert_eq!(groups(&[0.0, 1.0, 2.0, 9.0, 10.0], 2, 3.0), [(0, 2), (2, 3), (3, 5)]);
        assert_eq!(groups(&[0.0, 1.0], 1, 3.0), [(0, 1), (1, 2)]);
    }

    #[test]
    fn angles_do_not_jump() {
        let back = unwrapped(&[3.0, -3.0, f64::NAN, 3.1]);
        assert!((back[1] - (TAU - 3.0)).abs() < 1e-12 && (back[3] - 3.1).abs() < 1e-12);
    }
}
