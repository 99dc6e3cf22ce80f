//! Zig-zags in a log: the rudder rests at nearly the same angle to alternate sides, is reversed quickly, and the
//! heading swings about a course. The bounds of the part are set in `bounds`.
//!
//! Source: ITTC 7.5-04-02-01, Full Scale Manoeuvring Trials.

use super::bounds::first_execute;
use super::headings::thinned_median;
use super::pattern::{Pattern, PreparedLog};
use super::rudder::{Hold, finite_median};
use crate::manoeuvre::Manoeuvre;
use crate::zigzag::Side;
use estimation::statistics::median;

/// Maximum ratio of the rudder angles to both sides.
const MAX_SIDE_RATIO: f64 = 1.6;

/// Tolerance of the holds to one side, as a share of their level.
const SIDE_TOLERANCE: f64 = 0.15;

/// Tolerance of the holds to one side at small levels, rad.
const MIN_SIDE_TOLERANCE: f64 = 1.5_f64.to_radians();

/// Maximum duration of a movement from side to side, as a share of the longer adjacent hold. A first hold may be short.
const MAX_MOVEMENT_SHARE: f64 = 1.25;

/// Maximum duration of a pause in a movement as a share of the hold before it.
const PAUSE_SHARE: f64 = 0.3;

/// Maximum time after a hold up to which pauses are skipped, as a multiple of the hold.
const MAX_PAUSE_REACH: f64 = 4.0;

/// Minimum share of time with the rudder held. A first-order 35/5 trial has 0.5.
const MIN_HELD_SHARE: f64 = 0.3;

/// Maximum ratio of a swing of the heading, from execute to execute, to the next.
const MAX_SWING_RATIO: f64 = 1.7;

/// Minimum and maximum change of heading in the first hold, as shares of the swings: half a swing from the base course,
/// more if the hold begins within a reversal.
const FIRST_SWING: (f64, f64) = (0.15, 1.6);

/// [`FIRST_SWING`] of a trial of only three holds: narrower, because three holds may fit by chance.
const ONLY_SWING: (f64, f64) = (0.4, 0.62);

/// Length of the straight approach of a trial of three holds, as a share of the first hold.
const APPROACH_SHARE: f64 = 0.5;

/// Maximum change of heading in that approach, as a share of the swings.
const MAX_APPROACH_TURN: f64 = 0.12;

/// Maximum rudder off amidships in that approach, as a share of its level in the holds.
const MAX_AMIDSHIPS_SHARE: f64 = 0.5;

/// Minimum rudder angle of a clear zig-zag, rad; this or the change of heading is sufficient. An autopilot on a course
/// uses 3 degrees of rudder.
const CLEAR_RUDDER: f64 = 4.0_f64.to_radians();

/// Minimum change of heading of a clear zig-zag, rad. Under an autopilot on a course the heading varies by one degree.
const CLEAR_HEADING: f64 = 2.0_f64.to_radians();

/// Minimum rudder angle of a zig-zag, rad.
const MIN_RUDDER: f64 = 0.8_f64.to_radians();

/// Minimum change of heading from the base course, rad.
const MIN_HEADING: f64 = 0.6_f64.to_radians();

/// Maximum change of heading from the base course, rad.
const MAX_HEADING: f64 = 100.0_f64.to_radians();

/// Maximum turn in the last hold, swings; a larger turn is another manoeuvre.
const MAX_LAST_SWINGS: f64 = 4.0;

/// Minimum number of holds.
const MIN_HOLDS: usize = 3;

/// Zig-zags among holds, which are in order of time.
pub(crate) fn zigzags(record: &PreparedLog, holds: &[Hold]) -> Vec<Pattern> {
    let mut patterns: Vec<Pattern> = Vec::new();
    let mut start = 0;
    while start < holds.len() {
        if record.rudder.is_amidships(&holds[start]) {
            start += 1;
            continue;
        }
        let chain = Chain::from(start, holds, record.rudder.neutral);
        patterns.extend(answered(record, &chain.holds));
        let ends =
            patterns.last().is_some_and(|pattern| pattern.last() >= holds[chain.next.min(holds.len() - 1)].last_row);
        start = chain.next + usize::from(ends);
    }
    patterns
}

/// Holds to alternate sides.
struct Chain {
    holds: Vec<Hold>,
    /// Index of the hold at which the next search begins: the last hold of this chain may be the first of the next.
    next: usize,
}

