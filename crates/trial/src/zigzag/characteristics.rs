//! Characteristics of the zig-zag of a record, from the executes of its rudder (`executes`) and its smoothed heading
//! (`heading`).
//!
//! Source of the definitions: ITTC 7.5-04-02-01 (2017).

use document::Quantity;
use ship::angle::{from_deg, to_deg};

use super::executes::{RudderMovement, RudderMovements};
use super::findings::{
    BaseCourse, BaseCourseSource, Execute, NominalAngles, Overshoot, Side, ZigZag, ZigZagError, period,
};
use super::heading::Heading;
use super::holds::{self, Hold};
use super::local::LocalPolynomial;
use crate::channel::Channel;
use crate::plausibility::range;
use crate::record::Trial;
use estimation::statistics::median;

/// Maximum yaw rate at a first execute, as a share of the maximum; at a reversal it is 0.7 or more.
const MAX_START_RATE: f64 = 0.4;

/// Maximum distance from the middle course at a first execute, as a share of the execute heading; at a peak it is
/// beyond 1.
const MAX_START_HEADING: f64 = 0.6;

/// Minimum rudder off amidships in the first row, as a share of the rudder of the trial, for a first execute that began
/// before the record.
const MIN_BEGUN_SHARE: f64 = 0.1;

/// Tolerance of the rudder in a steady approach, as a share of the rudder of the trial.
const STEADY_RUDDER: f64 = 0.25;

/// Maximum standard deviation of a measured overshoot, deg.
const MAX_OVERSHOOT_SD_DEG: f64 = 3.0;

/// Minimum number of headings of an approach whose mean is the base course.
const MIN_APPROACH_ROWS: usize = 3;

impl ZigZag {
    /// Characteristics of the zig-zag of a record.
    ///
    /// Fails if the record is not a zig-zag (see [`ZigZagError`]): the rudder is not laid by at least half a degree to
    /// both sides with two reversals, is not held there, or the heading moves against it; or if headings are missing
    /// at an execute.
    pub fn from_trial(trial: &Trial) -> Result<Self, ZigZagError> {
        read(trial)
    }
}

fn read(trial: &Trial) -> Result<ZigZag, ZigZagError> {
    let time = trial.time();
    let holds = holds::holds(trial.rudder())?;
    let rudder = RudderMovements::new(time, trial.rudder(), &holds, trial.noise().rudder_sd);
    let movements: Vec<RudderMovement> = (1..holds.len()).map(|index| rudder.reversal(index)).collect();
    let (opening, closing) = (movements[0].start_time.value, movements[movements.len() - 1].start_time.value);
    let rough_period = 2.0 * (closing - opening) / (movements.len() - 1) as f64;
    // A record has at least as many headings as a `Heading` requires.
    let heading = Heading::new(time, trial.heading(), rough_period, trial.noise().heading_sd)
        .expect("a trial has at least 8 headings");
    let mut executes: Vec<Execute> =
        movements.iter().map(|movement| execute(movement, &heading)).collect::<Result<_, _>>()?;
    check_direction(&executes)?;

    let end = time[holds[holds.len() - 1].last_row];
    let largest_rate_of_swings = heading.largest_rate(executes[0].time.value, end);
    let middle = middle_course(&executes);
    let first = rudder.first_movement().filter(|movement| {
        starts_straight(movement.start_time.value, &heading, &executes, middle, largest_rate_of_swings)
    });
    let base_course = match &first {
        None => BaseCourse { heading: middle, source: BaseCourseSource::Executes },
        Some(movement) => approach_course(trial, movement, &holds[0], &heading),
    };
    let pair = nominal_pair(&holds, &executes, middle);
    if let Some(movement) = &first {
        executes.insert(0, execute(movement, &heading)?);
    }
    let side = first.map(|_| executes[0].side());
    let overshoots = overshoots(&executes, usize::from(side.is_some()), end, &heading);
    let begins_moving = first.is_some_and(|movement| begins_moving(&movement, &holds));
    let since_first = |time: Option<Quantity>| Some(time?.minus(executes[0].time)).filter(|_| !begins_moving);
    let turned = side.zip(pair).and_then(|(side, pair)| {
        let level = base_course.heading.value + side.sign() * pair.heading - heading.origin;
        crossing(&heading, level, base_course.heading.sd, side, executes[0].time.value, end)
    });
    let back_on_base = |number: usize| {
        let execute: &Execute = executes.get(number)?;
        let level = base_course.heading.value - heading.origin;
        crossing(&heading, level, base_course.heading.sd, execute.side(), execute.time.value, time[time.len() - 1])
    };
    let from_first = side.is_some();
    Ok(ZigZag {
        nominal_angles: pair,
        first_side: side,
        base_course,
        initial_turning_time: since_first(turned),
        initial_turning_distance: (turned.filter(|_| !begins_moving))
            .and_then(|turned| distance(trial, executes[0].time.value, turned.value)),
        begins_at_reversal: side.is_none() && !shows_execute(&executes[0], &heading),
        overshoots,
        period: period(&executes, from_first),
        reach: from_first.then(|| since_first(back_on_base(1))).flatten(),
        complete_cycle_time: from_first.then(|| since_first(back_on_base(2))).flatten(),
        largest_yaw_rate: heading.largest_rate(executes[0].time.value, end),
        rudder_rate: rudder.rate,
        heading_noise_sd: heading.noise_sd,
        executes,
    })
}

