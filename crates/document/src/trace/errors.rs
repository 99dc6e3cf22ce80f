//! Replay errors of a trace, before and after.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Replay errors on all records.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ReplayErrorLists {
    /// Reason to keep the replay of the base, if the structures do not improve it on the fitted records.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_base: Option<String>,
    /// Fitted records.
    pub identification: Vec<RecordReplayErrors>,
    /// Held-out records; no fit depends on them.
    pub validation: Vec<RecordReplayErrors>,
    /// Records omitted in turn, if several are fitted and none is held out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub leave_one_out: Vec<RecordReplayErrors>,
}

/// Replay errors on one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RecordReplayErrors {
    /// File of the record.
    pub file: String,
    /// Errors of the base.
    pub before: ModelReplayErrors,
    /// Errors of the structure average.
    pub after: ModelReplayErrors,
    /// Heading error by prediction horizon, the shortest first and the whole record last; empty for fitted records.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub horizons: Vec<HorizonEntry>,
}

/// Root mean square heading errors of replays restarted at one interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct HorizonEntry {
    /// Interval of the restarts.
    pub horizon_s: f64,
    /// Error of the base.
    pub before_deg: f64,
    /// Error of the structure average.
    pub after_deg: f64,
}

/// Replay errors of one model on one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ModelReplayErrors {
    /// Root mean square heading error of the full replay.
    pub heading_rmse_deg: f64,
    /// Root mean square yaw-rate error of the full replay, if the yaw rate was measured.
    pub yaw_rate_rmse_deg_s: Option<f64>,
    /// Mean absolute error of the overshoot angles.
    pub overshoot_error_deg: Option<f64>,
    /// Root mean square heading error of restarted replays, by the interval in seconds.
    pub horizon_rmse_deg: BTreeMap<String, Option<f64>>,
    /// Share of the headings inside the 95 % band of the full replay.
    pub band_coverage_95: Option<f64>,
    /// Mean width of that band.
    pub band_width_95_deg: Option<f64>,
    /// Heading error with a fitted rudder bias of the record, on held-out records.
    #[serde(rename = "with_own_bias_deg", default, skip_serializing_if = "Option::is_none")]
    pub heading_rmse_own_bias_deg: Option<f64>,
    /// Heading error with a fitted slow moment of the record (piecewise linear, five knots), on held-out records.
    #[serde(rename = "with_own_moment_deg", default, skip_serializing_if = "Option::is_none")]
    pub heading_rmse_own_moment_deg: Option<f64>,
}
