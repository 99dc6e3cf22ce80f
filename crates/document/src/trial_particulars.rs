//! Ship, date and draughts of a trial, for documents and the first pages of reports.

use serde::{Deserialize, Serialize};

/// Ship, date and draughts of a trial; undeclared ones are omitted.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct TrialParticularsEntry {
    /// Name of the ship.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ship_name: Option<String>,
    /// Date of the trial, as 2026-11-20.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Draught at the fore perpendicular, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draught_fore_m: Option<f64>,
    /// Draught at the aft perpendicular, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draught_aft_m: Option<f64>,
    /// Mean draught, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub draught_m: Option<f64>,
}

impl TrialParticularsEntry {
    /// `true` if nothing is declared.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}
