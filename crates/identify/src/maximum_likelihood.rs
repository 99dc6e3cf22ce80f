//! `maximum-likelihood`: K, T and δ_r of a ship that more moves than its rudder.
//!
//! The yaw moment beside that of the rudder is absent, white, gusting (Ornstein–Uhlenbeck) or a random walk, the
//! compass error white or of first order in time, and the recorded rudder may have a white error of its own; which
//! of them a record shows is decided by likelihood (BIC). Given 1/T and the noise the heading is linear in all
//! other unknowns, so the search is over these few numbers alone, by Fisher scoring with exact slopes. It begins
//! at the answer of `output-error`, which is global in both signs of 1/T, and asks every 1/T again under the noise
//! it found. Where nothing but the compass is random, the answer is that of `output-error`.
//!
//! Readings of the compass that stand alone, and jumps of its level, are recognised, left out or estimated, and
//! listed.
//!
//! Sources: Åström and Källström (1976), Automatica 12, 9–22; Källström and Åström (1981), Automatica 17, 187–198;
//! Harvey (1989) for the prediction error decomposition; Schwarz (1978) for BIC.

mod answer;
mod choice;
mod outliers;
mod point;
mod score;
mod search;
mod settings;
#[cfg(test)]
mod tests;

use choice::PreparedRecords;
use trial::Trial;

pub use answer::cramer_rao;
pub use settings::{CompassChoice, MomentChoice, RudderChoice, Settings};

use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::identifier::Identifier;
use crate::settings::{SettingsError, check_iterations};

/// Times, s, of the readings of every record that belong to no ship: single spikes and sentinels such as −999, which
/// stand alone against what `output-error` leaves of the headings about them. None where more than a tenth of the
/// readings do: that is noise of another law. Fails as `output-error` does.
pub fn spikes(trials: &[Trial]) -> Result<Vec<Vec<f64>>, IdentifyError> {
    Ok(PreparedRecords::new(&Settings::default(), trials)?.spikes())
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

impl MaximumLikelihood {
    /// The kinds of noise that explain some records best, with the likelihood of each.
    fn chosen(&self, trials: &[Trial]) -> Result<choice::Chosen, IdentifyError> {
        if trials.is_empty() {
            return Err(IdentifyError::NoTrial);
        }
        choice::PreparedRecords::new(&self.settings, trials)?.choose(&self.settings)
    }

    /// Log of the largest likelihood of some records; `None` where the method has no answer.
    pub fn log_likelihood(&self, trials: &[Trial]) -> Option<f64> {
        let chosen = self.chosen(trials).ok()?;
        let log_likelihood = -0.5 * chosen.found[0].1.point.deviance;
        answer::estimate(trials, chosen).is_ok().then_some(log_likelihood)
    }
}

impl Identifier for MaximumLikelihood {
    fn id(&self) -> &'static str {
        "maximum-likelihood"
    }

    fn summary(&self) -> &'static str {
        "maximum likelihood with a random yaw moment, rudder error and compass error, chosen by BIC"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        answer::estimate(trials, self.chosen(trials)?)
    }
}
