//! Numbers that are no angle in the unit of their name: counts of a converter, tenths and hundredths of a degree, a
//! rudder whose side stands in another column, a count of milliseconds since 1970.

use document::{Code, Warning};

use super::error::Problem;
use super::layout::{Content, RawColumn};
use super::units::{EPOCH, ZIG_ZAG};
use crate::channel::Channel;
use crate::cleaning::{LARGEST_SHARE, NO_RUDDER};
use crate::plausibility::{extremes, range, reversals};
use crate::words::shortened;

/// Largest angle of a rudder, deg: few go beyond 45°.
const LARGEST_RUDDER_DEG: f64 = 46.0;

/// Least step of a heading in tenths of a degree at north, as a number in the file.
const WRAP_OF_TENTHS: std::ops::RangeInclusive<f64> = 3400.0..=3600.0;

/// What the numbers of a column are.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Numbers {
    /// So many to a degree.
    Parts(f64),
    /// Counts about this one.
    Counts(f64),
    /// Neither.
    NoAngle,
}

/// Refuses rudder and heading whose numbers are no angles in the unit of their columns.
pub(super) fn check(columns: &[RawColumn], line: usize) -> Result<(), Problem> {
    let of = |channel: Channel| {
        columns.iter().find_map(|column| match column.content {
            // Radians, and what a sidecar scales, are their own affair.
            Content::Channel(own, factor) if own == channel && (factor.abs() - 1f64.to_radians()).abs() < 1e-12 => {
                Some(column)
            }
            _ => None,
        })
    };
    let refusal = |column: &RawColumn, quantity, numbers| {
        let column = column.name.clone();
        let [low, high] = numbers_of(columns, &column);
        Err(match numbers {
            Numbers::Parts(parts) => {
                Problem::Parts { line, column, quantity, high: low.abs().max(high), parts, scale: 1.0 / parts }
            }
            Numbers::Counts(zero) => Problem::Counts { line, column, quantity, low, high, zero },
            Numbers::NoAngle => Problem::NoAngle { line, column, quantity, high: low.abs().max(high) },
        })
    };
    let rudder = of(Channel::Rudder).or_else(|| of(Channel::RudderOrder));
    if let Some((rudder, numbers)) = rudder.and_then(|rudder| Some((rudder, of_rudder(rudder)?))) {
        return refusal(rudder, "rudder angle", numbers);
    }
    match of(Channel::Heading).filter(|heading| is_in_tenths(heading, rudder)) {
        Some(heading) => refusal(heading, "heading", Numbers::Parts(10.0)),
        None => Ok(()),
    }
}

/// Least and largest number of the column with this name.
fn numbers_of(columns: &[RawColumn], name: &str) -> [f64; 2] {
    let column = columns.iter().find(|column| column.name == name);
    let (low, high) = extremes(column.into_iter().flat_map(|column| column.values.iter().copied()));
    [low, high].map(|end| (1e3 * end.to_degrees()).round() / 1e3)
}

/// What the numbers of a rudder are where they are no degrees.
fn of_rudder(rudder: &RawColumn) -> Option<Numbers> {
    let read: Vec<f64> = rudder.values.iter().copied().filter(|value| value.is_finite()).collect();
    let wild = read.iter().filter(|value| value.abs() > NO_RUDDER).count();
    let is_few = wild as f64 <= LARGEST_SHARE * read.len() as f64;
    let (low, high) = extremes(read.iter().copied().map(f64::to_degrees));
    // From 0 to 360, it is written in another way, and read.
    let is_circle = low >= -1e-9
        && high <= 360.0 + 1e-9
        && read.iter().all(|value| {
            let degrees = value.to_degrees();
            !(60.0..270.0).contains(&degrees)
        });
    if is_few || is_circle {
        return None;
    }
    let largest = high.max(-low);
    let has_zero = low <= 0.1 * largest && high >= -0.1 * largest;
    let parts = [10.0, 100.0].into_iter().find(|parts| largest <= parts * LARGEST_RUDDER_DEG);
    Some(match parts {
        Some(parts) if rudder.is_whole && has_zero => Numbers::Parts(parts),
        _ if rudder.is_whole && !has_zero => Numbers::Counts((0.5 * (low + high)).round()),
        _ => Numbers::NoAngle,
    })
}

/// Whether a heading counts tenths of a degree: it wraps at 3600, or moves as many times as far as the rudder as no ship
/// does in a zig-zag.
fn is_in_tenths(heading: &RawColumn, rudder: Option<&RawColumn>) -> bool {
    if !heading.is_whole || heading.largest > 3600.0 {
        return false;
    }
    let ratio = rudder.filter(|rudder| reversals(&rudder.values) >= 2);
    let ratio = ratio.map(|rudder| range(&heading.values) / range(&rudder.values));
    WRAP_OF_TENTHS.contains(&heading.largest_step)
        || ratio.is_some_and(|ratio| ratio > ZIG_ZAG[1] && ratio.is_finite() && ratio < 10.0 * ZIG_ZAG[1])
}

/// Gives the rudder the side that stands in a column of its own.
pub(super) fn take_side(columns: &mut [RawColumn]) -> Option<Warning> {
    let is_side = |column: &RawColumn| {
        let (low, high) = extremes(column.values.iter().copied());
        column.content == Content::Unknown
            && column.sides > 0
            && column.last.is_none()
            && column.text == 0
            && low < high
    };
    let sides: Vec<usize> = (0..columns.len()).filter(|&place| is_side(&columns[place])).collect();
    let [side] = sides[..] else { return None };
    let is_rudder =
        |column: &RawColumn| matches!(column.content, Content::Channel(Channel::Rudder, factor) if factor > 0.0);
    let rudder = columns.iter().position(is_rudder)?;
    if !columns[rudder].values.iter().all(|value| value.is_nan() || *value >= 0.0) {
        return None;
    }
    let signs = std::mem::take(&mut columns[side].values);
    columns[rudder].values.iter_mut().zip(&signs).for_each(|(value, sign)| *value *= sign);
    columns[side].values = signs;
    let [rudder, side] = [rudder, side].map(|place| shortened(&columns[place].name));
    let text = format!("the rudder `{rudder}` has no sign; it is taken from the side in `{side}`, port negative");
    Some(Code::TurnedSign.warning(text))
}

/// Refuses a time that counts milliseconds or microseconds since 1970 under a name that says seconds.
pub(super) fn check_time(column: &str, first: f64, line: usize) -> Result<(), Problem> {
    let unit =
        [(1e-3, "ms"), (1e-6, "us")].into_iter().find(|(factor, _)| (EPOCH[0]..EPOCH[1]).contains(&(first * factor)));
    match unit {
        Some((_, unit)) => Err(Problem::EpochUnit { line, column: column.to_owned(), first, unit }),
        None => Ok(()),
    }
}
