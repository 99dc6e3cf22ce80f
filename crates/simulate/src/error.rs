//! Errors of simulation: an invalid specification, or a run without a record. Errors contain the numbers, with the key
//! and unit of the scenario file, and advice.

use std::fmt;

use ship::ShortNumber;
use ship::angle::DEGREE;
use thiserror::Error;
use trial::TrialError;

use crate::limits::{MAX_ROWS, MAX_TIME_S};

/// Requirement on a value in a specification: its sign, its range or its presence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Requirement {
    /// Finite number.
    Finite,
    /// Finite number above zero.
    Positive,
    /// Finite number, zero or above.
    NotNegative,
    /// Number above zero, infinity included.
    PositiveOrInfinite,
    /// Number between two bounds, both included.
    Between(f64, f64),
    /// Number up to a limit.
    AtMost(f64),
    /// Required duration, because no other setting ends the run.
    Duration,
    /// Run within the limit of steps.
    Steps {
        /// Upper estimate of the steps.
        estimate: f64,
        /// Maximum number of steps.
        most: f64,
    },
    /// Number of an execute, up to the number of the last execute.
    Execute(usize),
    /// Presence that depends on another key: messages of the problem, the expectation and the advice.
    OtherKey([&'static str; 3]),
    /// Value that depends on another value: messages of the problem, the expectation and the advice.
    OtherValue([&'static str; 3]),
}

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Finite => write!(f, "a finite number"),
            Self::Positive => write!(f, "a finite number above 0"),
            Self::NotNegative => write!(f, "a finite number, 0 or above"),
            Self::PositiveOrInfinite => write!(f, "a number above 0 (infinite is allowed)"),
            Self::Between(low, high) => {
                write!(f, "a number from {} to {}", numeral(*low), numeral(*high))
            }
            Self::AtMost(limit) => write!(f, "at most {}", numeral(*limit)),
            Self::Duration => write!(f, "a duration, because nothing else ends the run"),
            Self::Steps { estimate, most } => {
                write!(f, "a run of at most {most:.0e} steps, but this one can take {estimate:.1e}")
            }
            Self::Execute(last) => write!(f, "at most {last}"),
            Self::OtherKey([_, expected, _]) | Self::OtherValue([_, expected, _]) => f.write_str(expected),
        }
    }
}

/// Error of an invalid value of a specification.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{key} is {}, expected {expected}", numeral(*.value))]
pub struct SpecificationError {
    /// Key of the value in a scenario ("steering-gear.rate-deg-s"), or its name if no scenario sets it.
    pub key: &'static str,
    /// Given value, in the unit of its key; NaN without a value.
    pub value: f64,
    /// Requirement, in the unit of its key.
    pub expected: Requirement,
}

/// Tables of a scenario whose keys are all optional.
const OPTIONAL: [&str; 4] = ["steering-gear.", "helmsman.", "approach.", "sensor."];

/// Nested tables that are optional as a whole.
const WHOLE: [&str; 2] = ["sensor.heading-wander.", "sensor.heading-spikes."];

impl SpecificationError {
    /// `true` if the presence of the key is the error, `false` if its value is.
    pub fn is_about_key(&self) -> bool {
        matches!(self.expected, Requirement::OtherKey(_)) || self.key == "vessel.dead_time"
    }

    /// Message in the units of a scenario, as its parts: problem, expectation and advice.
    pub fn message_parts(&self) -> [String; 3] {
        let Self { key, value, expected } = *self;
        let problem = match expected {
            Requirement::OtherKey(message) | Requirement::OtherValue(message) => return message.map(str::to_owned),
            Requirement::Duration => format!("`{key}` is missing"),
            Requirement::Execute(last) => {
                format!("`{key}` is {}, but the manoeuvre ends after execute {last}", numeral(value))
            }
            _ if key == "vessel.dead_time" => {
                format!("the dead times of all effects add up to {} s", ShortNumber(value))
            }
            _ => format!("`{key}` is {}", numeral(value)),
        };
        let requirement = match expected {
            Requirement::Finite => "expected a finite number".to_owned(),
            Requirement::Positive if value.is_finite() => "expected a number above 0".to_owned(),
            Requirement::NotNegative if value.is_finite() => "expected a number, 0 or above".to_owned(),
            Requirement::PositiveOrInfinite if key == "recording.assumed-rudder-rate-deg-s" => {
                "expected a number above 0, or inf for a rudder that jumps".to_owned()
            }
            Requirement::PositiveOrInfinite => "expected a number above 0, or inf for no limit".to_owned(),
            _ => format!("expected {expected}"),
        };
        [problem, requirement, self.advice()]
    }

    fn advice(&self) -> String {
        let advice = match (self.key, self.expected) {
            ("vessel.dead_time", _) => "give dead times of 0 s or more: a rudder does not act before it moves",
            ("recording.duration-s", Requirement::Duration) => {
                "add `duration-s = …` (seconds), or let `executes` end the zig-zag"
            }
            (_, Requirement::Execute(_)) => "start the record earlier, or leave the key out to record from the start",
            (_, Requirement::AtMost(limit)) if limit == MAX_TIME_S => "give a time in seconds",
            (key, Requirement::AtMost(limit)) if key.ends_with("duration-s") => {
                let periods = (MAX_ROWS - 1) as f64;
                let sampling_s = numeral(limit / periods);
                return format!(
                    "record less, or more rarely: with `sampling-s` = {sampling_s} that limit is {periods} rows"
                );
            }
            (key, Requirement::AtMost(_)) if key.ends_with("rudder-deg") => {
                "give less rudder, or set `steering-gear.maximum-deg` if the rudder of this ship goes further"
            }
            ("manoeuvre.zig-zag.executes" | "recording.after-execute", Requirement::Steps { .. }) => {
                "wait for fewer executes (each counts with the longest wait), or end the zig-zag by `duration-s`"
            }
            (_, Requirement::Steps { .. }) => "make the run shorter",
            ("recording.sampling-s", _) => "give the time between two rows of the record, in seconds",
            ("recording.after-execute", _) => {
                "count the executes from 1, or leave the key out to record from the start"
            }
            ("recording.assumed-rudder-rate-deg-s", _) => "give the rate the analyst assumes, for instance 2.5",
            ("manoeuvre.replay.file", _) => "give a record with rows at more than one time",
            (key, _) if WHOLE.iter().any(|part| key.starts_with(part)) => {
                "change the value, or leave the whole table out"
            }
            (key, _) if OPTIONAL.iter().any(|part| key.starts_with(part)) => "change the value, or leave the key out",
            _ => "change the value",
        };
        advice.to_owned()
    }
}

