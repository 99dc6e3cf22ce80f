//! Which part of a run is recorded, as a person writes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::angle::from_deg;

use crate::recording::{Recording, RudderColumn, Start};
use crate::settings::refusal::SettingError;

/// The record of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RecordingSettings {
    /// Time between two rows.
    pub sampling_s: f64,
    /// Time from the first to the last row; left out, the record lasts until the end of the manoeuvre.
    pub duration_s: Option<f64>,
    /// Number of the execute, from 1, at which the record starts; left out, it starts with the run.
    pub after_execute: Option<usize>,
    /// Time from that execute to the first row; 0 when left out.
    pub offset_s: Option<f64>,
    /// What stands in the rudder column: the feedback, or angles rebuilt from the orders.
    #[serde(default)]
    pub rudder: RudderSource,
    /// Rate at which angles are rebuilt from orders; inf for a rudder that jumps.
    pub assumed_rudder_rate_deg_s: Option<f64>,
}

/// What stands in the rudder column.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RudderSource {
    /// The rudder feedback.
    #[default]
    Feedback,
    /// Angles rebuilt from the orders.
    Orders,
}

impl RecordingSettings {
    /// The recording. Fails with the first value that makes no sense, or that lacks another.
    pub fn build(&self) -> Result<Recording, SettingError> {
        let rudder = match (self.rudder, self.assumed_rudder_rate_deg_s) {
            (RudderSource::Feedback, None) => RudderColumn::Feedback,
            (RudderSource::Orders, Some(rate)) => RudderColumn::Orders { assumed_rate: from_deg(rate) },
            (RudderSource::Orders, None) => {
                return Err(SettingError::name(
                    "recording.rudder",
                    "`recording.rudder` is \"orders\", and nothing says how fast the rudder is taken to move",
                    "expected `assumed-rudder-rate-deg-s` as well",
                    "add `assumed-rudder-rate-deg-s = 2.5`, or inf for a rudder that jumps",
                ));
            }
            (RudderSource::Feedback, Some(_)) => {
                return Err(SettingError::name(
                    "recording.assumed-rudder-rate-deg-s",
                    "`recording` has an assumed rate for a rudder that is recorded",
                    "a rate is assumed for `rudder = \"orders\"` only",
                    "add `rudder = \"orders\"`, or leave the rate out",
                ));
            }
        };
        let start = match (self.after_execute, self.offset_s) {
            (Some(number), offset) => Start::Execute { number, offset: offset.unwrap_or(0.0) },
            (None, None) => Start::Run,
            (None, Some(_)) => {
                return Err(SettingError::name(
                    "recording.offset-s",
                    "`recording.offset-s` counts from an execute, and `after-execute` is missing",
                    "expected `after-execute` as well",
                    "add `after-execute = 1` for the first execute, or leave `offset-s` out",
                ));
            }
        };
        let recording = Recording { start, period: self.sampling_s, duration: self.duration_s, rudder };
        recording.validate()?;
        Ok(recording)
    }
}
