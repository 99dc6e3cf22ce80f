//! Posterior probabilities of the structures: all subsets of the candidates are weighed by a quadratic approximation
//! about the full model (Laplace; Kass and Raftery 1995), the best of them are refitted and weighed again.

mod quadratic;
mod result;

use std::collections::BTreeMap;
use std::sync::Arc;

use estimation::subsets::{RemovableTerm, conditional_mean};
use rayon::prelude::*;

use crate::candidates::{is_alternative, is_delay};
use crate::fit::{FittedRecords, StoppingRule, StructureFit};
use crate::full::FullModel;
use crate::model::{ModelParameter, Structure, Term, TermName};
use crate::noise_law::RecordWhitening;
use crate::selection::Selection;
use crate::settings::WeightingRule;
use quadratic::{MAX_LOG_ODDS, QuadraticPosterior};
use result::names;

pub use quadratic::{TermEvidence, chi_square_p_value};
pub use result::{Structures, WeighedStructure};

/// Maximum number of structures whose fit is iterated to convergence.
const MAX_CONVERGED: usize = 8;

/// Minimum start value of a delay that replaces another delay, in standard deviations of the prior.
const DELAY_START: f64 = 0.3;

/// Number of rounds, each about the best structure of the round before.
const ROUNDS: usize = 2;

/// Search over the structures of one noise law.
struct StructureSearch<'a> {
    problem: &'a FittedRecords,
    whitening: RecordWhitening,
    full: &'a FullModel,
    variants: Vec<&'a Arc<Term>>,
    selection: &'a Selection,
    rule: WeightingRule,
    /// Evaluated structures by the names of their terms.
    evaluated: BTreeMap<Vec<TermName>, WeighedStructure>,
    visibility: BTreeMap<TermName, f64>,
    /// Latest approximation, which gives the evidence for every term.
    latest: Option<QuadraticPosterior>,
}

/// Weighs the structures under every noise law and chooses the most probable law by the evidence of its structures. If
/// structures under a smooth model error explain the misfit of the base, only such laws compete. `base` is the mean
/// square residual of the base, rad².
pub fn weigh_structures(
    problem: &FittedRecords,
    fulls: Vec<FullModel>,
    candidates: &[Arc<Term>],
    selection: &Selection,
    rule: WeightingRule,
    base: f64,
) -> (FullModel, Structures) {
    let penalty = 0.5 * (problem.heading_count() as f64).ln();
    let weighed: Vec<(f64, FullModel, Structures)> = fulls
        .into_par_iter()
        .map(|full| {
            let structures = weigh(problem, &full, candidates, selection, rule);
            let evidence =
                structures.weighed.first().map_or(f64::NEG_INFINITY, |top| top.log_posterior - top.weight.ln());
            let law =
                problem.log_normaliser(&full.noise_law) - penalty * full.noise_law.colour.parameter_count() as f64;
            (evidence + law, full, structures)
        })
        .collect();
    let diverges = weighed.iter().any(|(_, full, structures)| {
        full.noise_law.is_random_moment() && structures.ship_mean_square() > MAX_RANDOM_RATIO * MAX_RANDOM_RATIO * base
    });
    let is_physical = |(_, full, structures): &(f64, FullModel, Structures)| {
        let max_ratio = if diverges { MAX_PHYSICAL_RATIO_IF_DIVERGENT } else { MAX_PHYSICAL_RATIO };
        full.noise_law.includes_model_error() && structures.ship_mean_square() / base < max_ratio * max_ratio
    };
    let physical = weighed.iter().any(is_physical);
    let mut kept: Vec<(f64, FullModel, Structures)> =
        weighed.into_iter().filter(|law| !physical || is_physical(law)).collect();
    kept.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (highest, full, mut structures) = kept.remove(0);
    let rivals: Vec<(f64, Structures)> =
        kept.into_iter().map(|(evidence, _, rival)| ((evidence - highest).exp(), rival)).collect();
    structures.share_with(rivals);
    (full, structures)
}

/// Maximum ratio of the replay error to the error of the base, for structures that explain the misfit.
const MAX_PHYSICAL_RATIO: f64 = 0.4;

