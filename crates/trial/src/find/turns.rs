//! Turning circles and pull-outs in a log: the rudder rests at an angle until the ship has turned, and then amidships.
//! A change of course is neither of them.
//!
//! Source: ITTC 7.5-04-02-01, Full Scale Manoeuvring Trials.

use std::f64::consts::{FRAC_PI_2, PI};

use super::pattern::{Pattern, PreparedLog};
use super::rudder::Hold;
use crate::manoeuvre::Manoeuvre;
use crate::zigzag::Side;

/// Minimum rudder angle of a turn, rad.
const MIN_RUDDER: f64 = 3.0_f64.to_radians();

/// Minimum change of heading of a turning circle, rad: the tactical diameter is reached.
const MIN_CIRCLE: f64 = PI;

/// Minimum change of heading of a turn before a pull-out, rad.
const MIN_TURN: f64 = FRAC_PI_2;

/// Maximum rudder amidships, as a share of the rudder of the turn.
const MAX_AMIDSHIPS_SHARE: f64 = 0.3;

/// Change of heading, rad, whose duration at the yaw rate of the turn is the time scale of a pull-out.
const PULL_OUT_TURN: f64 = 30.0_f64.to_radians();

/// Minimum duration of the rudder amidships, time scales.
const MIN_SCALES: f64 = 2.0;

/// Maximum change of a steady yaw rate from a time scale to the next, as a share of the rate of the turn.
const MAX_RATE_CHANGE: f64 = 0.04;

/// Turning circles and pull-outs among holds, which are in order of time.
pub(crate) fn turns(record: &PreparedLog, holds: &[Hold]) -> Vec<Pattern> {
    let mut patterns = Vec::new();
    for (index, hold) in holds.iter().enumerate() {
        let Some(turned) = turned(record, hold) else { continue };
        let rate = turned.abs() / hold.duration();
        if turned.abs() >= MIN_CIRCLE {
            let (side, heading_change) = (Side::from_angle(hold.median_angle), Some(turned.abs()));
            let manoeuvre =
                Manoeuvre::TurningCircle { rudder: hold.median_angle.abs(), side, duration: None, heading_change };
            patterns.push(Pattern { manoeuvre, holds: vec![*hold], scale: MIN_TURN / rate, swing: MIN_TURN });
        }
        patterns.extend(pull_out(record, hold, &holds[index + 1..]));
    }
    patterns
}

/// Change of heading in a turn, rad; `None` for a hold without a turn.
fn turned(record: &PreparedLog, hold: &Hold) -> Option<f64> {
    let rudder = hold.median_angle - record.rudder.neutral;
    let is_over = hold.median_angle.abs() >= MIN_RUDDER && rudder.abs() >= MIN_RUDDER;
    let turned =
        record.headings.heading_change(hold.start_time, hold.end_time).filter(|_| is_over && is_whole(record, hold))?;
    (turned * rudder.signum() >= MIN_TURN).then_some(turned)
}

/// `true` if a hold has no gap in which the rudder may have moved.
fn is_whole(record: &PreparedLog, hold: &Hold) -> bool {
    let rows = &record.log.time[hold.first_row..=hold.last_row];
    rows.windows(2).all(|pair| pair[1] - pair[0] <= 0.25 * hold.duration())
}

/// Pull-out after a turn: the rudder amidships until the yaw rate is steady or the rudder moves. `None` if the rudder
/// is not put amidships soon or long enough, or if headings are missing.
fn pull_out(record: &PreparedLog, turn: &Hold, next: &[Hold]) -> Option<Pattern> {
    let end_of_turn = turn.end_time - 0.25 * turn.duration();
    let rate = record.headings.mean_rate(end_of_turn, turn.end_time)?.abs();
    let time = PULL_OUT_TURN / rate;
    let soon = |hold: &&Hold| hold.start_time - turn.end_time <= time.max(0.25 * turn.duration());
    // Between two turns the rudder is not amidships.
    let mut reach = next.iter().take_while(soon).take_while(|hold| turned(record, hold).is_none());
    let amidships = reach.find(|hold| hold.duration() >= MIN_SCALES * time)?;
    let neutral = record.rudder.neutral;
    let off = (amidships.median_angle - neutral).abs();
    let is_amidships = off <= MAX_AMIDSHIPS_SHARE * (turn.median_angle - neutral).abs() && off < MIN_RUDDER;
    if !is_amidships || !is_whole(record, amidships) {
        return None;
    }
    let rate_in =
        |k: f64| record.headings.mean_rate(amidships.start_time + k * time, amidships.start_time + (k + 1.0) * time);
    let mut pieces = 1.0;
    while (pieces + 1.0) * time <= amidships.duration() {
        let change = rate_in(pieces)? - rate_in(pieces - 1.0)?;
        pieces += 1.0;
        if change.abs() <= MAX_RATE_CHANGE * rate {
            break;
        }
    }
    let settled = amidships.start_time + pieces * time;
    let last = if (pieces + 1.0) * time > amidships.duration() {
        amidships.last_row
    } else {
        record
            .log
            .time
            .partition_point(|&t| t <= settled)
            .saturating_sub(1)
            .clamp(amidships.first_row, amidships.last_row)
    };
    // The rudder moves from the row after the turn on.
    let first = (turn.last_row + 1).min(amidships.first_row);
    let [from, until] = [first, last].map(|row| record.log.time[row]);
    let hold = Hold {
        first_row: first,
        last_row: last,
        start_time: from,
        end_time: until,
        median_angle: amidships.median_angle,
    };
    let (rudder, side) = (turn.median_angle.abs(), Side::from_angle(turn.median_angle));
    let manoeuvre = Manoeuvre::PullOut { rudder, side, hold: turn.duration(), duration: until - from };
    Some(Pattern { manoeuvre, holds: vec![hold], scale: time, swing: PULL_OUT_TURN })
}
