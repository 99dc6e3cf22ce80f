//! Cleaning of the columns of a table before they become a record: impossible rudder angles, channels that repeat an
//! old value until the next reading, a heading that is frozen while the ship turns, and single wrong readings.
//! Every change is located and reported; columns are unchanged if a sound record could look the same.

mod north;
pub(crate) mod readings;
mod written;

use document::{Warning, WarningCode};

use crate::channel::Channel;
use crate::record::{Columns, RejectedReading};
use crate::wording::{counted, rounded_to_thousandth};

/// Minimum magnitude of an impossible rudder angle, rad.
pub(crate) const MIN_IMPOSSIBLE_RUDDER_RAD: f64 = 1.6;

/// Maximum magnitude of the possible rudder angles of a record with impossible angles, rad. A larger angle shows a
/// wrong unit of the column, not single wrong readings.
const MAX_RUDDER: f64 = 1.05;

/// Maximum share of rows with an impossible rudder angle.
pub(crate) const MAX_IMPOSSIBLE_SHARE: f64 = 0.1;

/// Maximum period of the new values in a channel that repeats its values, rows.
const MAX_HOLD_ROWS: usize = 100;

/// Minimum number of changes that determine the rhythm of a channel.
const MIN_CHANGES: usize = 12;

/// Minimum share of rows with a reading in a channel that may repeat old values.
const MIN_READ_SHARE: f64 = 0.8;

/// Minimum share of changes in step with the rhythm of a channel.
const MIN_IN_STEP_SHARE: f64 = 0.97;

/// Maximum probability that separate movements have the same phase by chance. Rounding gives every steady movement a
/// rhythm, but not the same phase.
const MAX_CHANCE: f64 = 2e-3;

/// Minimum number of rows of a frozen heading.
const MIN_FROZEN_ROWS: usize = 8;

/// Minimum ratio of the rate of the heading at the end of a freeze to the 99th percentile of its rates.
const MIN_THAW_RATIO: f64 = 3.0;

/// Minimum change of heading before and after a freeze, each over as many readings as the freeze has, in steps of the
/// resolution. Before and after a peak that the resolution flattens, the change is 8 steps.
const MIN_TURN_STEPS: f64 = 20.0;

/// Sentinels: numbers that loggers write for a missing reading, without their sign.
const SENTINELS: [f64; 12] =
    [999.0, 999.9, 9999.0, 9999.9, 99999.0, 327.67, 327.68, 3276.7, 3276.8, 32767.0, 32768.0, 65535.0];

/// Minimum distance of a sentinel from the last reading, in the unit of the column.
const MIN_SENTINEL_JUMP: f64 = 60.0;

/// `true` for a sentinel: a number (in the unit of the column) that loggers write for a missing reading, far from the
/// last reading, if any. Always `false` for a position, which may have any value.
pub(crate) fn is_sentinel(channel: Channel, value: f64, last: Option<f64>) -> bool {
    !matches!(channel, Channel::North | Channel::East)
        && SENTINELS.contains(&value.abs())
        && last.is_none_or(|last| (value - last).abs() > MIN_SENTINEL_JUMP)
}

/// Cleans the columns and returns the warnings of all changes. Single wrong readings are added to `rejected`.
pub(crate) fn clean(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    warnings.extend(written::below_360(columns));
    warnings.extend(drop_impossible_rudder(columns, rejected));
    warnings.extend(straighten_rudder(columns));
    for channel in [Channel::Heading, Channel::YawRate] {
        warnings.extend(blank_repeats(columns, channel));
    }
    warnings.extend(written::blank_held(columns));
    warnings.extend(north::blank_sweeps(columns, rejected));
    warnings.extend(blank_frozen(columns, rejected));
    warnings.extend(readings::blank_lost_polls(columns, rejected));
    warnings.extend(readings::blank_spikes(columns, rejected));
    warnings.extend(readings::blank_clipped(columns, rejected));
    warnings
}

