//! How much a term explains, and how much it has to.

use identify::settings::SettingsError;
use serde::{Deserialize, Serialize};
use ship::Shown;

/// Most effects that may be asked for: each is one more round over all candidates. The list has fewer.
const MOST_EFFECTS: usize = 20;

/// What decides whether a term is believed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Thresholds {
    /// Smallest gain in BIC (Kass and Raftery 1995: above 10 is very strong).
    pub gain: f64,
    /// Probability of naming any effect where there is none, shared by all candidates (Bonferroni).
    pub false_discovery: f64,
    /// Most effects.
    pub most_effects: usize,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self { gain: 10.0, false_discovery: 0.01, most_effects: 4 }
    }
}

impl Thresholds {
    /// Refuses a gain that is negative or no number, a rate that is no probability, and more effects than there are.
    pub fn check(&self) -> Result<(), SettingsError> {
        let Self { gain, false_discovery, most_effects } = *self;
        if !(gain.is_finite() && gain >= 0.0) {
            return Err(SettingsError::new("gain", Shown(gain), "a gain in BIC of at least 0"));
        }
        if !(false_discovery > 0.0 && false_discovery <= 1.0) {
            let expected = "a probability above 0 and up to 1";
            return Err(SettingsError::new("false-discovery", Shown(false_discovery), expected));
        }
        if most_effects > MOST_EFFECTS {
            return Err(SettingsError::new("most-effects", most_effects, "at most 20"));
        }
        Ok(())
    }
}

/// How much a term explains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// BIC without it less BIC with it.
    pub gain: f64,
    /// Probability of a likelihood ratio as large by chance, times the number of candidates.
    pub p_value: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_decide_nothing_are_refused_by_name() {
        let usual = Thresholds::default();
        assert_eq!(usual.check(), Ok(()));
        assert_eq!(Thresholds { gain: 0.0, false_discovery: 1.0, ..usual }.check(), Ok(()));
        let refused = |thresholds: Thresholds| {
            let error = thresholds.check().expect_err("out of range");
            (error.key, error.found)
        };
        for gain in [f64::NAN, f64::INFINITY, -1.0] {
            assert_eq!(refused(Thresholds { gain, ..usual }), ("gain", Shown(gain).to_string()));
        }
        for rate in [f64::NAN, 0.0, -0.01, 1.5] {
            let thresholds = Thresholds { false_discovery: rate, ..usual };
            assert_eq!(refused(thresholds), ("false-discovery", Shown(rate).to_string()));
        }
        assert_eq!(refused(Thresholds { most_effects: 21, ..usual }), ("most-effects", "21".to_owned()));
    }
}
