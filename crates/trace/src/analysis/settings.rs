//! What an analysis is asked, and why there may be none.

use identify::IdentifyError;
use identify::settings::SettingsError;
use ship::Shown;
use thiserror::Error;

use crate::search::Thresholds;

/// Settings of an analysis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// What it takes to believe an effect.
    pub thresholds: Thresholds,
    /// Whether every record has a rudder bias of its own.
    pub own_bias: bool,
    /// Whether terms without a name are proposed for what no effect carries.
    pub discovery: bool,
    /// Whether errors of restarted replays, overshoots and separations are computed; a benchmark may leave them out.
    pub thorough: bool,
}

impl Default for Settings {
    fn default() -> Self {
        let thresholds = Thresholds { gain: 10.0, false_discovery: 0.01, most_terms: 4 };
        Self { thresholds, own_bias: false, discovery: true, thorough: true }
    }
}

impl Settings {
    /// Refuses a gain that is negative or no number, and a rate that is no probability.
    pub fn check(&self) -> Result<(), SettingsError> {
        let Thresholds { gain, false_discovery, .. } = self.thresholds;
        if !(gain.is_finite() && gain >= 0.0) {
            return Err(SettingsError::new("gain", Shown(gain), "a gain in BIC of at least 0"));
        }
        if !(false_discovery > 0.0 && false_discovery <= 1.0) {
            let expected = "a probability above 0 and up to 1";
            return Err(SettingsError::new("false-discovery", Shown(false_discovery), expected));
        }
        Ok(())
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
    /// The base cannot be replayed.
    #[error("{trial} cannot be replayed through the base model: its response leaves the range of numbers")]
    Replay {
        /// Name of the trial.
        trial: String,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_decide_nothing_are_refused_by_name() {
        let with = |gain, false_discovery| {
            let thresholds = Thresholds { gain, false_discovery, ..Settings::default().thresholds };
            Settings { thresholds, ..Settings::default() }.check()
        };
        assert_eq!(with(0.0, 1.0), Ok(()));
        for gain in [f64::NAN, f64::INFINITY, -1.0] {
            let error = with(gain, 0.01).expect_err("no gain");
            assert_eq!((error.key, error.found), ("gain", Shown(gain).to_string()));
        }
        for rate in [f64::NAN, 0.0, -0.01, 1.5] {
            let error = with(10.0, rate).expect_err("no probability");
            assert_eq!((error.key, error.found), ("false-discovery", Shown(rate).to_string()));
        }
    }
}
