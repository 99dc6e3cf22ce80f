//! Direct spirals (Dieudonné) in a log: the rudder goes from side to side in steps and rests at each step until the
//! ship turns steadily. Reverse spirals (Bech), with ordered rates, are not recognised.
//!
//! Source: ITTC 7.5-04-02-01, Full Scale Manoeuvring Trials.

use super::pattern::{Pattern, PreparedLog};
use super::rudder::{Hold, finite_median};
use crate::manoeuvre::Manoeuvre;

/// Minimum number of holds of a sweep from side to side.
const MIN_HOLDS: usize = 5;

/// Minimum number of holds of a partial sweep before or after a sweep from side to side.
const MIN_PART_HOLDS: usize = 3;

/// Minimum step of the rudder, rad.
const MIN_STEP: f64 = 0.75_f64.to_radians();

/// Minimum rudder angle of a sweep to both sides, rad.
const MIN_AMPLITUDE: f64 = 2.0_f64.to_radians();

/// Maximum duration of a movement as a share of the shorter adjacent hold.
const MAX_MOVEMENT_SHARE: f64 = 0.5;

/// Maximum duration of a pause in a movement as a share of both adjacent holds.
const PAUSE_SHARE: f64 = 0.2;

/// Minimum duration of a hold as a share of the median hold.
const MIN_HOLD_SHARE: f64 = 0.4;

/// Maximum ratio of the rudder angles to both sides.
const MAX_SIDE_RATIO: f64 = 2.0;

/// Maximum change of the yaw rate within the last two thirds of a hold, as a share of the range of rates.
const MAX_RATE_CHANGE: f64 = 0.04;

/// Maximum change of the yaw rate against the rudder from a hold to the next, as a share of the range of rates.
const MAX_RATE_REVERSAL: f64 = 0.15;

/// Spirals of a log.
pub(crate) fn spirals(record: &PreparedLog) -> Vec<Pattern> {
    let all = &record.rudder.holds;
    let is_pause = |index: usize| {
        let shorter = |x: Option<&Hold>| x.is_some_and(|x| all[index].duration() < PAUSE_SHARE * x.duration());
        index > 0 && shorter(all.get(index - 1)) && shorter(all.get(index + 1))
    };
    let holds: Vec<Hold> = (0..all.len()).filter(|&index| !is_pause(index)).map(|index| all[index]).collect();
    let sweeps: Vec<&[Hold]> = sweeps(&holds).into_iter().filter(|sweep| is_answered(record, sweep)).collect();
    let mut patterns: Vec<Pattern> = Vec::new();
    // Sweeps share the hold at which the rudder reverses.
    for group in sweeps.chunk_by(|a, b| a[a.len() - 1].first_row == b[0].first_row) {
        if !group.iter().any(|sweep| is_from_side_to_side(sweep)) {
            continue;
        }
        let mut holds = group[0].to_vec();
        group[1..].iter().for_each(|sweep| holds.extend(&sweep[1..]));
        let rudder = holds.iter().map(|hold| hold.median_angle.abs()).fold(0.0, f64::max);
        let scale = finite_median(holds.iter().map(Hold::duration));
        let turns = holds.iter().filter_map(|hold| record.headings.heading_change(hold.start_time, hold.end_time));
        let swing = turns.map(f64::abs).fold(0.0, f64::max);
        patterns.push(Pattern { manoeuvre: Manoeuvre::Spiral { rudder }, holds, scale, swing });
    }
    patterns
}

/// Sweeps: runs of holds, each further to the same side than the previous hold.
fn sweeps(holds: &[Hold]) -> Vec<&[Hold]> {
    let step = |index: usize| {
        let (a, b) = (&holds[index], &holds[index + 1]);
        let step = b.median_angle - a.median_angle;
        let quick = b.start_time - a.end_time <= MAX_MOVEMENT_SHARE * a.duration().min(b.duration());
        if quick && step.abs() >= MIN_STEP { step.signum() } else { 0.0 }
    };
    let mut sweeps = Vec::new();
    let mut first = 0;
    while first + 1 < holds.len() {
        let direction = step(first);
        let mut last = first + 1;
        while direction != 0.0 && last + 1 < holds.len() && step(last) == direction {
            last += 1;
        }
        if direction != 0.0 && last + 1 - first >= MIN_PART_HOLDS {
            sweeps.push(&holds[first..=last]);
        }
        first = last;
    }
    sweeps
}

fn is_from_side_to_side(sweep: &[Hold]) -> bool {
    let (first, last) = (sweep[0].median_angle, sweep[sweep.len() - 1].median_angle);
    let (port, starboard) = (-first.min(last), first.max(last));
    let (smaller, larger) = (port.min(starboard), port.max(starboard));
    sweep.len() >= MIN_HOLDS && smaller >= MIN_AMPLITUDE && larger <= MAX_SIDE_RATIO * smaller
}

/// `true` if the ship turns steadily in every hold, and faster to the side of the rudder from hold to hold.
fn is_answered(record: &PreparedLog, sweep: &[Hold]) -> bool {
    let usual = finite_median(sweep.iter().map(Hold::duration));
    if sweep.iter().any(|hold| hold.duration() < MIN_HOLD_SHARE * usual) {
        return false;
    }
    let thirds = |hold: &Hold| {
        let third = hold.duration() / 3.0;
        let late = hold.end_time - third;
        record.headings.mean_rate(late - third, late).zip(record.headings.mean_rate(late, hold.end_time))
    };
    let Some(rates) = sweep.iter().map(thirds).collect::<Option<Vec<(f64, f64)>>>() else { return false };
    let (first, last) = (rates[0].1, rates[rates.len() - 1].1);
    let range = (last - first) * (sweep[sweep.len() - 1].median_angle - sweep[0].median_angle).signum();
    let sense = (last - first).signum();
    range > 0.0
        && rates.iter().all(|(earlier, later)| (later - earlier).abs() <= MAX_RATE_CHANGE * range)
        && rates.windows(2).all(|pair| sense * (pair[1].1 - pair[0].1) >= -MAX_RATE_REVERSAL * range)
}
