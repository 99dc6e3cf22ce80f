//! What weighed structures say.

use std::collections::BTreeMap;

use super::quadratic::Support;
use crate::candidates::PROBABILITY;
use crate::fit::StructureFit;
use crate::model::{Structure, TermName};

/// Odds against the best within which structures are members of the average.
const MEMBERS: f64 = 20.0;

/// A refitted structure with its weight among all.
#[derive(Debug, Clone)]
pub struct WeighedStructure {
    /// The fit.
    pub fit: StructureFit,
    /// Probability.
    pub weight: f64,
    /// Log of evidence and prior odds.
    pub height: f64,
}

/// Structures with their probabilities, the most probable first.
#[derive(Debug, Clone)]
pub struct Structures {
    /// All that were refitted.
    pub all: Vec<WeighedStructure>,
    /// Probability of every candidate, by its name.
    pub probabilities: BTreeMap<TermName, f64>,
    /// Expected |size/error|² of every candidate beside all others: what cannot be seen is not observable.
    pub visibility: BTreeMap<TermName, f64>,
    /// What speaks for every candidate.
    pub support: BTreeMap<TermName, Support>,
    /// Structures under other laws of the noise: their names and weights.
    pub(super) others: Vec<(f64, Vec<TermName>)>,
}

/// Names of the terms of a structure.
pub(super) fn names(structure: &Structure) -> Vec<TermName> {
    structure.terms.iter().map(|term| term.name()).collect()
}

impl Structures {
    /// The members of the average with their weights, which sum to one.
    pub fn members(&self) -> Vec<(f64, &StructureFit)> {
        let least = self.all.first().map_or(0.0, |one| one.weight) / MEMBERS;
        let kept: Vec<&WeighedStructure> = self.all.iter().filter(|one| one.weight >= least).collect();
        let total: f64 = kept.iter().map(|one| one.weight).sum();
        kept.iter().map(|one| (one.weight / total, &one.fit)).collect()
    }

    /// Shares the weight with structures under other laws, each with the odds of its law against that of these.
    pub(super) fn share_with(&mut self, others: Vec<(f64, Structures)>) {
        let total = 1.0 + others.iter().map(|(odds, _)| odds).sum::<f64>();
        self.all.iter_mut().for_each(|one| one.weight /= total);
        for (odds, other) in others {
            for (name, seen) in &other.visibility {
                self.visibility.entry(*name).or_insert(*seen);
                self.probabilities.entry(*name).or_insert(0.0);
            }
            for (name, support) in &other.support {
                self.support.entry(*name).or_insert(*support);
            }
            self.others.extend(other.weighed_names().map(|(weight, names)| (weight * odds / total, names)));
        }
        for probability in self.probabilities.values_mut() {
            *probability = 0.0;
        }
        for (weight, names) in self.weighed_names().collect::<Vec<_>>() {
            for name in names {
                *self.probabilities.entry(name).or_default() += weight;
            }
        }
    }

    /// Probability of an effect in any form, in all records or in one.
    pub fn of_effect(&self, id: &str, only: Option<usize>) -> f64 {
        self.of_any(|name| name.0 == id && name.2 == only)
    }

    /// Mean square of what the most probable structure leaves that has nothing but the ship in it, rad².
    pub fn mean_square_of_ship(&self) -> f64 {
        let is_ship = |one: &&WeighedStructure| one.fit.structure.terms.iter().all(|term| !term.effect.is_of_time());
        let residual = self.all.iter().find(is_ship).into_iter().flat_map(|best| best.fit.residual.iter().flatten());
        let (sum, rows) = residual.fold((0.0, 0.0), |(sum, rows), e| (sum + e * e, rows + 1.0));
        if rows > 0.0 { sum / rows } else { f64::INFINITY }
    }

