//! Single readings that are wrong: spikes and jumps of a heading, a yaw rate at the end of its scale. A spike is left
//! out; a jump is told and left, for nobody can say which side of it is right.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use document::{Code, Warning};
use estimation::statistics::upper_median;

use super::reject;
use crate::channel::Channel;
use crate::record::{Columns, RejectedReading};
use crate::words::counted;

/// Least height of a spike or a jump, rad: 2°, more than any digits and waves make of two readings.
const LEAST: f64 = 0.035;

/// Height of a spike, or of a jump, in usual deviations from a straight line between neighbours.
const CLEAR: f64 = 12.0;

/// A spike is as many times higher than its neighbours are apart.
const ALONE: f64 = 4.0;

/// Largest share of the readings that may be spikes: more are the noise of the sensor.
const FEW: f64 = 0.05;

/// Fewest readings of one value that are lost polls, and the largest share of a channel they may be.
const LOST_POLLS: (usize, f64) = (3, 0.4);

/// Share of the readings far from both neighbours that have this one value: those of a noisy sensor have many.
const OF_ONE_VALUE: f64 = 0.8;

/// Values that agree to this many parts of a radian are one.
const DIGITS: f64 = 1e9;

/// A lost poll is as many times farther from its neighbours as they are apart.
const FROM_BOTH: f64 = 2.0;

/// Fewest rows at the end of the scale of a yaw rate.
const CLIPPED: usize = 5;

/// Rate of the heading over the largest reading of its rate that shows the end of a scale.
const BEYOND: f64 = 1.15;

/// The readings of a channel: row by row, those that are there.
fn readings(values: &[f64]) -> impl Iterator<Item = usize> {
    (0..values.len()).filter(|&row| values[row].is_finite())
}

/// Distance of every inner reading from the straight line between its neighbours, with its rows.
pub(crate) fn deviations<'a>(time: &'a [f64], values: &'a [f64]) -> impl Iterator<Item = ([usize; 3], f64)> + 'a {
    let (mut one, mut two) = (None, None);
    readings(values).filter_map(move |row| {
        let rows = one.zip(two).map(|(one, two): (usize, usize)| [one, two, row]);
        (one, two) = (two, Some(row));
        let [before, at, after] = rows?;
        let share = (time[at] - time[before]) / (time[after] - time[before]);
        let line = values[before] + share * (values[after] - values[before]);
        Some(([before, at, after], values[at] - line))
    })
}

/// The usual size of a deviation, from a hundred thousand of them at most; `None` for a channel that is hardly read.
fn usual(time: &[f64], values: &[f64]) -> Option<f64> {
    const ENOUGH: usize = 100_000;
    let every = values.len() / ENOUGH + 1;
    let sizes: Vec<f64> = deviations(time, values).step_by(every).map(|(_, deviation)| deviation.abs()).collect();
    Some(sizes).filter(|sizes| sizes.len() > 2 * CLIPPED).and_then(upper_median).map(|size| 1.4826 * size)
}

