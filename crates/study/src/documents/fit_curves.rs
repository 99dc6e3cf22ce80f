//! Curves of a fit, stored with `fit.json`.

use std::collections::BTreeMap;

use campaign::stored_figures::Replays;
use report::PlotCurve;
use report::figures::ZigZagPlot;
use serde::{Deserialize, Serialize};

/// `curves.json`: the curves of the figures of a fit, from which they can be plotted again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FitCurves {
    /// Records, the fitted ones first.
    pub records: Vec<FitRecord>,
    /// Outline of the 95 % region of K (1/s) and T (s) of every method whose region is bounded.
    pub regions: BTreeMap<String, PlotCurve>,
    /// Median track of the predicted turning circle, east and north in ship lengths from the execute; north is the
    /// approach course.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predicted_circle: Option<PlotCurve>,
}

/// Record with its replays, in degrees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FitRecord {
    /// Unique name of the record.
    pub name: String,
    /// Path of the file.
    pub file: String,
    /// `true` if another record had the same name, so that this one was renamed.
    pub is_renamed: bool,
    /// `true` if the record was held out for validation.
    pub validation: bool,
    /// The zig-zag with its characteristic points.
    pub zigzag: Option<ZigZagPlot>,
    /// Record and replays of all methods.
    pub replays: Replays,
    /// Rudder angle.
    pub rudder: PlotCurve,
    /// Track of a turning circle, east and north in ship lengths from the execute; north is the approach course.
    #[serde(default, skip_serializing_if = "Option::is_none", rename = "circle")]
    pub circle_track: Option<PlotCurve>,
    /// Headings and rudder angles that are excluded or doubtful, if there are any.
    pub rejected: Option<[PlotCurve; 2]>,
}