impl Chain {
    fn from(start: usize, all: &[Hold], neutral: f64) -> Self {
        let mut holds = vec![all[start]];
        let mut next = start + 1;
        for (index, &hold) in all.iter().enumerate().skip(start + 1) {
            let count = holds.len();
            let last = holds[count - 1];
            let (gap, pause) = (hold.start_time - last.end_time, PAUSE_SHARE * last.duration());
            let (shorter, longer) = (last.duration().min(hold.duration()), last.duration().max(hold.duration()));
            let same_side = count.checked_sub(2).map(|index| holds[index].median_angle);
            if is_opposed(last.median_angle, hold.median_angle, neutral)
                && gap <= MAX_MOVEMENT_SHARE * longer
                && same_side.is_none_or(|level| is_level(level, hold.median_angle))
            {
                holds.push(hold);
                next = index;
            } else if is_level(last.median_angle, hold.median_angle) && gap <= 0.5 * shorter && hold.duration() >= pause
            {
                holds[count - 1] = last.joined(hold);
                next = index;
            } else if last.median_angle * hold.median_angle > 0.0
                && last.duration() < PAUSE_SHARE * hold.duration()
                && gap <= MAX_MOVEMENT_SHARE * hold.duration()
                && count.checked_sub(3).is_none_or(|same| is_level(holds[same].median_angle, hold.median_angle))
            {
                // The rudder paused on its way to this hold.
                holds[count - 1] = hold;
                next = index;
            } else if hold.duration() < pause && hold.end_time - last.end_time <= MAX_PAUSE_REACH * last.duration() {
                continue;
            } else {
                break;
            }
        }
        Self { holds, next: next.max(start + 1) }
    }
}

/// `true` for levels to opposite sides and of similar size, about zero or about the neutral rudder.
fn is_opposed(a: f64, b: f64, neutral: f64) -> bool {
    [0.0, neutral].into_iter().any(|zero| {
        let (a, b) = (a - zero, b - zero);
        a * b < 0.0 && a.abs() <= MAX_SIDE_RATIO * b.abs() && b.abs() <= MAX_SIDE_RATIO * a.abs()
    })
}

/// `true` for levels that agree as those of two holds to the same side.
fn is_level(a: f64, b: f64) -> bool {
    let size = a.abs().max(b.abs());
    (a - b).abs() <= (SIDE_TOLERANCE * size).max(MIN_SIDE_TOLERANCE.min(0.4 * size))
}

/// Zig-zags in a chain of holds: its parts in which the heading responds as in a zig-zag.
fn answered(record: &PreparedLog, holds: &[Hold]) -> Vec<Pattern> {
    if holds.len() < MIN_HOLDS {
        return Vec::new();
    }
    let headings: Vec<Option<f64>> = holds.iter().map(|hold| heading_at_end(record, hold)).collect();
    // Swing under the rudder of hold `index`, from the execute at its beginning to the execute at its end.
    let swing = |index: usize| -> Option<f64> {
        let change = headings[index]? - headings[index - 1]?;
        let size = change * side(holds, index);
        (size > 0.0).then_some(size)
    };
    let mut patterns = Vec::new();
    let mut index = 1;
    while index + 1 < holds.len() {
        let Some(mut size) = swing(index) else {
            index += 1;
            continue;
        };
        let begin = index;
        while let Some(next) = (index + 2 < holds.len()).then(|| swing(index + 1)).flatten()
            && next <= MAX_SWING_RATIO * size
            && size <= MAX_SWING_RATIO * next
        {
            (index, size) = (index + 1, next);
        }
        patterns.extend(pattern(record, &holds[begin - 1..=index + 1], &headings[begin - 1..=index + 1]));
        index += 1;
    }
    // Runs of swings of different size share the hold between them.
    patterns.dedup_by(|next: &mut Pattern, last: &mut Pattern| {
        let shared = next.first() <= last.last();
        if shared && next.holds.len() > last.holds.len() {
            std::mem::swap(next, last);
        }
        shared
    });
    patterns
}

/// +1 if a hold is to starboard of its neighbour, else −1.
fn side(holds: &[Hold], index: usize) -> f64 {
    let neighbour = if index > 0 { index - 1 } else { index + 1 };
    (holds[index].median_angle - holds[neighbour].median_angle).signum()
}

/// Heading at the end of a hold, between its last row and the next, rad; `None` if headings are missing there.
fn heading_at_end(record: &PreparedLog, hold: &Hold) -> Option<f64> {
    let scale = hold.duration();
    record.headings.heading_near(hold.end_time + 0.5 * record.rudder.step, 0.02 * scale, 0.5 * scale)
}

