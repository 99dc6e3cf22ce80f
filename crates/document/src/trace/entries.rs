//! Entries of a trace: parameters, what is left beside the named effects, and records with the yaw moment that the base
//! lacks on them.

use serde::{Deserialize, Serialize};
use ship::Particulars;

use super::errors::BeforeAfter;
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
    /// K' and T', where length and speed of the ship are known.
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
    /// Those of K and T of a ship of these particulars.
    pub fn of([k, t]: [Quantity; 2], ship: Particulars) -> Self {
        Self { K: k.scaled(ship.prime([-1, 0])), T: t.scaled(ship.prime([1, 0])) }
    }
}

/// A parameter, averaged over the structures that have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct ParameterEntry {
    /// Name in files.
    pub key: String,
    /// Symbol, as in the equation.
    pub symbol: String,
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit.
    pub unit: String,
    /// The same without dimension, where length and speed of the ship are known and it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prime: Option<PrimeEntry>,
    /// The one record it belongs to.
    pub only: Option<String>,
    /// Whether it ends at an end of its range; left out where it does not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub at_bound: bool,
}

/// A number without dimension; angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct PrimeEntry {
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit: 1, or one of angles.
    pub unit: String,
}

/// What a moment depends on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Dependence {
    /// Time.
    Time,
    /// The heading.
    Heading,
    /// The way to one side of the first course.
    #[serde(rename = "way to one side")]
    Way,
    /// The yaw rate.
    #[serde(rename = "yaw rate")]
    YawRate,
    /// The rudder.
    Rudder,
    /// What rudder and yaw rate were before.
    #[serde(rename = "history of the rudder")]
    History,
}

/// What is left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct UnexplainedEntry {
    /// Whether it is neither chance nor of a shape that was looked for.
    pub present: bool,
    /// Where it is, where it is more than noise.
    pub signature: Option<String>,
}

/// A random moment beside what is named and located.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct DisturbanceEntry {
    /// Its size as a rudder angle: the root mean square over the longest record.
    pub rudder_deg: f64,
    /// Share of the square of the heading error that it carries.
    pub heading_error_share: f64,
}

/// A moment that is no effect of the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct LocatedEntry {
    /// What it depends on: `time`, `heading`, `way to one side`, `yaw rate`, `rudder` or `history of the rudder`.
    pub depends_on: Dependence,
    /// The moment in words.
    pub form: String,
    /// The one record in which it acts.
    pub only: Option<String>,
    /// Since when, where it is a matter of instants.
    pub from_s: Option<f64>,
    /// Until when.
    pub until_s: Option<f64>,
    /// How much worse the records are explained without it, by any random moment as well.
    pub nats: f64,
    /// Rudder angle that its root mean square is worth.
    pub rudder_deg: f64,
    /// What the records cannot tell from it: other moments, and effects of the list.
    pub alternatives: Vec<String>,
    /// The moment as an effect that a trace can be asked for, where a formula says it.
    pub formula: Option<String>,
}

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
    /// Ship, day and draughts, where something is known of them.
    #[serde(default, skip_serializing_if = "TrialParticularsEntry::is_empty")]
    pub trial_particulars: TrialParticularsEntry,
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

/// A step from the base to the most probable structure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct StairEntry {
    /// Identifier of the effect that is added; none of the base.
    pub id: Option<String>,
    /// Its form.
    pub form: Option<String>,
    /// Root mean square heading error on the fitted records, every step fitted anew for the nearest replay.
    pub heading_rmse_deg: f64,
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