/// Takes single readings of one and the same value as missing where both neighbours are far from it and near each
/// other: polls that were not answered, for which a logger writes zero, and a calibration behind it another number. A
/// channel that passes through the value has neighbours on either side of it.
pub(super) fn drop_lost_polls(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Vec<Warning> {
    let time = &columns.time;
    let mut told = Vec::new();
    for channel in [Channel::Heading, Channel::Rudder, Channel::YawRate] {
        let Some(values) = columns.channels.get_mut(&channel) else { continue };
        let rows: Vec<usize> = readings(values).collect();
        let is_alone = |at: usize, beside: [usize; 2]| {
            let [one, other] = beside.map(|row| values[row] - values[at]);
            let near = one.abs().min(other.abs());
            one * other > 0.0 && near > LEAST && near > FROM_BOTH * (one - other).abs()
        };
        let inner = rows.windows(3).filter(|rows| is_alone(rows[1], [rows[0], rows[2]])).map(|rows| rows[1]);
        // The first and the last have their neighbours on one side.
        let first = rows.get(..3).filter(|rows| is_alone(rows[0], [rows[1], rows[2]])).map(|rows| rows[0]);
        let last = rows.last_chunk::<3>().filter(|rows| is_alone(rows[2], [rows[1], rows[0]])).map(|rows| rows[2]);
        let alone: Vec<usize> = first.into_iter().chain(inner).chain(last).collect();
        // Whole turns of a heading are nothing.
        let value = |row: usize| match channel {
            Channel::Heading => (values[row].rem_euclid(TAU) * DIGITS).round().rem_euclid((TAU * DIGITS).round()),
            _ => (values[row] * DIGITS).round(),
        };
        let mut of_value: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
        alone.iter().for_each(|&row| of_value.entry(value(row) as i64).or_default().push(row));
        let Some((written, lost)) = of_value.into_iter().max_by_key(|(_, rows)| rows.len()) else { continue };
        let is_most = lost.len() as f64 >= OF_ONE_VALUE * alone.len() as f64;
        if lost.len() < LOST_POLLS.0 || lost.len() as f64 > LOST_POLLS.1 * rows.len() as f64 || !is_most {
            continue;
        }
        let times = reject(channel, time, values, &lost, rejected);
        lost.iter().for_each(|&row| values[row] = f64::NAN);
        // What is the same beside them may be lost, too, and nobody can tell.
        told.push(Code::RejectedReadings.warning(format!(
            "{} of exactly {} between others far from it taken as missing, as polls that were not answered, {times}",
            counted(lost.len(), channel.spoken()),
            if written == 0 { "zero".to_owned() } else { format!("{:.2}°", (written as f64 / DIGITS).to_degrees()) },
        )));
    }
    told
}

/// Takes single readings far from both neighbours as missing, of heading and rudder, and tells of jumps of the heading.
pub(super) fn drop_spikes(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Vec<Warning> {
    let time = &columns.time;
    let mut told = Vec::new();
    for channel in [Channel::Heading, Channel::Rudder] {
        let Some(values) = columns.channels.get_mut(&channel) else { continue };
        let Some(usual) = usual(time, values) else { continue };
        let least = LEAST.max(CLEAR * usual);
        let mut spikes = Vec::new();
        for ([before, row, after], deviation) in deviations(time, values) {
            let apart = (values[after] - values[before]).abs();
            if deviation.abs() > least.max(ALONE * apart) {
                spikes.push((row, deviation));
            }
        }
        if !spikes.is_empty() && spikes.len() as f64 <= FEW * values.len() as f64 {
            let largest = spikes.iter().map(|(_, deviation)| deviation.abs()).fold(0.0, f64::max);
            let rows: Vec<usize> = spikes.iter().map(|&(row, _)| row).collect();
            let times = reject(channel, time, values, &rows, rejected);
            rows.into_iter().for_each(|row| values[row] = f64::NAN);
            told.push(Code::RejectedReadings.warning(format!(
                "{} far from both neighbours (by up to {:.1}°) taken as missing, {times}",
                counted(spikes.len(), channel.spoken()),
                largest.to_degrees(),
            )));
        }
        if channel == Channel::Heading {
            told.extend(jumps(time, values, least, rejected));
        }
    }
    told
}

/// Tells of steps between two headings that no ship makes: far more than the steps before and after.
fn jumps(time: &[f64], heading: &[f64], least: f64, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let mut found = Vec::new();
    let mut last: [Option<usize>; 3] = [None; 3];
    for row in readings(heading) {
        if let [Some(first), Some(second), Some(third)] = last {
            let rate = |from: usize, to: usize| ((heading[to] - heading[from]) / (time[to] - time[from])).abs();
            let step = (heading[third] - heading[second]).abs();
            let around = rate(first, second).max(rate(third, row));
            // Over a gap a ship may turn far.
            if step > least && step > ALONE * around * (time[third] - time[second]) {
                found.push((third, step));
            }
        }
        last = [last[1], last[2], Some(row)];
    }
    if found.is_empty() || found.len() as f64 > FEW * heading.len() as f64 {
        return None;
    }
    let largest = found.iter().map(|(_, step)| *step).fold(0.0, f64::max);
    let rows: Vec<usize> = found.iter().map(|&(row, _)| row).collect();
    let times = reject(Channel::Heading, time, heading, &rows, rejected);
    Some(Code::HeadingJump.warning(format!(
        "the heading jumps (by up to {:.1}°) as no ship turns, {times}; it is left as it is, for nobody can say which side is right",
        largest.to_degrees(),
    )))
}

/// Takes a yaw rate as missing where it stays at the end of its scale while the heading turns faster.
pub(super) fn drop_clipped(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let time = &columns.time;
    let (heading, rate) = (columns.channels.get(&Channel::Heading)?, columns.channels.get(&Channel::YawRate)?);
    let end = rate.iter().filter(|rate| rate.is_finite()).fold(0.0, |end: f64, rate| end.max(rate.abs()));
    let at_end: Vec<usize> = readings(rate).filter(|&row| rate[row].abs() == end).collect();
    if end == 0.0 || at_end.len() < CLIPPED {
        return None;
    }
    // The heading over every run of rows at the end of the scale.
    let (mut turned, mut expected, mut rows) = (0.0, 0.0, 0);
    for run in at_end.chunk_by(|one, next| next - one == 1 && rate[*one] == rate[*next]) {
        let (first, last) = (run[0], run[run.len() - 1]);
        let change = (heading[last] - heading[first]).abs();
        if run.len() >= CLIPPED && change.is_finite() {
            turned += change;
            expected += end * (time[last] - time[first]);
            rows += run.len();
        }
    }
    if rows == 0 || turned < BEYOND * expected {
        return None;
    }
    let rate = columns.channels.get_mut(&Channel::YawRate)?;
    reject(Channel::YawRate, &columns.time, rate, &at_end, rejected);
    at_end.iter().for_each(|&row| rate[row] = f64::NAN);
    Some(Code::RejectedReadings.warning(format!(
        "the yaw rate ends at {:.2}°/s while the heading turns faster: {} rows at the end of its scale taken as missing",
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
        let [told] = clean(&mut spiked).try_into().expect("one sentence");
        assert!(
            told.starts_with("1 heading far from both neighbours (by up to 5.7°)") && told.ends_with("t = 90 s"),
            "{told}"
        );
        assert!(spiked.channels[&Channel::Heading][900].is_nan());
        let jump = |row: usize, values: &[f64]| values[row] + if (900..950).contains(&row) { 0.1 } else { 0.0 };
        let mut jumped = with(Channel::Heading, jump);
        let [told] = clean(&mut jumped).try_into().expect("one sentence");
        assert!(told.contains("jumps (by up to 5.8°)") && told.contains("t = 90, 95 s"), "{told}");
    }

    #[test]
    fn a_poll_that_was_not_answered_is_missing() {
        for every in [3, 7] {
            let lost = |row: usize, values: &[f64]| if row.is_multiple_of(every) { 0.0 } else { values[row] };
            let mut polled = with(Channel::Rudder, lost);
            let told = clean(&mut polled).remove(0);
            assert!(told.contains("of exactly zero between others far from it"), "{told}");
            let calibrated = |row: usize, values: &[f64]| lost(row, values) + 0.04;
            let told = clean(&mut with(Channel::Rudder, calibrated)).remove(0);
            assert!(told.contains("of exactly 2.29° between"), "{told}");
            let rudder = &polled.channels[&Channel::Rudder];
            assert!(rudder.iter().filter(|delta| delta.is_nan()).count() > rudder.len() / every / 2);
        }
    }

    /// A heading that was made continuous has zeros at whole turns, and one may be the first row.
    #[test]
    fn a_heading_of_north_that_was_not_read_is_missing() {
        let lost = |row: usize, values: &[f64]| if row.is_multiple_of(7) { TAU } else { values[row] - 0.4 };
        let mut polled = with(Channel::Heading, lost);
        let told = clean(&mut polled).remove(0);
        assert!(told.contains("of exactly zero between others far from it") && told.contains("at t = 0, "), "{told}");
        assert!(polled.channels[&Channel::Heading].iter().step_by(7).all(|psi| psi.is_nan()));
    }

    #[test]
    fn a_rate_at_the_end_of_its_scale_is_missing() {
        let mut clipped = columns();
        let heading = clipped.channels[&Channel::Heading].clone();
        let rate = |row: usize| (heading[(row + 1).min(2999)] - heading[row.saturating_sub(1)]) / 0.2;
        let largest = 0.7 * (0..3000).map(rate).fold(0.0, f64::max);
        clipped.channels.insert(Channel::YawRate, (0..3000).map(|row| rate(row).clamp(-largest, largest)).collect());
        let [told] = clean(&mut clipped).try_into().expect("one sentence");
        assert!(told.contains("end of its scale"), "{told}");
        let mut sound = columns();
        sound.channels.insert(Channel::YawRate, (0..3000).map(rate).collect());
        assert_eq!(clean(&mut sound), [] as [String; 0]);
    }
}
