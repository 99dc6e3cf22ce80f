//! Where the rudder of a log rests: holds of rows about one angle, whatever the noise, the rounding and the spikes
//! of the channel. Which of them belong to a manoeuvre is not decided here.

use std::ops::RangeInclusive;

use super::course::{middle, thinned};
use estimation::statistics::median;

/// Narrowest band about a level in which the rudder rests, rad: orders and feedback agree to about half a degree.
const NARROWEST_BAND: f64 = 0.5_f64.to_radians();

/// Widest such band that noise and rounding may ask for, rad: steering by an autopilot is no noise.
const WIDEST_BAND: f64 = 1.5_f64.to_radians();

/// Half-width of the band as a share of its level.
const BAND: f64 = 0.11;

/// Differences that no rudder angle is read to, rad.
const RESOLUTION: f64 = 0.05_f64.to_radians();

/// Largest rudder angle that may keep a straight course, rad.
const LARGEST_NEUTRAL: f64 = 2.5_f64.to_radians();

/// Difference of neighbouring holds that are taken together, as a share of the larger level.
const SAME_LEVEL: f64 = 0.15;

/// Pause between such holds as a share of their time together.
const SHORT_PAUSE: f64 = 0.5;

/// A rest shorter than this share of another is no hold beside it.
const SHORT: f64 = 0.2;

/// Rows off the level that do not end a hold.
const STRAY_ROWS: usize = 2;

/// Fewest rows of a hold.
const FEWEST_ROWS: usize = 3;

/// A step between rows of so many usual ones ends a hold: nobody knows what the rudder did meanwhile.
const GAP: f64 = 30.0;

/// A hold of rows with the rudder at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hold {
    /// First row.
    pub first: usize,
    /// Last row.
    pub last: usize,
    /// Time of the first row, s.
    pub from: f64,
    /// Time of the last row, s.
    pub until: f64,
    /// Middle of its rudder angles, rad.
    pub level: f64,
}

impl Hold {
    /// Time at rest, s.
    pub fn duration(&self) -> f64 {
        self.until - self.from
    }

    /// Both and what is between them; the level is that of the longer.
    pub fn joined(self, later: Self) -> Self {
        let level = if later.duration() > self.duration() { later.level } else { self.level };
        Self { last: later.last, until: later.until, level, ..self }
    }
}

/// The rudder of a log and where it rests.
#[derive(Debug)]
pub(crate) struct Rest {
    /// Rudder angle without spikes of one row, rad.
    pub angle: Vec<f64>,
    /// Standard deviation of the rudder noise, rad.
    pub noise: f64,
    /// Half-width of the narrowest band in which the rudder rests, rad.
    pub floor: f64,
    /// Usual time between rows, s; 0 for less than two rows.
    pub step: f64,
    /// Rudder angle of a straight course, rad: what the rudder has mostly, or 0 where that is no small angle.
    pub neutral: f64,
    /// Every hold, in order.
    pub holds: Vec<Hold>,
    /// The same with neighbours of nearly the same level taken together.
    pub merged: Vec<Hold>,
}

impl Rest {
    /// Fails never; a log of less than three rows has no holds.
    pub fn of(time: &[f64], rudder: &[f64]) -> Self {
        let angle = without_spikes(rudder);
        let step = usual(time.windows(2).map(|pair| pair[1] - pair[0]));
        // Second differences see noise and no movement; those of white noise have six times its variance.
        let noise = 1.4826 / 6.0_f64.sqrt() * usual(rudder.windows(3).map(|x| (x[0] - 2.0 * x[1] + x[2]).abs()));
        let quantum = smallest_steps(rudder);
        let floor = (3.0 * noise).max(1.1 * quantum).clamp(NARROWEST_BAND, WIDEST_BAND);
        let most = usual(angle.iter().copied());
        let neutral = if most.abs() <= LARGEST_NEUTRAL { most } else { 0.0 };
        let mut rest = Self { angle, noise, floor, step, neutral, holds: Vec::new(), merged: Vec::new() };
        rest.holds = rest.cut(time);
        rest.merged = rest.merged();
        rest
    }

    /// Whether the rudder of a hold is that of a straight course.
    pub fn is_amidships(&self, hold: &Hold) -> bool {
        hold.level.abs().min((hold.level - self.neutral).abs()) < self.floor
    }

    /// Cuts the log where the rudder leaves the band about the mean of the rows since the last cut.
    fn cut(&self, time: &[f64]) -> Vec<Hold> {
        let mut holds = Vec::new();
        let (mut first, mut last, mut sum, mut count) = (0, 0, 0.0, 0.0);
        for row in 0..self.angle.len() {
            let gap = row > 0 && time[row] - time[row - 1] > GAP * self.step;
            let level: f64 = sum / count;
            let band = self.floor.max(BAND * level.abs());
            let inside = |row: usize| self.angle.get(row).is_some_and(|x| (x - level).abs() <= band);
            if count > 0.0 && !gap && !inside(row) && (row + 1..=row + STRAY_ROWS).any(inside) {
                continue;
            }
            if count > 0.0 && (gap || !inside(row)) {
                holds.extend(self.hold(time, first, last, band));
                (first, sum, count) = (row, 0.0, 0.0);
            }
            (sum, count, last) = (sum + self.angle[row], count + 1.0, row);
        }
        if count > 0.0 {
            let band = self.floor.max(BAND * (sum / count).abs());
            holds.extend(self.hold(time, first, last, band));
        }
        holds
    }

