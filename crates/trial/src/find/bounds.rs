//! Bounds of a manoeuvre in a log: from the first execute, or the steady approach before it, to the last row before the
//! rudder leaves its last hold or the propeller stops.

use super::detection::{ApproachState, DetectedManoeuvre, MAX_APPROACH_SPEED_CHANGE, RecordingQuality};
use super::headings::thinned_median;
use super::pattern::{Pattern, PreparedLog};
use super::rudder::{Hold, finite_median};
use crate::manoeuvre::Manoeuvre;
use crate::plausibility::{extremes, range};
use crate::zigzag::executes::{RudderMovements, row_before};
use crate::zigzag::holds::{self, MIN_HOLD_ANGLE_SHARE};

/// Tolerance of the rudder about its median in a steady approach, as a share of the rudder of the manoeuvre.
const STEADY_RUDDER: f64 = 0.15;

/// Tolerance of the median rudder about amidships in a steady approach, as a share of the rudder of the manoeuvre.
const AMIDSHIPS: f64 = 0.35;

/// Maximum rate of change of heading in a steady approach, as a share of the usual rate of the manoeuvre.
const STEADY_RATE: f64 = 0.2;

/// Additional change of heading in a steady approach for noise and waves, as a share of a swing.
const STEADY_HEADING: f64 = 0.05;

/// Minimum length of a steady approach as a share of the maximum length; shorter if the log begins with it.
const MIN_APPROACH_SHARE: f64 = 0.25;

/// Maximum revolutions of a stopped engine, as a share of the usual revolutions.
const STOPPED_SHARE: f64 = 0.5;

/// Minimum length of a gap in the approach, usual time steps.
const GAP_STEPS: f64 = 30.0;

/// Maximum number of holds for the time of the first execute; more holds do not make it more certain.
const MAX_TIMING_HOLDS: usize = 4;

/// Tolerance of the rudder about the line of its movement, as a share of the band of a hold.
const RAMP_TOLERANCE: f64 = 0.6;

/// Minimum number of rows on the line of a movement.
const MIN_RAMP_ROWS: usize = 3;

/// Number of rows, in addition to the last row at rest, whose median is the rudder angle before a movement.
const MEDIAN_ROWS: usize = 8;

/// Manoeuvres with their bounds, from patterns that are in order of time and do not overlap.
pub(crate) fn with_bounds(record: &PreparedLog, patterns: &[Pattern]) -> Vec<DetectedManoeuvre> {
    let time = record.log.time;
    let mut free = 0;
    let mut list = Vec::new();
    for pattern in patterns {
        let last = before_stop(record, pattern);
        let (start, approach) = match pattern.manoeuvre {
            Manoeuvre::PullOut { .. } => (pattern.first(), None),
            _ => {
                let start = first_execute(record, &pattern.holds, pattern.scale, free);
                (start, Some(ApproachSegment::from_pattern(record, pattern, start, free)))
            }
        };
        let first = approach.as_ref().map_or(start, |segment| segment.first);
        let last = last.max(start);
        let executes = pattern.holds.iter().filter(|hold| hold.first_row <= last).count();
        let mut quality = RecordingQuality::from_rows(record, first, last);
        quality.rudder_spread = spread(pattern);
        if let Some(segment) = approach {
            quality.approach = Some(segment.approach);
            quality.speed_change = segment.speed_change;
        }
        list.push(DetectedManoeuvre {
            manoeuvre: Some(pattern.manoeuvre.clone()),
            start_time: time[first],
            end_time: time[last],
            first_execute_time: time[start],
            execute_count: executes,
            quality,
        });
        free = last + 1;
    }
    list
}

/// Maximum difference between holds to one side of a zig-zag, rad; 0 for other manoeuvres.
fn spread(pattern: &Pattern) -> f64 {
    if !matches!(pattern.manoeuvre, Manoeuvre::ZigZag { .. }) {
        return 0.0;
    }
    let side_spread = |offset: usize| {
        let levels = pattern.holds.iter().skip(offset).step_by(2).map(|hold| hold.median_angle);
        range(&levels.collect::<Vec<f64>>())
    };
    side_spread(0).max(side_spread(1))
}

/// Last row of a manoeuvre in which the propeller turns.
fn before_stop(record: &PreparedLog, pattern: &Pattern) -> usize {
    let (first, last) = (pattern.first(), pattern.last());
    let Some(propeller) = record.log.propeller_rate.and_then(|values| values.get(first..=last)) else { return last };
    let stopped = STOPPED_SHARE * finite_median(propeller.iter().map(|n| n.abs()));
    let is_stopped = |row: usize| propeller.get(row).is_none_or(|n| n.abs() < stopped);
    // A single row without revolutions is a fault of the channel, except the last row, which has no next row.
    (0..propeller.len())
        .find(|&row| is_stopped(row) && is_stopped(row + 1))
        .map_or(last, |row| (first + row).max(first + 1) - 1)
}

