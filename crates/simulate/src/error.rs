//! What can go wrong: a specification that makes no sense, or a run that leads nowhere. Errors carry the numbers, under
//! the key and in the unit in which a person writes them, and say what to do.

use std::fmt;

use ship::ShortNumber;
use ship::angle::DEGREE;
use thiserror::Error;
use trial::TrialError;

use crate::limits::{LONGEST_TIME, MOST_ROWS};

/// What a value of a specification has to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Expected {
    /// A finite number.
    Finite,
    /// A finite number above zero.
    Positive,
    /// A finite number, zero or above.
    NotNegative,
    /// A number above zero, infinity included.
    PositiveOrInfinite,
    /// A number within two bounds, both included.
    Between(f64, f64),
    /// A number that is not larger than this one.
    AtMost(f64),
    /// A duration, because nothing else ends the run.
    Duration,
    /// A run of no more steps.
    Steps {
        /// Steps it may take.
        estimate: f64,
        /// Most steps.
        most: f64,
    },
    /// The number of an execute that the manoeuvre has; it has this many.
    Execute(usize),
    /// A key that goes with another: what was found, what was expected, what to do.
    Other([&'static str; 3]),
    /// A value that goes with another: the same.
    Value([&'static str; 3]),
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finite => write!(f, "a finite number"),
            Self::Positive => write!(f, "a finite number above 0"),
            Self::NotNegative => write!(f, "a finite number, 0 or above"),
            Self::PositiveOrInfinite => write!(f, "a number above 0 (infinite is allowed)"),
            Self::Between(low, high) => write!(f, "a number from {} to {}", shown(*low), shown(*high)),
            Self::AtMost(limit) => write!(f, "at most {}", shown(*limit)),
            Self::Duration => write!(f, "a duration, because nothing else ends the run"),
            Self::Steps { estimate, most } => {
                write!(f, "a run of at most {most:.0e} steps, and this one may take {estimate:.1e}")
            }
            Self::Execute(last) => write!(f, "at most {last}"),
            Self::Other([_, expected, _]) | Self::Value([_, expected, _]) => f.write_str(expected),
        }
    }
}

/// A value of a specification that makes no sense.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{key} is {}, expected {expected}", shown(*.value))]
pub struct SpecificationError {
    /// Key of the value in a scenario ("steering-gear.rate-deg-s"), or its name where no scenario sets it.
    pub key: &'static str,
    /// Value found, in the unit of its key; NaN where none was given.
    pub value: f64,
    /// What was expected, in the unit of its key.
    pub expected: Expected,
}

/// Parts of a scenario whose every key may be left out.
const OPTIONAL: [&str; 4] = ["steering-gear.", "helmsman.", "approach.", "sensor."];

/// Parts of them that may be left out only whole.
const WHOLE: [&str; 2] = ["sensor.heading-wander.", "sensor.heading-spikes."];

impl SpecificationError {
    /// Whether it is the name of the key that is at fault, because it is there or lacks another; else its value.
    pub fn is_of_name(&self) -> bool {
        matches!(self.expected, Expected::Other(_)) || self.key == "vessel.dead_time"
    }

    /// In the words and units of a scenario: what was found, what was expected, what to do.
    pub fn words(&self) -> [String; 3] {
        let Self { key, value, expected } = *self;
        let found = match expected {
            Expected::Other(words) | Expected::Value(words) => return words.map(str::to_owned),
            Expected::Duration => format!("`{key}` is missing"),
            Expected::Execute(last) => {
                format!("`{key}` is {}, and the manoeuvre ends after execute {last}", shown(value))
            }
            _ if key == "vessel.dead_time" => {
                format!("the dead times of all effects add up to {} s", ShortNumber(value))
            }
            _ => format!("`{key}` is {}", shown(value)),
        };
        let wanted = match expected {
            Expected::Finite => "expected a finite number".to_owned(),
            Expected::Positive if value.is_finite() => "expected a number above 0".to_owned(),
            Expected::NotNegative if value.is_finite() => "expected a number, 0 or above".to_owned(),
            Expected::PositiveOrInfinite if key == "recording.assumed-rudder-rate-deg-s" => {
                "expected a number above 0, or inf for a rudder that jumps".to_owned()
            }
            Expected::PositiveOrInfinite => "expected a number above 0, or inf for no limit".to_owned(),
            _ => format!("expected {expected}"),
        };
        [found, wanted, self.advice()]
    }

    fn advice(&self) -> String {
        let advice = match (self.key, self.expected) {
            ("vessel.dead_time", _) => "give dead times of 0 s or more: a rudder does not act before it moves",
            ("recording.duration-s", Expected::Duration) => {
                "add `duration-s = …` (seconds), or let `executes` end the zig-zag"
            }
            (_, Expected::Execute(_)) => "start the record earlier, or leave the key out to record from the start",
            (_, Expected::AtMost(limit)) if limit == LONGEST_TIME => "give a time in seconds",
            (key, Expected::AtMost(limit)) if key.ends_with("duration-s") => {
                let periods = (MOST_ROWS - 1) as f64;
                let sampling_s = shown(limit / periods);
                return format!(
                    "record less, or more rarely: with `sampling-s` = {sampling_s} that limit is {periods} rows"
                );
            }
            (key, Expected::AtMost(_)) if key.ends_with("rudder-deg") => {
                "give less rudder, or set `steering-gear.maximum-deg` if the rudder of this ship goes further"
            }
            ("manoeuvre.zig-zag.executes" | "recording.after-execute", Expected::Steps { .. }) => {
                "wait for fewer executes, each of which counts with the longest wait for it; or end the zig-zag by \
                 `duration-s`"
            }
            (_, Expected::Steps { .. }) => "make the run shorter",
            ("recording.sampling-s", _) => "give the time between two rows of the record, in seconds",
            ("recording.after-execute", _) => {
                "count the executes from 1, or leave the key out to record from the start"
            }
            ("recording.assumed-rudder-rate-deg-s", _) => "give the rate the analyst assumes, for instance 2.5",
            ("manoeuvre.replay.file", _) => "give a record that lasts longer than an instant",
            (key, _) if WHOLE.iter().any(|part| key.starts_with(part)) => {
                "change the value, or leave the whole table out"
            }
            (key, _) if OPTIONAL.iter().any(|part| key.starts_with(part)) => "change the value, or leave the key out",
            _ => "change the value",
        };
        advice.to_owned()
    }
}

/// Why a run gave no record.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulateError {
    /// The specification makes no sense.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// The state is not finite, or the ship has turned more than a hundred times.
    #[error("the motion diverged at {time:.1} s: heading {} rad, yaw rate {} rad/s", ShortNumber(*.heading), ShortNumber(*.yaw_rate))]
    Diverged {
        /// Time, s.
        time: f64,
        /// Heading, rad.
        heading: f64,
        /// Yaw rate, rad/s.
        yaw_rate: f64,
    },
    /// The ship never reached the heading at which something was to happen.
    #[error("after execute {execute} the heading never deviated by {}° within {} s", ShortNumber(.angle.to_degrees()), ShortNumber(*.waited))]
    NeverReached {
        /// Executes made so far.
        execute: usize,
        /// Deviation awaited, rad.
        angle: f64,
        /// Time waited, s.
        waited: f64,
    },
    /// The record was to start at an execute that was never made.
    #[error("the record starts at execute {execute}, the run ended after {made}")]
    NoSuchExecute {
        /// Execute awaited, from 1.
        execute: usize,
        /// Executes made.
        made: usize,
    },
    /// The run was given up, because it took more than any manoeuvre does.
    #[error("the run was given up at {time:.1} s: it took more than {most} {what}")]
    TooLong {
        /// Time reached, s.
        time: f64,
        /// What there were too many of: steps, executes or rows.
        what: &'static str,
        /// Most of them.
        most: usize,
    },
    /// The rows do not make a record.
    #[error(transparent)]
    Record(#[from] TrialError),
}

/// Shorthand for the checks below.
pub(crate) type Check = Result<(), SpecificationError>;

/// A number as it was written: conversion to radians and back must not show.
pub(crate) fn shown(value: f64) -> ShortNumber {
    ShortNumber::rounded(value, 14)
}

/// Size in SI of the unit that the name of a key says.
fn unit(key: &str) -> f64 {
    if key.split(['-', '.']).any(|word| word == "deg") { DEGREE } else { 1.0 }
}

/// Refuses what no single value is to blame for.
pub(crate) fn refused(key: &'static str, expected: Expected) -> Check {
    Err(SpecificationError { key, value: f64::NAN, expected })
}

/// Refuses a value (SI, rad) that does not hold.
fn check(holds: bool, key: &'static str, value: f64, expected: Expected) -> Check {
    if holds {
        return Ok(());
    }
    let unit = unit(key);
    let expected = match expected {
        Expected::Between(low, high) => Expected::Between(low / unit, high / unit),
        Expected::AtMost(limit) => Expected::AtMost(limit / unit),
        other => other,
    };
    Err(SpecificationError { key, value: value / unit, expected })
}

pub(crate) fn finite(key: &'static str, value: f64) -> Check {
    check(value.is_finite(), key, value, Expected::Finite)
}

pub(crate) fn positive(key: &'static str, value: f64) -> Check {
    check(value.is_finite() && value > 0.0, key, value, Expected::Positive)
}

/// A count of at least one.
pub(crate) fn count(key: &'static str, value: usize, most: usize) -> Check {
    between(key, value as f64, 1.0, most as f64)
}

pub(crate) fn not_negative(key: &'static str, value: f64) -> Check {
    check(value.is_finite() && value >= 0.0, key, value, Expected::NotNegative)
}

pub(crate) fn positive_or_infinite(key: &'static str, value: f64) -> Check {
    check(value > 0.0, key, value, Expected::PositiveOrInfinite)
}

pub(crate) fn between(key: &'static str, value: f64, low: f64, high: f64) -> Check {
    check(value >= low && value <= high, key, value, Expected::Between(low, high))
}

pub(crate) fn at_most(key: &'static str, value: f64, limit: f64) -> Check {
    check(value <= limit, key, value, Expected::AtMost(limit))
}

/// A length of time, s: not negative, and no longer than [`LONGEST_TIME`](crate::limits::LONGEST_TIME).
pub(crate) fn time(key: &'static str, value: f64) -> Check {
    not_negative(key, value)?;
    at_most(key, value, LONGEST_TIME)
}

/// A length of time, s, above zero.
pub(crate) fn positive_time(key: &'static str, value: f64) -> Check {
    positive(key, value)?;
    at_most(key, value, LONGEST_TIME)
}