/// Omits rows with an impossible rudder angle and returns the warning. `None`, and no change, without such rows, with
/// more than [`MAX_IMPOSSIBLE_SHARE`] of them, or if another angle exceeds [`MAX_RUDDER`].
fn drop_impossible_rudder(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let rudder = columns.channels.get(&Channel::Rudder)?;
    let wild: Vec<usize> = (0..rudder.len()).filter(|&row| rudder[row].abs() > MIN_IMPOSSIBLE_RUDDER_RAD).collect();
    let largest = rudder.iter().map(|x| x.abs()).filter(|x| *x <= MIN_IMPOSSIBLE_RUDDER_RAD).fold(0.0, f64::max);
    if wild.is_empty() || wild.len() as f64 > MAX_IMPOSSIBLE_SHARE * rudder.len() as f64 || largest > MAX_RUDDER {
        return None;
    }
    let times = reject(Channel::Rudder, &columns.time, rudder, &wild, rejected);
    let largest = wild.iter().map(|&k| rudder[k]).fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
    let mut keep = vec![true; columns.time.len()];
    wild.iter().for_each(|&row| keep[row] = false);
    columns.retain(&keep);
    Some(WarningCode::RejectedReadings.warning(format!(
        "{} with an impossible rudder angle ({:.0}°) left out, {}; the rudder is interpolated between its neighbours",
        counted(wild.len(), "row"),
        largest.to_degrees(),
        times
    )))
}

/// Ordinal number: 2nd, 3rd, 4th, …
fn ordinal(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (1, teen) if teen != 11 => "st",
        (2, teen) if teen != 12 => "nd",
        (3, teen) if teen != 13 => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// Adds the readings of these rows to `rejected`; returns the text `at t = … s` with up to six of their times.
fn reject(
    channel: Channel,
    time: &[f64],
    values: &[f64],
    rows: &[usize],
    rejected: &mut Vec<RejectedReading>,
) -> String {
    const SHOWN: usize = 6;
    rejected.extend(rows.iter().map(|&row| RejectedReading { channel, time: time[row], value: values[row] }));
    let mut shown: Vec<String> = rows.iter().take(SHOWN).map(|&k| rounded_to_thousandth(time[k]).to_string()).collect();
    shown.extend((rows.len() > SHOWN).then(|| String::from("…")));
    format!("at t = {} s", shown.join(", "))
}

/// Rhythm of a channel that repeats its values: a new value every `every` rows, from row `first` on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rhythm {
    every: usize,
    first: usize,
}

impl Rhythm {
    /// Slowest rhythm of the changes of a channel; `None` for a channel without a rhythm of two rows or more.
    ///
    /// A rudder of whole degrees that moves at a steady rate also changes in a rhythm, but with a different phase in
    /// every movement. Separate movements therefore must agree.
    fn from_values(values: &[f64]) -> Option<Self> {
        let changed = |row: &usize| {
            let pair = [values[*row - 1], values[*row]];
            pair[0] != pair[1] && pair.iter().all(|x| x.is_finite())
        };
        // A channel with readings in some rows only has a rhythm without repetition.
        let read = values.iter().filter(|value| value.is_finite()).count();
        if (read as f64) < MIN_READ_SHARE * values.len() as f64 {
            return None;
        }
        // More changes than the shortest rhythm allows: most channels end here.
        let count = (1..values.len()).filter(changed).count();
        if count < MIN_CHANGES || MIN_IN_STEP_SHARE * count as f64 > values.len().div_ceil(2) as f64 {
            return None;
        }
        let changes: Vec<usize> = (1..values.len()).filter(changed).collect();
        let rhythm = |every: usize| {
            // With more changes than this rhythm allows, the phases need not be counted.
            if MIN_IN_STEP_SHARE * changes.len() as f64 > values.len().div_ceil(every) as f64 {
                return None;
            }
            let mut phases = vec![0usize; every];
            changes.iter().for_each(|row| phases[row % every] += 1);
            let (first, &most) = phases.iter().enumerate().max_by_key(|(_, count)| **count)?;
            let movements = 1 + changes.windows(2).filter(|pair| pair[1] - pair[0] > 3 * every).count();
            let accident = (every as f64).powi(1 - movements as i32);
            // With a new value in nearly every such row, no separate movements are needed to confirm the rhythm.
            let full = most as f64 > 0.8 * (values.len() / every) as f64 && most >= MIN_CHANGES;
            let keeps = most as f64 >= MIN_IN_STEP_SHARE * changes.len() as f64;
            // A channel of steps, such as an order, does not continue to change with the next new value.
            let continued = changes.windows(2).filter(|pair| pair[1] - pair[0] == every).count();
            let keeps = keeps && 2 * continued > changes.len();
            (keeps && (full || accident < MAX_CHANCE)).then_some(Self { every, first })
        };
        (2..=MAX_HOLD_ROWS.min(values.len() / MIN_CHANGES)).rev().find_map(rhythm)
    }