fn execute(movement: &RudderMovement, heading: &Heading) -> Result<Execute, ZigZagError> {
    let time = movement.start_time;
    let psi = heading
        .heading_at(time.value)
        .ok_or(ZigZagError::NoHeading { time: time.value, reach: heading.widest_half_width() })?;
    let yaw_rate = heading.rate_at(time.value);
    // An error of the execute time shifts the heading along the turn.
    let timing = yaw_rate.and_then(|rate| Some((rate.value * time.sd?).abs()));
    Ok(Execute {
        time,
        heading: Quantity { value: psi.value + heading.origin, ..psi.widened(timing.or(Some(0.0))) },
        yaw_rate,
        rudder_before: movement.rudder_before,
        rudder_after: movement.rudder_after,
    })
}

/// Check that the heading moves to the side of the rudder between two reversals.
fn check_direction(reversals: &[Execute]) -> Result<(), ZigZagError> {
    for pair in reversals.windows(2) {
        let change = pair[1].heading.value - pair[0].heading.value;
        if pair[0].side().sign() * change <= 0.0 {
            return Err(ZigZagError::HeadingAgainstRudder {
                from: pair[0].time.value,
                to: pair[1].time.value,
                rudder_deg: to_deg(pair[0].rudder_after),
                change_deg: to_deg(change),
            });
        }
    }
    Ok(())
}

/// Middle course: midway between the mean headings at the executes to starboard and to port, so that a late helm
/// cancels.
fn middle_course(reversals: &[Execute]) -> Quantity {
    let mean = |side: Side| {
        let headings: Vec<Quantity> =
            reversals.iter().filter(|execute| execute.side() == side).map(|execute| execute.heading).collect();
        Quantity::mean(&headings).expect("two reversals or more alternate between the sides")
    };
    Quantity::mean(&[mean(Side::Port), mean(Side::Starboard)]).expect("there are two sides")
}

/// `true` if the ship runs straight on the middle course at the movement into the first hold: this is the
/// first execute of the trial. Otherwise the record begins within a reversal.
fn starts_straight(
    start: f64,
    heading: &Heading,
    reversals: &[Execute],
    middle: Quantity,
    largest_rate: Option<Quantity>,
) -> bool {
    let Some(largest) = largest_rate else { return false };
    // At the first row of a record a cubic is many times as noisy as a line, and a line has the mean rate of its
    // window: the highest degree with sufficiently low noise is used.
    let precise = 0.4 * MAX_START_RATE * largest.value;
    let Some((psi, rate)) = start_motion::<4>(heading, start, precise)
        .or_else(|| start_motion::<3>(heading, start, precise))
        .or_else(|| start_motion::<2>(heading, start, f64::INFINITY))
    else {
        return false;
    };
    let amplitude = 0.5 * (reversals[0].heading.value - reversals[1].heading.value).abs();
    let off_course = psi + heading.origin - middle.value;
    rate.abs() <= MAX_START_RATE * largest.value && off_course.abs() <= MAX_START_HEADING * amplitude
}

/// `true` if the record begins within the movement of the first execute.
fn begins_moving(first: &RudderMovement, holds: &[Hold]) -> bool {
    let amidships = 0.5 * (holds[0].median_angle + holds[1].median_angle);
    first.last_row_before == 0
        && (first.rudder_before - amidships).abs() > MIN_BEGUN_SHARE * holds[0].median_angle.abs()
}

/// `true` if the headings begin at least half a fit before an execute: a one-sided fit misses the bend there.
fn shows_execute(execute: &Execute, heading: &Heading) -> bool {
    execute.time.value - heading.half_width >= heading.time[0]
}

/// Relative heading (rad) and yaw rate (rad/s) at a time by a polynomial with `N` coefficients; `None` if headings are
/// missing, or the standard deviation of the rate exceeds `precise` (rad/s).
fn start_motion<const N: usize>(heading: &Heading, time: f64, precise: f64) -> Option<(f64, f64)> {
    let fit = LocalPolynomial::<N>::fit(&heading.time, &heading.relative, time, 2.0 * heading.half_width)?;
    (fit.slope_gain(time) * heading.noise_sd.unwrap_or(0.0) <= precise).then(|| (fit.value(time), fit.slope(time)))
}

