//! Zig-zags in a log: the rudder rests at nearly the same angle to alternate sides, goes over quickly, and the heading
//! swings about a course with it. Where the part to analyse begins and ends is decided in `bounds`.

use super::bounds::first_execute;
use super::course::middle;
use super::pattern::{Pattern, Prepared};
use super::rest::{Hold, usual};
use crate::manoeuvre::Manoeuvre;
use crate::zigzag::Side;
use estimation::statistics::median;

/// Largest ratio of the rudder angles to both sides.
const SIDES: f64 = 1.6;

/// Difference of the holds to one side, as a share of their level; or, for small levels, in rad.
const SAME_SIDE: f64 = 0.15;
const SAME_SIDE_AT_LEAST: f64 = 1.5_f64.to_radians();

/// Longest movement from side to side, as a share of the longer hold beside it. A first hold may be short.
const QUICK: f64 = 1.25;

/// A rest shorter than this share of the hold before it is a pause of the movement.
const PAUSE: f64 = 0.3;

/// How long after a hold, as a multiple of it, such pauses are passed over.
const REACH: f64 = 4.0;

/// Least share of the time between first and last row with the rudder held. A first-order 35/5 trial has 0.5.
const LEAST_HELD: f64 = 0.3;

/// Largest ratio of one swing of the heading, from execute to execute, to the next.
const SWINGS: f64 = 1.7;

/// Change of heading in the first hold, as a share of the swings: half a swing from the base course, somewhat more
/// where the hold begins within a reversal. With only three holds nothing else tells a trial from chance.
const FIRST_SWING: (f64, f64) = (0.15, 1.6);
const ONLY_SWING: (f64, f64) = (0.4, 0.62);

/// Before a trial of three holds, for a share of the first: change of heading as a share of the swings, and rudder off
/// amidships as a share of its level.
const BEFORE: f64 = 0.5;
const STRAIGHT: f64 = 0.12;
const AMIDSHIPS: f64 = 0.5;

/// Rudder angle from which on the smallest change of heading makes a zig-zag, and change of heading from which on the
/// smallest rudder angle does, rad: an autopilot that keeps a course uses 3 degrees and lets it vary by one.
const CLEAR_RUDDER: f64 = 4.0_f64.to_radians();
const CLEAR_HEADING: f64 = 2.0_f64.to_radians();

/// Smallest rudder angle and change of heading from the base course, rad.
const SMALLEST_RUDDER: f64 = 0.8_f64.to_radians();
const SMALLEST_HEADING: f64 = 0.6_f64.to_radians();

/// Largest change of heading from the base course, rad.
const LARGEST_HEADING: f64 = 100.0_f64.to_radians();

/// A last hold that turns the ship by more than so many swings is another manoeuvre.
const TURN: f64 = 4.0;

/// Fewest holds.
const FEWEST: usize = 3;

/// The zig-zags among holds that are in order of time.
pub(crate) fn zigzags(record: &Prepared, holds: &[Hold]) -> Vec<Pattern> {
    let mut found: Vec<Pattern> = Vec::new();
    let mut start = 0;
    while start < holds.len() {
        if record.rest.is_amidships(&holds[start]) {
            start += 1;
            continue;
        }
        let chain = Chain::from(start, holds, record.rest.neutral);
        found.extend(answered(record, &chain.holds));
        let ends = found.last().is_some_and(|pattern| pattern.last() >= holds[chain.next.min(holds.len() - 1)].last);
        start = chain.next + usize::from(ends);
    }
    found
}

/// Holds to alternate sides.
struct Chain {
    holds: Vec<Hold>,
    /// Where the search goes on: the last hold of this chain may be the first of the next.
    next: usize,
}

