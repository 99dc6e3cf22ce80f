//! Settings that make no sense, in the words and units of a scenario: the key, what was found, what was expected, what
//! to do.

use ship::Shown;

use crate::error::{Expected, SpecificationError, shown};
use crate::limits::{LONGEST_TIME, MOST_ROWS};

/// Settings that make no sense.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{found}; {expected}")]
pub struct SettingError {
    /// The key at fault, as a scenario of one trial writes it.
    pub key: String,
    /// Whether it is the value of the key that is at fault; else it is that the key is there, or lacks another.
    pub of_value: bool,
    /// The key and the value found.
    pub found: String,
    /// What was expected.
    pub expected: String,
    /// What to do.
    pub advice: String,
}

impl SettingError {
    /// A value at fault.
    pub(crate) fn value(
        key: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        let (found, expected, advice) = (found.into(), expected.into(), advice.into());
        Self { key: key.to_owned(), of_value: true, found, expected, advice }
    }

    /// A key at fault.
    pub(crate) fn name(
        key: &str,
        found: impl Into<String>,
        expected: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { of_value: false, ..Self::value(key, found, expected, advice) }
    }
}

impl From<SpecificationError> for SettingError {
    fn from(error: SpecificationError) -> Self {
        let SpecificationError { key, value, expected } = error;
        match key {
            "vessel.dead_time" => {
                return Self::name(
                    "effect",
                    format!("the dead times of all effects add up to {} s", Shown(value)),
                    format!("expected {expected}"),
                    "give dead times of 0 s or more: a rudder does not act before it moves",
                );
            }
            // No scenario sets these; only a manoeuvre can make them matter.
            "longest_wait" | "solver.step" => {
                return Self::value("manoeuvre", error.to_string(), "not accepted", "change the value");
            }
            _ => {}
        }
        let found = match expected {
            Expected::Duration => format!("`{key}` is missing"),
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
        Self::value(key, found, wanted, advice(key, expected))
    }
}

/// Parts of a scenario whose every key may be left out.
const OPTIONAL: [&str; 4] = ["steering-gear.", "helmsman.", "approach.", "sensor."];

/// Parts of them that may be left out only whole.
const WHOLE: [&str; 2] = ["sensor.heading-wander.", "sensor.heading-spikes."];

fn advice(key: &str, expected: Expected) -> String {
    match (key, expected) {
        ("recording.duration-s", Expected::Duration) => {
            "add `duration-s = …` (seconds), or let `executes` end the zig-zag".to_owned()
        }
        (_, Expected::AtMost(limit)) if limit == LONGEST_TIME => "give a time in seconds".to_owned(),
        (_, Expected::AtMost(limit)) if key.ends_with("duration-s") => {
            let periods = (MOST_ROWS - 1) as f64;
            let sampling_s = shown(limit / periods);
            format!("record less, or more rarely: with `sampling-s` = {sampling_s} that limit is {periods} rows")
        }
        (_, Expected::AtMost(_)) if key.ends_with("rudder-deg") => {
            "give less rudder, or set `steering-gear.maximum-deg` if the rudder of this ship goes further".to_owned()
        }
        ("manoeuvre.zig-zag.executes" | "recording.after-execute", Expected::Steps { .. }) => {
            "wait for fewer executes, each of which counts with the longest wait for it; or end the zig-zag by `duration-s`".to_owned()
        }
        (_, Expected::Steps { .. }) => "make the run shorter".to_owned(),
        ("recording.sampling-s", _) => "give the time between two rows of the record, in seconds".to_owned(),
        ("recording.after-execute", _) => {
            "count the executes from 1, or leave the key out to record from the start".to_owned()
        }
        ("recording.assumed-rudder-rate-deg-s", _) => {
            "give the rate the analyst assumes, for instance 2.5".to_owned()
        }
        ("manoeuvre.replay.file", _) => "give a record that lasts longer than an instant".to_owned(),
        _ if WHOLE.iter().any(|part| key.starts_with(part)) => {
            "change the value, or leave the whole table out".to_owned()
        }
        _ if OPTIONAL.iter().any(|part| key.starts_with(part)) => "change the value, or leave the key out".to_owned(),
        _ => "change the value".to_owned(),
    }
}