/// Error of a run without a record.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SimulateError {
    /// Invalid specification.
    #[error(transparent)]
    Specification(#[from] SpecificationError),
    /// Divergence: the state is not finite, or the ship has turned more than a hundred times.
    #[error("the motion diverged at {time:.1} s: heading {} rad, yaw rate {} rad/s", ShortNumber(*.heading), ShortNumber(*.yaw_rate))]
    Diverged {
        /// Time, s.
        time: f64,
        /// Heading, rad.
        heading: f64,
        /// Yaw rate, rad/s.
        yaw_rate: f64,
    },
    /// Heading of the next execute that was never reached.
    #[error("the heading did not deviate by {}° within {} s after execute \
        {execute}", ShortNumber(.angle.to_degrees()), ShortNumber(*.waited))]
    NeverReached {
        /// Number of executes made so far.
        execute: usize,
        /// Deviation from the base course at the next execute, rad.
        angle: f64,
        /// Time waited, s.
        waited: f64,
    },
    /// Record whose start is an execute that was never made.
    #[error("the record starts at execute {execute}, but the run ended after {made} executes")]
    NoSuchExecute {
        /// Number of the execute, from 1.
        execute: usize,
        /// Number of executes made.
        made: usize,
    },
    /// Run that was stopped because it exceeded a limit.
    #[error("the run was stopped at {time:.1} s, because it took more than {limit} {quantity}")]
    TooLong {
        /// Time reached, s.
        time: f64,
        /// Exceeded quantity: steps, executes or rows.
        quantity: &'static str,
        /// Maximum of that quantity.
        limit: usize,
    },
    /// Rows that are not a valid record.
    #[error(transparent)]
    Record(#[from] TrialError),
}

/// Result of a check of a value.
pub(crate) type Check = Result<(), SpecificationError>;

/// Number as written in the scenario, without the rounding errors of the conversion to radians and back.
pub(crate) fn numeral(value: f64) -> ShortNumber {
    ShortNumber::rounded(value, 14)
}

/// Size in SI of the unit in the name of a key.
fn unit(key: &str) -> f64 {
    if key.split(['-', '.']).any(|word| word == "deg") { DEGREE } else { 1.0 }
}

/// Error that no single value causes; always fails.
pub(crate) fn refuse(key: &'static str, expected: Requirement) -> Check {
    Err(SpecificationError { key, value: f64::NAN, expected })
}

/// Check of a value (SI, rad); fails if `holds` is false.
fn check(holds: bool, key: &'static str, value: f64, expected: Requirement) -> Check {
    if holds {
        return Ok(());
    }
    let unit = unit(key);
    let expected = match expected {
        Requirement::Between(low, high) => Requirement::Between(low / unit, high / unit),
        Requirement::AtMost(limit) => Requirement::AtMost(limit / unit),
        other => other,
    };
    Err(SpecificationError { key, value: value / unit, expected })
}

pub(crate) fn check_finite(key: &'static str, value: f64) -> Check {
    check(value.is_finite(), key, value, Requirement::Finite)
}

pub(crate) fn check_positive(key: &'static str, value: f64) -> Check {
    check(value.is_finite() && value > 0.0, key, value, Requirement::Positive)
}

/// Check of a count; fails outside the range from 1 to `most`.
pub(crate) fn check_count(key: &'static str, value: usize, most: usize) -> Check {
    check_between(key, value as f64, 1.0, most as f64)
}

pub(crate) fn check_not_negative(key: &'static str, value: f64) -> Check {
    check(value.is_finite() && value >= 0.0, key, value, Requirement::NotNegative)
}

pub(crate) fn check_positive_or_infinite(key: &'static str, value: f64) -> Check {
    check(value > 0.0, key, value, Requirement::PositiveOrInfinite)
}

pub(crate) fn check_between(key: &'static str, value: f64, low: f64, high: f64) -> Check {
    check(value >= low && value <= high, key, value, Requirement::Between(low, high))
}

pub(crate) fn check_at_most(key: &'static str, value: f64, limit: f64) -> Check {
    check(value <= limit, key, value, Requirement::AtMost(limit))
}

/// Check of a duration, s; fails if it is negative or longer than [`MAX_TIME_S`](crate::limits::MAX_TIME_S).
pub(crate) fn check_time(key: &'static str, value: f64) -> Check {
    check_not_negative(key, value)?;
    check_at_most(key, value, MAX_TIME_S)
}

/// Check of a duration, s; fails if it is not positive or longer than [`MAX_TIME_S`](crate::limits::MAX_TIME_S).
pub(crate) fn check_positive_time(key: &'static str, value: f64) -> Check {
    check_positive(key, value)?;
    check_at_most(key, value, MAX_TIME_S)
}
