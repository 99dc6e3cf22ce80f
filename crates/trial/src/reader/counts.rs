//! Numbers in another unit than their name states: counts of a converter, tenths and hundredths of a degree, a rudder
//! with its side in another column, milliseconds since 1970.

use document::{Warning, WarningCode};
use ship::angle::DEGREE;

use super::error::ReadProblem;
use super::layout::{ColumnContent, RawColumn};
use super::units::{POSIX_TIME_RANGE_S, ZIG_ZAG_RANGE_RATIO};
use crate::channel::Channel;
use crate::cleaning::{MAX_IMPOSSIBLE_SHARE, MIN_IMPOSSIBLE_RUDDER_RAD};
use crate::plausibility::{count_reversals, extremes, range};
use crate::wording::shortened;

/// Maximum angle of a rudder, deg: few exceed 45°.
const MAX_RUDDER_DEG: f64 = 46.0;

/// Range of the jump of a heading at north, in tenths of a degree: 360° less the turn between two rows.
const TENTHS_WRAP: std::ops::RangeInclusive<f64> = 3400.0..=3600.0;

/// Minimum ratio of the range of a heading in tenths of a degree to the range of its rudder in degrees.
const MIN_TENTHS_RATIO: f64 = 5.0;

/// Kind of the numbers of a column that are not degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Numbers {
    /// Parts of a degree: the number of parts to a degree.
    PartsOfDegree(f64),
    /// Counts of a converter: the count at zero.
    ConverterCounts(f64),
    /// Neither parts of a degree nor counts.
    ImpossibleAngle,
}

/// Refuses rudder and heading whose numbers are not angles in the unit of their columns.
pub(super) fn check_angles(columns: &[RawColumn], line: usize) -> Result<(), ReadProblem> {
    let column_of = |channel: Channel| {
        // Radians and columns with a scale in the sidecar are not checked.
        let is_in_degrees = |factor: f64| (factor.abs() - DEGREE).abs() < 1e-12;
        let is_channel = |content: ColumnContent| match content {
            ColumnContent::Channel(held, factor) => held == channel && is_in_degrees(factor),
            _ => false,
        };
        columns.iter().find(|column| is_channel(column.content))
    };
    let refusal = |column: &RawColumn, quantity, numbers| {
        let (low, high) = extremes(column.values.iter().map(|value| value.to_degrees().round()));
        let (column, largest) = (column.name.clone(), column.largest);
        Err(match numbers {
            Numbers::PartsOfDegree(parts) => {
                ReadProblem::PartsOfDegree { line, column, quantity, largest, parts, scale: 1.0 / parts }
            }
            Numbers::ConverterCounts(zero) => ReadProblem::ConverterCounts { line, column, quantity, low, high, zero },
            Numbers::ImpossibleAngle => ReadProblem::ImpossibleAngle { line, column, quantity, largest },
        })
    };
    let rudder = column_of(Channel::Rudder).or_else(|| column_of(Channel::RudderOrder));
    if let Some((rudder, numbers)) = rudder.and_then(|rudder| Some((rudder, rudder_numbers(rudder)?))) {
        return refusal(rudder, "rudder angle", numbers);
    }
    match column_of(Channel::Heading).filter(|heading| is_in_tenths(heading, rudder)) {
        Some(heading) => refusal(heading, "heading", Numbers::PartsOfDegree(10.0)),
        None => Ok(()),
    }
}

/// Kind of the numbers of a rudder; `None` for degrees.
fn rudder_numbers(rudder: &RawColumn) -> Option<Numbers> {
    let read: Vec<f64> = rudder.values.iter().copied().filter(|value| value.is_finite()).collect();
    let wild = read.iter().filter(|value| value.abs() > MIN_IMPOSSIBLE_RUDDER_RAD).count();
    let is_few = wild as f64 <= MAX_IMPOSSIBLE_SHARE * read.len() as f64;
    let (low, high) = extremes(read.iter().copied().map(f64::to_degrees));
    // A rudder from 0 to 360 is converted later, in the cleaning.
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
    let parts = [10.0, 100.0].into_iter().find(|parts| largest <= parts * MAX_RUDDER_DEG);
    Some(match parts {
        Some(parts) if rudder.is_whole && has_zero => Numbers::PartsOfDegree(parts),
        _ if rudder.is_whole && !has_zero => Numbers::ConverterCounts((0.5 * (low + high)).round()),
        _ => Numbers::ImpossibleAngle,
    })
}

/// `true` for a heading in tenths of a degree: it wraps at 3600, or moves further than any ship in a zig-zag with
/// its rudder.
fn is_in_tenths(heading: &RawColumn, rudder: Option<&RawColumn>) -> bool {
    if !heading.is_whole || heading.largest > 3600.0 {
        return false;
    }
    let ratio = rudder.filter(|rudder| count_reversals(&rudder.values) >= 2);
    let ratio = ratio.map(|rudder| range(&heading.values) / range(&rudder.values));
    let wraps = TENTHS_WRAP.contains(&heading.largest_step);
    // A single wrong reading may step as far, but does not move the heading.
    match ratio {
        Some(ratio) => {
            (wraps && ratio > MIN_TENTHS_RATIO)
                || (ZIG_ZAG_RANGE_RATIO[1]..10.0 * ZIG_ZAG_RANGE_RATIO[1]).contains(&ratio)
        }
        None => wraps,
    }
}

/// Changes the sign of the rudder by a column of sides, port negative, and returns the warning. `None`, and no change,
/// unless there is exactly one such column and the rudder has no negative angle.
pub(super) fn apply_side_column(columns: &mut [RawColumn]) -> Option<Warning> {
    let is_side = |column: &RawColumn| {
        let (low, high) = extremes(column.values.iter().copied());
        column.content == ColumnContent::Unknown
            && column.sides > 0
            && column.last.is_none()
            && column.text == 0
            && low < high
    };
    let sides: Vec<usize> = (0..columns.len()).filter(|&index| is_side(&columns[index])).collect();
    let [side] = sides[..] else { return None };
    let is_rudder =
        |raw: &RawColumn| matches!(raw.content, ColumnContent::Channel(Channel::Rudder, factor) if factor > 0.0);
    let rudder = columns.iter().position(is_rudder)?;
    if !columns[rudder].values.iter().all(|value| value.is_nan() || *value >= 0.0) {
        return None;
    }
    let signs = std::mem::take(&mut columns[side].values);
    columns[rudder].values.iter_mut().zip(&signs).for_each(|(value, sign)| *value *= sign);
    columns[side].values = signs;
    let [rudder, side] = [rudder, side].map(|index| shortened(&columns[index].name));
    let text = format!("the rudder `{rudder}` has no sign; the sign is taken from the side in `{side}`, port negative");
    Some(WarningCode::TurnedSign.warning(text))
}

/// Refuses a time in seconds whose first value is a present date in milliseconds or microseconds since 1970.
pub(super) fn check_time(column: &str, first: f64, line: usize) -> Result<(), ReadProblem> {
    let unit = [(1e-3, "ms"), (1e-6, "us")]
        .into_iter()
        .find(|(factor, _)| (POSIX_TIME_RANGE_S[0]..POSIX_TIME_RANGE_S[1]).contains(&(first * factor)));
    match unit {
        Some((_, unit)) => Err(ReadProblem::EpochUnit { line, column: column.to_owned(), first, unit }),
        None => Ok(()),
    }
}
