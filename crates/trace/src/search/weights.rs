//! How probable every effect is, given the records: weights over all structures that a search has tried.
//!
//! The weight of a structure is exp(−BIC/2), which approximates the probability of the records under it (Schwarz 1978;
//! Raftery 1995), times its prior. A priori every place of the menu (an effect; a moment of time in one record) is
//! taken independently with probability π = 1/(size of the menu), by any of its forms alike: one effect is expected
//! whatever the length of the list, so a longer list makes each of its entries less probable.

use std::collections::{BTreeMap, BTreeSet};

use ship::effects::{Effect, WaveYaw};

use super::ledger::Names;
use super::models::Search;
use crate::index::RecordNumber;
use crate::structure::TermName;

/// A structure with its weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Weighted {
    /// Identifier, form and record of its terms, waves included.
    pub terms: Vec<TermName>,
    /// Probability among all structures that were tried.
    pub weight: f64,
    /// BIC less the lowest of all.
    pub bic: f64,
}

/// All structures that were tried, with their weights.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    /// Places of the menu: effects, and moments of time once for every record.
    pub menu: usize,
    /// Prior probability π of each of them.
    pub prior: f64,
    /// Every structure, the largest weight first.
    pub structures: Vec<Weighted>,
}

/// A structure of a smaller share of the largest weight can be told from the best.
const SMALLEST_SHARE: f64 = 0.05;

impl Weights {
    /// Weights of structures with these BIC; `forms` has the number of forms of every place of the menu.
    fn new(tried: &BTreeMap<Names, f64>, forms: &BTreeMap<(&'static str, Option<RecordNumber>), usize>) -> Self {
        let menu = forms.len();
        // Even the only candidate may be absent.
        let prior = 1.0 / menu.max(2) as f64;
        let lowest = tried.values().copied().fold(f64::INFINITY, f64::min);
        let logarithm = |terms: &[TermName], bic: f64| {
            let taken: BTreeSet<_> = terms.iter().map(|(id, _, only)| (*id, *only)).collect();
            let present = taken.len() as f64 * prior.ln();
            let absent = menu.saturating_sub(taken.len()) as f64 * (1.0 - prior).ln();
            let shared = terms.iter().map(|(id, _, only)| forms.get(&(*id, *only)).map_or(1, |count| *count) as f64);
            present + absent - shared.map(f64::ln).sum::<f64>() - 0.5 * (bic - lowest)
        };
        let mut structures: Vec<Weighted> = tried
            .iter()
            .map(|(terms, &bic)| Weighted { terms: terms.clone(), weight: logarithm(terms, bic), bic: bic - lowest })
            .collect();
        let most = structures.iter().map(|one| one.weight).fold(f64::NEG_INFINITY, f64::max);
        structures.iter_mut().for_each(|one| one.weight = (one.weight - most).exp());
        let sum: f64 = structures.iter().map(|one| one.weight).sum();
        structures.iter_mut().for_each(|one| one.weight /= sum);
        structures.sort_by(|one, other| other.weight.total_cmp(&one.weight));
        Self { menu, prior, structures }
    }

    fn sum(&self, has: impl Fn(&TermName) -> bool) -> f64 {
        let all = self.structures.iter().filter(|one| one.terms.iter().any(&has));
        all.map(|one| one.weight).sum::<f64>().min(1.0)
    }

    /// Probability that an effect is present in any form, in any record.
    pub fn of_effect(&self, effect: &str) -> f64 {
        self.sum(|(id, ..)| *id == effect)
    }

    /// Probability that an effect is present in any form where a term acts: in one record, or in all.
    pub fn of_place(&self, effect: &str, only: Option<RecordNumber>) -> f64 {
        self.sum(|(id, _, own)| *id == effect && *own == only)
    }

    /// Probability that a term is present.
    pub fn of_term(&self, name: TermName) -> f64 {
        self.sum(|own| *own == name)
    }

    /// The structures that cannot be told apart: at least a twentieth of the largest weight.
    pub fn alike(&self) -> &[Weighted] {
        let least = SMALLEST_SHARE * self.structures.first().map_or(0.0, |best| best.weight);
        &self.structures[..self.structures.partition_point(|one| one.weight >= least)]
    }
}

impl Search<'_> {
    /// Weights over everything that was tried so far.
    pub fn weights(&self) -> Weights {
        self.weigh(&self.ledger.known().iter().map(|(names, noted)| (names.clone(), noted.fit.bic)).collect())
    }

