//! Single wrong readings: lost polls, spikes and jumps of a heading, a yaw rate at the end of its scale. A spike
//! is omitted; a jump is reported and kept, because either side of it may be right.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use document::{Warning, WarningCode};
use estimation::statistics::upper_median;

use super::reject;
use crate::channel::Channel;
use crate::record::{Columns, RejectedReading};
use crate::wording::counted;

/// Minimum height of a spike or a jump, rad: 2°, more than digits and waves cause between two readings.
const MIN_HEIGHT: f64 = 0.035;

/// Minimum height of a spike or a jump in robust standard deviations of the readings from the straight line between
/// their neighbours.
const MIN_HEIGHT_SDS: f64 = 12.0;

/// Minimum ratio of the height of a spike to the distance between its neighbours.
const MIN_SPIKE_RATIO: f64 = 4.0;

/// Maximum number of spikes or jumps as a share of the rows: a larger share is the noise of the sensor.
const MAX_SPIKE_SHARE: f64 = 0.05;

/// Minimum number of lost polls of a value, and their maximum share of a channel.
const LOST_POLLS: (usize, f64) = (3, 0.4);

/// Minimum share of the lost value among the readings far from both neighbours: a noisy sensor has many values.
const MIN_LOST_SHARE: f64 = 0.8;

/// Resolution of the comparison of values, 1/rad: values that agree to 1e-9 rad are the same.
const PER_RAD: f64 = 1e9;

/// Minimum ratio of the distance of a lost poll from its neighbours to the distance between them.
const MIN_LOST_RATIO: f64 = 2.0;

/// Minimum number of rows at the end of the scale of a yaw rate.
const MIN_CLIPPED_ROWS: usize = 5;

/// Minimum ratio of the rate of the heading to the maximum reading of a clipped yaw rate.
const MIN_CLIPPED_RATIO: f64 = 1.15;

/// Rows of a channel with a reading.
fn readings(values: &[f64]) -> impl Iterator<Item = usize> {
    (0..values.len()).filter(|&row| values[row].is_finite())
}

/// Rows `[before, at, after]` of every inner reading and its neighbours, and the deviation of the reading from the
/// straight line between its neighbours, in the unit of the values.
pub(crate) fn deviations<'a>(time: &'a [f64], values: &'a [f64]) -> impl Iterator<Item = ([usize; 3], f64)> + 'a {
    let (mut before, mut last) = (None, None);
    readings(values).filter_map(move |row| {
        let rows = before.zip(last).map(|(before, last): (usize, usize)| [before, last, row]);
        (before, last) = (last, Some(row));
        let [before, at, after] = rows?;
        let share = (time[at] - time[before]) / (time[after] - time[before]);
        let line = values[before] + share * (values[after] - values[before]);
        Some(([before, at, after], values[at] - line))
    })
}

/// Robust standard deviation from the straight line between neighbours: 1.4826 times the median of at most a hundred
/// thousand deviations. `None` for a channel with ten deviations or fewer.
fn deviation_sd(time: &[f64], values: &[f64]) -> Option<f64> {
    const MAX_DEVIATIONS: usize = 100_000;
    let every = values.len() / MAX_DEVIATIONS + 1;
    let sizes: Vec<f64> = deviations(time, values).step_by(every).map(|(_, deviation)| deviation.abs()).collect();
    Some(sizes).filter(|sizes| sizes.len() > 2 * MIN_CLIPPED_ROWS).and_then(upper_median).map(|size| 1.4826 * size)
}

