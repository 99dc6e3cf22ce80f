//! `maximum-likelihood`: K, T and δ_r of a ship that more moves than its rudder.
//!
//! The yaw moment beside that of the rudder is absent, white, gusting (Ornstein–Uhlenbeck) or a random walk, the
//! compass error white or of first order in time, and the recorded rudder may have a white error of its own; which of
//! them a record shows is decided by likelihood (BIC). Given 1/T and the noise the heading is linear in all other
//! unknowns, so the search is over these few numbers alone, by Fisher scoring with exact slopes. It begins at the answer
//! of `output-error`, which is global in both signs of 1/T, and asks every 1/T again under the noise it found. Where
//! nothing but the compass is random, the answer is that of `output-error`.
//!
//! Readings of the compass that stand alone, and jumps of its level, are recognised, left out or estimated, and listed.
//!
//! Sources: Åström and Källström (1976), Automatica 12, 9–22; Källström and Åström (1981), Automatica 17, 187–198;
//! Harvey (1989) for the prediction error decomposition; Schwarz (1978) for BIC.

mod answer;
mod choice;
mod outliers;
mod point;
mod search;
#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};
use trial::Trial;

pub use answer::cramer_rao;

use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::identifier::Identifier;
use crate::likelihood::Moment;
use crate::settings::{SettingsError, check_iterations};

/// Which yaw moment is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentChoice {
    /// The one with the lowest BIC.
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
    /// The kinds that are tried.
    fn kinds(self) -> &'static [Moment] {
        match self {
            Self::Chosen => &Moment::ALL,
            Self::None => &[Moment::None],
            Self::White => &[Moment::White],
            Self::OrnsteinUhlenbeck => &[Moment::OrnsteinUhlenbeck],
            Self::Walk => &[Moment::Walk],
        }
    }
}

/// Which compass error is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CompassChoice {
    /// White, or with a correlation time where that has the lower BIC.
    #[default]
    Chosen,
    /// White.
    White,
    /// With a correlation time.
    Coloured,
}

/// Which error of the recorded rudder is fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RudderChoice {
    /// The one that the record declares, if it makes the record more likely.
    #[default]
    Declared,
    /// None.
    None,
    /// A white one whose size is estimated.
    Estimated,
}

/// Settings of [`MaximumLikelihood`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Settings {
    /// The yaw moment: `chosen`, `none`, `white`, `ornstein-uhlenbeck` or `walk`.
    pub moment: MomentChoice,
    /// The compass error: `chosen`, `white` or `coloured`.
    pub compass: CompassChoice,
    /// The error of the recorded rudder: `declared`, `none` or `estimated`.
    pub rudder: RudderChoice,
    /// Whether the yaw rate is used where every record has one.
    pub yaw_rate: bool,
    /// Whether spikes are left out and jumps of the compass estimated.
    pub outliers: bool,
    /// Largest number of scoring steps for one kind of noise.
    pub iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            moment: MomentChoice::default(),
            compass: CompassChoice::default(),
            rudder: RudderChoice::default(),
            yaw_rate: true,
            outliers: true,
            iterations: 40,
        }
    }
}

impl Settings {
    /// Checks the settings and makes the method.
    pub fn build(self) -> Result<MaximumLikelihood, SettingsError> {
        check_iterations("iterations", self.iterations)?;
        Ok(MaximumLikelihood { settings: self })
    }
}

/// Maximum likelihood under a random yaw moment, rudder error and coloured compass error.
#[derive(Debug, Clone, PartialEq)]
pub struct MaximumLikelihood {
    settings: Settings,
}

impl Identifier for MaximumLikelihood {
    fn id(&self) -> &'static str {
        "maximum-likelihood"
    }

    fn summary(&self) -> &'static str {
        "maximum likelihood with a random yaw moment, rudder error and compass error, chosen by BIC"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        if trials.is_empty() {
            return Err(IdentifyError::NoTrial);
        }
        let prepared = choice::Prepared::new(&self.settings, trials)?;
        let chosen = prepared.choose(&self.settings)?;
        answer::estimate(trials, chosen)
    }
}
