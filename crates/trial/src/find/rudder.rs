//! Holds of the rudder in a log: rows about one angle, robust against noise, rounding and spikes of the channel. The
//! patterns of holds of each manoeuvre are in the neighbouring modules.

use std::ops::RangeInclusive;

use super::headings::{thinned, thinned_median};
use estimation::statistics::median;

/// Minimum half-width of the band of a hold, rad: orders and feedback agree to about half a degree.
const MIN_BAND: f64 = 0.5_f64.to_radians();

/// Maximum half-width for noise and rounding, rad: larger movements are steering.
const MAX_BAND: f64 = 1.5_f64.to_radians();

/// Half-width of the band of a hold as a share of the level.
const BAND_SHARE: f64 = 0.11;

/// Resolution of a rudder angle, rad.
const RESOLUTION: f64 = 0.05_f64.to_radians();

/// Maximum neutral rudder angle of a straight course, rad.
const MAX_NEUTRAL: f64 = 2.5_f64.to_radians();

/// Maximum difference between the levels of merged holds, as a share of the larger level.
const LEVEL_TOLERANCE: f64 = 0.15;

/// Maximum pause between merged holds as a share of their total duration.
const MAX_PAUSE_SHARE: f64 = 0.5;

/// Maximum duration of a short hold, such as a pause or the end of a movement, as a share of the adjacent holds.
const SHORT_SHARE: f64 = 0.2;

/// Maximum number of consecutive rows off the level within a hold.
const MAX_STRAY_ROWS: usize = 2;

/// Minimum number of rows of a hold.
const MIN_ROWS: usize = 3;

/// Minimum length of a gap that ends a hold, usual time steps.
const GAP_STEPS: f64 = 30.0;

/// Interval of rows over which the rudder stays near one angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hold {
    /// First row.
    pub first_row: usize,
    /// Last row.
    pub last_row: usize,
    /// Time of the first row, s.
    pub start_time: f64,
    /// Time of the last row, s.
    pub end_time: f64,
    /// Median rudder angle, rad.
    pub median_angle: f64,
}

impl Hold {
    /// Time from the first to the last row, s.
    pub fn duration(&self) -> f64 {
        self.end_time - self.start_time
    }

    /// Union of two holds with the rows between them; with the level of the longer hold.
    pub fn joined(self, later: Self) -> Self {
        let level = if later.duration() > self.duration() { later.median_angle } else { self.median_angle };
        Self { last_row: later.last_row, end_time: later.end_time, median_angle: level, ..self }
    }
}

/// Rudder angle of a log, with its noise and its holds.
#[derive(Debug)]
pub(crate) struct RudderHolds {
    /// Rudder angle without spikes of one row, rad.
    pub angle: Vec<f64>,
    /// Standard deviation of the rudder noise, rad.
    pub noise_sd: f64,
    /// Half-width of the narrowest band of a hold, rad.
    pub floor: f64,
    /// Median time between rows, s; 0 for fewer than two rows.
    pub step: f64,
    /// Neutral rudder angle, rad: the median of the log, or 0 if the median is not small.
    pub neutral: f64,
    /// Holds, in order of time.
    pub holds: Vec<Hold>,
    /// Holds with neighbours of nearly the same level merged.
    pub merged: Vec<Hold>,
}

impl RudderHolds {
    /// Holds of a rudder (rad) over time (s); empty for a log of fewer than three rows.
    pub fn from_signal(time: &[f64], rudder: &[f64]) -> Self {
        let angle = without_spikes(rudder);
        let step = finite_median(time.windows(2).map(|pair| pair[1] - pair[0]));
        // Second differences respond to noise and not to steady movement; for white noise their variance is six times
        // as large.
        let noise_sd =
            1.4826 / 6.0_f64.sqrt() * finite_median(rudder.windows(3).map(|x| (x[0] - 2.0 * x[1] + x[2]).abs()));
        let floor = (3.0 * noise_sd).max(1.1 * smallest_step(rudder)).clamp(MIN_BAND, MAX_BAND);
        let median = finite_median(angle.iter().copied());
        let neutral = if median.abs() <= MAX_NEUTRAL { median } else { 0.0 };
        let mut rudder = Self { angle, noise_sd, floor, step, neutral, holds: Vec::new(), merged: Vec::new() };
        rudder.holds = rudder.cut(time);
        rudder.merged = rudder.merged();
        rudder
    }

    /// `true` if the rudder of a hold is amidships or neutral.
    pub fn is_amidships(&self, hold: &Hold) -> bool {
        hold.median_angle.abs().min((hold.median_angle - self.neutral).abs()) < self.floor
    }

