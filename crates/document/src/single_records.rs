//! K and T of single records, and the amplitude that they belong to.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;

/// Every zig-zag of some records alone: whether K and T of a first-order response depend on the amplitude.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct SingleRecords {
    /// The method that was used.
    pub method: String,
    /// The zig-zags that it could identify.
    pub records: Vec<SingleRecord>,
    /// Whether K and T of all records are the same as far as their standard deviations tell (χ² at 5 %); none where a
    /// record has no standard deviation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub agree: Option<bool>,
}

/// How far rudder and heading go in a zig-zag, or in the mean of several. K and T of a first-order response belong to
/// such an amplitude.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Amplitude {
    /// Mean size of the rudder between its executes, deg.
    pub rudder_deg: f64,
    /// Mean size of the heading at its peaks from the base course, deg.
    pub heading_deg: f64,
}

/// K and T of one zig-zag.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct SingleRecord {
    /// Name of the record.
    #[serde(default)]
    pub record: String,
    /// How far rudder and heading go.
    #[serde(flatten)]
    pub amplitude: Amplitude,
    /// K.
    #[serde(rename = "K_per_s")]
    pub k_per_s: Quantity,
    /// T.
    #[serde(rename = "T_s")]
    pub t_s: Quantity,
}
