//! K and T of single records, and the amplitude to which they belong.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;

/// K and T of every zig-zag alone, from which their dependence on the amplitude follows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct SingleRecords {
    /// Method of the identification.
    pub method: String,
    /// Identified zig-zags.
    pub records: Vec<SingleRecord>,
    /// `true` if K and T of all records agree within their standard deviations (χ² at 5 %); `null` if a record has
    /// no standard deviation.
    #[serde(rename = "agree", default, skip_serializing_if = "Option::is_none")]
    pub is_consistent: Option<bool>,
}

/// Amplitude of a zig-zag, or mean amplitude of several. K and T of a first-order response depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "Amplitude")]
pub struct ZigZagAmplitude {
    /// Mean absolute rudder angle between the executes, deg.
    pub rudder_deg: f64,
    /// Mean absolute heading at the peaks from the base course, deg.
    pub heading_deg: f64,
}

/// K and T of one zig-zag.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct SingleRecord {
    /// Name of the record.
    #[serde(default)]
    pub record: String,
    /// Amplitude of rudder and heading.
    #[serde(flatten)]
    pub amplitude: ZigZagAmplitude,
    /// K.
    #[serde(rename = "K_per_s")]
    pub k_per_s: Quantity,
    /// T.
    #[serde(rename = "T_s")]
    pub t_s: Quantity,
}
