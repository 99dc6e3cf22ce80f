//! Settings of a trace, and its errors.

use identify::IdentifyError;
use identify::hull::EarlierHull;
use identify::settings::SettingsError;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::selection::{EffectId, Selection};

/// Weighting rule of the structures.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case", rename = "Rule")]
pub enum WeightingRule {
    /// Marginal likelihood under the priors of all coefficients.
    #[default]
    Posterior,
    /// exp(−BIC/2): a penalty of ½ log n per parameter, with n observed headings (Schwarz 1978).
    Bic,
}

impl WeightingRule {
    /// All rules.
    pub const ALL: [Self; 2] = [Self::Posterior, Self::Bic];

    /// Name in files.
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
    /// Minimum probability of a named effect.
    pub min_probability: f64,
    /// Weighting rule of the structures.
    pub rule: WeightingRule,
    /// Number of monomials among the candidates, as empirical terms ([`crate::empirical::all_monomials`]).
    pub monomial_count: usize,
    /// Required and excluded effects, and effects given as formulas.
    pub selection: Selection,
    /// `true` if all errors are computed: restarted replays, yaw rate and overshoots on fitted records, horizons and
    /// fitted moments on held-out records, and leave-one-out folds. A benchmark can skip them.
    pub is_thorough: bool,
    /// `true` if only heading, yaw rate and rudder are used, as in methods without other channels.
    pub uses_minimal_channels: bool,
    /// `true` if hull models of three degrees of freedom are fitted when the residual is more than noise, or when there
    /// are `earlier_hulls`.
    pub fits_hulls: bool,
    /// Hulls from earlier trials of the ship or a similar one, used as priors of the hull models.
    pub earlier_hulls: Vec<EarlierHull>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            min_probability: 0.95,
            rule: WeightingRule::default(),
            monomial_count: 0,
            selection: Selection::default(),
            is_thorough: true,
            uses_minimal_channels: false,
            fits_hulls: false,
            earlier_hulls: Vec::new(),
        }
    }
}

impl Settings {
    /// Fails if a setting is out of its range.
    pub fn check(&self) -> Result<(), SettingsError> {
        if !(0.5..1.0).contains(&self.min_probability) {
            return Err(SettingsError::new("probability", self.min_probability, "a number from 0.5 to below 1"));
        }
        self.selection.check()
    }
}

/// Error of a trace.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TraceError {
    /// A setting is out of its range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The base cannot be fitted.
    #[error(transparent)]
    Base(#[from] IdentifyError),
    /// A requested effect is no candidate for these records.
    #[error("{} cannot be included as requested: {reason}", effect.as_str())]
    NoCandidate {
        /// Effect.
        effect: EffectId,
        /// Reason.
        reason: &'static str,
    },
    /// The replay of a record is not finite.
    #[error("{trial}: the replay of the model diverges; check units and signs of its rudder and heading")]
    Replay {
        /// Name of the trial.
        trial: String,
    },
}
