//! How the probabilities of effects move with the prior odds of all of them together.

use super::TraceParts;
use crate::candidates::PROBABILITY;
use crate::model::TermName;

/// Factors of the prior odds.
pub const FACTORS: [f64; 5] = [0.1, 1.0 / 3.0, 1.0, 3.0, 10.0];

/// Probability of an effect that is weighed alone, from the log of the ratio of the evidence with it to that without,
/// with its prior odds times a factor.
pub fn of_gain(gain: f64, factor: f64) -> f64 {
    1.0 / (1.0 + (-gain).exp() * (1.0 - PROBABILITY) / (factor * PROBABILITY))
}

impl TraceParts<'_> {
    /// Probability that one of some terms is there for each of [`FACTORS`]; nothing where no structure has one. An
    /// effect that was asked for has no odds.
    pub fn by_prior_odds(&self, is_one: impl Fn(&TermName) -> bool) -> Vec<f64> {
        let is_weighed = |name: &TermName| !self.settings.selection.asks_for(name.0);
        let with = |factor: f64| self.structures.of_any_with_odds(factor, is_weighed, &is_one);
        let all = FACTORS.map(with);
        if all.iter().any(|probability| *probability > 0.0) { all.into() } else { Vec::new() }
    }
}
