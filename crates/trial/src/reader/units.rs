//! Units of columns without a unit, from their values if only one unit fits. If two units fit, the table is
//! refused, or the channel is omitted if it is not required.

use std::collections::BTreeMap;

use document::{Warning, WarningCode};
use estimation::statistics::upper_median;

use super::error::ReadProblem;
use super::source::InstrumentLog;
use crate::channel::{Channel, Unit};
use crate::clock::Clock;
use crate::plausibility::{MEAN_RATE_RANGE_DEG_S, changes, count_reversals, mean_rate, range, wraps_at_two_pi_degrees};
use crate::wording::shortened;

/// Maximum reading of a rudder in radians, rad: 46°. A rudder in degrees exceeds this number in any manoeuvre.
const MAX_RUDDER_RAD: f64 = 0.8;

/// Minimum of the maximum reading of a rudder in degrees: in radians the same number would be more than 90°.
const MIN_RUDDER_DEG: f64 = 1.6;

/// Bounds of the ratio of heading range to rudder range in a zig-zag. Their ratio of 56 is below the 57.3 between
/// degrees and radians.
pub(super) const ZIG_ZAG_RANGE_RATIO: [f64; 2] = [0.25, 14.0];

/// Bounds of that ratio for a rudder laid to a single side: course changes and turning circles.
const TURN: [f64; 2] = [1.0, 500.0];

/// Maximum unwrapped heading, rad: six circles.
const MAX_HEADING_RAD: f64 = 38.0;

/// Minimum rate of a rudder, rad/s: 0.2 °/s.
const MIN_RUDDER_RATE: f64 = 3.5e-3;

/// Range of POSIX time, seconds since 1970, of the years 1990 to 2100.
pub(super) const POSIX_TIME_RANGE_S: [f64; 2] = [6.3e8, 4.1e9];

/// Days since 1899-12-30, as counted by spreadsheets, of the years 2000 to 2100.
const SERIAL_DAY: [f64; 2] = [36_526.0, 73_415.0];

/// Day 0 of spreadsheets, counted from 1970-01-01.
const SERIAL_ZERO: i64 = -25_569;

type Channels = BTreeMap<Channel, Vec<f64>>;

/// Column of a channel whose name states no unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct UnitlessColumn {
    pub channel: Channel,
    /// Name of the column.
    pub name: String,
    /// Maximum absolute number.
    pub largest: f64,
}

/// Determines the units of the columns `open`, and of the time column `open_time`, whose names state no unit; returns
/// the warnings of the decisions.
///
/// Fails if the unit of the heading, the rudder or a yaw rate used for the heading is undetermined, or if the time
/// cannot be in seconds.
pub(super) fn infer_units(
    log: &mut InstrumentLog,
    mut open: Vec<UnitlessColumn>,
    open_time: Option<String>,
    line: usize,
) -> Result<Vec<Warning>, ReadProblem> {
    let mut decided = Vec::new();
    let mut left_out = Vec::new();
    // The unit of the heading follows from the rudder, and the unit of the yaw rate from the heading.
    const FIRST: [Channel; 4] = [Channel::Rudder, Channel::RudderOrder, Channel::Heading, Channel::YawRate];
    open.sort_by_key(|open| FIRST.iter().position(|first| *first == open.channel).unwrap_or(FIRST.len()));
    let (time, channels) = (&log.columns.time, &mut log.columns.channels);
    for open in &open {
        let is_angle = open.channel.units().contains(&Unit::Radian);
        let unit = match open.channel {
            Channel::Rudder | Channel::RudderOrder if open.largest <= MAX_RUDDER_RAD => Some(Unit::Radian),
            Channel::Rudder | Channel::RudderOrder => (open.largest > MIN_RUDDER_DEG).then_some(Unit::Degree),
            Channel::Heading => heading(channels, open),
            Channel::YawRate => yaw_rate(time, channels),
            _ if is_angle && open.largest > std::f64::consts::TAU + 0.01 => Some(Unit::Degree),
            Channel::Speed => speed(time, channels),
            _ => None,
        };
        let is_needed = FIRST.contains(&open.channel)
            && (open.channel != Channel::YawRate || !channels.contains_key(&Channel::Heading));
        match unit {
            Some(unit) => {
                scale(channels, open.channel, unit);
                decided.push(format!(
                    "`{}` is the {} in {}",
                    shortened(&open.name),
                    open.channel.label(),
                    unit.label()
                ));
            }
            None if is_needed => {
                let UnitlessColumn { channel, name: column, largest } = open.clone();
                return Err(ReadProblem::MissingUnit { line, column, quantity: channel.label(), largest, channel });
            }
            None if open.channel.units().len() > 1 => left_out.push(open),
            None => {}
        }
    }
    for open in &left_out {
        channels.remove(&open.channel);
    }
    let mut warnings = Vec::new();
    if !decided.is_empty() {
        let text = format!("columns without a unit: {}, the only unit that fits their values", decided.join(", "));
        warnings.push(WarningCode::AssumedUnit.warning(text));
    }
    warnings.extend(left_out.into_iter().map(without_unit));
    if let Some(name) = open_time {
        warnings.push(WarningCode::AssumedUnit.warning(seconds(log, &name, line)?));
    }
    Ok(warnings)
}