    fn is_new(self, row: usize) -> bool {
        row % self.every == self.first
    }
}

/// Replaces the values between rows `from` and `to` by linear interpolation in time.
pub(crate) fn interpolate_rows(time: &[f64], values: &mut [f64], from: usize, to: usize) {
    let slope = (values[to] - values[from]) / (time[to] - time[from]);
    for row in from + 1..to {
        values[row] = values[from] + slope * (time[row] - time[from]);
    }
}

/// Interpolates between the new values of a rudder that repeats its values and returns the warning. `None`, and no
/// change, without a rhythm.
fn straighten_rudder(columns: &mut Columns) -> Option<Warning> {
    let time = &columns.time;
    let rudder = columns.channels.get_mut(&Channel::Rudder)?;
    let rhythm = Rhythm::from_values(rudder)?;
    let new: Vec<usize> = (0..rudder.len()).filter(|&row| rhythm.is_new(row)).collect();
    for pair in new.windows(2) {
        interpolate_rows(time, rudder, pair[0], pair[1]);
    }
    Some(WarningCode::MissingValues.warning(format!(
        "the rudder has a new value in every {} row only; it is interpolated between the new values",
        ordinal(rhythm.every)
    )))
}

/// Sets the repetitions of a channel to missing and returns the warning. `None`, and no change, without a rhythm or if
/// too few rows would remain.
fn blank_repeats(columns: &mut Columns, channel: Channel) -> Option<Warning> {
    let values = columns.channels.get_mut(&channel)?;
    let rhythm = Rhythm::from_values(values)?;
    let left = (0..values.len()).filter(|&row| rhythm.is_new(row)).count();
    if left < crate::record::Trial::MIN_ROWS {
        return None;
    }
    for (row, value) in values.iter_mut().enumerate() {
        if !rhythm.is_new(row) {
            *value = f64::NAN;
        }
    }
    let (name, every) = (channel.label(), ordinal(rhythm.every));
    let text = format!("the {name} has a new value in every {every} row only; repeated values are taken as missing");
    Some(WarningCode::MissingValues.warning(text))
}

/// `true` if a channel keeps its value over the minimum length of a freeze.
fn has_rest(values: &[f64]) -> bool {
    let (mut last, mut count) = (f64::NAN, 0);
    for &value in values.iter().filter(|value| value.is_finite()) {
        count = if value == last { count + 1 } else { 0 };
        last = value;
        if count >= MIN_FROZEN_ROWS {
            return true;
        }
    }
    false
}