/// Sets lost polls of heading, rudder and yaw rate to missing, appends them to `rejected` and returns one warning per
/// channel.
///
/// A logger writes zero for an unanswered poll, and a calibration may turn this zero into another number. Lost polls
/// are therefore single readings that all have one value. Both neighbours are far from it, on the same side, and near
/// each other. A reading with one neighbour above and one below is kept: there the channel passes through the value.
pub(super) fn blank_lost_polls(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Vec<Warning> {
    let time = &columns.time;
    let mut warnings = Vec::new();
    for channel in [Channel::Heading, Channel::Rudder, Channel::YawRate] {
        let Some(values) = columns.channels.get_mut(&channel) else { continue };
        let rows: Vec<usize> = readings(values).collect();
        let is_alone = |at: usize, beside: [usize; 2]| {
            let [left, right] = beside.map(|row| values[row] - values[at]);
            let distance = left.abs().min(right.abs());
            left * right > 0.0 && distance > MIN_HEIGHT && distance > MIN_LOST_RATIO * (left - right).abs()
        };
        let inner = rows.windows(3).filter(|rows| is_alone(rows[1], [rows[0], rows[2]])).map(|rows| rows[1]);
        // The first and the last reading have both neighbours on one side.
        let first = rows.get(..3).filter(|rows| is_alone(rows[0], [rows[1], rows[2]])).map(|rows| rows[0]);
        let last = rows.last_chunk::<3>().filter(|rows| is_alone(rows[2], [rows[1], rows[0]])).map(|rows| rows[2]);
        let alone: Vec<usize> = first.into_iter().chain(inner).chain(last).collect();
        // Headings are compared modulo a full turn.
        let value = |row: usize| match channel {
            Channel::Heading => (values[row].rem_euclid(TAU) * PER_RAD).round().rem_euclid((TAU * PER_RAD).round()),
            _ => (values[row] * PER_RAD).round(),
        };
        let mut by_value: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
        alone.iter().for_each(|&row| by_value.entry(value(row) as i64).or_default().push(row));
        let Some((written, lost)) = by_value.into_iter().max_by_key(|(_, rows)| rows.len()) else { continue };
        let is_most = lost.len() as f64 >= MIN_LOST_SHARE * alone.len() as f64;
        if lost.len() < LOST_POLLS.0 || lost.len() as f64 > LOST_POLLS.1 * rows.len() as f64 || !is_most {
            continue;
        }
        let times = reject(channel, time, values, &lost, rejected);
        lost.iter().for_each(|&row| values[row] = f64::NAN);
        // Equal readings next to them may be lost as well; that cannot be decided.
        warnings.push(WarningCode::RejectedReadings.warning(format!(
            "{} of exactly {} far from both neighbours taken as missing (polls without an answer), {times}",
            counted(lost.len(), channel.label()),
            if written == 0 { "zero".to_owned() } else { format!("{:.2}°", (written as f64 / PER_RAD).to_degrees()) },
        )));
    }
    warnings
}

/// Sets spikes of heading and rudder to missing and reports jumps of the heading.
pub(super) fn blank_spikes(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Vec<Warning> {
    let time = &columns.time;
    let mut warnings = Vec::new();
    for channel in [Channel::Heading, Channel::Rudder] {
        let Some(values) = columns.channels.get_mut(&channel) else { continue };
        let Some(sd) = deviation_sd(time, values) else { continue };
        let least = MIN_HEIGHT.max(MIN_HEIGHT_SDS * sd);
        let mut spikes = Vec::new();
        for ([before, row, after], deviation) in deviations(time, values) {
            let apart = (values[after] - values[before]).abs();
            if deviation.abs() > least.max(MIN_SPIKE_RATIO * apart) {
                spikes.push((row, deviation));
            }
        }
        if !spikes.is_empty() && spikes.len() as f64 <= MAX_SPIKE_SHARE * values.len() as f64 {
            let largest = spikes.iter().map(|(_, deviation)| deviation.abs()).fold(0.0, f64::max);
            let rows: Vec<usize> = spikes.iter().map(|&(row, _)| row).collect();
            let times = reject(channel, time, values, &rows, rejected);
            rows.into_iter().for_each(|row| values[row] = f64::NAN);
            warnings.push(WarningCode::RejectedReadings.warning(format!(
                "{} far from both neighbours (by up to {:.1}°) taken as missing, {times}",
                counted(spikes.len(), channel.label()),
                largest.to_degrees(),
            )));
        }
        if channel == Channel::Heading {
            warnings.extend(jumps(time, values, least, rejected));
        }
    }
    warnings
}

/// Warning of the jumps of a heading: steps of more than `least` (rad) and far larger than the steps before and after.
/// Their readings are appended to `rejected` and kept. `None` without a jump, and if jumps are so frequent that they
/// are the noise of the sensor.
fn jumps(time: &[f64], heading: &[f64], least: f64, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let mut jumps = Vec::new();
    let mut last: [Option<usize>; 3] = [None; 3];
    for row in readings(heading) {
        if let [Some(first), Some(second), Some(third)] = last {
            let rate = |from: usize, to: usize| ((heading[to] - heading[from]) / (time[to] - time[from])).abs();
            let step = (heading[third] - heading[second]).abs();
            let around = rate(first, second).max(rate(third, row));
            // Over a gap a ship may turn far.
            if step > least && step > MIN_SPIKE_RATIO * around * (time[third] - time[second]) {
                jumps.push((third, step));
            }
        }
        last = [last[1], last[2], Some(row)];
    }
    if jumps.is_empty() || jumps.len() as f64 > MAX_SPIKE_SHARE * heading.len() as f64 {
        return None;
    }
    let largest = jumps.iter().map(|(_, step)| *step).fold(0.0, f64::max);
    let rows: Vec<usize> = jumps.iter().map(|&(row, _)| row).collect();
    let times = reject(Channel::Heading, time, heading, &rows, rejected);
    Some(WarningCode::HeadingJump.warning(format!(
        "the heading jumps (by up to {:.1}°) faster than a ship turns, {times}; it is unchanged: either side may be right",
        largest.to_degrees(),
    )))
}

/// Sets the readings of a yaw rate at the end of its scale to missing if the heading turns faster there, and returns
/// the warning; `None` for a yaw rate within its scale.
pub(super) fn blank_clipped(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let time = &columns.time;
    let (heading, rate) = (columns.channels.get(&Channel::Heading)?, columns.channels.get(&Channel::YawRate)?);
    let end = rate.iter().filter(|rate| rate.is_finite()).fold(0.0, |end: f64, rate| end.max(rate.abs()));
    let at_end: Vec<usize> = readings(rate).filter(|&row| rate[row].abs() == end).collect();
    if end == 0.0 || at_end.len() < MIN_CLIPPED_ROWS {
        return None;
    }
    // Change of heading over every run of rows at the end of the scale.
    let (mut turned, mut expected, mut rows) = (0.0, 0.0, 0);
    for run in at_end.chunk_by(|row, next| next - row == 1 && rate[*row] == rate[*next]) {
        let (first, last) = (run[0], run[run.len() - 1]);
        let change = (heading[last] - heading[first]).abs();
        if run.len() >= MIN_CLIPPED_ROWS && change.is_finite() {
            turned += change;
            expected += end * (time[last] - time[first]);
            rows += run.len();
        }
    }
    if rows == 0 || turned < MIN_CLIPPED_RATIO * expected {
        return None;
    }
    let rate = columns.channels.get_mut(&Channel::YawRate)?;
    reject(Channel::YawRate, &columns.time, rate, &at_end, rejected);
    at_end.iter().for_each(|&row| rate[row] = f64::NAN);
    Some(WarningCode::RejectedReadings.warning(format!(
        "the yaw rate is clipped at {:.2}°/s: the heading turns faster; {} rows at the end of its scale taken as missing",
        end.to_degrees(),
        at_end.len()
    )))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{clean, columns, with};
    use super::*;

    #[test]
    fn a_spike_is_left_out_and_a_jump_is_told() {
        let spike = |row: usize, values: &[f64]| values[row] + if row == 900 { 0.1 } else { 0.0 };
        let mut spiked = with(Channel::Heading, spike);
        let [text] = clean(&mut spiked).try_into().expect("one sentence");
        assert!(
            text.starts_with("1 heading far from both neighbours (by up to 5.7°)") && text.ends_with("t = 90 s"),
            "{text}"
        );
        assert!(spiked.channels[&Channel::Heading][900].is_nan());
        let jump = |row: usize, values: &[f64]| values[row] + if (900..950).contains(&row) { 0.1 } else { 0.0 };
        let mut jumped = with(Channel::Heading, jump);
        let [text] = clean(&mut jumped).try_into().expect("one sentence");
        assert!(text.contains("jumps (by up to 5.8°)") && text.contains("t = 90, 95 s"), "{text}");
    }

    #[test]
    fn a_poll_that_was_not_answered_is_missing() {
        for every in [3, 7] {
            let lost = |row: usize, values: &[f64]| if row.is_multiple_of(every) { 0.0 } else { values[row] };
            let mut polled = with(Channel::Rudder, lost);
            let text = clean(&mut polled).remove(0);
            assert!(text.contains("of exactly zero far from both neighbours"), "{text}");
            let calibrated = |row: usize, values: &[f64]| lost(row, values) + 0.04;
            let text = clean(&mut with(Channel::Rudder, calibrated)).remove(0);
            assert!(text.contains("of exactly 2.29° far"), "{text}");
            let rudder = &polled.channels[&Channel::Rudder];
            assert!(rudder.iter().filter(|delta| delta.is_nan()).count() > rudder.len() / every / 2);
        }
    }

    /// An unwrapped heading has zeros at whole turns, one of them perhaps in the first row.
    #[test]
    fn a_heading_of_north_that_was_not_read_is_missing() {
        let lost = |row: usize, values: &[f64]| if row.is_multiple_of(7) { TAU } else { values[row] - 0.4 };
        let mut polled = with(Channel::Heading, lost);
        let text = clean(&mut polled).remove(0);
        assert!(text.contains("of exactly zero far from both neighbours") && text.contains("at t = 0, "), "{text}");
        assert!(polled.channels[&Channel::Heading].iter().step_by(7).all(|psi| psi.is_nan()));
    }

    #[test]
    fn a_rate_at_the_end_of_its_scale_is_missing() {
        let mut clipped = columns();
        let heading = clipped.channels[&Channel::Heading].clone();
        let rate = |row: usize| (heading[(row + 1).min(2999)] - heading[row.saturating_sub(1)]) / 0.2;
        let largest = 0.7 * (0..3000).map(rate).fold(0.0, f64::max);
        clipped.channels.insert(Channel::YawRate, (0..3000).map(|row| rate(row).clamp(-largest, largest)).collect());
        let [text] = clean(&mut clipped).try_into().expect("one sentence");
        assert!(text.contains("end of its scale"), "{text}");
        let mut sound = columns();
        sound.channels.insert(Channel::YawRate, (0..3000).map(rate).collect());
        assert_eq!(clean(&mut sound), [] as [String; 0]);
    }
}
