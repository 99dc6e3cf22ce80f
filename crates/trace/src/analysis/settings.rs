//! What an analysis is asked, and why there may be none.

use identify::IdentifyError;
use identify::settings::SettingsError;
use thiserror::Error;

use crate::search::{Rule, Thresholds};
use crate::wanted::{EffectId, Wanted};

/// Settings of an analysis.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// What it takes to believe an effect.
    pub thresholds: Thresholds,
    /// Which of the structures that were tried is believed.
    pub rule: Rule,
    /// Number of monomials that stand among the candidates as effects without a name ([`crate::monomial::all`]).
    pub monomials: usize,
    /// Effects that are in the model on request, and effects that are no candidates.
    pub wanted: Wanted,
    /// Whether every record has a rudder bias of its own.
    pub own_bias: bool,
    /// Whether errors of restarted replays, overshoots and separations are computed; a benchmark may leave them out.
    pub thorough: bool,
}

impl Default for Settings {
    fn default() -> Self {
        let (thresholds, wanted) = (Thresholds::default(), Wanted::default());
        let rule = Rule::default();
        Self { thresholds, rule, monomials: 0, wanted, own_bias: false, thorough: true }
    }
}

/// Why there is no analysis.
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
    /// The base cannot be replayed.
    #[error("{trial} cannot be replayed through the base model: its response leaves the range of numbers")]
    Replay {
        /// Name of the trial.
        trial: String,
    },
}
