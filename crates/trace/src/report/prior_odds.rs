//! Sensitivity of the probabilities to the prior odds of all effects together.

use super::TraceParts;
use crate::candidates::PRIOR_PROBABILITY;
use crate::model::TermName;

/// Factors by which the prior odds are multiplied.
pub const PRIOR_ODDS_FACTORS: [f64; 5] = [0.1, 1.0 / 3.0, 1.0, 3.0, 10.0];

/// Probability of a single effect from its log evidence ratio, with its prior odds multiplied by a factor.
pub fn probability_from_log_ratio(log_ratio: f64, factor: f64) -> f64 {
    1.0 / (1.0 + (-log_ratio).exp() * (1.0 - PRIOR_PROBABILITY) / (factor * PRIOR_PROBABILITY))
}

impl TraceParts<'_> {
    /// Probability that one of the terms selected by `matches` is present, for each of [`PRIOR_ODDS_FACTORS`]; empty if
    /// no structure has one. The odds of a required effect are not changed.
    pub fn by_prior_odds(&self, matches: impl Fn(&TermName) -> bool) -> Vec<f64> {
        let is_weighed = |name: &TermName| !self.settings.selection.requires(name.0);
        let with = |factor: f64| self.structures.probability_with_odds(factor, is_weighed, &matches);
        let all = PRIOR_ODDS_FACTORS.map(with);
        if all.iter().any(|probability| *probability > 0.0) { all.into() } else { Vec::new() }
    }
}