impl Chain {
    fn from(start: usize, all: &[Hold], neutral: f64) -> Self {
        let mut holds = vec![all[start]];
        let mut next = start + 1;
        for (index, &hold) in all.iter().enumerate().skip(start + 1) {
            let count = holds.len();
            let last = holds[count - 1];
            let gap = hold.from - last.until;
            let (shorter, longer) = (last.duration().min(hold.duration()), last.duration().max(hold.duration()));
            let same_side = count.checked_sub(2).map(|other| holds[other].level);
            if is_opposed(last.level, hold.level, neutral)
                && gap <= QUICK * longer
                && same_side.is_none_or(|level| is_level(level, hold.level))
            {
                holds.push(hold);
                next = index;
            } else if is_level(last.level, hold.level)
                && gap <= 0.5 * shorter
                && hold.duration() >= PAUSE * last.duration()
            {
                holds[count - 1] = last.joined(hold);
                next = index;
            } else if last.level * hold.level > 0.0
                && last.duration() < PAUSE * hold.duration()
                && gap <= QUICK * hold.duration()
                && count.checked_sub(3).is_none_or(|same| is_level(holds[same].level, hold.level))
            {
                // The rudder paused on its way to this hold.
                holds[count - 1] = hold;
                next = index;
            } else if hold.duration() < PAUSE * last.duration() && hold.until - last.until <= REACH * last.duration() {
                continue;
            } else {
                break;
            }
        }
        Self { holds, next: next.max(start + 1) }
    }
}

/// Whether two levels are to opposite sides and of similar size, about zero or about the neutral rudder.
fn is_opposed(a: f64, b: f64, neutral: f64) -> bool {
    [0.0, neutral].into_iter().any(|zero| {
        let (a, b) = (a - zero, b - zero);
        a * b < 0.0 && a.abs() <= SIDES * b.abs() && b.abs() <= SIDES * a.abs()
    })
}

/// Whether two levels are those of one side.
fn is_level(a: f64, b: f64) -> bool {
    let size = a.abs().max(b.abs());
    (a - b).abs() <= (SAME_SIDE * size).max(SAME_SIDE_AT_LEAST.min(0.4 * size))
}

/// The parts of a chain that the heading answers as in a zig-zag.
fn answered(record: &Prepared, holds: &[Hold]) -> Vec<Pattern> {
    if holds.len() < FEWEST {
        return Vec::new();
    }
    let headings: Vec<Option<f64>> = holds.iter().map(|hold| heading_at_end(record, hold)).collect();
    // Swing under the rudder of hold `index`, from the execute that began it to the one that ended it.
    let swing = |index: usize| -> Option<f64> {
        let change = headings[index]? - headings[index - 1]?;
        let size = change * side(holds, index);
        (size > 0.0).then_some(size)
    };
    let mut found = Vec::new();
    let mut index = 1;
    while index + 1 < holds.len() {
        let Some(mut size) = swing(index) else {
            index += 1;
            continue;
        };
        let begin = index;
        while let Some(next) = (index + 2 < holds.len()).then(|| swing(index + 1)).flatten()
            && next <= SWINGS * size
            && size <= SWINGS * next
        {
            (index, size) = (index + 1, next);
        }
        found.extend(pattern(record, &holds[begin - 1..=index + 1], &headings[begin - 1..=index + 1]));
        index += 1;
    }
    // Runs of swings of different size share the holds where one ends and the next begins.
    found.dedup_by(|next: &mut Pattern, last: &mut Pattern| {
        let shared = next.first() <= last.last();
        if shared && next.holds.len() > last.holds.len() {
            std::mem::swap(next, last);
        }
        shared
    });
    found
}

/// +1 where a hold is to starboard of the one beside it.
fn side(holds: &[Hold], index: usize) -> f64 {
    let other = if index > 0 { index - 1 } else { index + 1 };
    (holds[index].level - holds[other].level).signum()
}

/// Heading when the rudder leaves a hold: between its last row and the next.
fn heading_at_end(record: &Prepared, hold: &Hold) -> Option<f64> {
    let scale = hold.duration();
    record.course.near(hold.until + 0.5 * record.rest.step, 0.02 * scale, 0.5 * scale)
}

