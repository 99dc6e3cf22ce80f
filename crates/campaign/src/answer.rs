//! The answer of a method as other programs read it, in `fit.json` and in a showcase.

use std::collections::BTreeMap;

use document::trace::PrimeIndices;
use document::{HeadingNoise, Quantity};
use identify::replay::pooled;
use identify::{Estimate, IdentifyError};
use serde::{Deserialize, Serialize};
use ship::angle::to_deg;

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

    /// The entry of a method that gave an answer.
    pub fn of(method: &str, estimate: &Estimate, heading_rmse_deg: Option<f64>) -> Self {
        let diagnostics = estimate.diagnostics.iter().filter(|(_, value)| value.is_finite());
        Self {
            method: method.to_owned(),
            status: Status::Ok,
            parameters: Some(IndexEstimates {
                k_per_s: estimate.K(),
                t_s: estimate.T(),
                delta_r_deg: estimate.rudder_bias().scaled(to_deg(1.0)),
            }),
            course_unstable: estimate.response.is_course_unstable(),
            heading_rmse_deg,
            noise: estimate.noise,
            diagnostics: diagnostics.map(|&(name, value)| (name.to_owned(), value)).collect(),
            stop: Some(estimate.stop.as_str().to_owned()),
            ..Self::default()
        }
    }

    /// The entry of a method that gave none.
    pub fn failed(method: &str, error: &IdentifyError) -> Self {
        let (reason, failure) = (Some(error.to_string()), Some(error.kind().to_owned()));
        Self { method: method.to_owned(), reason, failure, ..Self::default() }
    }
}

/// The entry of an answer, and the estimate itself where there is one.
pub fn entry(
    label: &str,
    answer: Result<Estimate, IdentifyError>,
    trials: &[trial::Trial],
) -> (MethodEntry, Option<Estimate>) {
    match answer {
        Ok(estimate) => {
            (MethodEntry::of(label, &estimate, pooled(trials, &estimate.response).map(to_deg)), Some(estimate))
        }
        Err(error) => (MethodEntry::failed(label, &error), None),
    }
}
