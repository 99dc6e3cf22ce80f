//! Estimate of a method, as in `fit.json` and in a showcase.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::noise::HeadingNoise;
use crate::quantity::Quantity;
use crate::trace::PrimeIndices;

/// Estimates of K, T and δ_r by one method, with their uncertainties.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct IndexEstimates {
    /// K, 1/s.
    #[serde(rename = "K_per_s")]
    pub k_per_s: Quantity,
    /// T, s.
    #[serde(rename = "T_s")]
    pub t_s: Quantity,
    /// Rudder bias δ_r, deg.
    pub delta_r_deg: Quantity,
}

/// Heading error on a held-out record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "Validation")]
pub struct ValidationEntry {
    /// File of the record.
    pub file: String,
    /// Root mean square heading error of the replay, deg; only the initial state is fitted.
    pub heading_rmse_deg: Option<f64>,
}

/// Success of a method.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "Status")]
pub enum MethodStatus {
    /// The method gives an estimate.
    Ok,
    /// The method failed; the reason is given.
    #[default]
    Failed,
}

/// Result of one method.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MethodEntry {
    /// Identifier of the method, or its label in a scenario.
    pub method: String,
    /// Identifier of the method, if `method` is a label.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Success of the method.
    pub status: MethodStatus,
    /// Reason of a failure.
    pub reason: Option<String>,
    /// Short reason of a failure for tables, such as "not-excited".
    pub failure: Option<String>,
    /// K, T and δ_r.
    pub parameters: Option<IndexEstimates>,
    /// K' and T', if length and speed of the ship are known; otherwise omitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prime: Option<PrimeIndices>,
    /// `true` if 1/T < 0 (course-unstable).
    pub course_unstable: bool,
    /// Root mean square heading error of the replay on the fitted records, deg.
    pub heading_rmse_deg: Option<f64>,
    /// Heading errors on held-out records.
    pub validation: Vec<ValidationEntry>,
    /// Noise of the first record, if the method estimates a random moment; SI units and radians.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<HeadingNoise>,
    /// Diagnostics of the method by name; the unit is in the name.
    pub diagnostics: BTreeMap<String, f64>,
    /// Stop reason of the method.
    pub stop: Option<String>,
}

impl MethodEntry {
    /// Identifier of the method, even if `method` is a label.
    pub fn id(&self) -> &str {
        self.id.as_deref().unwrap_or(&self.method)
    }
}