/// Maximum ratio if the replay under a random moment diverges.
const MAX_PHYSICAL_RATIO_IF_DIVERGENT: f64 = 0.7;

/// Maximum ratio of the replay error to the error of the base under a random moment; above it the moment has replaced
/// physics.
const MAX_RANDOM_RATIO: f64 = 2.0;

/// Searches subsets of the terms of a full model and weighs them by their posterior under its noise law.
fn weigh(
    problem: &FittedRecords,
    full: &FullModel,
    candidates: &[Arc<Term>],
    selection: &Selection,
    rule: WeightingRule,
) -> Structures {
    let mut search = StructureSearch {
        problem,
        whitening: problem.whitening(&full.noise_law),
        full,
        variants: candidates.iter().filter(|term| is_alternative(term.effect.as_ref())).collect(),
        selection,
        rule,
        evaluated: BTreeMap::new(),
        visibility: BTreeMap::new(),
        latest: None,
    };
    let none = vec![false; full.fit.structure.terms.len()];
    if none.is_empty() {
        search.store(vec![full.fit.clone()]);
        return search.result();
    }
    search.screen(&full.fit.theta, &full.fit.initial, &none);
    let mut seen: Vec<Vec<TermName>> = Vec::new();
    for _ in 0..ROUNDS {
        let Some(top) = search.top().map(|top| top.fit.clone()).filter(|top| !seen.contains(&names(&top.structure)))
        else {
            break;
        };
        seen.push(names(&top.structure));
        // Alternatives to a term appear after its removal.
        for out in 0..top.structure.terms.len() {
            let less = top.refit_without(out, problem, &search.whitening, StoppingRule::COARSE);
            search.screen(&search.full_parameters(&less), &less.initial, &search.terms_of(&less));
            search.store(vec![less]);
        }
        search.screen(&search.full_parameters(&top), &top.initial, &search.terms_of(&top));
        search.swap_delays(&top);
    }
    search.converge();
    search.result()
}

