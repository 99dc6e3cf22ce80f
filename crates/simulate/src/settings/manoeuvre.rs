//! What the ship is asked to do, as a person writes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::Polyline;
use ship::angle::from_deg;

use crate::manoeuvre::{Manoeuvre, PullOut, Side, TurnEnd, TurningCircle, ZigZag, ZigZagEnd};
use crate::settings::refusal::SettingError;

/// A manoeuvre: one key, its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ManoeuvreSettings {
    /// Zig-zag: the rudder is reversed whenever the heading deviates far enough from the base course.
    ZigZag(ZigZagSettings),
    /// Turning circle: one order, held.
    TurningCircle(TurningCircleSettings),
    /// Pull-out: a turn, then rudder amidships.
    PullOut(PullOutSettings),
    /// The rudder of a record, followed as it is, without helmsman and steering gear.
    Replay(ReplaySettings),
}

/// A zig-zag; a 10/20 has rudder 10° and heading 20°.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ZigZagSettings {
    /// Rudder angle δ to either side.
    pub rudder_deg: f64,
    /// Deviation of the heading ψ from the base course at which the rudder is reversed.
    pub heading_deg: f64,
    /// Side of the first execute.
    #[serde(default)]
    pub first: Side,
    /// Number of the execute that ends the manoeuvre, or `duration-s`; left out, the end of the record is its end.
    pub executes: Option<usize>,
    /// Time from the first execute to the end, or `executes`.
    pub duration_s: Option<f64>,
}

/// A turning circle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TurningCircleSettings {
    /// Rudder angle δ.
    pub rudder_deg: f64,
    /// Side of the turn.
    #[serde(default)]
    pub side: Side,
    /// Time from the execute to the end, or `heading-change-deg`.
    pub duration_s: Option<f64>,
    /// Change of heading that ends the turn, or `duration-s`.
    pub heading_change_deg: Option<f64>,
}

/// A pull-out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PullOutSettings {
    /// Rudder angle δ of the turn.
    pub rudder_deg: f64,
    /// Side of the turn.
    #[serde(default)]
    pub side: Side,
    /// Time the rudder is held.
    pub hold_s: f64,
    /// Time from the order amidships to the end.
    pub duration_s: f64,
}

/// The rudder of a recorded trial, followed as it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ReplaySettings {
    /// Record with a rudder, relative to the scenario.
    pub file: String,
}

impl ManoeuvreSettings {
    /// The manoeuvre; `rudder_of` reads the rudder (rad) of the record to replay.
    ///
    /// Fails with the first value that makes no sense, or as `rudder_of` does.
    pub fn build<E: From<SettingError>>(
        &self,
        rudder_of: impl FnOnce(&str) -> Result<Polyline, E>,
    ) -> Result<Manoeuvre, E> {
        let manoeuvre = match self {
            Self::ZigZag(zig_zag) => Manoeuvre::ZigZag(zig_zag.build()?),
            Self::TurningCircle(turn) => Manoeuvre::TurningCircle(turn.build()?),
            Self::PullOut(PullOutSettings { rudder_deg, side, hold_s, duration_s }) => Manoeuvre::PullOut(PullOut {
                rudder: from_deg(*rudder_deg),
                side: *side,
                hold: *hold_s,
                duration: *duration_s,
            }),
            Self::Replay(replay) => Manoeuvre::Replay(rudder_of(&replay.file)?),
        };
        manoeuvre.validate().map_err(SettingError::from)?;
        Ok(manoeuvre)
    }
}

impl ZigZagSettings {
    fn build(&self) -> Result<ZigZag, SettingError> {
        let end = match (self.executes, self.duration_s) {
            (Some(executes), None) => ZigZagEnd::Executes(executes),
            (None, Some(duration)) => ZigZagEnd::Duration(duration),
            (None, None) => ZigZagEnd::Record,
            (Some(_), Some(_)) => return Err(two_ends("manoeuvre.zig-zag", "executes", "duration-s")),
        };
        let (rudder, heading) = (from_deg(self.rudder_deg), from_deg(self.heading_deg));
        Ok(ZigZag { rudder, heading, first: self.first, end })
    }
}

impl TurningCircleSettings {
    fn build(&self) -> Result<TurningCircle, SettingError> {
        let key = "manoeuvre.turning-circle";
        let end = match (self.duration_s, self.heading_change_deg) {
            (Some(duration), None) => TurnEnd::Duration(duration),
            (None, Some(change)) => TurnEnd::HeadingChange(from_deg(change)),
            (Some(_), Some(_)) => return Err(two_ends(key, "duration-s", "heading-change-deg")),
            (None, None) => {
                return Err(SettingError::name(
                    key,
                    "nothing ends the turning circle",
                    "expected `duration-s` or `heading-change-deg` here",
                    "add a line `heading-change-deg = 540.0`, or one with `duration-s`",
                ));
            }
        };
        Ok(TurningCircle { rudder: from_deg(self.rudder_deg), side: self.side, end })
    }
}

fn two_ends(key: &str, one: &str, other: &str) -> SettingError {
    SettingError::name(
        &format!("{key}.{other}"),
        format!("`{key}` has both `{one}` and `{other}`"),
        "expected one end of the manoeuvre",
        format!("leave out `{one}` or `{other}`"),
    )
}