/// First row in which the rudder moves into the first of the holds. The search begins `scale` seconds before the hold,
/// earlier for a slow rudder, but not before row `free`.
pub(crate) fn first_execute(record: &PreparedLog, holds: &[Hold], scale: f64, free: usize) -> usize {
    let time = record.log.time;
    let holds = &holds[..holds.len().min(MAX_TIMING_HOLDS)];
    let hold = holds[0];
    // A slow rudder takes longer than a short first hold.
    let longest = |times: &mut dyn Iterator<Item = f64>| times.fold(0.0, f64::max);
    let movement = longest(&mut holds.windows(2).map(|pair| pair[1].start_time - pair[0].end_time));
    let scale = scale.max(movement + longest(&mut holds.iter().map(Hold::duration)));
    let window = time.partition_point(|&t| t < hold.start_time - scale).max(free).min(hold.first_row);
    let end = holds[holds.len() - 1].last_row;
    let local = |hold: &Hold| holds::Hold {
        side: if hold.median_angle < 0.0 { -1.0 } else { 1.0 },
        first_row: hold.first_row - window,
        last_row: hold.last_row - window,
        median_angle: hold.median_angle,
    };
    let mut local: Vec<holds::Hold> = holds.iter().map(local).collect();
    // A movement ends slowly, so its end does not give its rate: the hold begins before the rudder rests.
    let angle = &record.rudder.angle[window..=end];
    let laid = |&row: &usize| {
        let [before, after] = [row, row + 1].map(|row| local[0].side * angle[row]);
        before < after && before >= MIN_HOLD_ANGLE_SHARE * hold.median_angle.abs()
    };
    local[0].first_row = (0..local[0].first_row).rev().take_while(laid).last().unwrap_or(local[0].first_row);
    if let ([_], Some(row)) = (&local[..], single_ramp(&time[window..=end], angle, &local[0], record.rudder.noise_sd)) {
        return window + row;
    }
    let rudder = RudderMovements::new(&time[window..=end], angle, &local, Some(record.rudder.noise_sd));
    let Some(movement) = rudder.first_movement() else { return hold.first_row };
    let start = time.partition_point(|&t| t < movement.start_time.value).clamp(window, hold.first_row);
    let rate = movement.rate.map(f64::abs).or(rudder.rate);
    rate.map_or(start, |rate| {
        start.max(window + on_ramp(&time[window..=end], angle, &local[0], rate, record.rudder.floor))
    })
}

/// Last row before a hold in which the rudder has at most half of its angle; `None` if the record has no such row.
fn half_way(angle: &[f64], hold: &holds::Hold) -> Option<usize> {
    (0..hold.first_row).rev().find(|&row| hold.side * angle[row] <= 0.5 * hold.median_angle.abs())
}

/// First row on the line of a movement into a hold, at a rate in rad/s; 0 for a movement with too few rows. Steering to
/// the same side just before the movement shifts the intersection of that line with the old level, but is not on it.
fn on_ramp(time: &[f64], angle: &[f64], hold: &holds::Hold, rate: f64, floor: f64) -> usize {
    let half = half_way(angle, hold).unwrap_or(0);
    let off = |row: usize| (angle[row] - angle[half] - hold.side * rate * (time[row] - time[half])).abs();
    // The second half of the movement gives the scatter about the line: rounding and uneven times.
    let ramp: Vec<usize> = (half + 1..hold.first_row)
        .take_while(|&row| hold.side * angle[row] < MIN_HOLD_ANGLE_SHARE * hold.median_angle.abs())
        .collect();
    if ramp.len() < MIN_RAMP_ROWS {
        return 0;
    }
    let usual = ramp.iter().map(|&row| off(row)).fold(0.0, f64::max);
    let tolerance = (RAMP_TOLERANCE * floor).max(1.2 * usual);
    // Noise can move a row or two further off.
    let is_on = |&row: &usize| (row.saturating_sub(2)..=row).any(|row| off(row) <= tolerance);
    (0..=half).rev().take_while(is_on).last().unwrap_or(half)
}

