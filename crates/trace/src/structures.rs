//! Structures and their probabilities: all subsets of the candidates weighed at once round the full model, the best of
//! them refitted and weighed again.

mod quadratic;
mod result;

use std::collections::BTreeMap;
use std::sync::Arc;

use estimation::subsets::{Removable, conditional};
use rayon::prelude::*;

use crate::candidates::{is_delay, is_variant};
use crate::fit::{Effort, FittedRecords, StructureFit};
use crate::full::Full;
use crate::model::{ModelParameter, Structure, Term, TermName};
use crate::selection::Selection;
use crate::settings::Rule;
use crate::weights::Weights;
use quadratic::{HOPELESS, Quadratic};
use result::names;

pub use quadratic::{Support, by_chance};
pub use result::{Structures, WeighedStructure};

/// Structures whose fit is driven to the end.
const POLISHED: usize = 8;

/// Start of a delay that takes the place of another, in standard deviations of its prior.
const SMALL_DELAY: f64 = 0.3;

/// Rounds of weighing, round the best structure of the last.
const ROUNDS: usize = 2;

/// The search with what it needs.
struct StructureSearch<'a> {
    problem: &'a FittedRecords,
    weights: Weights,
    full: &'a Full,
    variants: Vec<&'a Arc<Term>>,
    selection: &'a Selection,
    rule: Rule,
    known: BTreeMap<Vec<TermName>, WeighedStructure>,
    visibility: BTreeMap<TermName, f64>,
    /// The last approximation: what speaks for every term is read off it in the end.
    latest: Option<Quadratic>,
}

/// Weighs the structures under every law, and keeps the law that explains the records best: by the evidence of its
/// structures; but where physics beside a smooth error of the model explains what the base leaves, no other law does.
pub fn choose(
    problem: &FittedRecords,
    fulls: Vec<Full>,
    candidates: &[Arc<Term>],
    selection: &Selection,
    rule: Rule,
    base: f64,
) -> (Full, Structures) {
    let price = 0.5 * (problem.observations() as f64).ln();
    let weighed: Vec<(f64, Full, Structures)> = fulls
        .into_par_iter()
        .map(|full| {
            let structures = weigh(problem, &full, candidates, selection, rule);
            let height = structures.all.first().map_or(f64::NEG_INFINITY, |best| best.height - best.weight.ln());
            let own = problem.log_normaliser(&full.law) - price * full.law.colour.freedom() as f64;
            (height + own, full, structures)
        })
        .collect();
    let astray = weighed.iter().any(|(_, full, structures)| {
        full.law.is_random_moment() && structures.mean_square_of_ship() > ASTRAY * ASTRAY * base
    });
    let is_physical = |(_, full, structures): &(f64, Full, Structures)| {
        let left = structures.mean_square_of_ship() / base;
        full.law.is_of_model() && left < if astray { PARTLY * PARTLY } else { PHYSICS * PHYSICS }
    };
    let physical = weighed.iter().any(is_physical);
    let mut kept: Vec<(f64, Full, Structures)> =
        weighed.into_iter().filter(|one| !physical || is_physical(one)).collect();
    kept.sort_by(|one, other| other.0.total_cmp(&one.0));
    let (highest, full, mut structures) = kept.remove(0);
    let others: Vec<(f64, Structures)> =
        kept.into_iter().map(|(height, _, other)| ((height - highest).exp(), other)).collect();
    structures.share_with(others);
    (full, structures)
}

/// Share of the error of the base up to which physics explains it.
const PHYSICS: f64 = 0.4;

/// The same where a random moment is further from the records than the base.
const PARTLY: f64 = 0.7;

/// Error of the base times this beyond which a random moment has taken the place of physics.
const ASTRAY: f64 = 2.0;

/// Weighs the structures of a full model.
fn weigh(
    problem: &FittedRecords,
    full: &Full,
    candidates: &[Arc<Term>],
    selection: &Selection,
    rule: Rule,
) -> Structures {
    let mut search = StructureSearch {
        problem,
        weights: problem.weights(&full.law),
        full,
        variants: candidates.iter().filter(|one| is_variant(one.effect.as_ref())).collect(),
        selection,
        rule,
        known: BTreeMap::new(),
        visibility: BTreeMap::new(),
        latest: None,
    };
    let none = vec![false; full.fit.structure.terms.len()];
    if none.is_empty() {
        search.keep(vec![full.fit.clone()]);
        return search.result();
    }
    search.look(&full.fit.theta, &full.fit.initial, &none);
    let mut seen: Vec<Vec<TermName>> = Vec::new();
    for _ in 0..ROUNDS {
        let Some(top) = search.top().map(|top| top.fit.clone()).filter(|top| !seen.contains(&names(&top.structure)))
        else {
            break;
        };
        seen.push(names(&top.structure));
        // What may stand in the place of a term shows when it is taken away.
        for out in 0..top.structure.terms.len() {
            let less = top.without(out, problem, &search.weights, Effort::COARSE);
            search.look(&search.unfold(&less), &less.initial, &search.terms_of(&less));
            search.keep(vec![less]);
        }
        search.look(&search.unfold(&top), &top.initial, &search.terms_of(&top));
        search.swap(&top);
    }
    search.polish();
    search.result()
}

