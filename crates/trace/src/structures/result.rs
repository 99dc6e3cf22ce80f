//! Weighed structures and the probabilities that follow from them.

use std::collections::BTreeMap;

use super::quadratic::TermEvidence;
use crate::candidates::PRIOR_PROBABILITY;
use crate::fit::StructureFit;
use crate::model::{Structure, TermName};

/// Maximum odds of the best structure against a member of the average.
const MAX_MEMBER_ODDS: f64 = 20.0;

/// Fitted structure with its posterior weight.
#[derive(Debug, Clone)]
pub struct WeighedStructure {
    /// Fit.
    pub fit: StructureFit,
    /// Posterior probability.
    pub weight: f64,
    /// Log evidence plus log prior odds.
    pub log_posterior: f64,
}

/// Structures with their probabilities, the most probable first.
#[derive(Debug, Clone)]
pub struct Structures {
    /// Fitted structures.
    pub weighed: Vec<WeighedStructure>,
    /// Probability of every candidate.
    pub probabilities: BTreeMap<TermName, f64>,
    /// Visibility of every candidate: expected squared coefficient over its variance with all other candidates present;
    /// a candidate of small visibility is unobservable.
    pub visibility: BTreeMap<TermName, f64>,
    /// Evidence for every candidate term.
    pub evidence: BTreeMap<TermName, TermEvidence>,
    /// Structures under other noise laws: weight, names of the terms.
    pub(super) other_law_structures: Vec<(f64, Vec<TermName>)>,
}

/// Names of the terms of a structure.
pub(super) fn names(structure: &Structure) -> Vec<TermName> {
    structure.terms.iter().map(|term| term.name()).collect()
}

impl Structures {
    /// Members of the average with their weights, which sum to one.
    pub fn weighted_members(&self) -> Vec<(f64, &StructureFit)> {
        let least = self.weighed.first().map_or(0.0, |best| best.weight) / MAX_MEMBER_ODDS;
        let kept: Vec<&WeighedStructure> = self.weighed.iter().filter(|weighed| weighed.weight >= least).collect();
        let total: f64 = kept.iter().map(|weighed| weighed.weight).sum();
        kept.iter().map(|weighed| (weighed.weight / total, &weighed.fit)).collect()
    }