/// Zig-zag of holds whose swings agree, with the headings at their ends; `None` if the holds are not a zig-zag.
fn pattern(record: &PreparedLog, holds: &[Hold], headings: &[Option<f64>]) -> Option<Pattern> {
    let mut sizes = Vec::new();
    for pair in headings[..headings.len() - 1].windows(2) {
        sizes.push((pair[1]? - pair[0]?).abs());
    }
    let swing = median(&mut sizes)?;
    let mut first = 0;
    let execute = record.log.time[first_execute(record, holds, holds[0].duration(), 0)];
    let began = record.headings.heading_near(execute, 0.02 * holds[0].duration(), holds[0].duration());
    if let (Some(began), Some(ended)) = (began, headings[0]) {
        let share = side(holds, 0) * (ended - began) / swing;
        let (least, most) = if holds.len() == MIN_HOLDS { ONLY_SWING } else { FIRST_SWING };
        let at_start = holds[0].first_row == 0;
        let manoeuvring = holds.len() == MIN_HOLDS && !is_straight_before(record, holds, execute, began, swing);
        first = usize::from(manoeuvring || share > most || share < least && !at_start);
    }
    let mut last = holds.len() - 1;
    let turned = record.headings.heading_change(holds[last].start_time, holds[last].end_time).unwrap_or(0.0).abs();
    if turned > MAX_LAST_SWINGS * swing {
        last -= 1;
    }
    let (holds, headings) = (holds.get(first..=last)?, headings.get(first..=last)?);
    if holds.len() < MIN_HOLDS || !is_held(record, holds) {
        return None;
    }
    // Half the difference of the sides, which is independent of a neutral rudder off zero.
    let level = |first: usize| finite_median(holds.iter().skip(first).step_by(2).map(|hold| hold.median_angle));
    let rudder = 0.5 * (level(0) - level(1)).abs();
    let heading = deviation(holds, headings)?;
    let clear = rudder >= CLEAR_RUDDER || heading >= CLEAR_HEADING;
    let manoeuvre = Manoeuvre::zig_zag(rudder, heading).with_first_side(Side::from_angle(holds[0].median_angle));
    let scale = finite_median(holds[..holds.len() - 1].iter().map(Hold::duration));
    (clear && rudder >= MIN_RUDDER && (MIN_HEADING..=MAX_HEADING).contains(&heading)).then(|| Pattern {
        manoeuvre,
        holds: holds.to_vec(),
        scale,
        swing,
    })
}

/// `true` if the ship went straight with the rudder about amidships before the first of three holds, which began at
/// the time `from` (s) and the heading `began` (rad); also `true` if the log does not contain the approach.
fn is_straight_before(record: &PreparedLog, holds: &[Hold], from: f64, began: f64, swing: f64) -> bool {
    // In the second hold the change of heading is twice as large, and the ship first stops a turn.
    if holds[1].duration() <= holds[0].duration() {
        return false;
    }
    let time = APPROACH_SHARE * holds[0].duration();
    let rows = [from - time, from].map(|end| record.log.time.partition_point(|&t| t < end));
    let [a, b] = [holds[0].median_angle, holds[1].median_angle];
    let rudder = thinned_median(&record.rudder.angle[rows[0]..rows[1]]);
    let heading = record.headings.heading_near(from - time, 0.1 * time, 0.5 * time);
    rudder.is_none_or(|rudder| (rudder - 0.5 * (a + b)).abs() <= MAX_AMIDSHIPS_SHARE * 0.5 * (a - b).abs())
        && heading.is_none_or(|heading| (began - heading).abs() <= MAX_APPROACH_TURN * swing)
}

/// `true` if the rudder is held for a sufficient share of the time and no gap of the log hides a hold.
fn is_held(record: &PreparedLog, holds: &[Hold]) -> bool {
    let held: f64 = holds.iter().map(Hold::duration).sum();
    let (first, last) = (holds[0], holds[holds.len() - 1]);
    let mean = held / holds.len() as f64;
    let rows = &record.log.time[first.first_row..=last.last_row];
    held >= MIN_HELD_SHARE * (last.end_time - first.start_time)
        && rows.windows(2).all(|pair| pair[1] - pair[0] <= 0.5 * mean)
}

/// Median change of heading from the base course to the reversals, rad; the base course is midway between the sides.
/// `None` if a heading is missing.
fn deviation(holds: &[Hold], headings: &[Option<f64>]) -> Option<f64> {
    let reversals = headings.len() - 1;
    let mut sides = [Vec::new(), Vec::new()];
    for index in 0..reversals {
        sides[usize::from(side(holds, index) > 0.0)].push(headings[index]?);
    }
    let [port, starboard] = sides;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let base = 0.5 * (mean(&port) + mean(&starboard));
    Some(finite_median(port.iter().chain(&starboard).map(|psi| (psi - base).abs())))
}
