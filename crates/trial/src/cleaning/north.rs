//! Sweeps of the heading through the compass at north: headings interpolated or filtered across the step from 360 to 0,
//! through values that the ship never had.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use document::{Warning, WarningCode};

use super::reject;
use crate::channel::Channel;
use crate::record::{Columns, RejectedReading};
use crate::wording::counted;

/// Minimum ratio of the rate at the beginning of a sweep to the 90th percentile of the rates.
const MIN_RATE_RATIO: f64 = 5.0;

/// Maximum distance from north at the beginning of a sweep, rad.
const MAX_FROM_NORTH: f64 = 0.6;

/// Minimum excursion of a sweep from its beginning, rad: 30°.
const MIN_EXCURSION: f64 = 0.52;

/// Maximum distance between beginning and end of a sweep beyond the turn of the ship, rad: 3°.
const RETURN_TOLERANCE: f64 = 0.05;

/// Minimum ratio of the mean rate, up to the minimum excursion, to the 90th percentile of the rates.
const MIN_MEAN_RATIO: f64 = 3.0;

/// Maximum distance between beginning and end of a sweep as a share of the excursion.
const RETURN_SHARE: f64 = 0.3;

/// Maximum length of a sweep, s and rows: filters of a compass take seconds.
const MAX_SWEEP: (f64, usize) = (60.0, 600);

/// Settling time of a filter after a sweep, in lengths of the sweep.
const SETTLING: usize = 2;

/// Maximum share of headings in sweeps and settling times.
const MAX_SWEPT_SHARE: f64 = 0.6;

/// Sets headings in sweeps through the compass, and in the settling time after them, to missing and returns the
/// warning. A full turn between the headings before and after a sweep is removed. `None`, and no change, for fewer than
/// 41 headings, without a sweep, or with more than [`MAX_SWEPT_SHARE`] of the headings in sweeps and settling times.
pub(super) fn blank_sweeps(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let time = &columns.time;
    let heading = columns.channels.get_mut(&Channel::Heading)?;
    let read: Vec<usize> = (0..heading.len()).filter(|&row| heading[row].is_finite()).collect();
    let rate = |at: usize| {
        let [from, to] = [read[at], read[at + 1]];
        ((heading[to] - heading[from]) / (time[to] - time[from])).abs()
    };
    let mut rates: Vec<f64> = (0..read.len().saturating_sub(1)).map(rate).collect();
    let rank = rates.len() * 9 / 10;
    let usual = *(rates.len() >= 40).then(|| rates.select_nth_unstable_by(rank, f64::total_cmp).1)?;
    let mut sweeps: Vec<Range<usize>> = Vec::new();
    let mut at = 0;
    while at + 1 < read.len() {
        let swept = (rate(at) > MIN_RATE_RATIO * usual).then(|| sweep(time, heading, &read, at, usual)).flatten();
        at = swept.as_ref().map_or(at + 1, |swept| swept.end);
        sweeps.extend(swept);
    }
    let places = sweeps.iter().flat_map(|swept| swept.start + 1..(swept.end + SETTLING * swept.len()).min(read.len()));
    let mut rows: Vec<usize> = places.map(|place| read[place]).collect();
    rows.dedup();
    if rows.is_empty() || rows.len() as f64 > MAX_SWEPT_SHARE * read.len() as f64 {
        return None;
    }
    let begins: Vec<usize> = sweeps.iter().map(|swept| read[swept.start + 1]).collect();
    let times = reject(Channel::Heading, time, heading, &begins, rejected);
    // The heading after a sweep may be off by a full turn.
    for swept in &sweeps {
        let turns = ((heading[read[swept.end]] - heading[read[swept.start]]) / TAU).round() * TAU;
        heading[read[swept.start] + 1..].iter_mut().for_each(|psi| *psi -= turns);
    }
    rows.iter().for_each(|&row| heading[row] = f64::NAN);
    Some(WarningCode::RejectedReadings.warning(format!(
        "the heading sweeps through the compass at north {times}: it was resampled or filtered across the step from \
         360 to 0; {} left out there; unwrap a heading before it is resampled or filtered",
        counted(rows.len(), "heading"),
    )))
}