/// A zig-zag of holds whose swings agree, with the headings at their ends; `None` where it is none.
fn pattern(record: &Prepared, holds: &[Hold], headings: &[Option<f64>]) -> Option<Pattern> {
    let mut sizes = Vec::new();
    for pair in headings[..headings.len() - 1].windows(2) {
        sizes.push((pair[1]? - pair[0]?).abs());
    }
    let swing = median(&mut sizes)?;
    let mut first = 0;
    let execute = record.log.time[first_execute(record, holds, holds[0].duration(), 0)];
    let began = record.course.near(execute, 0.02 * holds[0].duration(), holds[0].duration());
    if let (Some(began), Some(ended)) = (began, headings[0]) {
        let share = side(holds, 0) * (ended - began) / swing;
        let (least, most) = if holds.len() == FEWEST { ONLY_SWING } else { FIRST_SWING };
        let at_start = holds[0].first == 0;
        let manoeuvring = holds.len() == FEWEST && !is_straight_before(record, holds, execute, began, swing);
        first = usize::from(manoeuvring || share > most || share < least && !at_start);
    }
    let mut last = holds.len() - 1;
    let turned = record.course.change(holds[last].from, holds[last].until).unwrap_or(0.0).abs();
    if turned > TURN * swing {
        last -= 1;
    }
    let (holds, headings) = (holds.get(first..=last)?, headings.get(first..=last)?);
    if holds.len() < FEWEST || !is_held(record, holds) {
        return None;
    }
    // Between the sides: a neutral rudder off zero adds to one what it takes from the other.
    let level = |first: usize| usual(holds.iter().skip(first).step_by(2).map(|hold| hold.level));
    let rudder = 0.5 * (level(0) - level(1)).abs();
    let heading = deviation(holds, headings)?;
    let clear = rudder >= CLEAR_RUDDER || heading >= CLEAR_HEADING;
    let manoeuvre = Manoeuvre::zig_zag(rudder, heading).to(Side::of(holds[0].level));
    let scale = usual(holds[..holds.len() - 1].iter().map(Hold::duration));
    (clear && rudder >= SMALLEST_RUDDER && (SMALLEST_HEADING..=LARGEST_HEADING).contains(&heading)).then(|| Pattern {
        manoeuvre,
        holds: holds.to_vec(),
        scale,
        swing,
    })
}

/// Whether the ship went straight with the rudder about amidships before the first of three holds, which began at
/// the time `from` (s) and the heading `began` (rad); also where the log does not tell.
fn is_straight_before(record: &Prepared, holds: &[Hold], from: f64, began: f64, swing: f64) -> bool {
    // The second hold has twice the way of heading to go, and stops a turn first.
    if holds[1].duration() <= holds[0].duration() {
        return false;
    }
    let time = BEFORE * holds[0].duration();
    let rows = [from - time, from].map(|end| record.log.time.partition_point(|&t| t < end));
    let [one, other] = [holds[0].level, holds[1].level];
    let rudder = middle(&record.rest.angle[rows[0]..rows[1]]);
    let heading = record.course.near(from - time, 0.1 * time, 0.5 * time);
    rudder.is_none_or(|rudder| (rudder - 0.5 * (one + other)).abs() <= AMIDSHIPS * 0.5 * (one - other).abs())
        && heading.is_none_or(|heading| (began - heading).abs() <= STRAIGHT * swing)
}

/// Whether the rudder is held most of the time, and no gap of the log hides a hold.
fn is_held(record: &Prepared, holds: &[Hold]) -> bool {
    let held: f64 = holds.iter().map(Hold::duration).sum();
    let (first, last) = (holds[0], holds[holds.len() - 1]);
    let mean = held / holds.len() as f64;
    let rows = &record.log.time[first.first..=last.last];
    held >= LEAST_HELD * (last.until - first.from) && rows.windows(2).all(|pair| pair[1] - pair[0] <= 0.5 * mean)
}

/// Median change of heading from the base course to the reversals, rad; the base course is midway between the sides.
fn deviation(holds: &[Hold], headings: &[Option<f64>]) -> Option<f64> {
    let reversals = headings.len() - 1;
    let mut sides = [Vec::new(), Vec::new()];
    for index in 0..reversals {
        sides[usize::from(side(holds, index) > 0.0)].push(headings[index]?);
    }
    let [port, starboard] = sides;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let base = 0.5 * (mean(&port) + mean(&starboard));
    Some(usual(port.iter().chain(&starboard).map(|psi| (psi - base).abs())))
}