    /// Holds of the log, cut wherever the rudder leaves the band about the mean of the rows since the last cut.
    fn cut(&self, time: &[f64]) -> Vec<Hold> {
        let mut holds = Vec::new();
        let (mut first, mut last, mut sum, mut count) = (0, 0, 0.0, 0.0);
        for row in 0..self.angle.len() {
            let gap = row > 0 && time[row] - time[row - 1] > GAP_STEPS * self.step;
            let level: f64 = sum / count;
            let band = self.floor.max(BAND_SHARE * level.abs());
            let inside = |row: usize| self.angle.get(row).is_some_and(|x| (x - level).abs() <= band);
            if count > 0.0 && !gap && !inside(row) && (row + 1..=row + MAX_STRAY_ROWS).any(inside) {
                continue;
            }
            if count > 0.0 && (gap || !inside(row)) {
                holds.extend(self.hold(time, first, last, band));
                (first, sum, count) = (row, 0.0, 0.0);
            }
            (sum, count, last) = (sum + self.angle[row], count + 1.0, row);
        }
        if count > 0.0 {
            let band = self.floor.max(BAND_SHARE * (sum / count).abs());
            holds.extend(self.hold(time, first, last, band));
        }
        holds
    }

    /// The holds with neighbours of nearly the same level merged, short rests between them included.
    fn merged(&self) -> Vec<Hold> {
        let mut merged: Vec<Hold> = Vec::new();
        for &next in &self.holds {
            // A rest much shorter than both neighbours is a pause or the end of a movement. Next to hours on a straight
            // course every rest is short.
            if let [.., before, between] = merged.as_slice()
                && between.duration() < SHORT_SHARE * before.duration().min(next.duration())
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

    /// Hold in the rows between two cuts, without the ends of the adjacent movements; `None` if too few rows remain or
    /// the rudder moves through the band.
    fn hold(&self, time: &[f64], first: usize, last: usize, band: f64) -> Option<Hold> {
        if last + 1 - first < MIN_ROWS {
            return None;
        }
        let half = (last + 1 - first) / 2;
        let (early, late) = (&self.angle[first..first + half], &self.angle[last + 1 - half..=last]);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        // A steady movement through the band has halves whose means differ by a band.
        if (mean(early) - mean(late)).abs() > 0.5 * band {
            return None;
        }
        let level = thinned_median(&self.angle[first..=last])?;
        let (early, late) = (self.settled(early, band)?, self.settled(late, band)?);
        let begin = (first..=last).find(|&row| early.contains(&self.angle[row]))?;
        let end = (begin..=last).rev().find(|&row| late.contains(&self.angle[row]))?;
        (end + 1 - begin >= MIN_ROWS).then_some(Hold {
            first_row: begin,
            last_row: end,
            start_time: time[begin],
            end_time: time[end],
            median_angle: level,
        })
    }

    /// Range of the settled rudder, rad: values beyond it belong to a movement. `None` without a finite value.
    fn settled(&self, values: &[f64], band: f64) -> Option<RangeInclusive<f64>> {
        let level = thinned_median(values)?;
        let mut off: Vec<f64> = thinned(values).iter().map(|x| (x - level).abs()).collect();
        off.sort_unstable_by(f64::total_cmp);
        let scatter = 1.3 * off[(off.len() - 1) * 9 / 10];
        let reach = scatter.max(2.5 * self.noise_sd).max(0.01 * level.abs()).max(RESOLUTION).min(band);
        Some(level - reach..=level + reach)
    }
}

/// `true` if two neighbouring holds belong together: similar level, short pause.
fn is_same(a: &Hold, b: &Hold, floor: f64) -> bool {
    let (shorter, longer) = (a.duration().min(b.duration()), a.duration().max(b.duration()));
    // The end of a movement is also near the level.
    let size = a.median_angle.abs().max(b.median_angle.abs());
    let tolerance = if shorter < SHORT_SHARE * longer { 0.5 * floor } else { floor.max(LEVEL_TOLERANCE * size) };
    (a.median_angle - b.median_angle).abs() <= tolerance
        && b.start_time - a.end_time <= MAX_PAUSE_SHARE * (a.duration() + b.duration())
}

/// Running median of three; the first and last value are unchanged.
fn without_spikes(values: &[f64]) -> Vec<f64> {
    let mut calm = values.to_vec();
    for (row, x) in values.windows(3).enumerate() {
        calm[row + 1] = x[0].max(x[1]).min(x[0].min(x[1]).max(x[2]));
    }
    calm
}

/// Median of the finite values; 0 for none.
pub(crate) fn finite_median(values: impl Iterator<Item = f64>) -> f64 {
    median(&mut values.filter(|x| x.is_finite()).collect::<Vec<f64>>()).unwrap_or(0.0)
}

/// Resolution of a rounded rudder, rad: the 5th percentile of the changes between rows, without rows that repeat the
/// previous row; 0 if the rudder seldom changes.
fn smallest_step(rudder: &[f64]) -> f64 {
    let steps = rudder.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    // Values that differ by rounding of the arithmetic count as equal.
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
            let rudder_holds = RudderHolds::from_signal(&time, &rudder);
            let holds: Vec<(usize, usize)> =
                rudder_holds.merged.iter().map(|hold| (hold.first_row, hold.last_row)).collect();
            assert_eq!(holds, rows);
            assert_eq!(rudder_holds.merged[2].median_angle, -sign * from_deg(20.0));
        }
    }
}
