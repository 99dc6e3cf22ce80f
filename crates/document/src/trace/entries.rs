//! Entries of a trace: parameters, random moment and shapes in addition to the named effects, records with their
//! missing moments.

use serde::{Deserialize, Serialize};
use ship::Particulars;

use super::errors::RecordReplayErrors;
use crate::quantity::Quantity;
use crate::trial_particulars::TrialParticularsEntry;

/// K, T and δ_r.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[expect(non_snake_case, reason = "K and T are the symbols of the field")]
pub struct Indices {
    /// K, 1/s.
    pub K_per_s: Quantity,
    /// T, s.
    pub T_s: Quantity,
    /// δ_r, deg.
    pub delta_r_deg: Quantity,
    /// K' and T', if length and speed of the ship are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prime: Option<PrimeIndices>,
}

/// K' = K L/U and T' = T U/L.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[expect(non_snake_case, reason = "K and T are the symbols of the field")]
pub struct PrimeIndices {
    /// K'.
    pub K: Quantity,
    /// T'.
    pub T: Quantity,
}

impl PrimeIndices {
    /// K' and T' from K and T of a ship of these particulars.
    pub fn new([k, t]: [Quantity; 2], ship: Particulars) -> Self {
        Self { K: k.scaled(ship.prime_factor([-1, 0])), T: t.scaled(ship.prime_factor([1, 0])) }
    }
}

/// Parameter, averaged over the structures that contain it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ParameterEntry {
    /// Key.
    pub key: String,
    /// Symbol, as in the equation.
    pub symbol: String,
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit.
    pub unit: String,
    /// Dimensionless value, if length and speed of the ship are known and the parameter has a dimension.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prime: Option<NondimensionalValue>,
    /// Record to which it belongs; `null` for all.
    pub only: Option<String>,
    /// `true` if the parameter lies at its bound; otherwise omitted.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub at_bound: bool,
}

/// Dimensionless number; angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[schemars(rename = "PrimeEntry")]
pub struct NondimensionalValue {
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit: 1, or a unit of angles.
    pub unit: String,
}

/// Variable that determines a moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Dependence {
    /// Time.
    Time,
    /// Heading.
    Heading,
    /// Distance to one side of the initial course.
    #[serde(rename = "way to one side")]
    LateralDistance,
    /// Yaw rate.
    #[serde(rename = "yaw rate")]
    YawRate,
    /// Rudder.
    Rudder,
    /// Earlier rudder and yaw rate.
    #[serde(rename = "history of the rudder")]
    History,
}

/// Unexplained residual.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct UnexplainedEntry {
    /// `true` if the residual is neither random nor of a shape that was searched for.
    pub present: bool,
    /// Location of the residual, if larger than noise.
    pub signature: Option<String>,
}

/// Random moment in addition to named effects and shapes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct DisturbanceEntry {
    /// Root mean square over the record of maximum duration, as a rudder angle.
    pub rudder_deg: f64,
    /// Share of the squared heading error that it explains.
    pub heading_error_share: f64,
}

/// Located moment that belongs to no listed effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct LocatedMomentEntry {
    /// Variable of the moment: `time`, `heading`, `way to one side`, `yaw rate`, `rudder` or `history of the
    /// rudder`.
    pub depends_on: Dependence,
    /// Description of the moment.
    pub form: String,
    /// Record in which it acts; `null` for all.
    pub only: Option<String>,
    /// Start of the action, for a moment with instants.
    pub from_s: Option<f64>,
    /// End of the action.
    pub until_s: Option<f64>,
    /// Decrease of the log evidence without it, under the best random law.
    pub nats: f64,
    /// Root mean square of the moment, as a rudder angle.
    pub rudder_deg: f64,
    /// Equivalent explanations: other moments, and listed effects.
    pub alternatives: Vec<String>,
    /// Formula for `--effect`, if there is one.
    pub formula: Option<String>,
}

/// Record of a trace.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct RecordEntry {
    /// Unique name.
    pub name: String,
    /// File.
    pub file: String,
    /// SHA-256 of the file.
    #[serde(default)]
    pub sha256: String,
    /// `true` if it was held out.
    pub held_out: bool,
    /// File of the record and its replays.
    pub curves: String,
    /// File of the innovations, if the record was fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub innovations: Option<String>,
    /// Length of the ship, if known, m.
    pub length_m: Option<f64>,
    /// Approach speed of the ship, if known, m/s.
    pub speed_m_s: Option<f64>,
    /// Ship, date and draughts, if declared.
    #[serde(default, skip_serializing_if = "TrialParticularsEntry::is_empty")]
    pub trial_particulars: TrialParticularsEntry,
}

impl RecordEntry {
    /// Length and speed of the ship; `None` if one is unknown.
    pub fn particulars(&self) -> Option<Particulars> {
        Some(Particulars { length: self.length_m?, speed: self.speed_m_s? })
    }
}

/// Replay errors on one record, with the use of the record.
#[derive(Clone, Copy)]
pub struct RecordErrors<'a> {
    /// Name of the record.
    pub name: &'a str,
    /// `fitted`, `held out` or `left out`.
    pub used: &'static str,
    /// Replay errors of the base and of the structure average.
    pub errors: &'a RecordReplayErrors,
}

/// Step from the base to the most probable structure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct InclusionStepEntry {
    /// Identifier of the added effect; `null` for the base.
    pub id: Option<String>,
    /// Form of the added effect.
    pub form: Option<String>,
    /// Root mean square heading error on the fitted records, after a refit for the nearest replay.
    pub heading_rmse_deg: f64,
}

/// Missing moment of one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MissingMomentEntry {
    /// File of the record.
    pub file: String,
    /// Name of the record.
    pub record: String,
    /// File of the smoothed moment.
    pub moment: String,
    /// File of the curves over the channels.
    pub curves: String,
    /// Root mean square of the moment, as a rudder angle.
    pub rms_rudder_deg: f64,
    /// Explanation in the tables: the named effects together, otherwise the best candidate alone.
    pub explanation: Option<String>,
    /// `true` if the verdict is located or unexplained and no effect lies inside the bands of all significant curves.
    #[serde(rename = "unlisted")]
    pub is_unlisted: bool,
    /// Effects inside the bands of all significant curves.
    #[serde(rename = "inside_all")]
    pub effects_inside_bands: Vec<String>,
    /// Curves over the channels, the most likely first.
    #[serde(rename = "over")]
    pub channel_curves: Vec<ChannelCurveEntry>,
}

/// Curve of a missing moment over one channel.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ChannelCurveEntry {
    /// Channel.
    pub channel: String,
    /// Column of the channel in the tables.
    pub column: String,
    /// Share of the variance of the walk that the curve explains.
    pub variance_share: Option<f64>,
    /// `true` if the curve is significant: its band excludes zero somewhere.
    #[serde(rename = "shows")]
    pub is_significant: bool,
    /// Effects inside the band everywhere.
    #[serde(rename = "inside")]
    pub effects_inside_band: Vec<String>,
}
