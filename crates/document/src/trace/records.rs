//! The records of a trace: their files, their errors, and the yaw moment that the base lacks on them.

use serde::{Deserialize, Serialize};
use ship::Particulars;

use super::errors::BeforeAfter;

/// A record of a trace.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RecordEntry {
    /// A name that no other record has.
    pub name: String,
    /// Its file.
    pub file: String,
    /// SHA-256 of its bytes.
    #[serde(default)]
    pub sha256: String,
    /// Whether it was held out.
    pub held_out: bool,
    /// The table of the record and its replays.
    pub curves: String,
    /// The table of its innovations, where it was fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub innovations: Option<String>,
    /// Length of its ship, where it is known, m.
    pub length_m: Option<f64>,
    /// Approach speed of its ship, where it is known, m/s.
    pub speed_m_s: Option<f64>,
}

impl RecordEntry {
    /// Length and speed of its ship.
    pub fn particulars(&self) -> Option<Particulars> {
        Some(Particulars { length: self.length_m?, speed: self.speed_m_s? })
    }
}

/// Errors on one record, and how it was used.
#[derive(Clone, Copy)]
pub struct RecordErrors<'a> {
    /// Name of the record.
    pub name: &'a str,
    /// `fitted`, `held out` or `left out`.
    pub used: &'static str,
    /// The errors.
    pub errors: &'a BeforeAfter,
}

/// The moment of one record in `trace.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MissingMomentEntry {
    /// The record.
    pub file: String,
    /// Its name.
    pub record: String,
    /// The table of the smoothed moment.
    pub moment: String,
    /// The table of the curves over the channels.
    pub curves: String,
    /// Root mean square of the moment, as an angle of the rudder.
    pub rms_rudder_deg: f64,
    /// The explanation beside it in the tables: the named effects together, else the best candidate alone.
    pub explanation: Option<String>,
    /// Whether the verdict is located or unexplained and no effect lies inside the bands of all curves that show
    /// something.
    pub unlisted: bool,
    /// Effects inside the bands of all curves that show something.
    pub inside_all: Vec<String>,
    /// Curves over the channels, the most likely first.
    pub over: Vec<PanelEntry>,
}

/// One curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PanelEntry {
    /// The channel.
    pub channel: String,
    /// Its column in the tables.
    pub column: String,
    /// Share of the variance of its walk that the curve takes away.
    pub variance_share: Option<f64>,
    /// Whether the band leaves zero.
    pub shows: bool,
    /// Effects inside the band everywhere.
    pub inside: Vec<String>,
}
