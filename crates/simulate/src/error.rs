//! What can go wrong: a specification that makes no sense, or a run that leads nowhere. Errors carry the numbers; the
//! wording for a user's own file and units belongs to whoever read that file.

use std::fmt;

use thiserror::Error;
use trial::TrialError;

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
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finite => write!(f, "a finite number"),
            Self::Positive => write!(f, "a finite number above 0"),
            Self::NotNegative => write!(f, "a finite number, 0 or above"),
            Self::PositiveOrInfinite => write!(f, "a number above 0 (infinite is allowed)"),
            Self::Between(low, high) => write!(f, "a number from {low} to {high}"),
            Self::AtMost(limit) => write!(f, "at most {limit}"),
            Self::Duration => write!(f, "a duration, because nothing else ends the run"),
        }
    }
}

/// A value of a specification that makes no sense.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{key} is {value}, expected {expected}")]
pub struct SpecificationError {
    /// Name of the value, with the part it belongs to ("gear.rate").
    pub key: &'static str,
    /// Value found, in SI units and radians; NaN where none was given.
    pub value: f64,
    /// What was expected.
    pub expected: Expected,
}

/// Why a run gave no record.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulateError {
    /// The specification makes no sense.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// The state is not finite, or the ship has turned more than a hundred times.
    #[error("the motion diverged at {time:.1} s: heading {heading} rad, yaw rate {yaw_rate} rad/s")]
    Diverged {
        /// Time, s.
        time: f64,
        /// Heading, rad.
        heading: f64,
        /// Yaw rate, rad/s.
        yaw_rate: f64,
    },
    /// The ship never reached the heading at which something was to happen.
    #[error("after execute {execute} the heading never deviated by {angle} rad within {waited} s")]
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
    /// The rows do not make a record.
    #[error(transparent)]
    Record(#[from] TrialError),
}

/// Shorthand for the checks below.
pub(crate) type Checked = Result<(), SpecificationError>;

fn check(holds: bool, key: &'static str, value: f64, expected: Expected) -> Checked {
    if holds { Ok(()) } else { Err(SpecificationError { key, value, expected }) }
}

pub(crate) fn finite(key: &'static str, value: f64) -> Checked {
    check(value.is_finite(), key, value, Expected::Finite)
}

pub(crate) fn positive(key: &'static str, value: f64) -> Checked {
    check(value.is_finite() && value > 0.0, key, value, Expected::Positive)
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
