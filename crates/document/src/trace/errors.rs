//! Errors of the headings before and after, as a trace says them.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Errors on all records.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ErrorEntry {
    /// Why the replay after is that before, where the structures are no nearer to the fitted records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_base: Option<String>,
    /// Records that were fitted.
    pub identification: Vec<BeforeAfter>,
    /// Records that were held out: nothing else in the document depends on them.
    pub validation: Vec<BeforeAfter>,
    /// Every record left out in turn, where there are several and none was held out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub leave_one_out: Vec<BeforeAfter>,
}

/// One record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct BeforeAfter {
    /// Its file.
    pub file: String,
    /// The best first-order response.
    pub before: ErrorsEntry,
    /// The average of the structures.
    pub after: ErrorsEntry,
    /// Heading error against how far ahead a replay goes, the shortest first and the whole record last; nothing on
    /// records that were fitted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub horizons: Vec<HorizonEntry>,
}

/// Root mean square heading errors of replays that begin anew every so many seconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct HorizonEntry {
    /// Seconds from one beginning to the next.
    pub horizon_s: f64,
    /// Of the best first-order response.
    pub before_deg: f64,
    /// Of the average of the structures.
    pub after_deg: f64,
}

/// Errors of one model on one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ErrorsEntry {
    /// Full replay.
    pub heading_rmse_deg: f64,
    /// Full replay, where the yaw rate was measured.
    pub yaw_rate_rmse_deg_s: Option<f64>,
    /// Mean absolute error of the overshoot angles.
    pub overshoot_error_deg: Option<f64>,
    /// Replays restarted every so many seconds.
    pub horizon_rmse_deg: BTreeMap<String, Option<f64>>,
    /// Share of the headings inside the 95 % band of the full replay.
    pub band_coverage_95: Option<f64>,
    /// Mean width of that band.
    pub band_width_95_deg: Option<f64>,
    /// Full replay with a rudder bias of the record fitted, where the record was not fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with_own_bias_deg: Option<f64>,
    /// The same with a moment of the record as a rudder angle: straight between five evenly spaced instants.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with_own_moment_deg: Option<f64>,
}