    /// Shares the weight with structures under other noise laws, given with the odds of their law against this law.
    pub(super) fn share_with(&mut self, rivals: Vec<(f64, Structures)>) {
        let total = 1.0 + rivals.iter().map(|(odds, _)| odds).sum::<f64>();
        self.weighed.iter_mut().for_each(|weighed| weighed.weight /= total);
        for (odds, rival) in rivals {
            for (name, visibility) in &rival.visibility {
                self.visibility.entry(*name).or_insert(*visibility);
                self.probabilities.entry(*name).or_insert(0.0);
            }
            for (name, evidence) in &rival.evidence {
                self.evidence.entry(*name).or_insert(*evidence);
            }
            self.other_law_structures
                .extend(rival.weighed_names().map(|(weight, names)| (weight * odds / total, names)));
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
    pub fn effect_probability(&self, id: &str, record: Option<usize>) -> f64 {
        self.inclusion_probability(|name| name.0 == id && name.2 == record)
    }

    /// Mean square residual of the most probable structure without moments of time, rad²; infinite if all structures
    /// have such a moment.
    pub fn ship_mean_square(&self) -> f64 {
        let is_ship =
            |all: &&WeighedStructure| all.fit.structure.terms.iter().all(|term| !term.effect.is_time_dependent());
        let residual =
            self.weighed.iter().find(is_ship).into_iter().flat_map(|best| best.fit.residual.iter().flatten());
        let (sum, rows) = residual.fold((0.0, 0.0), |(sum, rows), e| (sum + e * e, rows + 1.0));
        if rows > 0.0 { sum / rows } else { f64::INFINITY }
    }

    /// Evidence for the best form of an effect.
    pub fn effect_evidence(&self, id: &str, record: Option<usize>) -> TermEvidence {
        let forms = self.evidence.iter().filter(|(name, _)| name.0 == id && name.2 == record).map(|(_, form)| *form);
        let none = TermEvidence { log_ratio: 0.0, p_value: 1.0 };
        let mut best = forms.max_by(|a, b| a.log_ratio.total_cmp(&b.log_ratio)).unwrap_or(none);
        // The refitted structures are more accurate than the quadratic approximation.
        let probability = self.effect_probability(id, record).clamp(1e-12, 1.0 - 1e-12);
        if probability > 0.5 {
            best.log_ratio = best.log_ratio.max((probability / (1.0 - probability)).ln() - PRIOR_PROBABILITY.ln());
        }
        best.log_ratio = best.log_ratio.clamp(-1e6, 1e6);
        best
    }

    /// Probability that at least one of the terms selected by `matches` is present.
    pub fn inclusion_probability(&self, matches: impl Fn(&TermName) -> bool) -> f64 {
        let present = self.weighed_names().filter(|(_, names)| names.iter().any(&matches));
        present.map(|(weight, _)| weight).sum::<f64>().clamp(0.0, 1.0)
    }

    /// [`inclusion_probability`](Self::inclusion_probability) with the prior odds of `is_weighed` terms multiplied by
    /// a factor: the weight of a structure changes by the factor for each such term. Only fitted structures count.
    pub fn probability_with_odds(
        &self,
        factor: f64,
        is_weighed: impl Fn(&TermName) -> bool,
        matches: impl Fn(&TermName) -> bool,
    ) -> f64 {
        let (mut present, mut all) = (0.0, 0.0);
        for (weight, names) in self.weighed_names() {
            let odds: f64 = names.iter().filter(|name| is_weighed(name)).map(|_| factor).product();
            all += weight * odds;
            present += if names.iter().any(&matches) { weight * odds } else { 0.0 };
        }
        if all > 0.0 { (present / all).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Weights of the structures under all noise laws, with the names of their terms.
    fn weighed_names(&self) -> impl Iterator<Item = (f64, Vec<TermName>)> + '_ {
        let chosen = self.weighed.iter().map(|weighed| (weighed.weight, names(&weighed.fit.structure)));
        chosen.chain(self.other_law_structures.iter().cloned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DAMPING: TermName = ("nonlinear_damping", "r³", None);
    const LAG: TermName = ("steering_lag", "dead time", None);

    fn structures(rivals: &[(f64, &[TermName])]) -> Structures {
        Structures {
            weighed: Vec::new(),
            probabilities: BTreeMap::new(),
            visibility: BTreeMap::new(),
            evidence: BTreeMap::new(),
            other_law_structures: rivals.iter().map(|(weight, names)| (*weight, names.to_vec())).collect(),
        }
    }

    /// For one term: p' = f p/(1 − p + f p). For several terms, weights 0.5, 0.2, 0.2 and 0.1 of none, damping, lag and
    /// both become 0.5, 2, 2 and 10 at ten times the odds.
    #[test]
    fn prior_odds_move_the_weights_term_by_term() {
        let with = |structures: &Structures, factor, asked: Option<TermName>| {
            structures.probability_with_odds(factor, |name| Some(*name) != asked, |name| *name == DAMPING)
        };
        let near = |value: f64, expected: f64| assert!((value - expected).abs() < 1e-15, "{value} {expected}");
        let alone = structures(&[(0.7, &[]), (0.3, &[DAMPING])]);
        for factor in [0.1, 1.0, 3.0, 10.0] {
            near(with(&alone, factor, None), factor * 0.3 / (0.7 + factor * 0.3));
        }
        near(with(&alone, 10.0, Some(DAMPING)), 0.3);
        let both = structures(&[(0.5, &[]), (0.2, &[DAMPING]), (0.2, &[LAG]), (0.1, &[DAMPING, LAG])]);
        near(with(&both, 1.0, None), both.effect_probability(DAMPING.0, None));
        near(with(&both, 10.0, None), 12.0 / 14.5);
        near(with(&both, 10.0, Some(LAG)), 3.0 / 3.7);
        near(with(&structures(&[]), 10.0, None), 0.0);
    }
}
