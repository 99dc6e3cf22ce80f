//! Why the settings of a method are refused; shared by every method, found before any record is read.

use ship::ShortNumber;
use thiserror::Error;

/// A setting out of its range.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{key} = {found}: expected {expected}")]
pub struct SettingsError {
    /// The key as it is written in a scenario.
    pub key: &'static str,
    /// The value found.
    pub found: String,
    /// What would be accepted, in words.
    pub expected: &'static str,
}

impl SettingsError {
    /// A refusal that names the key, the value found and what would be accepted.
    pub fn new(key: &'static str, found: impl ToString, expected: &'static str) -> Self {
        Self { key, found: found.to_string(), expected }
    }
}

/// Most steps of an iteration: what has not settled in a thousand never does.
pub(crate) const MOST_ITERATIONS: usize = 1000;

/// Refuses a setting of which something does not hold, with the value found and what would be accepted.
pub(crate) fn require(
    holds: bool,
    key: &'static str,
    found: impl ToString,
    expected: &'static str,
) -> Result<(), SettingsError> {
    if holds { Ok(()) } else { Err(SettingsError::new(key, found, expected)) }
}

/// Refuses a number of iterations that is none, or has no end.
pub(crate) fn check_iterations(key: &'static str, iterations: usize) -> Result<(), SettingsError> {
    require((1..=MOST_ITERATIONS).contains(&iterations), key, iterations, "1 to 1000")
}

/// Refuses a `condition-limit` that no equations can keep, and one that is no number.
pub(crate) fn check_condition_limit(limit: f64) -> Result<(), SettingsError> {
    require(limit > 1.0, "condition-limit", ShortNumber(limit), "a number above 1")
}

/// Refuses a `longest-gap-s` that is no time.
pub(crate) fn check_longest_gap(gap_s: Option<f64>) -> Result<(), SettingsError> {
    gap_s.map_or(Ok(()), |gap| require(gap > 0.0, "longest-gap-s", ShortNumber(gap), "a positive time"))
}