    /// What speaks for the best form of an effect.
    pub fn support_of(&self, id: &str, only: Option<usize>) -> Support {
        let own = self.support.iter().filter(|(name, _)| name.0 == id && name.2 == only).map(|(_, own)| *own);
        let none = Support { gain: 0.0, p_value: 1.0 };
        let mut best = own.max_by(|one, other| one.gain.total_cmp(&other.gain)).unwrap_or(none);
        // The structures that were refitted know better than the approximation.
        let probability = self.of_effect(id, only).clamp(1e-12, 1.0 - 1e-12);
        if probability > 0.5 {
            best.gain = best.gain.max((probability / (1.0 - probability)).ln() - PROBABILITY.ln());
        }
        best.gain = best.gain.clamp(-1e6, 1e6);
        best
    }

    /// Probability that one of the terms of which something is true is there.
    pub fn of_any(&self, is_one: impl Fn(&TermName) -> bool) -> f64 {
        let there = self.weighed_names().filter(|(_, names)| names.iter().any(&is_one));
        there.map(|(weight, _)| weight).sum::<f64>().clamp(0.0, 1.0)
    }

    /// The same with the prior odds of every term that `is_weighed` times a factor: the weight of a structure changes
    /// by the factor for each of its terms. Structures that the search did not refit have no part in it.
    pub fn of_any_with_odds(
        &self,
        factor: f64,
        is_weighed: impl Fn(&TermName) -> bool,
        is_one: impl Fn(&TermName) -> bool,
    ) -> f64 {
        let (mut there, mut all) = (0.0, 0.0);
        for (weight, names) in self.weighed_names() {
            let odds: f64 = names.iter().filter(|name| is_weighed(name)).map(|_| factor).product();
            all += weight * odds;
            there += if names.iter().any(&is_one) { weight * odds } else { 0.0 };
        }
        if all > 0.0 { (there / all).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Weights of all structures with the names of their terms.
    fn weighed_names(&self) -> impl Iterator<Item = (f64, Vec<TermName>)> + '_ {
        let own = self.all.iter().map(|one| (one.weight, names(&one.fit.structure)));
        own.chain(self.others.iter().cloned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAMPING: TermName = ("nonlinear_damping", "r³", None);
    const LAG: TermName = ("steering_lag", "dead time", None);

    fn structures(others: &[(f64, &[TermName])]) -> Structures {
        Structures {
            all: Vec::new(),
            probabilities: BTreeMap::new(),
            visibility: BTreeMap::new(),
            support: BTreeMap::new(),
            others: others.iter().map(|(weight, names)| (*weight, names.to_vec())).collect(),
        }
    }

    /// Alone, odds are multiplied: p' = f p/(1 − p + f p). Together every term counts: with weights 0.5, 0.2, 0.2 and
    /// 0.1 of none, damping, lag and both, ten times the odds make 0.5, 2, 2 and 10 of them.
    #[test]
    fn prior_odds_move_the_weights_term_by_term() {
        let with = |structures: &Structures, factor, asked: Option<TermName>| {
            structures.of_any_with_odds(factor, |name| Some(*name) != asked, |name| *name == DAMPING)
        };
        let near = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-15, "{value} {expected}");
        let alone = structures(&[(0.7, &[]), (0.3, &[DAMPING])]);
        for factor in [0.1, 1.0, 3.0, 10.0] {
            near(with(&alone, factor, None), factor * 0.3 / (0.7 + factor * 0.3));
        }
        near(with(&alone, 10.0, Some(DAMPING)), 0.3);
        let both = structures(&[(0.5, &[]), (0.2, &[DAMPING]), (0.2, &[LAG]), (0.1, &[DAMPING, LAG])]);
        near(with(&both, 1.0, None), both.of_effect(DAMPING.0, None));
        near(with(&both, 10.0, None), 12.0 / 14.5);
        near(with(&both, 10.0, Some(LAG)), 3.0 / 3.7);
        near(with(&structures(&[]), 10.0, None), 0.0);
    }
}
