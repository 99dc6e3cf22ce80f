//! The answer of a method, as `fit.json` and a showcase hold it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::noise::HeadingNoise;
use crate::quantity::Quantity;
use crate::trace::PrimeIndices;

/// K, T and δ_r of one method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct IndexEstimates {
    /// K, 1/s.
    #[serde(rename = "K_per_s")]
    pub k_per_s: Quantity,
    /// T, s.
    #[serde(rename = "T_s")]
    pub t_s: Quantity,
    /// δ_r, deg.
    pub delta_r_deg: Quantity,
}

/// Heading error on a record that was not used for identification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Validation {
    /// The record.
    pub file: String,
    /// Root mean square heading error of the replay, deg; only the initial state is fitted.
    pub heading_rmse_deg: Option<f64>,
}

/// Whether a method gave an answer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It did.
    Ok,
    /// It did not; the reason says why.
    #[default]
    Failed,
}

/// The answer of one method.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MethodEntry {
    /// Id of the method, or its label in a scenario.
    pub method: String,
    /// Id of the method in `fit.json`, where it goes by another name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub id: Option<String>,
    /// Whether it gave an answer.
    pub status: Status,
    /// Why it gave none.
    pub reason: Option<String>,
    /// The reason in a word or two, for tables: "not-excited".
    pub failure: Option<String>,
    /// K, T and δ_r.
    pub parameters: Option<IndexEstimates>,
    /// K' and T', where length and speed of the ship are known; left out elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prime: Option<PrimeIndices>,
    /// 1/T < 0, in words "course-unstable".
    pub course_unstable: bool,
    /// Root mean square heading error of the replay on the records themselves, deg.
    pub heading_rmse_deg: Option<f64>,
    /// Heading errors on other records.
    pub validation: Vec<Validation>,
    /// The noise of the first record, where the method looks for a random moment; SI units and radians.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<HeadingNoise>,
    /// Named figures of the method; the unit is in the name.
    pub diagnostics: BTreeMap<String, f64>,
    /// Why the method stopped.
    pub stop: Option<String>,
}

impl MethodEntry {
    /// Id of the method, whatever name it goes by.
    pub fn id(&self) -> &str {
        self.id.as_deref().unwrap_or(&self.method)
    }
}