impl StructureSearch<'_> {
    /// Weighs all subsets about a point of the full model and refits the best; `about` is `true` for the terms that the
    /// structure of this point has.
    fn screen(&mut self, theta: &[f64], initial: &[[f64; 2]], about: &[bool]) {
        let structure = &self.full.fit.structure;
        let normal = self.problem.normal_equations(structure, theta, initial, &self.whitening);
        let odds: Vec<f64> = structure.terms.iter().map(|term| self.odds(term, 1e6)).collect();
        let Some(quadratic) = QuadraticPosterior::new(&normal, structure, theta, &odds) else { return };
        if self.visibility.is_empty() {
            self.visibility = self.visibility(&quadratic);
        }
        let subsets = quadratic.best(about);
        self.fit_all(subsets.iter().map(|chosen| self.start(&quadratic, chosen, theta, initial)).collect());
        self.latest = Some(quadratic);
    }

    /// Refits a structure with each of its delays replaced by every other delay: they are nearly collinear, so only a
    /// fit separates them.
    fn swap_delays(&mut self, top: &StructureFit) {
        let terms = self.full.fit.structure.terms.iter().chain(self.variants.iter().copied());
        let delays: Vec<Arc<Term>> = terms.filter(|term| is_delay(term.effect.as_ref())).cloned().collect();
        let mut fresh = Vec::new();
        for (place, term) in top.structure.terms.iter().enumerate().filter(|(_, term)| is_delay(term.effect.as_ref())) {
            for other in delays.iter().filter(|other| other.name() != term.name()) {
                let (mut terms, mut theta) = (top.structure.terms.clone(), top.theta.clone());
                terms[place] = Arc::clone(other);
                let start = other.priors.iter().map(|prior| prior.mean.max(DELAY_START * prior.sd).min(prior.highest));
                theta.splice(top.structure.term_ranges()[place].clone(), start);
                fresh.push((top.structure.with_terms(terms), theta, top.initial.clone()));
            }
        }
        self.fit_all(fresh);
    }

    /// Fits the structures that are not evaluated yet, from their start points.
    fn fit_all(&mut self, fresh: Vec<(Structure, Vec<f64>, Vec<[f64; 2]>)>) {
        let fits: Vec<StructureFit> = fresh
            .into_par_iter()
            .filter(|(model, ..)| !self.evaluated.contains_key(&names(model)))
            .map(|(model, theta, initial)| {
                self.problem.fit(&model, theta, initial, &self.whitening, StoppingRule::COARSE)
            })
            .collect();
        self.store(fits);
    }

    /// Stores fits; of several fits of one structure, the fit with the maximum posterior density.
    fn store(&mut self, fits: Vec<StructureFit>) {
        let objective = |fit: &StructureFit| fit.misfit + fit.prior_penalty;
        for fit in fits {
            let name = names(&fit.structure);
            if self.evaluated.get(&name).is_none_or(|stored| objective(&fit) <= objective(&stored.fit)) {
                let log_posterior = self.log_posterior(&fit);
                self.evaluated.insert(name, WeighedStructure { fit, weight: 0.0, log_posterior });
            }
        }
    }

    /// Fits to convergence the best [`MAX_CONVERGED`] structures whose log posterior is within [`MAX_LOG_ODDS`] of the
    /// highest.
    fn converge(&mut self) {
        let highest = self.top().map_or(0.0, |top| top.log_posterior);
        let mut best: Vec<&WeighedStructure> =
            self.evaluated.values().filter(|stored| stored.log_posterior > highest - MAX_LOG_ODDS).collect();
        best.sort_by(|a, b| b.log_posterior.total_cmp(&a.log_posterior));
        let fits: Vec<StructureFit> = best
            .into_par_iter()
            .take(MAX_CONVERGED)
            .map(|WeighedStructure { fit, .. }| {
                let StructureFit { structure, theta, initial, .. } = fit.clone();
                self.problem.fit(&structure, theta, initial, &self.whitening, StoppingRule::FINE)
            })
            .collect();
        self.store(fits);
    }

    /// Flag of every term of the full model, `true` if a fit has it.
    fn terms_of(&self, fit: &StructureFit) -> Vec<bool> {
        let names = names(&fit.structure);
        self.full.fit.structure.terms.iter().map(|term| names.contains(&term.name())).collect()
    }

    /// Log prior odds of a term, or `required` for a term of a required effect.
    fn odds(&self, term: &Term, required: f64) -> f64 {
        if self.selection.requires(term.effect.id()) { required } else { term.log_odds }
    }

    /// Visibility of every term: expected squared coefficient over its posterior variance with all other terms present.
    fn visibility(&self, quadratic: &QuadraticPosterior) -> BTreeMap<TermName, f64> {
        let visibility = |(term, removable): (&Arc<Term>, &RemovableTerm)| {
            let expected: Vec<f64> = term
                .priors
                .iter()
                .filter(|prior| prior.is_fitted() && !prior.is_shape)
                .zip(term.neutral())
                .map(|(prior, neutral)| prior.sd.powi(2) + (prior.mean - neutral).powi(2))
                .collect();
            let variance = |k: usize| if quadratic.free[k] { quadratic.covariance[(k, k)] } else { f64::INFINITY };
            let ratios = removable.amplitudes.iter().zip(expected).map(|((k, _), square)| square / variance(*k));
            (term.name(), ratios.fold(0.0, f64::max))
        };
        self.full.fit.structure.terms.iter().zip(&quadratic.removable).map(visibility).collect()
    }

    /// Structure of a subset with its start point by the quadratic approximation.
    fn start(
        &self,
        quadratic: &QuadraticPosterior,
        chosen: &[bool],
        theta: &[f64],
        initial: &[[f64; 2]],
    ) -> (Structure, Vec<f64>, Vec<[f64; 2]>) {
        let structure = &self.full.fit.structure;
        let out: Vec<&RemovableTerm> =
            quadratic.removable.iter().zip(chosen).filter_map(|(term, kept)| (!kept).then_some(term)).collect();
        let moved = conditional_mean(&quadratic.covariance, &quadratic.mean, &out);
        let mut moved = moved.iter();
        let mut next = || *moved.next().expect("an unknown for every fitted entry and state");
        let value = |(entry, fixed): (ModelParameter, &f64)| match entry.prior.is_fitted() {
            true => next().clamp(entry.prior.lowest, entry.prior.highest),
            false => *fixed,
        };
        let all: Vec<f64> = structure.entries().into_iter().zip(theta).map(value).collect();
        let initial = initial.iter().map(|_| [next(), next()]).collect();
        let mut theta = all[..structure.base_parameter_count()].to_vec();
        let mut terms = Vec::new();
        for ((term, range), _) in
            structure.terms.iter().zip(structure.term_ranges()).zip(chosen).filter(|(_, kept)| **kept)
        {
            terms.push(Arc::clone(term));
            theta.extend_from_slice(&all[range]);
        }
        (structure.with_terms(terms), theta, initial)
    }

    /// Log evidence plus log prior odds of a fit; [`WeightingRule::Bic`] takes −BIC/2 for the evidence.
    fn log_posterior(&self, fit: &StructureFit) -> f64 {
        let odds: f64 = fit.structure.terms.iter().map(|term| self.odds(term, 0.0)).sum();
        odds + match self.rule {
            WeightingRule::Posterior => fit.log_evidence,
            WeightingRule::Bic => {
                let free = fit.structure.entries().iter().filter(|entry| entry.prior.is_fitted()).count() as f64;
                -0.5 * (fit.misfit + free * (self.problem.heading_count() as f64).ln())
            }
        }
    }

    /// Evaluated structure with the highest log posterior.
    fn top(&self) -> Option<&WeighedStructure> {
        self.evaluated
            .values()
            .filter(|stored| stored.log_posterior.is_finite())
            .max_by(|a, b| a.log_posterior.total_cmp(&b.log_posterior))
    }

    /// Parameters of the full model: the parameters of a fit, all other terms neutral.
    fn full_parameters(&self, fit: &StructureFit) -> Vec<f64> {
        let structure = &self.full.fit.structure;
        let mut theta = fit.theta[..structure.base_parameter_count()].to_vec();
        let fitted: BTreeMap<TermName, &[f64]> = fit
            .structure
            .terms
            .iter()
            .zip(fit.structure.term_ranges())
            .map(|(term, range)| (term.name(), &fit.theta[range]))
            .collect();
        for (term, range) in structure.terms.iter().zip(structure.term_ranges()) {
            match fitted.get(&term.name()) {
                Some(values) => theta.extend_from_slice(values),
                None => {
                    let shaped = term.neutral().into_iter().zip(&term.priors).zip(&self.full.fit.theta[range]);
                    theta.extend(shaped.map(|((neutral, prior), full)| if prior.is_shape { *full } else { neutral }));
                }
            }
        }
        theta
    }

    /// Structures with their weights, and the probabilities, visibilities and evidence of the terms.
    fn result(self) -> Structures {
        let terms = &self.full.fit.structure.terms;
        let effects: Vec<_> = terms.iter().map(|term| (term.effect.id(), term.record_index)).collect();
        let evidence = self.latest.map_or_else(Vec::new, |latest| latest.evidence(&effects));
        let evidence = terms.iter().map(|term| term.name()).zip(evidence).collect();
        let visibility = self.visibility;
        let mut all: Vec<WeighedStructure> =
            self.evaluated.into_values().filter(|stored| stored.log_posterior.is_finite()).collect();
        all.sort_by(|a, b| {
            b.log_posterior
                .total_cmp(&a.log_posterior)
                .then_with(|| names(&a.fit.structure).cmp(&names(&b.fit.structure)))
        });
        let highest = all.first().map_or(0.0, |best| best.log_posterior);
        let total: f64 = all.iter().map(|weighed| (weighed.log_posterior - highest).exp()).sum();
        let mut probabilities: BTreeMap<TermName, f64> = visibility.keys().map(|name| (*name, 0.0)).collect();
        for weighed in &mut all {
            weighed.weight = (weighed.log_posterior - highest).exp() / total;
            for term in &weighed.fit.structure.terms {
                *probabilities.entry(term.name()).or_default() += weighed.weight;
            }
        }
        Structures { weighed: all, probabilities, visibility, evidence, other_law_structures: Vec::new() }
    }
}
