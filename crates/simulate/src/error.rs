//! What can go wrong: a specification that makes no sense, or a run that leads nowhere. Errors carry the numbers, under
//! the key and in the unit in which a person writes them; the advice for a scenario is in [`crate::settings`].

use std::fmt;

use ship::Shown;
use ship::angle::DEGREE;
use thiserror::Error;
use trial::TrialError;

use crate::limits::LONGEST_TIME;

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

/// Why a run gave no record.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulateError {
    /// The specification makes no sense.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// The state is not finite, or the ship has turned more than a hundred times.
    #[error("the motion diverged at {time:.1} s: heading {} rad, yaw rate {} rad/s", Shown(*.heading), Shown(*.yaw_rate))]
    Diverged {
        /// Time, s.
        time: f64,
        /// Heading, rad.
        heading: f64,
        /// Yaw rate, rad/s.
        yaw_rate: f64,
    },
    /// The ship never reached the heading at which something was to happen.
    #[error("after execute {execute} the heading never deviated by {} rad within {} s", Shown(*.angle), Shown(*.waited))]
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
pub(crate) type Checked = Result<(), SpecificationError>;

/// A number as it was written: conversion to radians and back must not show.
pub(crate) fn shown(value: f64) -> Shown {
    Shown::rounded(value, 14)
}

/// Size in SI of the unit that the name of a key says.
fn unit(key: &str) -> f64 {
    if key.split(['-', '.']).any(|word| word == "deg") { DEGREE } else { 1.0 }
}

/// Refuses a value (SI, rad) that does not hold.
fn check(holds: bool, key: &'static str, value: f64, expected: Expected) -> Checked {
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

pub(crate) fn finite(key: &'static str, value: f64) -> Checked {
    check(value.is_finite(), key, value, Expected::Finite)
}

pub(crate) fn positive(key: &'static str, value: f64) -> Checked {
    check(value.is_finite() && value > 0.0, key, value, Expected::Positive)
}

/// A count of at least one.
pub(crate) fn count(key: &'static str, value: usize, most: usize) -> Checked {
    between(key, value as f64, 1.0, most as f64)
}

pub(crate) fn not_negative(key: &'static str, value: f64) -> Checked {
    check(value.is_finite() && value >= 0.0, key, value, Expected::NotNegative)
}

pub(crate) fn positive_or_infinite(key: &'static str, value: f64) -> Checked {
    check(value > 0.0, key, value, Expected::PositiveOrInfinite)
}

pub(crate) fn between(key: &'static str, value: f64, low: f64, high: f64) -> Checked {
    check(value >= low && value <= high, key, value, Expected::Between(low, high))
}

pub(crate) fn at_most(key: &'static str, value: f64, limit: f64) -> Checked {
    check(value <= limit, key, value, Expected::AtMost(limit))
}

/// A length of time, s: not negative, and no longer than [`LONGEST_TIME`](crate::limits::LONGEST_TIME).
pub(crate) fn time(key: &'static str, value: f64) -> Checked {
    not_negative(key, value)?;
    at_most(key, value, LONGEST_TIME)
}

/// A length of time, s, above zero.
pub(crate) fn positive_time(key: &'static str, value: f64) -> Checked {
    positive(key, value)?;
    at_most(key, value, LONGEST_TIME)
}
