//! Entries of the form for reporting manoeuvring data to IMO (MSC/Circ.1053, 2002, appendix 6).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Entry of the form.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ImoFormEntry {
    /// Section heading.
    pub section: String,
    /// Name of the field.
    pub field: String,
    /// "port" or "starboard", if the form distinguishes sides.
    pub side: Option<String>,
    /// Declared text, or declared or measured number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Value>,
    /// Standard deviation of a measured number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sd: Option<f64>,
    /// Median of a predicted or corrected number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub median: Option<f64>,
    /// 90 % interval of the samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ci90: Option<[f64; 2]>,
    /// Unit of value and limit.
    pub unit: String,
    /// Maximum allowed value.
    pub limit: Option<f64>,
    /// `true` if a predicted manoeuvre is outside the range of the records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extrapolated: Option<bool>,
    /// Share of the drawn ships of a prediction that meet the limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub probability_of_passing: Option<f64>,
    /// Origin of the value.
    pub source: String,
}
