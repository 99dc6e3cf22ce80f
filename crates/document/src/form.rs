//! Entries of the form for reporting manoeuvring data to IMO (MSC/Circ.1053, 2002, appendix 6).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// An entry of the form.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ImoFormEntry {
    /// Heading it stands under.
    pub section: String,
    /// What it is called.
    pub field: String,
    /// "port" or "starboard", where the form has one for either side.
    pub side: Option<String>,
    /// A declared word, or a declared or measured number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Value>,
    /// Standard deviation of a measured number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sd: Option<f64>,
    /// Median of a predicted or corrected number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub median: Option<f64>,
    /// The interval of nine tenths of the draws.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ci90: Option<[f64; 2]>,
    /// Unit of value and limit.
    pub unit: String,
    /// Largest value allowed.
    pub limit: Option<f64>,
    /// Of a predicted entry whether the manoeuvre is beyond what the records have seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extrapolated: Option<bool>,
    /// Of a predicted entry the share of the drawn ships that keep within the limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub probability_of_passing: Option<f64>,
    /// Where it comes from.
    pub source: String,
}
