//! Settings of the method.

use serde::{Deserialize, Serialize};
use trial::noise_model::MomentKind;

/// Choice of the fitted yaw moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MomentChoice {
    /// Moment with the lowest BIC.
    #[default]
    Chosen,
    /// None.
    None,
    /// White.
    White,
    /// Ornstein–Uhlenbeck.
    OrnsteinUhlenbeck,
    /// Random walk.
    Walk,
}

impl MomentChoice {
    /// Kinds of moment that the choice admits.
    pub(super) fn kinds(self) -> &'static [MomentKind] {
        match self {
            Self::Chosen => &MomentKind::ALL,
            Self::None => &[MomentKind::None],
            Self::White => &[MomentKind::White],
            Self::OrnsteinUhlenbeck => &[MomentKind::OrnsteinUhlenbeck],
            Self::Walk => &[MomentKind::Walk],
        }
    }
}

/// Choice of the fitted compass error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CompassChoice {
    /// White, or with a correlation time if that has the lower BIC.
    #[default]
    Chosen,
    /// White.
    White,
    /// With a correlation time.
    Coloured,
}

/// Choice of the fitted error of the recorded rudder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RudderChoice {
    /// White, of the declared size; none unless every record declares one.
    #[default]
    Declared,
    /// None.
    None,
    /// White, of estimated size.
    Estimated,
}

/// Settings of the method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Settings {
    /// Yaw moment: `chosen`, `none`, `white`, `ornstein-uhlenbeck` or `walk`.
    pub moment: MomentChoice,
    /// Compass error: `chosen`, `white` or `coloured`.
    pub compass: CompassChoice,
    /// Error of the recorded rudder: `declared`, `none` or `estimated`.
    pub rudder: RudderChoice,
    /// `true` if the yaw rate is used, provided that every record has one.
    #[serde(rename = "yaw-rate")]
    pub uses_yaw_rate: bool,
    /// `true` if spikes are left out and jumps of the compass estimated.
    #[serde(rename = "outliers")]
    pub removes_outliers: bool,
    /// Maximum number of scoring steps for one kind of noise.
    pub iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            moment: MomentChoice::default(),
            compass: CompassChoice::default(),
            rudder: RudderChoice::default(),
            uses_yaw_rate: true,
            removes_outliers: true,
            iterations: 40,
        }
    }
}
