//! Notations of a logger: a rudder from 0 to 360, a heading written only after a minimum change.

use document::{Warning, WarningCode};

use crate::channel::Channel;
use crate::record::{Columns, Trial};
use crate::zigzag::quantum;

/// Rudder angles to port in the notation from 0 to 360, rad: from 270° to 360°.
const PORT: std::ops::RangeInclusive<f64> = 1.5 * std::f64::consts::PI..=std::f64::consts::TAU + 1e-9;

/// Maximum angle to starboard in that notation, rad.
const MAX_STARBOARD: f64 = 1.05;

/// Minimum dead band of a heading, rad (0.4°), and in steps of its digits.
const MIN_DEAD_BAND: (f64, f64) = (0.007, 4.0);

/// Minimum share of changes that follow a repeated heading, and minimum number of changes, of a heading that the logger
/// writes only after a minimum change.
const ON_CHANGE: (f64, usize) = (0.5, 12);

/// Subtracts 360° from rudder angles and orders to port that are written as angles up to 360°, and returns the warning;
/// `None` for another notation.
pub(super) fn below_360(columns: &mut Columns) -> Option<Warning> {
    let mut count = 0;
    for channel in [Channel::Rudder, Channel::RudderOrder] {
        let Some(values) = columns.channels.get_mut(&channel) else { continue };
        let read = || values.iter().filter(|value| value.is_finite());
        let port = read().filter(|value| PORT.contains(value)).count();
        if port < 2 || !read().all(|value| PORT.contains(value) || (0.0..=MAX_STARBOARD).contains(value)) {
            continue;
        }
        values.iter_mut().filter(|value| PORT.contains(value)).for_each(|value| *value -= std::f64::consts::TAU);
        count += port;
    }
    (count > 0).then(|| {
        let text = format!(
            "the rudder is written from 0 to 360°; {count} angles above 270° are read as angles to port, 360° less"
        );
        WarningCode::TurnedSign.warning(text)
    })
}

/// Replaces repeated readings by NaN if the logger writes the heading only after a minimum change; returns the warning,
/// `None` if nothing was replaced.
pub(super) fn blank_held(columns: &mut Columns) -> Option<Warning> {
    let heading = columns.channels.get_mut(&Channel::Heading)?;
    let read: Vec<usize> = (0..heading.len()).filter(|&row| heading[row].is_finite()).collect();
    let is_new = |pair: &&[usize]| heading[pair[0]] != heading[pair[1]];
    let mut changes: Vec<f64> =
        read.windows(2).filter(is_new).map(|pair| (heading[pair[1]] - heading[pair[0]]).abs()).collect();
    let after_rest = read.windows(3).filter(|rows| heading[rows[0]] == heading[rows[1]] && is_new(&&rows[1..])).count();
    let few = changes.len() / 20;
    if changes.len() < ON_CHANGE.1.max(Trial::MIN_ROWS) || (after_rest as f64) < ON_CHANGE.0 * changes.len() as f64 {
        return None;
    }
    let least = *changes.select_nth_unstable_by(few, f64::total_cmp).1;
    if least < MIN_DEAD_BAND.0.max(MIN_DEAD_BAND.1 * quantum(heading)) {
        return None;
    }
    let repeated: Vec<usize> = read.windows(2).filter(|pair| !is_new(pair)).map(|pair| pair[1]).collect();
    repeated.iter().for_each(|&row| heading[row] = f64::NAN);
    Some(WarningCode::FaultyReadings.warning(format!(
        "the heading holds a value until it has changed by {:.1}° (a dead band, or written on change): repeated values \
         are taken as missing; other channels may have a dead band too, and the rudder may be wrong by as much",
        least.to_degrees(),
    )))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{clean, columns, with};
    use super::*;

    #[test]
    fn a_rudder_up_to_360_is_read_with_its_side() {
        let mut written = with(Channel::Rudder, |row, values| values[row].rem_euclid(std::f64::consts::TAU));
        let [text] = clean(&mut written).try_into().expect("one sentence");
        assert!(text.contains("written from 0 to 360°"), "{text}");
        let sound = columns();
        let mut pairs = written.channels[&Channel::Rudder].iter().zip(&sound.channels[&Channel::Rudder]);
        assert!(pairs.all(|(read, truth)| (read - truth).abs() < 1e-9));
    }

    #[test]
    fn a_heading_in_a_dead_band_loses_its_repetitions() {
        let held = |band: f64| {
            let mut last = f64::NAN;
            let values = columns().channels[&Channel::Heading].clone();
            let held_values = values.into_iter().map(|psi| {
                last = if (psi - last).abs() < band.to_radians() { last } else { psi };
                last
            });
            held_values.collect::<Vec<f64>>()
        };
        let of_band = held(1.0);
        let text = clean(&mut with(Channel::Heading, |row, _| of_band[row])).remove(0);
        assert!(text.contains("holds a value until it has changed by 1.0°"), "{text}");
        let fine = held(0.2);
        assert_eq!(clean(&mut with(Channel::Heading, |row, _| fine[row])), [] as [String; 0]);
    }
}