/// Sets a frozen heading to missing and returns the warning; `None` without a freeze. A constant heading is frozen if
/// it then changes faster than the ship turns, or if the ship turns before and after by much more than the resolution.
fn blank_frozen(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let time = &columns.time;
    let heading = columns.channels.get_mut(&Channel::Heading)?;
    if !has_rest(heading) {
        return None;
    }
    let seen: Vec<usize> = (0..heading.len()).filter(|&row| heading[row].is_finite()).collect();
    if seen.len() < 4 * MIN_FROZEN_ROWS {
        return None;
    }
    let steps: Vec<f64> = seen.windows(2).map(|pair| (heading[pair[1]] - heading[pair[0]]).abs()).collect();
    let mut rates: Vec<f64> =
        seen.windows(2).zip(&steps).map(|(pair, step)| step / (time[pair[1]] - time[pair[0]])).collect();
    let rates_of_rows = rates.clone();
    let fast = (0.99 * (rates.len() - 1) as f64) as usize;
    let usual = *rates.select_nth_unstable_by(fast, f64::total_cmp).1;
    let rests = steps.chunk_by(|before, after| *before == 0.0 && *after == 0.0).scan(0, |begin, chunk| {
        let range = *begin..*begin + chunk.len();
        *begin = range.end;
        Some(range)
    });
    let is_frozen = |span: &std::ops::Range<usize>| {
        let length = span.len();
        // The resolution is the larger of the steps to and from the value.
        let step = |at: Option<usize>| at.and_then(|at| steps.get(at)).copied().unwrap_or(0.0);
        let digit = step(span.start.checked_sub(1)).max(step(Some(span.end)));
        let turned = |range: std::ops::Range<usize>| steps[range].iter().sum::<f64>() > MIN_TURN_STEPS * digit;
        let before = turned(span.start.saturating_sub(length)..span.start);
        let after = turned(span.end..(span.end + length).min(steps.len()));
        let leaves = rates_of_rows.get(span.end).is_some_and(|rate| *rate > MIN_THAW_RATIO * usual);
        length >= MIN_FROZEN_ROWS && steps[span.start] == 0.0 && (leaves || (before && after))
    };
    // A rest of n steps has n + 1 rows, and the first is a true reading.
    let frozen: Vec<&[usize]> = rests.filter(is_frozen).map(|span| &seen[span.start..=span.end]).collect();
    let spans: Vec<String> = frozen
        .iter()
        .map(|rows| [rows[0], rows[rows.len() - 1]].map(|row| rounded_to_thousandth(time[row])))
        .map(|[from, to]| format!("from {from} s to {to} s"))
        .collect();
    let rows: Vec<usize> = frozen.iter().flat_map(|rows| &rows[1..]).copied().collect();
    reject(Channel::Heading, time, heading, &rows, rejected);
    rows.into_iter().for_each(|row| heading[row] = f64::NAN);
    let text = || format!("the heading is frozen {}; it is taken as missing there", spans.join(", "));
    (!spans.is_empty()).then(|| WarningCode::MissingValues.warning(text()))
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn clean(columns: &mut Columns) -> Vec<String> {
        super::clean(columns, &mut Vec::new()).into_iter().map(|warning| warning.text).collect()
    }

    /// Synthetic zig-zag: the rudder goes to 10° and back at 2.5°/s, the heading oscillates; 10 Hz, 300 s.
    pub(super) fn columns() -> Columns {
        let time: Vec<f64> = (0..3000).map(|row| 0.1 * f64::from(row)).collect();
        let rudder = |t: f64| (25.0 * (t / 9.7).sin()).clamp(-10.0, 10.0).to_radians();
        let heading = |t: f64| (15.0 * ((t - 20.0) / 9.7).sin()).to_radians();
        let channels = [
            (Channel::Rudder, time.iter().map(|&t| rudder(t)).collect()),
            (Channel::Heading, time.iter().map(|&t| heading(t)).collect()),
        ];
        Columns { time, channels: channels.into(), unknown_columns: Vec::new() }
    }

    pub(super) fn with(channel: Channel, change: impl Fn(usize, &[f64]) -> f64) -> Columns {
        let mut columns = columns();
        let values = columns.channels[&channel].clone();
        let changed = (0..values.len()).map(|row| change(row, &values)).collect();
        columns.channels.insert(channel, changed);
        columns
    }

    fn rounded(degrees: f64) -> impl Fn(usize, &[f64]) -> f64 {
        move |row, values| ((values[row].to_degrees() / degrees).round() * degrees).to_radians()
    }

    #[test]
    fn numbers_of_loggers_are_no_readings() {
        assert!(is_sentinel(Channel::Heading, -999.0, Some(12.0)) && is_sentinel(Channel::Rudder, 327.67, None));
        // A ship in continued turning has such a heading once, and a position may have any value.
        assert!(!is_sentinel(Channel::Heading, 999.0, Some(998.2)) && !is_sentinel(Channel::North, 999.0, None));
        assert!(!is_sentinel(Channel::Heading, -998.0, Some(12.0)));
    }

    /// Digits, orders in steps, and a rest before the trial are not faults.
    #[test]
    fn a_sound_record_is_left_alone() {
        let order = |row: usize, values: &[f64]| {
            let held = values[row / 10 * 10];
            if held.abs() < 0.1 { 0.0 } else { held.signum() * 0.17 }
        };
        let straight = |row: usize, values: &[f64]| if row < 400 { values[400] } else { values[row] };
        for mut sound in [
            columns(),
            with(Channel::Rudder, rounded(1.0)),
            with(Channel::Rudder, rounded(0.1)),
            with(Channel::Rudder, order),
            with(Channel::Heading, rounded(0.01)),
            with(Channel::Heading, rounded(0.1)),
            with(Channel::Heading, rounded(1.0)),
            with(Channel::Heading, straight),
        ] {
            let before = sound.channels.clone();
            assert_eq!(clean(&mut sound), [] as [String; 0]);
            assert_eq!(sound.channels, before);
        }
    }

    #[test]
    fn a_reading_no_rudder_has_is_left_out() {
        let mut wild = with(Channel::Rudder, |row, values| if row == 700 { -5.7 } else { values[row] });
        let [text] = clean(&mut wild).try_into().expect("one sentence");
        assert!(text.contains("1 row") && text.contains("-327°") && text.contains("t = 70 s"), "{text}");
        assert_eq!((wild.time.len(), wild.channels[&Channel::Heading].len()), (2999, 2999));
        // A record in degrees under a name of radians is not a single wrong reading.
        let mut degrees = with(Channel::Rudder, |row, values| values[row].to_degrees());
        assert_eq!(clean(&mut degrees), [] as [String; 0]);
    }

    #[test]
    fn an_old_rudder_is_not_a_rudder_that_waits() {
        for phase in [0, 3] {
            let mut stale =
                with(Channel::Rudder, |row, values| values[((row + 10 - phase) / 10 * 10 + phase).saturating_sub(10)]);
            let [text] = clean(&mut stale).try_into().expect("one sentence");
            assert!(text.contains("every 10th row"), "{text}");
            let truth = &columns().channels[&Channel::Rudder];
            let far = stale.channels[&Channel::Rudder].iter().zip(truth).map(|(one, other)| (one - other).abs());
            assert!(far.fold(0.0, f64::max).to_degrees() < 0.7);
        }
        let mut stale = with(Channel::Heading, |row, values| values[row / 5 * 5]);
        assert!(clean(&mut stale)[0].contains("every 5th row"));
        let left = stale.channels[&Channel::Heading].iter().filter(|psi| psi.is_finite()).count();
        assert_eq!(left, 600);
    }

    #[test]
    fn a_frozen_heading_is_missing() {
        for degrees in [1e-9, 0.1, 1.0] {
            let frozen = |row: usize, values: &[f64]| values[if (1000..1300).contains(&row) { 1000 } else { row }];
            let mut stuck = with(Channel::Heading, |row, values| {
                let value = [frozen(row, values)];
                rounded(degrees)(0, &value)
            });
            let [text] = clean(&mut stuck).try_into().expect("one sentence");
            assert!(text.contains("s to 129.9 s"), "{text}");
            let missing = stuck.channels[&Channel::Heading].iter().filter(|psi| psi.is_nan()).count();
            assert!((299..=315).contains(&missing), "{missing}");
        }
    }
}
