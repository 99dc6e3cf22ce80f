//! What is cleaned in the columns of a table before they are a record: rudder angles that no rudder has, channels that
//! repeat an old value until the next one comes, a heading that stood still while the ship turned, and single readings
//! that are wrong. Each is located and told; nothing is changed where a sound record could look the same.

mod north;
pub(crate) mod readings;
mod written;

use document::{Code, Warning};

use crate::channel::Channel;
use crate::record::{Columns, RejectedReading};
use crate::words::{counted, instant};

/// Angle beyond which no rudder goes, rad.
pub(crate) const NO_RUDDER: f64 = 1.6;

/// Angle that the rest of a record with such values stays within, rad: otherwise its unit is wrong, not a reading.
const ANY_RUDDER: f64 = 1.05;

/// Largest share of rows that may be left out as readings of no rudder.
pub(crate) const LARGEST_SHARE: f64 = 0.1;

/// Longest repetition that is looked for, rows.
const LONGEST_HOLD: usize = 100;

/// Fewest changes of a channel that show a rhythm.
const FEWEST_CHANGES: usize = 12;

/// Share of the rows in which a channel is read that may repeat old values.
const READ_IN: f64 = 0.8;

/// Share of the changes that keep to a rhythm of a channel that repeats old values.
const IN_STEP: f64 = 0.97;

/// Chance at which separate movements fall into one rhythm by accident; a movement of a steady rate has one of its own.
const ACCIDENT: f64 = 2e-3;

/// Fewest rows in which a heading stands still before it may be frozen.
const FROZEN_ROWS: usize = 8;

/// Rate at which a frozen heading is left against that of one row in a hundred.
const THAW: f64 = 3.0;

/// Change of heading on either side of a rest, over a time as long, in steps of its digits: at a peak that these do not
/// resolve it is 8.
const TURNING: f64 = 20.0;

/// Numbers that loggers write where a sensor gives nothing, without their sign.
const SENTINELS: [f64; 12] =
    [999.0, 999.9, 9999.0, 9999.9, 99999.0, 327.67, 327.68, 3276.7, 3276.8, 32767.0, 32768.0, 65535.0];

/// Change from the last reading from which on such a number is no reading, in the unit of the column.
const NO_READING: f64 = 60.0;

/// Whether a number stands for a reading that is not there: it is one of those that loggers write then, and far from
/// the last reading, where there was one. A position may have any value.
pub(crate) fn is_sentinel(channel: Channel, value: f64, last: Option<f64>) -> bool {
    !matches!(channel, Channel::North | Channel::East)
        && SENTINELS.contains(&value.abs())
        && last.is_none_or(|last| (value - last).abs() > NO_READING)
}

