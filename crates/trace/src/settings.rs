//! What a trace is asked, and why there may be none.

use identify::IdentifyError;
use identify::hull::EarlierHull;
use identify::settings::SettingsError;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::selection::{EffectId, Selection};

/// How structures are weighed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// Marginal likelihood under the priors of all coefficients.
    #[default]
    Posterior,
    /// exp(−BIC/2): every parameter pays ½ log n (Schwarz 1978).
    Bic,
}

impl Rule {
    /// All rules.
    pub const ALL: [Self; 2] = [Self::Posterior, Self::Bic];

    /// The word used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Posterior => "posterior",
            Self::Bic => "bic",
        }
    }
}

/// Settings of a trace.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Probability from which an effect is named.
    pub probability: f64,
    /// How structures are weighed.
    pub rule: Rule,
    /// Number of monomials that stand among the candidates as effects without a name ([`crate::empirical::all`]).
    pub monomials: usize,
    /// Effects that are in the model on request, and effects that are no candidates.
    pub selection: Selection,
    /// Whether errors of restarted replays, bands and records left out in turn are computed; a benchmark may do
    /// without.
    pub thorough: bool,
    /// Whether heading, yaw rate and rudder are all that is read, as by a method that knows no other channel.
    pub heading_alone: bool,
    /// Whether hulls of three degrees of freedom are fitted where the structures leave more than noise.
    pub hulls: bool,
    /// Hulls that earlier trials of the ship, or of one like her, left: what is expected of hers.
    pub earlier: Vec<EarlierHull>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            probability: 0.95,
            rule: Rule::default(),
            monomials: 0,
            selection: Selection::default(),
            thorough: true,
            heading_alone: false,
            hulls: false,
            earlier: Vec::new(),
        }
    }
}

impl Settings {
    /// Refuses what is out of its range.
    pub fn check(&self) -> Result<(), SettingsError> {
        if !(0.5..1.0).contains(&self.probability) {
            return Err(SettingsError::new("probability", self.probability, "a number from 0.5 to below 1"));
        }
        self.selection.check()
    }
}

/// Why there is no trace.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TraceError {
    /// A setting is out of its range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The base cannot be fitted.
    #[error(transparent)]
    Base(#[from] IdentifyError),
    /// An effect was asked for that these records cannot hold.
    #[error("{} was asked for, but {reason}", effect.as_str())]
    Asked {
        /// The effect.
        effect: EffectId,
        /// What is in its way.
        reason: &'static str,
    },
    /// A record cannot be replayed.
    #[error("{trial} cannot be replayed through the model: its response leaves the range of numbers")]
    Replay {
        /// Name of the trial.
        trial: String,
    },
}