/// First row of the movement into the only hold of a manoeuvre, whose rate no other movement gives; `None` if
/// the record does not contain the movement.
fn single_ramp(time: &[f64], angle: &[f64], hold: &holds::Hold, noise: f64) -> Option<usize> {
    let laid = hold.first_row;
    let half = half_way(angle, hold)?;
    let rate = (angle[laid] - angle[half]) / (time[laid] - time[half]);
    let look_back = (0.2 * hold.median_angle.abs()).max(8.0 * noise) / rate.abs();
    let mut row = half;
    while row > 0 {
        let earlier = row_before(time, row, look_back).min(row - 1);
        if (angle[row] - angle[earlier]) / (time[row] - time[earlier]) / rate < 0.3 {
            break;
        }
        row -= 1;
    }
    let clear = row_before(time, row, 0.3 * look_back);
    let before = thinned_median(&angle[clear.saturating_sub(MEDIAN_ROWS)..=clear])?;
    let start = time[half] - (angle[half] - before) / rate;
    let tolerance = (2.5 * noise).max(0.01 * hold.median_angle.abs());
    let first = time.partition_point(|&t| t < start).min(laid);
    Some((first..laid).find(|&row| (angle[row] - before).abs() > tolerance).unwrap_or(laid))
}

/// Part of the approach that belongs to a manoeuvre.
struct ApproachSegment {
    /// First row of the part: before the execute in a steady approach, else the execute.
    first: usize,
    approach: ApproachState,
    /// Relative change of speed in the approach; `None` if no speed was recorded.
    speed_change: Option<f64>,
}

impl ApproachSegment {
    fn from_pattern(record: &PreparedLog, pattern: &Pattern, start: usize, free: usize) -> Self {
        let time = record.log.time;
        let earliest = time.partition_point(|&t| t < time[start] - pattern.scale).max(free).min(start);
        let speed_change = change(record.log.speed, earliest, start);
        let none = |approach| Self { first: start, approach, speed_change };
        if earliest == start {
            return none(if start == 0 { ApproachState::Absent } else { ApproachState::Unsteady });
        }
        let is_steady = |change: Option<f64>| change.is_none_or(|change| change.abs() <= MAX_APPROACH_SPEED_CHANGE);
        if !is_steady(speed_change) || !is_steady(change(record.log.propeller_rate, earliest, start)) {
            return none(ApproachState::Unsteady);
        }
        let Some(rudder_from) = steady_rudder(record, pattern, earliest, start) else {
            return none(ApproachState::Unsteady);
        };
        let longest = time[start] - time[rudder_from];
        let rate = pattern.swing / pattern.scale;
        // The approach is steadier nearer to the execute: if the course was reached late, its last part remains.
        for share in [1.0, 0.5, 0.25] {
            let first = time.partition_point(|&t| t < time[start] - share * longest).max(rudder_from);
            let duration = time[start] - time[first];
            let long = duration >= MIN_APPROACH_SHARE * pattern.scale * (1.0 - 1e-9) || first == 0;
            let turned = record.headings.heading_change(time[first], time[start - 1]);
            let limit = STEADY_RATE * rate * duration + STEADY_HEADING * pattern.swing;
            if long && first < start && turned.is_none_or(|turned| turned.abs() <= limit) {
                return Self { first, approach: ApproachState::Steady, speed_change };
            }
        }
        none(ApproachState::Unsteady)
    }
}

/// First row from which the rudder stays about amidships until row `start`; `None` if it is not amidships there.
fn steady_rudder(record: &PreparedLog, pattern: &Pattern, earliest: usize, start: usize) -> Option<usize> {
    let (time, angle) = (record.log.time, &record.rudder.angle);
    let (lowest, highest) = extremes(pattern.holds.iter().map(|hold| hold.median_angle));
    let largest = lowest.abs().max(highest.abs());
    let amidships = match pattern.manoeuvre {
        Manoeuvre::TurningCircle { .. } => record.rudder.neutral,
        _ => 0.5 * (highest + lowest),
    };
    let level = thinned_median(&angle[start - (start - earliest).div_ceil(4)..start])?;
    if (level - amidships).abs() > AMIDSHIPS * largest {
        return None;
    }
    let tolerance = (STEADY_RUDDER * largest).max(3.0 * record.rudder.noise_sd);
    let is_steady = |row: &usize| {
        let gap = time[row + 1] - time[*row] > GAP_STEPS * record.rudder.step;
        (angle[*row] - level).abs() <= tolerance && !gap
    };
    (earliest..start).rev().take_while(is_steady).last()
}

/// Change of a channel from the first to the last third of the rows `first..end`, as a share of the larger; `None`
/// without readings in both thirds, and if both means are zero.
fn change(channel: Option<&[f64]>, first: usize, end: usize) -> Option<f64> {
    let values = channel?.get(first..end)?;
    let third = values.len().div_ceil(3);
    let mean = |values: &[f64]| {
        let read = || values.iter().filter(|x| x.is_finite());
        let count = read().count();
        (count > 0).then(|| read().sum::<f64>() / count as f64)
    };
    let (early, late) = (mean(&values[..third])?, mean(&values[values.len() - third..])?);
    let size = early.abs().max(late.abs());
    (size > 0.0).then(|| (late - early) / size)
}