    /// Weights over structures with these BIC.
    pub(super) fn weigh(&self, tried: &BTreeMap<Names, f64>) -> Weights {
        let mut forms = BTreeMap::new();
        for candidate in self.candidates {
            *forms.entry((candidate.term.effect.id(), candidate.term.only)).or_insert(0) += 1;
        }
        if self.wanted.allows(WaveYaw.id()) {
            forms.insert((WaveYaw.id(), None), 1);
        }
        Weights::new(tried, &forms)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DRIFT: TermName = ("moment_drift", "linear trend", Some(RecordNumber(1)));
    const CUBIC: TermName = ("nonlinear_damping", "r³", None);
    const SQUARE: TermName = ("nonlinear_damping", "r|r|", None);

    fn weighed(tried: &[(&[TermName], f64)], menu: usize) -> Weights {
        let tried = tried.iter().map(|(terms, bic)| (terms.to_vec(), *bic)).collect();
        let mut forms: BTreeMap<_, _> = [((DRIFT.0, DRIFT.2), 1), ((CUBIC.0, None), 2)].into();
        const OTHERS: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];
        forms.extend(OTHERS.iter().take(menu - 2).map(|id| ((*id, None), 1)));
        Weights::new(&tried, &forms)
    }

    /// By hand: menu of 4, π = 1/4. Nothing: (3/4)⁴ e⁰; one form of two: ½·¼·(3/4)³ e^(½·6) and e^(½·4).
    #[test]
    fn weights_are_likelihood_times_prior() {
        let weights = weighed(&[(&[], 100.0), (&[CUBIC], 94.0), (&[SQUARE], 96.0)], 4);
        let by_hand = [0.75f64.powi(4), 0.125 * 0.75f64.powi(3) * 3f64.exp(), 0.125 * 0.75f64.powi(3) * 2f64.exp()];
        let sum: f64 = by_hand.iter().sum();
        assert_eq!((weights.menu, weights.prior), (4, 0.25));
        assert!((weights.of_term(CUBIC) - by_hand[1] / sum).abs() < 1e-12);
        assert!((weights.of_effect("nonlinear_damping") - (by_hand[1] + by_hand[2]) / sum).abs() < 1e-12);
        assert_eq!(weights.structures.iter().map(|one| one.bic).collect::<Vec<_>>(), [0.0, 2.0, 6.0]);
        assert_eq!(weights.alike().len(), 3);
    }

    /// A longer menu makes each of its entries less probable; structures far behind are told apart.
    #[test]
    fn a_longer_menu_asks_for_more() {
        let tried: [(&[TermName], f64); 2] = [(&[], 100.0), (&[DRIFT], 95.0)];
        let [short, long] = [4, 10].map(|menu| weighed(&tried, menu).of_place("moment_drift", DRIFT.2));
        assert!(short > 0.79 && long < 0.58, "{short} {long}");
        assert_eq!(weighed(&tried, 4).of_place("moment_drift", None), 0.0);
        let clear = weighed(&[(&[], 100.0), (&[CUBIC], 60.0)], 4);
        assert_eq!(clear.alike().iter().map(|one| one.terms.clone()).collect::<Vec<_>>(), [vec![CUBIC]]);
    }

    #[test]
    fn nothing_tried_is_nothing_weighed() {
        let nothing = Weights::new(&BTreeMap::new(), &BTreeMap::new());
        assert!(nothing.structures.is_empty() && nothing.alike().is_empty() && nothing.of_effect("x") == 0.0);
    }
}
