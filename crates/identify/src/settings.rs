//! Why the settings of a method are refused; shared by every method, found before any record is read.

use ship::Shown;
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

/// Refuses a number of iterations that is none, or has no end.
pub(crate) fn check_iterations(key: &'static str, iterations: usize) -> Result<(), SettingsError> {
    let holds = (1..=MOST_ITERATIONS).contains(&iterations);
    if holds { Ok(()) } else { Err(SettingsError::new(key, iterations, "1 to 1000")) }
}

/// Refuses a `condition-limit` that no equations can keep.
pub(crate) fn check_condition_limit(limit: f64) -> Result<(), SettingsError> {
    // Written so that NaN is refused too.
    if limit > 1.0 { Ok(()) } else { Err(SettingsError::new("condition-limit", Shown(limit), "a number above 1")) }
}

/// Refuses a `longest-gap-s` that is no time.
pub(crate) fn check_longest_gap(gap_s: Option<f64>) -> Result<(), SettingsError> {
    match gap_s {
        Some(gap) if gap.is_nan() || gap <= 0.0 => {
            Err(SettingsError::new("longest-gap-s", Shown(gap), "a positive time"))
        }
        _ => Ok(()),
    }
}
