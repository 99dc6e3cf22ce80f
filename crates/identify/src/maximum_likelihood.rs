//! Method `maximum-likelihood`: K, T and δ_r of a ship under a random yaw moment, with rudder and compass errors.
//!
//! The random yaw moment is absent, white, gusting (Ornstein–Uhlenbeck) or a random walk, the compass error white or of
//! first order in time, and the recorded rudder may have a white error; the law is selected by BIC. Given 1/T and the
//! noise the heading is linear in all other unknowns, so the search is over these few numbers alone, by Fisher scoring
//! (derivatives of the response are exact, those of the noise are finite differences). It starts at the estimate of
//! `output-error`, which is global in both signs of 1/T, and repeats the search over 1/T under the selected noise. With
//! compass noise alone it equals `output-error`.
//!
//! Spikes of the compass are left out, jumps of level are estimated, and both are listed.
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
mod weight;

use choice::PreparedRecords;
use trial::Trial;

pub use answer::cramer_rao;
pub use settings::{CompassChoice, MomentChoice, RudderChoice, Settings};

use crate::error::IdentifyError;
use crate::estimate::Estimate;
use crate::identifier::Identifier;
use crate::settings::{SettingsError, check_iterations};

/// Times, s, of the outliers of every record: single spikes and sentinels such as −999, isolated in the residual of
/// `output-error`. No times if more than a tenth of the readings of a record are outliers: the noise then follows
/// another law. Fails as `output-error` does.
pub fn spike_times(trials: &[Trial]) -> Result<Vec<Vec<f64>>, IdentifyError> {
    Ok(PreparedRecords::new(&Settings::default(), trials)?.spike_times())
}

impl Settings {
    /// Method with these settings, which are checked.
    ///
    /// Fails if the number of iterations is outside 1 to 1000.
    pub fn build(self) -> Result<MaximumLikelihood, SettingsError> {
        check_iterations("iterations", self.iterations)?;
        Ok(MaximumLikelihood { settings: self })
    }
}

/// Method of maximum likelihood under a random yaw moment, rudder error and coloured compass error.
///
/// Fails as [`OutputError`](crate::output_error::OutputError) does.
#[derive(Debug, Clone, PartialEq)]
pub struct MaximumLikelihood {
    settings: Settings,
}

impl MaximumLikelihood {
    /// Most plausible noise laws of the records, with the fit under each law.
    fn choose_law(&self, trials: &[Trial]) -> Result<choice::ChosenLaw, IdentifyError> {
        if trials.is_empty() {
            return Err(IdentifyError::NoTrial);
        }
        choice::PreparedRecords::new(&self.settings, trials)?.choose(&self.settings)
    }

    /// Maximum log-likelihood of the records; `None` if the method gives no estimate.
    pub fn log_likelihood(&self, trials: &[Trial]) -> Option<f64> {
        let chosen = self.choose_law(trials).ok()?;
        let log_likelihood = -0.5 * chosen.maxima[0].1.point.deviance;
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
        answer::estimate(trials, self.choose_law(trials)?)
    }
}
