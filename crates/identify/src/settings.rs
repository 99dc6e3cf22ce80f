//! Why the settings of a method are refused; shared by every method, found before any record is read.

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
