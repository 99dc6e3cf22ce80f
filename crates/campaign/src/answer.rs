//! The answer of a method as other programs read it, in `fit.json` and in a showcase.

use std::collections::BTreeMap;

use identify::estimate::Quantity;
use identify::{Estimate, IdentifyError};
use serde::{Deserialize, Serialize};
use ship::angle::to_deg;

/// A number with its error; `null` where a method has none.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Value {
    /// The value; `null` when it is infinite (a neutrally stable ship).
    pub value: Option<f64>,
    /// Standard deviation.
    pub sd: Option<f64>,
    /// 95 % interval; `null` when it is unbounded or the method has none.
    pub ci95: Option<[f64; 2]>,
}

impl Value {
    /// A quantity, multiplied by `factor` for its unit.
    pub fn of(quantity: Quantity, factor: f64) -> Self {
        let finite = |value: f64| value.is_finite().then_some(value);
        Self {
            value: finite(quantity.value * factor),
            sd: quantity.sd.and_then(|sd| finite(sd * factor)),
            ci95: quantity
                .ci95
                .filter(|ends| ends.iter().all(|end| end.is_finite()))
                .map(|ends| ends.map(|end| end * factor)),
        }
    }
}

/// K, T and δ_r of one method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// K, 1/s.
    #[serde(rename = "K_per_s")]
    pub k_per_s: Value,
    /// T, s.
    #[serde(rename = "T_s")]
    pub t_s: Value,
    /// δ_r, deg.
    pub delta_r_deg: Value,
}

/// Heading error on a record that was not used for identification.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Validation {
    /// The record.
    pub file: String,
    /// Root mean square heading error of the replay, deg; only the initial state is fitted.
    pub heading_rmse_deg: Option<f64>,
}

/// Whether a method gave an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Status {
    /// It did.
    Ok,
    /// It did not; the reason says why.
    Failed,
}

/// The answer of one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MethodEntry {
    /// Id of the method, or its label in a scenario.
    pub method: String,
    /// Whether it gave an answer.
    pub status: Status,
    /// Why it gave none.
    pub reason: Option<String>,
    /// The reason in a word or two, for tables: "not-excited".
    pub failure: Option<String>,
    /// K, T and δ_r.
    pub parameters: Option<Parameters>,
    /// 1/T < 0, in words "course-unstable".
    pub course_unstable: bool,
    /// Root mean square heading error of the replay on the records themselves, deg.
    pub heading_rmse_deg: Option<f64>,
    /// Heading errors on other records.
    pub validation: Vec<Validation>,
    /// Named figures of the method; the unit is in the name.
    pub diagnostics: BTreeMap<String, f64>,
    /// Why the method stopped.
    pub stop: Option<String>,
    /// What a reader should see beside the numbers.
    pub warnings: Vec<String>,
}

impl MethodEntry {
    /// The entry of a method that gave an answer.
    pub fn of(method: &str, estimate: &Estimate, heading_rmse_deg: Option<f64>) -> Self {
        let degree = to_deg(1.0);
        Self {
            method: method.to_owned(),
            status: Status::Ok,
            reason: None,
            failure: None,
            parameters: Some(Parameters {
                k_per_s: Value::of(estimate.K(), 1.0),
                t_s: Value::of(estimate.T(), 1.0),
                delta_r_deg: Value::of(estimate.rudder_bias(), degree),
            }),
            course_unstable: estimate.response.is_course_unstable(),
            heading_rmse_deg,
            validation: Vec::new(),
            diagnostics: estimate
                .diagnostics
                .iter()
                .filter(|(_, value)| value.is_finite())
                .map(|&(name, value)| (name.to_owned(), value))
                .collect(),
            stop: Some(estimate.stop.as_str().to_owned()),
            warnings: estimate.warnings.clone(),
        }
    }

    /// The entry of a method that gave none.
    pub fn failed(method: &str, error: &IdentifyError) -> Self {
        Self {
            method: method.to_owned(),
            status: Status::Failed,
            reason: Some(error.to_string()),
            failure: Some(error.kind().to_owned()),
            parameters: None,
            course_unstable: false,
            heading_rmse_deg: None,
            validation: Vec::new(),
            diagnostics: BTreeMap::new(),
            stop: None,
            warnings: Vec::new(),
        }
    }
}

/// The entry of an answer, and the estimate itself where there is one.
pub fn entry(
    label: &str,
    answer: Result<Estimate, IdentifyError>,
    trials: &[trial::Trial],
) -> (MethodEntry, Option<Estimate>) {
    match answer {
        Ok(estimate) => (MethodEntry::of(label, &estimate, pooled_rmse_deg(trials, &estimate)), Some(estimate)),
        Err(error) => (MethodEntry::failed(label, &error), None),
    }
}

/// Root mean square replay error over all rows of all trials, deg.
fn pooled_rmse_deg(trials: &[trial::Trial], estimate: &Estimate) -> Option<f64> {
    let mut square = 0.0;
    let mut rows = 0usize;
    for trial in trials {
        let replay = identify::replay::replay(trial, &estimate.response)?;
        square += replay.heading_rmse_deg.powi(2) * replay.residual.len() as f64;
        rows += replay.residual.len();
    }
    Some((square / rows as f64).sqrt())
}
