//! Checks of the settings of all methods, made before any record is read.

use ship::ShortNumber;
use thiserror::Error;

/// Setting out of its range.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{key} = {value}: expected {expected}")]
pub struct SettingsError {
    /// Key, as written in a scenario.
    pub key: &'static str,
    /// Value of the setting, as text.
    pub value: String,
    /// Accepted values, as text.
    pub expected: &'static str,
}

impl SettingsError {
    /// Error that names the key, its value and the accepted values.
    pub fn new(key: &'static str, value: impl ToString, expected: &'static str) -> Self {
        Self { key, value: value.to_string(), expected }
    }
}

/// Maximum number of steps of an iteration that a setting may ask for; no iteration converges later.
pub(crate) const MAX_ITERATIONS: usize = 1000;

/// Checks the setting `key`: fails, with its value and the accepted values, unless `is_valid`.
pub(crate) fn require(
    is_valid: bool,
    key: &'static str,
    value: impl ToString,
    expected: &'static str,
) -> Result<(), SettingsError> {
    if is_valid { Ok(()) } else { Err(SettingsError::new(key, value, expected)) }
}

/// Fails for a number of iterations outside 1 to 1000.
pub(crate) fn check_iterations(key: &'static str, iterations: usize) -> Result<(), SettingsError> {
    require((1..=MAX_ITERATIONS).contains(&iterations), key, iterations, "1 to 1000")
}

/// Fails for a `condition-limit` of 1 or less, and for NaN.
pub(crate) fn check_condition_limit(limit: f64) -> Result<(), SettingsError> {
    require(limit > 1.0, "condition-limit", ShortNumber(limit), "a number above 1")
}

/// Fails for a `longest-gap-s` that is not positive.
pub(crate) fn check_longest_gap(gap_s: Option<f64>) -> Result<(), SettingsError> {
    gap_s.map_or(Ok(()), |gap| require(gap > 0.0, "longest-gap-s", ShortNumber(gap), "a positive time"))
}