/// Warning of a column omitted because its values do not determine its unit.
fn without_unit(UnitlessColumn { channel, name, .. }: &UnitlessColumn) -> Warning {
    let names: Vec<String> = channel.units().iter().map(|unit| format!("`{}`", channel.name_in(*unit))).collect();
    WarningCode::LeftOut.warning(format!(
        "the {} `{}` has no unit and is left out; to use it, name it {}, or write `is = \"{}\"` for it in a sidecar",
        channel.label(),
        shortened(name),
        names.join(" or "),
        channel.column_name()
    ))
}

/// Converts a channel that was read in the unit of written files.
fn scale(channels: &mut Channels, channel: Channel, unit: Unit) {
    let factor = unit.si_factor() / channel.written_unit().si_factor();
    if factor != 1.0
        && let Some(values) = channels.get_mut(&channel)
    {
        values.iter_mut().for_each(|value| *value *= factor);
    }
}

/// Unit of a heading that was read as degrees; `None` if both degrees and radians are possible, or neither. A heading
/// in radians is unwrapped at 2π.
fn heading(channels: &mut Channels, open: &UnitlessColumn) -> Option<Unit> {
    let degree = Unit::Degree.si_factor();
    let rudder = channels.get(&Channel::Rudder).or_else(|| channels.get(&Channel::RudderOrder)).cloned();
    let values = channels.get_mut(&Channel::Heading)?;
    if open.largest <= std::f64::consts::TAU + 0.01 && wraps_at_two_pi_degrees(values) {
        let mut last = f64::NAN;
        for value in values.iter_mut().filter(|psi| psi.is_finite()) {
            if last.is_finite() {
                let turns = ((*value - last) / degree / std::f64::consts::TAU).round();
                *value -= turns * std::f64::consts::TAU * degree;
            }
            last = *value;
        }
        return Some(Unit::Radian);
    }
    if open.largest > MAX_HEADING_RAD {
        return Some(Unit::Degree);
    }
    let rudder = rudder?;
    let ratio = range(values) / range(&rudder);
    let [least, largest] = if count_reversals(&rudder) >= 2 { ZIG_ZAG_RANGE_RATIO } else { TURN };
    let fits = |ratio: f64| (least..=largest).contains(&ratio);
    match (fits(ratio), fits(ratio / degree)) {
        (true, false) => Some(Unit::Degree),
        (false, true) => Some(Unit::Radian),
        _ => None,
    }
}

/// Unit of a yaw rate that was read as deg/s, from the heading; `None` without a heading, and if no unit fits.
fn yaw_rate(time: &[f64], channels: &Channels) -> Option<Unit> {
    let (heading, rate) = (channels.get(&Channel::Heading)?, channels.get(&Channel::YawRate)?);
    let (mut last, mut integral) = (None, 0.0);
    let integrals: Vec<f64> = (0..time.len())
        .map(|row| {
            if rate[row].is_finite() {
                if let Some((before, value)) = last {
                    integral += 0.5 * (rate[row] + value) * (time[row] - before);
                }
                last = Some((time[row], rate[row]));
            }
            if heading[row].is_finite() { integral } else { f64::NAN }
        })
        .collect();
    let pairs = changes(time, heading).zip(changes(time, &integrals));
    let (product, square) = pairs.fold((0.0, 0.0), |(xy, xx), ((psi, _), (sum, _))| (xy + psi * sum, xx + sum * sum));
    // The sign of the rate is checked with the record.
    let ratio = (product / square).abs();
    let near = |unit: &&Unit| {
        let factor = unit.si_factor() / Unit::DegreePerSecond.si_factor();
        (0.7..1.4).contains(&(ratio / factor))
    };
    Channel::YawRate.units().iter().find(near).copied()
}