/// Cleans the columns; a warning of everything that was done. The single readings it was done to go to `rejected`.
pub(crate) fn clean(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Vec<Warning> {
    let mut done = Vec::new();
    done.extend(written::below_360(columns));
    done.extend(leave_out_no_rudder(columns, rejected));
    done.extend(straighten_rudder(columns));
    for channel in [Channel::Heading, Channel::YawRate] {
        done.extend(drop_repeats(columns, channel));
    }
    done.extend(written::drop_held(columns));
    done.extend(north::drop_sweeps(columns, rejected));
    done.extend(drop_frozen(columns, rejected));
    done.extend(readings::drop_lost_polls(columns, rejected));
    done.extend(readings::drop_spikes(columns, rejected));
    done.extend(readings::drop_clipped(columns, rejected));
    done
}

/// Leaves out rows whose rudder angle no rudder has, where they are few.
fn leave_out_no_rudder(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let rudder = columns.channels.get(&Channel::Rudder)?;
    let wild: Vec<usize> = (0..rudder.len()).filter(|&row| rudder[row].abs() > NO_RUDDER).collect();
    let rest = rudder.iter().map(|delta| delta.abs()).filter(|size| *size <= NO_RUDDER).fold(0.0, f64::max);
    if wild.is_empty() || wild.len() as f64 > LARGEST_SHARE * rudder.len() as f64 || rest > ANY_RUDDER {
        return None;
    }
    let times = reject(Channel::Rudder, &columns.time, rudder, &wild, rejected);
    let largest =
        wild.iter().map(|&row| rudder[row]).fold(0.0, |most: f64, x| if x.abs() > most.abs() { x } else { most });
    let mut keep = vec![true; columns.time.len()];
    wild.iter().for_each(|&row| keep[row] = false);
    columns.retain(&keep);
    Some(Code::RejectedReadings.warning(format!(
        "{} with a rudder angle no rudder has ({:.0}°) left out, {}; between its neighbours the rudder runs straight",
        counted(wild.len(), "row"),
        largest.to_degrees(),
        times
    )))
}

/// 2nd, 3rd, 4th, …
fn ordinal(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (1, rest) if rest != 11 => "st",
        (2, rest) if rest != 12 => "nd",
        (3, rest) if rest != 13 => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// Notes the readings of some rows as rejected; up to six of their times, for a message.
fn reject(
    channel: Channel,
    time: &[f64],
    values: &[f64],
    rows: &[usize],
    rejected: &mut Vec<RejectedReading>,
) -> String {
    const SHOWN: usize = 6;
    rejected.extend(rows.iter().map(|&row| RejectedReading { channel, time: time[row], value: values[row] }));
    let mut shown: Vec<String> = rows.iter().take(SHOWN).map(|&row| instant(time[row]).to_string()).collect();
    shown.extend((rows.len() > SHOWN).then(|| String::from("…")));
    format!("at t = {} s", shown.join(", "))
}

/// A channel that repeats its values: every `every` rows, from row `first` on, it has a new one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rhythm {
    every: usize,
    first: usize,
}

impl Rhythm {
    /// The slowest rhythm that the changes of a channel keep to; `None` where it has none of two rows or more.
    ///
    /// A rudder of whole degrees that moves at a steady rate changes in a rhythm, too, but in another phase at every
    /// movement: separate movements have to agree.
    fn of(values: &[f64]) -> Option<Self> {
        let changed = |row: &usize| {
            let pair = [values[*row - 1], values[*row]];
            pair[0] != pair[1] && pair.iter().all(|x| x.is_finite())
        };
        // A channel that is not read in every row has a rhythm of its own, which is no repetition.
        let read = values.iter().filter(|value| value.is_finite()).count();
        if (read as f64) < READ_IN * values.len() as f64 {
            return None;
        }
        // More changes than the quickest rhythm has new values are none: most channels end here.
        let count = (1..values.len()).filter(changed).count();
        if count < FEWEST_CHANGES || IN_STEP * count as f64 > values.len().div_ceil(2) as f64 {
            return None;
        }
        let changes: Vec<usize> = (1..values.len()).filter(changed).collect();
        let rhythm = |every: usize| {
            // More changes than it has new values are no rhythm, and need no counting.
            if IN_STEP * changes.len() as f64 > values.len().div_ceil(every) as f64 {
                return None;
            }
            let mut phases = vec![0usize; every];
            changes.iter().for_each(|row| phases[row % every] += 1);
            let (first, &most) = phases.iter().enumerate().max_by_key(|(_, count)| **count)?;
            let movements = 1 + changes.windows(2).filter(|pair| pair[1] - pair[0] > 3 * every).count();
            let accident = (every as f64).powi(1 - movements as i32);
            // A channel that is new in nearly every such row keeps its rhythm without rests.
            let full = most as f64 > 0.8 * (values.len() / every) as f64 && most >= FEWEST_CHANGES;
            let keeps = most as f64 >= IN_STEP * changes.len() as f64;
            // What is given in steps, as an order is, has no movement that goes on with the next new value.
            let on = changes.windows(2).filter(|pair| pair[1] - pair[0] == every).count();
            let keeps = keeps && 2 * on > changes.len();
            (keeps && (full || accident < ACCIDENT)).then_some(Self { every, first })
        };
        (2..=LONGEST_HOLD.min(values.len() / FEWEST_CHANGES)).rev().find_map(rhythm)
    }

    fn is_new(self, row: usize) -> bool {
        row % self.every == self.first
    }
}

/// Draws a straight line between the values of two rows.
pub(crate) fn draw_line(time: &[f64], values: &mut [f64], from: usize, to: usize) {
    let slope = (values[to] - values[from]) / (time[to] - time[from]);
    for row in from + 1..to {
        values[row] = values[from] + slope * (time[row] - time[from]);
    }
}

/// Draws straight lines between the new values of a rudder that is repeated in between.
fn straighten_rudder(columns: &mut Columns) -> Option<Warning> {
    let time = &columns.time;
    let rudder = columns.channels.get_mut(&Channel::Rudder)?;
    let rhythm = Rhythm::of(rudder)?;
    let new: Vec<usize> = (0..rudder.len()).filter(|&row| rhythm.is_new(row)).collect();
    for pair in new.windows(2) {
        draw_line(time, rudder, pair[0], pair[1]);
    }
    Some(Code::MissingValues.warning(format!(
        "the rudder is new in every {} row only and repeated in between; between the new values it runs straight",
        ordinal(rhythm.every)
    )))
}

/// Takes the repetitions of a channel as missing.
fn drop_repeats(columns: &mut Columns, channel: Channel) -> Option<Warning> {
    let values = columns.channels.get_mut(&channel)?;
    let rhythm = Rhythm::of(values)?;
    let left = (0..values.len()).filter(|&row| rhythm.is_new(row)).count();
    if left < crate::record::Trial::FEWEST_ROWS {
        return None;
    }
    for (row, value) in values.iter_mut().enumerate() {
        if !rhythm.is_new(row) {
            *value = f64::NAN;
        }
    }
    let (name, every) = (channel.spoken(), ordinal(rhythm.every));
    let text = format!("the {name} is new in every {every} row only; its repetitions are taken as missing");
    Some(Code::MissingValues.warning(text))
}

/// Whether a channel keeps one value over as many readings as a freeze has.
fn rests(values: &[f64]) -> bool {
    let (mut last, mut count) = (f64::NAN, 0);
    for &value in values.iter().filter(|value| value.is_finite()) {
        count = if value == last { count + 1 } else { 0 };
        last = value;
        if count >= FROZEN_ROWS {
            return true;
        }
    }
    false
}

/// Takes a heading as missing where it stood still: it leaves the value faster than the ship turns, or the ship turned
/// before and after by much more than the heading resolves.
fn drop_frozen(columns: &mut Columns, rejected: &mut Vec<RejectedReading>) -> Option<Warning> {
    let time = &columns.time;
    let heading = columns.channels.get_mut(&Channel::Heading)?;
    if !rests(heading) {
        return None;
    }
    let seen: Vec<usize> = (0..heading.len()).filter(|&row| heading[row].is_finite()).collect();
    if seen.len() < 4 * FROZEN_ROWS {
        return None;
    }
    let steps: Vec<f64> = seen.windows(2).map(|pair| (heading[pair[1]] - heading[pair[0]]).abs()).collect();
    let mut rates: Vec<f64> =
        seen.windows(2).zip(&steps).map(|(pair, step)| step / (time[pair[1]] - time[pair[0]])).collect();
    let rates_of_rows = rates.clone();
    let fast = (0.99 * (rates.len() - 1) as f64) as usize;
    let usual = *rates.select_nth_unstable_by(fast, f64::total_cmp).1;
    let rests = steps.chunk_by(|one, other| *one == 0.0 && *other == 0.0).scan(0, |begin, chunk| {
        let own = *begin..*begin + chunk.len();
        *begin = own.end;
        Some(own)
    });
    let is_frozen = |rest: &std::ops::Range<usize>| {
        let length = rest.len();
        // What the digits resolve is the step by which the value is left, or was reached.
        let step = |at: Option<usize>| at.and_then(|at| steps.get(at)).copied().unwrap_or(0.0);
        let digit = step(rest.start.checked_sub(1)).max(step(Some(rest.end)));
        let turned = |range: std::ops::Range<usize>| steps[range].iter().sum::<f64>() > TURNING * digit;
        let before = turned(rest.start.saturating_sub(length)..rest.start);
        let after = turned(rest.end..(rest.end + length).min(steps.len()));
        let leaves = rates_of_rows.get(rest.end).is_some_and(|rate| *rate > THAW * usual);
        length >= FROZEN_ROWS && steps[rest.start] == 0.0 && (leaves || (before && after))
    };
    // A rest of n steps is one of n + 1 rows, the first of which is honest.
    let frozen: Vec<&[usize]> = rests.filter(is_frozen).map(|rest| &seen[rest.start..=rest.end]).collect();
    let told: Vec<String> = frozen
        .iter()
        .map(|rows| [rows[0], rows[rows.len() - 1]].map(|row| instant(time[row])))
        .map(|[from, to]| format!("from {from} s to {to} s"))
        .collect();
    let rows: Vec<usize> = frozen.iter().flat_map(|rows| &rows[1..]).copied().collect();
    reject(Channel::Heading, time, heading, &rows, rejected);
    rows.into_iter().for_each(|row| heading[row] = f64::NAN);
    let text = || format!("the heading is frozen {}; it is taken as missing there", told.join(", "));
    (!told.is_empty()).then(|| Code::MissingValues.warning(text()))
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn clean(columns: &mut Columns) -> Vec<String> {
        super::clean(columns, &mut Vec::new()).into_iter().map(|warning| warning.text).collect()
    }

    /// A zig-zag by hand: the rudder goes to 10° and back at 2.5°/s, the heading swings; 10 Hz, 300 s.
    pub(super) fn columns() -> Columns {
        let time: Vec<f64> = (0..3000).map(|row| 0.1 * f64::from(row)).collect();
        let rudder = |t: f64| (25.0 * (t / 9.7).sin()).clamp(-10.0, 10.0).to_radians();
        let heading = |t: f64| (15.0 * ((t - 20.0) / 9.7).sin()).to_radians();
        let channels = [
            (Channel::Rudder, time.iter().map(|&t| rudder(t)).collect()),
            (Channel::Heading, time.iter().map(|&t| heading(t)).collect()),
        ];
        Columns { time, channels: channels.into(), unknown: Vec::new() }
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
        // A ship that turns and turns has such a heading once, and a position may be anything.
        assert!(!is_sentinel(Channel::Heading, 999.0, Some(998.2)) && !is_sentinel(Channel::North, 999.0, None));
        assert!(!is_sentinel(Channel::Heading, -998.0, Some(12.0)));
    }

    /// Neither digits, nor an order in steps, nor a rest before the trial is a fault.
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
        let [told] = clean(&mut wild).try_into().expect("one sentence");
        assert!(told.contains("1 row") && told.contains("-327°") && told.contains("t = 70 s"), "{told}");
        assert_eq!((wild.time.len(), wild.channels[&Channel::Heading].len()), (2999, 2999));
        // All of a record in degrees under a name of radians is no reading that is off.
        let mut degrees = with(Channel::Rudder, |row, values| values[row].to_degrees());
        assert_eq!(clean(&mut degrees), [] as [String; 0]);
    }

    #[test]
    fn an_old_rudder_is_not_a_rudder_that_waits() {
        for phase in [0, 3] {
            let mut stale =
                with(Channel::Rudder, |row, values| values[((row + 10 - phase) / 10 * 10 + phase).saturating_sub(10)]);
            let [told] = clean(&mut stale).try_into().expect("one sentence");
            assert!(told.contains("every 10th row"), "{told}");
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
            let [told] = clean(&mut stuck).try_into().expect("one sentence");
            assert!(told.contains("s to 129.9 s"), "{told}");
            let missing = stuck.channels[&Channel::Heading].iter().filter(|psi| psi.is_nan()).count();
            assert!((299..=315).contains(&missing), "{missing}");
        }
    }
}
