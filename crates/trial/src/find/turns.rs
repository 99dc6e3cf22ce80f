//! Turning circles and pull-outs in a log: the rudder rests at one angle until the ship has turned, and then amidships.
//! A change of course is neither.

use std::f64::consts::{FRAC_PI_2, PI};

use super::pattern::{Pattern, Prepared};
use super::rest::Hold;
use crate::manoeuvre::Manoeuvre;
use crate::zigzag::Side;

/// Smallest rudder angle of a turn, rad.
const SMALLEST_RUDDER: f64 = 3.0_f64.to_radians();

/// Change of heading from which on a turn is a turning circle, rad: there the tactical diameter is known.
const CIRCLE: f64 = PI;

/// Change of heading from which on what follows a turn is a pull-out, rad.
const TURN: f64 = FRAC_PI_2;

/// Largest rudder amidships, as a share of that of the turn.
const AMIDSHIPS: f64 = 0.3;

/// Change of heading at the rate of the turn whose time is the scale of a pull-out, rad.
const PULL_OUT: f64 = 30.0_f64.to_radians();

/// Fewest such times in which the rudder rests amidships.
const FEWEST_TIMES: f64 = 2.0;

/// Change of the rate from one such time to the next, as a share of the rate of the turn, below which it is steady.
const STEADY: f64 = 0.04;

/// The turning circles and pull-outs among holds that are in order of time.
pub(crate) fn turns(record: &Prepared, holds: &[Hold]) -> Vec<Pattern> {
    let mut found = Vec::new();
    for (index, hold) in holds.iter().enumerate() {
        let Some(turned) = turned(record, hold) else { continue };
        let rate = turned.abs() / hold.duration();
        if turned.abs() >= CIRCLE {
            let (side, heading_change) = (Side::of(hold.level), Some(turned.abs()));
            let manoeuvre = Manoeuvre::TurningCircle { rudder: hold.level.abs(), side, duration: None, heading_change };
            found.push(Pattern { manoeuvre, holds: vec![*hold], scale: TURN / rate, swing: TURN });
        }
        found.extend(pull_out(record, hold, &holds[index + 1..]));
    }
    found
}

/// Change of heading in a turn, rad; `None` for a hold that is none.
fn turned(record: &Prepared, hold: &Hold) -> Option<f64> {
    let rudder = hold.level - record.rest.neutral;
    let is_over = hold.level.abs() >= SMALLEST_RUDDER && rudder.abs() >= SMALLEST_RUDDER;
    let turned = record.course.change(hold.from, hold.until).filter(|_| is_over && is_whole(record, hold))?;
    (turned * rudder.signum() >= TURN).then_some(turned)
}

/// Whether the log has no gap in a turn in which the rudder may have been elsewhere.
fn is_whole(record: &Prepared, hold: &Hold) -> bool {
    let rows = &record.log.time[hold.first..=hold.last];
    rows.windows(2).all(|pair| pair[1] - pair[0] <= 0.25 * hold.duration())
}

/// The rudder amidships from the end of a turn until the rate is steady or the rudder moves.
fn pull_out(record: &Prepared, turn: &Hold, next: &[Hold]) -> Option<Pattern> {
    let end_of_turn = turn.until - 0.25 * turn.duration();
    let rate = record.course.rate(end_of_turn, turn.until)?.abs();
    let time = PULL_OUT / rate;
    let soon = |hold: &&Hold| hold.from - turn.until <= time.max(0.25 * turn.duration());
    // Between two turns the rudder was not amidships.
    let mut reach = next.iter().take_while(soon).take_while(|hold| turned(record, hold).is_none());
    let amidships = reach.find(|hold| hold.duration() >= FEWEST_TIMES * time)?;
    let neutral = record.rest.neutral;
    let off = (amidships.level - neutral).abs();
    let is_amidships = off <= AMIDSHIPS * (turn.level - neutral).abs() && off < SMALLEST_RUDDER;
    if !is_amidships || !is_whole(record, amidships) {
        return None;
    }
    let rate_in = |piece: f64| record.course.rate(amidships.from + piece * time, amidships.from + (piece + 1.0) * time);
    let mut pieces = 1.0;
    while (pieces + 1.0) * time <= amidships.duration() {
        let change = rate_in(pieces)? - rate_in(pieces - 1.0)?;
        pieces += 1.0;
        if change.abs() <= STEADY * rate {
            break;
        }
    }
    let settled = amidships.from + pieces * time;
    let last = if (pieces + 1.0) * time > amidships.duration() {
        amidships.last
    } else {
        record.log.time.partition_point(|&t| t <= settled).saturating_sub(1).clamp(amidships.first, amidships.last)
    };
    // The rudder moves from the row after the turn on.
    let first = (turn.last + 1).min(amidships.first);
    let [from, until] = [first, last].map(|row| record.log.time[row]);
    let hold = Hold { first, last, from, until, level: amidships.level };
    let (rudder, side) = (turn.level.abs(), Side::of(turn.level));
    let manoeuvre = Manoeuvre::PullOut { rudder, side, hold: turn.duration(), duration: until - from };
    Some(Pattern { manoeuvre, holds: vec![hold], scale: time, swing: PULL_OUT })
}