/// Base course of a record with its first execute.
fn approach_course(trial: &Trial, first: &RudderMovement, hold: &Hold, heading: &Heading) -> BaseCourse {
    let tolerance = STEADY_RUDDER * hold.median_angle.abs();
    let moved = trial.rudder()[..=first.last_row_before]
        .iter()
        .rposition(|delta| (delta - first.rudder_before).abs() > tolerance);
    let from = moved.map_or(trial.time()[0], |row| trial.time()[row]);
    let rows = heading.rows(from, first.start_time.value);
    let n = rows.len();
    if n < MIN_APPROACH_ROWS {
        let heading = Quantity::new(heading.origin + heading.relative[0], heading.noise_sd);
        return BaseCourse { heading, source: BaseCourseSource::FirstHeading };
    }
    let mean = heading.relative[rows].iter().sum::<f64>() / n as f64;
    let sd = heading.noise_sd.map(|sd| sd / (n as f64).sqrt());
    BaseCourse { heading: Quantity::new(heading.origin + mean, sd), source: BaseCourseSource::Approach }
}

/// Nominal pair from the held rudder and the headings at the reversals; the helm is late rather than early.
///
/// Headings are relative to the middle course: it is less noisy than the first heading of a record, and valid if
/// the approach was not on the course of the trial. `None` if they differ by more than half their median, or if no
/// conventional angle is near.
fn nominal_pair(holds: &[Hold], reversals: &[Execute], middle: Quantity) -> Option<NominalAngles> {
    let mut angles: Vec<f64> =
        reversals.iter().map(|execute| to_deg((execute.heading.value - middle.value).abs())).collect();
    let angle = median(&mut angles)?;
    if range(&angles) > 0.5 * angle {
        return None;
    }
    let slack = to_deg(2.0 * middle.sd.unwrap_or(0.0));
    let heading = from_deg(holds::conventional_deg(angle, 0.05, 0.25, slack)?);
    let held = holds.iter().map(|hold| hold.median_angle.abs()).sum::<f64>() / holds.len() as f64;
    Some(NominalAngles { rudder: from_deg(holds::conventional_deg(to_deg(held), 0.08, 0.08, 0.0)?), heading })
}

fn overshoots(executes: &[Execute], first_reversal: usize, end: f64, heading: &Heading) -> Vec<Overshoot> {
    (first_reversal..executes.len())
        .filter_map(|index| {
            let execute = &executes[index];
            if !shows_execute(execute, heading) {
                return None;
            }
            let side = -execute.side().sign();
            let until = executes.get(index + 1).map_or(end, |next| next.time.value);
            let (peak_time, peak) = heading.peak(side, execute.time.value, until)?;
            let peak_heading = Quantity { value: peak.value + heading.origin, ..peak };
            let angle = peak_heading.minus(execute.heading).scaled(side);
            if angle.sd.is_some_and(|sd| to_deg(sd) > MAX_OVERSHOOT_SD_DEG) {
                return None;
            }
            Some(Overshoot {
                execute: index,
                peak_time,
                peak_heading,
                angle,
                time_to_check_yaw: peak_time.minus(execute.time),
            })
        })
        .collect()
}

/// Time, s, at which the heading passes a level that is itself uncertain; `None` if the record does not contain it.
fn crossing(heading: &Heading, level: f64, level_sd: Option<f64>, side: Side, from: f64, to: f64) -> Option<Quantity> {
    let time = heading.crossing(level, side.sign(), from, to)?;
    let rate = heading.rate_at(time.value)?;
    Some(time.widened(level_sd.map(|sd| sd / rate.value.abs())))
}

/// Distance travelled between two times, m: trapezoid integral of the speed over the rows with a speed. `None` unless
/// these rows include both times.
fn distance(trial: &Trial, from: f64, to: f64) -> Option<f64> {
    let speed = trial.channel(Channel::Speed)?;
    let rows: Vec<(f64, f64)> =
        trial.time().iter().copied().zip(speed.iter().copied()).filter(|(_, speed)| speed.is_finite()).collect();
    let (first, last) = (rows.first()?.0, rows.last()?.0);
    if from < first || to > last {
        return None;
    }
    let mut total = 0.0;
    for pair in rows.windows(2) {
        let ((t0, v0), (t1, v1)) = (pair[0], pair[1]);
        let (a, b) = (t0.max(from), t1.min(to));
        if b > a {
            let at = |t: f64| v0 + (v1 - v0) * (t - t0) / (t1 - t0);
            total += 0.5 * (at(a) + at(b)) * (b - a);
        }
    }
    Some(total)
}
