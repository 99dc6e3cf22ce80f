//! The curves of a fit beside `fit.json`.

use std::collections::BTreeMap;

use campaign::stored_figures::Replays;
use report::PlotCurve;
use report::figures::ZigzagTrial;
use serde::{Deserialize, Serialize};

/// `curves.json`: what the figures of a fit show, so that they can be drawn again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FitCurves {
    /// The records, first the fitted ones.
    pub records: Vec<FitRecord>,
    /// Of every method with a bounded one the outline of the region that holds K (1/s) and T (s) with 95 %.
    pub regions: BTreeMap<String, PlotCurve>,
    /// Median track of the turning circle that is predicted, east and north in ship lengths from the execute on, where
    /// the course is north.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predicted_circle: Option<PlotCurve>,
}

/// A record with its replays, in degrees.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FitRecord {
    /// A name that no other record has.
    pub name: String,
    /// Its file.
    pub file: String,
    /// `true` if another record has the name that it came with.
    pub is_renamed: bool,
    /// `true` if it was kept for validation.
    pub validation: bool,
    /// The zig-zag with its characteristic points.
    pub zigzag: Option<ZigzagTrial>,
    /// Record and replays of all methods.
    pub replays: Replays,
    /// The rudder.
    pub rudder: PlotCurve,
    /// The track of a turning circle, east and north in ship lengths from the execute on, where the course is north.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub circle: Option<PlotCurve>,
    /// Headings and rudder angles that are left out or doubtful, where there are some.
    pub rejected: Option<[PlotCurve; 2]>,
}