/// Indices into `read` from the last heading before a sweep, `at`, up to the first behind it, which is excluded; `None`
/// if no sweep begins at `at`. `usual` is the 90th percentile of the rates, rad/s.
fn sweep(time: &[f64], heading: &[f64], read: &[usize], at: usize, usual: f64) -> Option<Range<usize>> {
    let begin = heading[read[at]];
    let from_north = |psi: f64| (psi + PI).rem_euclid(TAU) - PI;
    let mut farthest: f64 = 0.0;
    for end in at + 1..read.len().min(at + MAX_SWEEP.1) {
        let elapsed = time[read[end]] - time[read[at]];
        let apart = ((heading[read[end]] - begin + PI).rem_euclid(TAU) - PI).abs();
        farthest = farthest.max(apart);
        if elapsed > MAX_SWEEP.0 || (farthest <= MIN_EXCURSION && elapsed * MIN_MEAN_RATIO * usual > MIN_EXCURSION) {
            return None;
        }
        if farthest > MIN_EXCURSION && apart < (RETURN_TOLERANCE + 2.0 * usual * elapsed).min(RETURN_SHARE * farthest) {
            let behind = heading[read[end]];
            // A single reading is a spike, unless the heading crosses north at it.
            let passes = from_north(begin) * from_north(behind) < 0.0 || (behind - begin).abs() > PI;
            return (from_north(begin).abs() < MAX_FROM_NORTH && (end > at + 2 || passes)).then_some(at..end);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::super::tests::{clean, with};
    use super::*;

    /// Headings as written, from 0 to 360, after a change, and unwrapped on reading.
    fn written(change: impl Fn(usize, &[f64]) -> f64) -> Vec<f64> {
        let made = with(Channel::Heading, |row, values| values[row].rem_euclid(TAU));
        let raw = &made.channels[&Channel::Heading];
        let mut read: Vec<f64> = (0..raw.len()).map(|row| change(row, raw)).collect();
        ship::angle::unwrap_heading(&mut read);
        read
    }

    #[test]
    fn a_heading_that_sweeps_through_the_compass_is_left_out() {
        let truth = super::super::tests::columns().channels[&Channel::Heading].clone();
        let resampled = |row: usize, raw: &[f64]| {
            let (first, next) = (row / 10 * 10, (row / 10 * 10 + 10).min(raw.len() - 1));
            raw[first] + (row - first) as f64 / 10.0 * (raw[next] - raw[first])
        };
        let filtered = |row: usize, raw: &[f64]| {
            raw[row.saturating_sub(300)..=row].iter().fold(raw[row.saturating_sub(300)], |y, x| y + 0.2 * (x - y))
        };
        for (read, late) in [(written(resampled), 0), (written(filtered), 4)] {
            let mut columns = with(Channel::Heading, |row, _| read[row]);
            let text = clean(&mut columns).join("; ");
            assert!(text.contains("sweeps through the compass at north at t = "), "{text}");
            let heading = &columns.channels[&Channel::Heading];
            let turns = ((heading[0] - truth[0]) / TAU).round() * TAU;
            let far = (300..2990).map(|row| (heading[row] - turns - truth[row - late]).abs());
            let far: Vec<f64> = far.filter(|far| far.is_finite()).collect();
            let farthest = far.iter().copied().fold(0.0, f64::max).to_degrees();
            assert!(far.len() > 2000 && farthest < 0.6, "{} headings, {farthest}°", far.len());
        }
        let mut sound = with(Channel::Heading, |row, _| written(|row, raw| raw[row])[row]);
        assert_eq!(clean(&mut sound), [] as [String; 0]);
    }
}