    /// The holds with neighbours of nearly the same level taken together, and what little is between them.
    fn merged(&self) -> Vec<Hold> {
        let mut merged: Vec<Hold> = Vec::new();
        for &next in &self.holds {
            // What is short beside both is a pause or the end of a movement; beside hours on a straight course
            // everything is short.
            if let [.., before, between] = merged.as_slice()
                && between.duration() < SHORT * before.duration().min(next.duration())
                && !self.is_amidships(before)
                && is_same(before, &next, self.floor)
            {
                merged.pop();
            }
            match merged.last_mut() {
                Some(last) if is_same(last, &next, self.floor) => *last = last.joined(next),
                _ => merged.push(next),
            }
        }
        merged
    }

    /// The rows of a cut without the ends of the movements about them; `None` where the rudder moved all the time.
    fn hold(&self, time: &[f64], first: usize, last: usize, band: f64) -> Option<Hold> {
        if last + 1 - first < FEWEST_ROWS {
            return None;
        }
        let half = (last + 1 - first) / 2;
        let (early, late) = (&self.angle[first..first + half], &self.angle[last + 1 - half..=last]);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        // A steady movement through the band has halves that are a band apart.
        if (mean(early) - mean(late)).abs() > 0.5 * band {
            return None;
        }
        let level = middle(&self.angle[first..=last])?;
        let (early, late) = (self.settled(early, band)?, self.settled(late, band)?);
        let begin = (first..=last).find(|&row| early.contains(&self.angle[row]))?;
        let end = (begin..=last).rev().find(|&row| late.contains(&self.angle[row]))?;
        (end + 1 - begin >= FEWEST_ROWS).then_some(Hold {
            first: begin,
            last: end,
            from: time[begin],
            until: time[end],
            level,
        })
    }

    /// Angles that most of these values have: what is beyond them has begun to move.
    fn settled(&self, values: &[f64], band: f64) -> Option<RangeInclusive<f64>> {
        let level = middle(values)?;
        let mut off: Vec<f64> = thinned(values).iter().map(|x| (x - level).abs()).collect();
        off.sort_unstable_by(f64::total_cmp);
        let most = 1.3 * off[(off.len() - 1) * 9 / 10];
        let reach = most.max(2.5 * self.noise).max(0.01 * level.abs()).max(RESOLUTION).min(band);
        Some(level - reach..=level + reach)
    }
}

fn is_same(a: &Hold, b: &Hold, floor: f64) -> bool {
    let (shorter, longer) = (a.duration().min(b.duration()), a.duration().max(b.duration()));
    // The end of a movement is near the level, too.
    let tolerance =
        if shorter < SHORT * longer { 0.5 * floor } else { floor.max(SAME_LEVEL * a.level.abs().max(b.level.abs())) };
    (a.level - b.level).abs() <= tolerance && b.from - a.until <= SHORT_PAUSE * (a.duration() + b.duration())
}

/// Every value with its two neighbours, the middle of the three.
fn without_spikes(values: &[f64]) -> Vec<f64> {
    let mut calm = values.to_vec();
    for (row, x) in values.windows(3).enumerate() {
        calm[row + 1] = x[0].max(x[1]).min(x[0].min(x[1]).max(x[2]));
    }
    calm
}

/// Median of the finite values, 0 of none.
pub(crate) fn usual(values: impl Iterator<Item = f64>) -> f64 {
    median(&mut values.filter(|x| x.is_finite()).collect::<Vec<f64>>()).unwrap_or(0.0)
}

/// Step of a rounded rudder that flickers, rad: one of the smallest differences between rows; 0 where the rudder seldom
/// changes at all.
fn smallest_steps(rudder: &[f64]) -> f64 {
    let steps = rudder.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    // Values that differ by rounding of the arithmetic are the same.
    let mut steps: Vec<f64> = steps.filter(|step| *step > 1e-9).collect();
    if steps.len() <= rudder.len() / 50 {
        return 0.0;
    }
    let smallest = steps.len() / 20;
    *steps.select_nth_unstable_by(smallest, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use ship::angle::from_deg;

    /// Ramps of a degree a row between 0, 20 and -20; spikes, a dip of two rows, and whole degrees that flicker.
    #[test]
    fn a_rudder_rests_between_its_movements() {
        let ramp = |from: i32, to: i32| -> Vec<f64> {
            let step = (to - from).signum();
            (1..(to - from).abs()).map(|k| f64::from(from + step * k)).collect()
        };
        let mut degrees =
            [vec![0.0; 60], ramp(0, 20), vec![20.0; 80], ramp(20, -20), vec![-20.0; 80], ramp(-20, 0), vec![0.0; 60]]
                .concat();
        degrees[30] = 99.0;
        degrees[100] = 0.0;
        degrees[110..112].fill(13.0);
        let rows = [(0, 59), (79, 158), (198, 277), (297, 356)];
        let time: Vec<f64> = (0..degrees.len()).map(|row| row as f64).collect();
        for sign in [1.0, -1.0] {
            let rudder: Vec<f64> = degrees.iter().map(|x| sign * from_deg(*x)).collect();
            let rest = Rest::of(&time, &rudder);
            let found: Vec<(usize, usize)> = rest.merged.iter().map(|hold| (hold.first, hold.last)).collect();
            assert_eq!(found, rows);
            assert_eq!(rest.merged[2].level, -sign * from_deg(20.0));
        }
    }
}