impl StructureSearch<'_> {
    /// Weighs all subsets round a point of the full model, and refits the best.
    fn look(&mut self, theta: &[f64], initial: &[[f64; 2]], about: &[bool]) {
        let structure = &self.full.fit.structure;
        let normal = self.problem.posterior(structure, theta, initial, &self.weights);
        let odds: Vec<f64> = structure.terms.iter().map(|term| self.odds(term, 1e6)).collect();
        let Some(quadratic) = Quadratic::new(&normal, structure, theta, &odds) else { return };
        if self.visibility.is_empty() {
            self.visibility = self.visibility(&quadratic);
        }
        let hopeful = quadratic.best(about);
        self.fit_all(hopeful.iter().map(|chosen| self.start(&quadratic, chosen, theta, initial)).collect());
        self.latest = Some(quadratic);
    }

    /// Refits a structure with every other effect that delays the rudder in the place of one: they are nearly alike,
    /// and only a fit tells them apart.
    fn swap(&mut self, top: &StructureFit) {
        let known = self.full.fit.structure.terms.iter().chain(self.variants.iter().copied());
        let delays: Vec<Arc<Term>> = known.filter(|term| is_delay(term.effect.as_ref())).cloned().collect();
        let mut fresh = Vec::new();
        for (place, term) in top.structure.terms.iter().enumerate().filter(|(_, term)| is_delay(term.effect.as_ref())) {
            for other in delays.iter().filter(|other| other.name() != term.name()) {
                let (mut terms, mut theta) = (top.structure.terms.clone(), top.theta.clone());
                terms[place] = Arc::clone(other);
                let start = other.priors.iter().map(|prior| prior.mean.max(SMALL_DELAY * prior.sd).min(prior.highest));
                theta.splice(top.structure.ranges()[place].clone(), start);
                fresh.push((top.structure.of(terms), theta, top.initial.clone()));
            }
        }
        self.fit_all(fresh);
    }

    /// Fits structures that are not known yet.
    fn fit_all(&mut self, fresh: Vec<(Structure, Vec<f64>, Vec<[f64; 2]>)>) {
        let fits: Vec<StructureFit> = fresh
            .into_par_iter()
            .filter(|(own, ..)| !self.known.contains_key(&names(own)))
            .map(|(own, theta, initial)| self.problem.fit(&own, theta, initial, &self.weights, Effort::COARSE))
            .collect();
        self.keep(fits);
    }

    /// Keeps fits; of a structure that was fitted from several starts that of the largest posterior density.
    fn keep(&mut self, fits: Vec<StructureFit>) {
        let square = |fit: &StructureFit| fit.misfit + fit.penalty;
        for fit in fits {
            let name = names(&fit.structure);
            if self.known.get(&name).is_none_or(|known| square(&fit) <= square(&known.fit)) {
                let height = self.height(&fit);
                self.known.insert(name, WeighedStructure { fit, weight: 0.0, height });
            }
        }
    }

    /// Drives the fits of the best structures to the end.
    fn polish(&mut self) {
        let highest = self.top().map_or(0.0, |top| top.height);
        let mut best: Vec<&WeighedStructure> =
            self.known.values().filter(|one| one.height > highest - HOPELESS).collect();
        best.sort_by(|one, other| other.height.total_cmp(&one.height));
        let fits: Vec<StructureFit> = best
            .into_par_iter()
            .take(POLISHED)
            .map(|WeighedStructure { fit, .. }| {
                let StructureFit { structure, theta, initial, .. } = fit.clone();
                self.problem.fit(&structure, theta, initial, &self.weights, Effort::FINE)
            })
            .collect();
        self.keep(fits);
    }

    /// Which terms of the full model a fit has.
    fn terms_of(&self, fit: &StructureFit) -> Vec<bool> {
        let own = names(&fit.structure);
        self.full.fit.structure.terms.iter().map(|term| own.contains(&term.name())).collect()
    }

    /// Log odds that count for a term; `required` are those of one that was asked for.
    fn odds(&self, term: &Term, required: f64) -> f64 {
        if self.selection.asks_for(term.effect.id()) { required } else { term.log_odds }
    }

    /// Expected squared size of every term over its posterior variance beside all others.
    fn visibility(&self, quadratic: &Quadratic) -> BTreeMap<TermName, f64> {
        let of = |(term, own): (&Arc<Term>, &Removable)| {
            let expected: Vec<f64> = term
                .priors
                .iter()
                .filter(|prior| prior.is_fitted() && !prior.is_shape)
                .zip(term.neutral())
                .map(|(prior, neutral)| prior.sd.powi(2) + (prior.mean - neutral).powi(2))
                .collect();
            let variance = |k: usize| if quadratic.free[k] { quadratic.covariance[(k, k)] } else { f64::INFINITY };
            let seen = own.sizes.iter().zip(expected).map(|((k, _), square)| square / variance(*k));
            (term.name(), seen.fold(0.0, f64::max))
        };
        self.full.fit.structure.terms.iter().zip(&quadratic.removable).map(of).collect()
    }

    /// A subset with the start that the quadratic approximation gives it.
    fn start(
        &self,
        quadratic: &Quadratic,
        chosen: &[bool],
        theta: &[f64],
        initial: &[[f64; 2]],
    ) -> (Structure, Vec<f64>, Vec<[f64; 2]>) {
        let structure = &self.full.fit.structure;
        let out: Vec<&Removable> =
            quadratic.removable.iter().zip(chosen).filter(|(_, kept)| !**kept).map(|(own, _)| own).collect();
        let moved = conditional(&quadratic.covariance, &quadratic.mean, &out);
        let mut moved = moved.iter();
        let mut next = || *moved.next().expect("an unknown for every fitted entry and state");
        let value = |(entry, own): (ModelParameter, &f64)| match entry.prior.is_fitted() {
            true => next().clamp(entry.prior.lowest, entry.prior.highest),
            false => *own,
        };
        let all: Vec<f64> = structure.entries().into_iter().zip(theta).map(value).collect();
        let initial = initial.iter().map(|_| [next(), next()]).collect();
        let mut theta = all[..structure.base_count()].to_vec();
        let mut terms = Vec::new();
        for ((term, range), _) in structure.terms.iter().zip(structure.ranges()).zip(chosen).filter(|(_, kept)| **kept)
        {
            terms.push(Arc::clone(term));
            theta.extend_from_slice(&all[range]);
        }
        (structure.of(terms), theta, initial)
    }

    /// Log of evidence and prior odds of a fit.
    fn height(&self, fit: &StructureFit) -> f64 {
        let odds: f64 = fit.structure.terms.iter().map(|term| self.odds(term, 0.0)).sum();
        odds + match self.rule {
            Rule::Posterior => fit.evidence,
            Rule::Bic => {
                let free = fit.structure.entries().iter().filter(|entry| entry.prior.is_fitted()).count() as f64;
                -0.5 * (fit.misfit + free * (self.problem.observations() as f64).ln())
            }
        }
    }

    fn top(&self) -> Option<&WeighedStructure> {
        self.known
            .values()
            .filter(|one| one.height.is_finite())
            .max_by(|one, other| one.height.total_cmp(&other.height))
    }

    /// Parameters of the full model: those of a fit, with everything else neutral.
    fn unfold(&self, fit: &StructureFit) -> Vec<f64> {
        let structure = &self.full.fit.structure;
        let mut theta = fit.theta[..structure.base_count()].to_vec();
        let own: BTreeMap<TermName, &[f64]> = fit
            .structure
            .terms
            .iter()
            .zip(fit.structure.ranges())
            .map(|(term, range)| (term.name(), &fit.theta[range]))
            .collect();
        for (term, range) in structure.terms.iter().zip(structure.ranges()) {
            match own.get(&term.name()) {
                Some(values) => theta.extend_from_slice(values),
                None => {
                    let shaped = term.neutral().into_iter().zip(&term.priors).zip(&self.full.fit.theta[range]);
                    theta.extend(shaped.map(|((neutral, prior), full)| if prior.is_shape { *full } else { neutral }));
                }
            }
        }
        theta
    }

    fn result(self) -> Structures {
        let terms = &self.full.fit.structure.terms;
        let effects: Vec<_> = terms.iter().map(|term| (term.effect.id(), term.only)).collect();
        let support = self.latest.map_or_else(Vec::new, |latest| latest.support(&effects));
        let support = terms.iter().map(|term| term.name()).zip(support).collect();
        let visibility = self.visibility;
        let mut all: Vec<WeighedStructure> = self.known.into_values().filter(|one| one.height.is_finite()).collect();
        all.sort_by(|one, other| {
            other
                .height
                .total_cmp(&one.height)
                .then_with(|| names(&one.fit.structure).cmp(&names(&other.fit.structure)))
        });
        let highest = all.first().map_or(0.0, |one| one.height);
        let total: f64 = all.iter().map(|one| (one.height - highest).exp()).sum();
        let mut probabilities: BTreeMap<TermName, f64> = visibility.keys().map(|name| (*name, 0.0)).collect();
        for one in &mut all {
            one.weight = (one.height - highest).exp() / total;
            for term in &one.fit.structure.terms {
                *probabilities.entry(term.name()).or_default() += one.weight;
            }
        }
        Structures { all, probabilities, visibility, support, others: Vec::new() }
    }
}