/// Unit of a speed that was read as m/s, from the positions; `None` without positions, and if no unit fits.
fn speed(time: &[f64], channels: &Channels) -> Option<Unit> {
    let (north, east) = (channels.get(&Channel::North)?, channels.get(&Channel::East)?);
    let values: Vec<f64> = channels.get(&Channel::Speed)?.iter().copied().filter(|speed| speed.is_finite()).collect();
    let distance: f64 = changes(time, north).zip(changes(time, east)).map(|((n, _), (e, _))| n.hypot(e)).sum();
    let duration: f64 = changes(time, north).map(|(_, time)| time).sum();
    let ratio = distance / duration / (values.iter().sum::<f64>() / values.len() as f64);
    Channel::Speed.units().iter().find(|unit| (0.75..1.33).contains(&(ratio / unit.si_factor()))).copied()
}

/// Determines the unit of a time column without a unit: a count since 1970 or 1899, or seconds if ships can turn at
/// such rates. Returns the text of the warning; fails if the unit cannot be seconds.
fn seconds(log: &mut InstrumentLog, name: &str, line: usize) -> Result<String, ReadProblem> {
    let name = shortened(name);
    let times = &mut log.columns.time;
    let first = times[0];
    for (factor, unit) in [(1.0, "seconds"), (1e-3, "milliseconds"), (1e-6, "microseconds"), (1e-9, "nanoseconds")] {
        if (POSIX_TIME_RANGE_S[0]..POSIX_TIME_RANGE_S[1]).contains(&(first * factor)) {
            times.iter_mut().for_each(|time| *time = (*time - first) * factor);
            log.clock = Some(clock(first * factor, 0));
            return Ok(format!("`{name}` is read as {unit} since 1970-01-01, UTC; time 0 is the first row"));
        }
    }
    let last = times[times.len() - 1];
    if SERIAL_DAY[0] < first && last < SERIAL_DAY[1] && last - first < 31.0 {
        times.iter_mut().for_each(|time| *time = (*time - first) * 86_400.0);
        log.clock = Some(Clock { utc_offset_min: None, ..clock(first * 86_400.0, SERIAL_ZERO) });
        return Ok(format!(
            "`{name}` is read as days since 1899-12-30, as spreadsheets count; time 0 is the first row"
        ));
    }
    let refusal = || ReadProblem::MissingTimeUnit { line, column: name.clone() };
    let channels = &log.columns.channels;
    if let Some(heading) = channels.get(&Channel::Heading) {
        let rate_deg_s = mean_rate(times, heading).to_degrees();
        if !(MEAN_RATE_RANGE_DEG_S[0]..MEAN_RATE_RANGE_DEG_S[1]).contains(&rate_deg_s) {
            return Err(refusal());
        }
    }
    if let Some(rudder) = channels.get(&Channel::Rudder) {
        let fastest = (1..times.len())
            .map(|row| ((rudder[row] - rudder[row - 1]) / (times[row] - times[row - 1])).abs())
            .filter(|rate| rate.is_finite())
            .fold(0.0, f64::max);
        if fastest > 0.0 && fastest < MIN_RUDDER_RATE {
            return Err(refusal());
        }
    }
    // A second in minutes is 0.016667, which is not a step of a clock in seconds.
    if let Some(step) = upper_median(times.windows(2).map(|pair| pair[1] - pair[0])) {
        let is_round = |step: f64| (100.0 * step - (100.0 * step).round()).abs() < 0.02;
        if step < 1.0 && !is_round(step) && is_round(60.0 * step) {
            return Err(refusal());
        }
    }
    Ok(format!("`{name}` has no unit and is read as seconds"))
}

/// Clock at a number of seconds after day `zero`, counted from 1970-01-01.
fn clock(seconds: f64, zero: i64) -> Clock {
    let day = (seconds / crate::clock::SECONDS_PER_DAY).floor();
    Clock {
        day: Some(zero + day as i64),
        second: seconds - day * crate::clock::SECONDS_PER_DAY,
        utc_offset_min: Some(0),
    }
}
