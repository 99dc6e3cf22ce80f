//! Structures and their probabilities: all subsets of the candidates weighed at once round the full model, the best of
//! them refitted and weighed again.

use std::collections::HashMap;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::candidates::{Candidate, PROBABILITY, is_delay, is_variant};
use crate::evidence::{MOST, Removable, conditional, subsets};
use crate::fit::{Effort, Fit, Problem, System, Weights, deviation, log_normaliser};
use crate::full::Full;
use crate::model::{Structure, Term, TermName};
use crate::selection::Selection;
use crate::settings::Rule;

/// Structures that are refitted a round, and the log of the odds against the best beyond which none is.
const REFITS: usize = 4;
const HOPELESS: f64 = 5.0;

/// Structures with one term more that are refitted a round.
const ADDITIONS: usize = 2;

/// Structures whose fit is driven to the end.
const POLISHED: usize = 8;

/// Start of a delay that takes the place of another, in standard deviations of its prior.
const SMALL_DELAY: f64 = 0.3;

/// Rounds of weighing, round the best structure of the last.
const ROUNDS: usize = 2;

/// Odds against the best within which structures are members of the average.
const MEMBERS: f64 = 20.0;

/// A refitted structure with its weight among all.
#[derive(Debug, Clone)]
pub struct Member {
    /// The fit.
    pub fit: Fit,
    /// Probability.
    pub weight: f64,
    /// Log of evidence and prior odds.
    pub height: f64,
}

/// Structures with their probabilities, the most probable first.
#[derive(Debug, Clone)]
pub struct Structures {
    /// All that were refitted.
    pub all: Vec<Member>,
    /// Probability of every candidate, by its name.
    pub probabilities: HashMap<TermName, f64>,
    /// Expected |size/error|² of every candidate beside all others: what cannot be seen is not observable.
    pub visibility: HashMap<TermName, f64>,
    /// What speaks for every candidate.
    pub support: HashMap<TermName, Support>,
    /// Structures under other laws of the noise: their names and weights.
    others: Vec<(f64, Vec<TermName>)>,
}

/// What speaks for a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Log evidence of the best structure with it less that of the best without it.
    pub gain: f64,
    /// Probability of sizes as far from neutral by chance, beside all other candidates.
    pub p_value: f64,
}

/// A quadratic approximation of the posterior of the full model, and what may be taken from it.
struct Quadratic {
    covariance: DMatrix<f64>,
    mean: DVector<f64>,
    removable: Vec<Removable>,
    /// Whether a term has its sizes at the end of their range and would leave it: it is out.
    pinned: Vec<bool>,
    /// Whether an unknown is free, and not that of a size that is out.
    free: Vec<bool>,
}

impl Quadratic {
    /// Round a point of the full structure.
    fn new(system: &System, structure: &Structure, theta: &[f64], log_odds: &[f64]) -> Option<Self> {
        let entries = structure.entries();
        let unknown: Vec<Option<usize>> = {
            let mut next = 0..;
            entries.iter().map(|entry| entry.prior.is_fitted().then(|| next.next()).flatten()).collect()
        };
        let count = system.gradient.len();
        let mut at = DVector::zeros(count);
        unknown.iter().zip(theta).for_each(|(place, value)| {
            if let Some(place) = place {
                at[*place] = *value;
            }
        });
        let factor = system.precision.clone().cholesky()?;
        let mut covariance = factor.inverse();
        let mut mean = &at + factor.solve(&system.gradient);
        let ranges = structure.ranges();
        let mut pinned = vec![false; ranges.len()];
        let removable = |mean: &DVector<f64>, number: usize| {
            let (term, range) = (&structure.terms[number], ranges[number].clone());
            let neutral = term.neutral();
            let mut own =
                Removable { sizes: Vec::new(), shapes: Vec::new(), log_prior: 0.0, log_odds: log_odds[number] };
            for (k, place) in range.enumerate() {
                let prior = term.priors[k];
                let Some(unknown) = unknown[place] else { continue };
                own.log_prior += log_normaliser(prior);
                if prior.is_shape {
                    own.log_prior -= 0.5 * deviation(prior, theta[place]).powi(2);
                    own.shapes.push(unknown);
                } else {
                    own.log_prior -= 0.5 * deviation(prior, neutral[k]).powi(2);
                    own.sizes.push((unknown, mean[unknown] - neutral[k]));
                }
            }
            own
        };
        // A size that would leave its range at its neutral end is no size.
        for _ in 0..ranges.len() {
            let leaves = |number: &usize| {
                let term = &structure.terms[*number];
                let own = ranges[*number].clone().zip(&term.priors).zip(term.neutral());
                !pinned[*number]
                    && own.into_iter().any(|((place, prior), neutral)| {
                        let value = unknown[place].map_or(neutral, |unknown| mean[unknown]);
                        !prior.is_shape && (prior.lowest == neutral && value < neutral)
                    })
            };
            let Some(worst) = (0..ranges.len()).filter(leaves).min_by(|&one, &other| {
                let depth = |number: usize| {
                    removable(&mean, number)
                        .sizes
                        .iter()
                        .map(|&(k, distance)| distance / covariance[(k, k)].sqrt())
                        .fold(0.0, f64::min)
                };
                depth(one).total_cmp(&depth(other))
            }) else {
                break;
            };
            let out = removable(&mean, worst);
            pinned[worst] = true;
            mean = conditional(&covariance, &mean, &[&out]);
            condition(&mut covariance, &out);
        }
        let removable: Vec<Removable> = (0..ranges.len()).map(|number| removable(&mean, number)).collect();
        let mut free = vec![true; count];
        for (own, _) in removable.iter().zip(&pinned).filter(|(_, pinned)| **pinned) {
            let own: &Removable = own;
            own.sizes.iter().for_each(|(unknown, _)| free[*unknown] = false);
        }
        Some(Self { covariance, mean, removable, pinned, free })
    }

    /// What speaks for every term, from the log weights of all subsets: the gain is that of its effect in any form;
    /// `effects` says which terms are forms of one.
    fn support(&self, kept: &[usize], weights: &[f64], effects: &[(&str, Option<usize>)]) -> Vec<Support> {
        let of = |number: usize| {
            let own = &self.removable[number];
            let places: Vec<usize> = own.sizes.iter().map(|(unknown, _)| *unknown).collect();
            let distance = DVector::from_iterator(places.len(), own.sizes.iter().map(|(_, distance)| *distance));
            let matrix = DMatrix::from_fn(places.len(), places.len(), |i, j| self.covariance[(places[i], places[j])]);
            let square = matrix.cholesky().map_or(0.0, |factor| distance.dot(&factor.solve(&distance)));
            let law = ChiSquared::new(places.len().max(1) as f64).expect("degrees of freedom");
            if !kept.contains(&number) {
                return Support { gain: 0.0, p_value: 1.0 };
            }
            let alike: usize = kept
                .iter()
                .enumerate()
                .filter(|(_, other)| effects[**other] == effects[number])
                .map(|(bit, _)| 1 << bit)
                .sum();
            let highest = |with: bool| {
                let all = weights.iter().enumerate().filter(|(subset, _)| (subset & alike != 0) == with);
                all.map(|(_, weight)| *weight).fold(f64::NEG_INFINITY, f64::max)
            };
            Support { gain: highest(true) - highest(false) - own.log_odds, p_value: law.sf(square) }
        };
        (0..self.removable.len()).map(of).collect()
    }

    /// The best subsets of terms and what speaks for every term: at most sixteen terms take part. Beside the best of all
    /// subsets the best are looked at that have one term more than `about`: a step so far from here is badly foretold,
    /// and only a fit tells.
    fn best(&self, about: &[bool], effects: &[(&str, Option<usize>)]) -> (Vec<Vec<bool>>, Vec<Support>) {
        let free: Vec<usize> = (0..self.removable.len()).filter(|&k| !self.pinned[k]).collect();
        let (kept, covariance, removable) = self.fewer(free);
        let weights = subsets(&covariance, &removable);
        let chosen = |subset: usize| {
            let mut chosen = vec![false; self.removable.len()];
            kept.iter().enumerate().for_each(|(bit, &k)| chosen[k] = subset >> bit & 1 == 1);
            chosen
        };
        let by_weight = |one: &usize, other: &usize| weights[*other].total_cmp(&weights[*one]);
        let mut order: Vec<usize> = (0..weights.len()).collect();
        if order.len() > REFITS {
            order.select_nth_unstable_by(REFITS - 1, by_weight);
            order.truncate(REFITS);
        }
        order.sort_by(by_weight);
        let least = weights[order[0]] - HOPELESS;
        order.retain(|subset| weights[*subset] > least);
        let own: usize = kept.iter().enumerate().filter(|(_, k)| about[**k]).map(|(bit, _)| 1 << bit).sum();
        let mut more: Vec<usize> = (0..kept.len())
            .map(|bit| own | 1 << bit)
            .filter(|subset| *subset != own && !order.contains(subset))
            .collect();
        more.sort_by(by_weight);
        order.extend(more.into_iter().take(ADDITIONS));
        (order.into_iter().map(chosen).collect(), self.support(&kept, &weights, effects))
    }

    /// The terms that matter most, with what is left of the posterior when the others are taken away.
    fn fewer(&self, mut kept: Vec<usize>) -> (Vec<usize>, DMatrix<f64>, Vec<Removable>) {
        let mut covariance = self.covariance.clone();
        let mut mean = self.mean.clone();
        let mut removable = self.removable.clone();
        while kept.len() > MOST {
            let loss =
                |&k: &usize| subsets(&covariance, std::slice::from_ref(&removable[k]))[0] - removable[k].log_odds;
            let place = (0..kept.len()).max_by(|&i, &j| loss(&kept[i]).total_cmp(&loss(&kept[j]))).expect("many");
            let out = removable[kept.remove(place)].clone();
            let moved = conditional(&covariance, &mean, &[&out]);
            condition(&mut covariance, &out);
            for &k in &kept {
                removable[k]
                    .sizes
                    .iter_mut()
                    .for_each(|(unknown, distance)| *distance += moved[*unknown] - mean[*unknown]);
            }
            mean = moved;
        }
        let own = kept.iter().map(|&k| removable[k].clone()).collect();
        (kept, covariance, own)
    }
}

/// Takes what the sizes of a candidate leave open from a covariance.
fn condition(covariance: &mut DMatrix<f64>, out: &Removable) {
    for &(unknown, _) in &out.sizes {
        let column: DVector<f64> = covariance.column(unknown).into();
        let variance = column[unknown];
        if variance > 0.0 {
            *covariance -= &column * column.transpose() / variance;
            covariance[(unknown, unknown)] = 1e-12 * variance;
        }
    }
}

/// The stage with what it needs.
struct Stage<'a> {
    problem: &'a Problem,
    weights: Weights,
    full: &'a Full,
    variants: Vec<&'a Candidate>,
    selection: &'a Selection,
    rule: Rule,
    known: HashMap<Vec<TermName>, Member>,
    visibility: HashMap<TermName, f64>,
    support: HashMap<TermName, Support>,
}

/// Weighs the structures under every law, and keeps the law that explains the records best: by the evidence of its
/// structures; but where physics under an error of the heading explains what the base leaves, no random moment does.
pub fn choose(
    problem: &Problem,
    fulls: Vec<Full>,
    candidates: &[Candidate],
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
            let own = full.law.log_normaliser(problem) - price * full.law.colour.freedom() as f64;
            (height + own, full, structures)
        })
        .collect();
    let astray = weighed.iter().any(|(_, full, structures)| {
        full.law.is_random_moment() && structures.mean_square_of_ship() > ASTRAY * ASTRAY * base
    });
    let is_physical = |(_, full, structures): &(f64, Full, Structures)| {
        let left = structures.mean_square_of_ship() / base;
        !full.law.is_random_moment() && left < if astray { 1.0 } else { PHYSICS * PHYSICS }
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

/// Error of the base times this beyond which a random moment has taken the place of physics.
const ASTRAY: f64 = 2.0;

/// Weighs the structures of a full model.
fn weigh(problem: &Problem, full: &Full, candidates: &[Candidate], selection: &Selection, rule: Rule) -> Structures {
    let mut stage = Stage {
        problem,
        weights: problem.weights(&full.law),
        full,
        variants: candidates.iter().filter(|one| is_variant(one.term.effect.as_ref())).collect(),
        selection,
        rule,
        known: HashMap::new(),
        visibility: HashMap::new(),
        support: HashMap::new(),
    };
    let none = vec![false; full.fit.structure.terms.len()];
    stage.look((full.fit.theta.clone(), full.fit.initial.clone()), &none);
    let mut seen: Vec<Vec<TermName>> = Vec::new();
    for _ in 0..ROUNDS {
        let Some(top) = stage.top().map(|top| top.fit.clone()).filter(|top| !seen.contains(&names(&top.structure)))
        else {
            break;
        };
        seen.push(names(&top.structure));
        // What may stand in the place of a term shows when it is taken away.
        for out in 0..top.structure.terms.len() {
            let less = stage.without(&top, out);
            stage.look(stage.unfold(&less), &stage.terms_of(&less));
        }
        stage.look(stage.unfold(&top), &stage.terms_of(&top));
        stage.swap(&top);
    }
    stage.polish();
    stage.result()
}

impl Stage<'_> {
    /// Weighs all subsets round a point of the full model, and refits the best.
    fn look(&mut self, at: (Vec<f64>, Vec<[f64; 2]>), about: &[bool]) {
        let structure = &self.full.fit.structure;
        let system = System::at(self.problem, structure, &at.0, &at.1, &self.weights);
        let Some(quadratic) = Quadratic::new(&system, structure, &at.0, &self.log_odds()) else { return };
        if self.visibility.is_empty() {
            self.visibility = self.visibility(&quadratic);
        }
        let effects: Vec<_> = structure.terms.iter().map(|term| (term.effect.id(), term.only)).collect();
        let (hopeful, support) = quadratic.best(about, &effects);
        self.support = structure.terms.iter().map(|term| term.name()).zip(support).collect();
        self.refit(&quadratic, &hopeful, &at);
    }

    /// Refits a structure with every other effect that delays the rudder in the place of one: they are nearly alike, and
    /// only a fit tells them apart.
    fn swap(&mut self, top: &Fit) {
        let known = self.full.fit.structure.terms.iter().chain(self.variants.iter().map(|one| &one.term));
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
        let fits: Vec<Fit> = fresh
            .into_par_iter()
            .filter(|(own, ..)| !self.known.contains_key(&names(own)))
            .map(|(own, theta, initial)| self.problem.fit(&own, theta, initial, &self.weights, Effort::COARSE))
            .collect();
        for fit in fits {
            let height = self.height(&fit);
            self.known.insert(names(&fit.structure), Member { fit, weight: 0.0, height });
        }
    }

    /// Drives the fits of the best structures to the end.
    fn polish(&mut self) {
        let highest = self.top().map_or(0.0, |top| top.height);
        let mut best: Vec<&Member> = self.known.values().filter(|one| one.height > highest - HOPELESS).collect();
        best.sort_by(|one, other| other.height.total_cmp(&one.height));
        let fits: Vec<Fit> = best
            .into_par_iter()
            .take(POLISHED)
            .map(|Member { fit, .. }| {
                let Fit { structure, theta, initial, .. } = fit.clone();
                self.problem.fit(&structure, theta, initial, &self.weights, Effort::FINE)
            })
            .collect();
        for fit in fits {
            let height = self.height(&fit);
            self.known.insert(names(&fit.structure), Member { fit, weight: 0.0, height });
        }
    }

    /// Which terms of the full model a fit has.
    fn terms_of(&self, fit: &Fit) -> Vec<bool> {
        let own = names(&fit.structure);
        self.full.fit.structure.terms.iter().map(|term| own.contains(&term.name())).collect()
    }

    /// A fit without one of its terms.
    fn without(&self, top: &Fit, out: usize) -> Fit {
        let (mut terms, mut theta) = (top.structure.terms.clone(), top.theta.clone());
        theta.drain(top.structure.ranges()[out].clone());
        terms.remove(out);
        self.problem.fit(&top.structure.of(terms), theta, top.initial.clone(), &self.weights, Effort::COARSE)
    }

    fn log_odds(&self) -> Vec<f64> {
        let required = |term: &Arc<Term>| self.selection.keeps(term);
        let terms = self.full.fit.structure.terms.iter().zip(&self.full.log_odds);
        terms.map(|(term, odds)| if required(term) { 1e6 } else { *odds }).collect()
    }

    /// Expected squared size of every term over its posterior variance beside all others.
    fn visibility(&self, quadratic: &Quadratic) -> HashMap<TermName, f64> {
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

    /// Refits subsets of the full model that are not known yet.
    fn refit(&mut self, quadratic: &Quadratic, chosen: &[Vec<bool>], at: &(Vec<f64>, Vec<[f64; 2]>)) {
        let fresh = chosen.iter().map(|chosen| self.start(quadratic, chosen, at)).collect();
        self.fit_all(fresh);
    }

    /// A subset with the start that the quadratic approximation gives it.
    fn start(
        &self,
        quadratic: &Quadratic,
        chosen: &[bool],
        at: &(Vec<f64>, Vec<[f64; 2]>),
    ) -> (Structure, Vec<f64>, Vec<[f64; 2]>) {
        let structure = &self.full.fit.structure;
        let out: Vec<&Removable> =
            quadratic.removable.iter().zip(chosen).filter(|(_, kept)| !**kept).map(|(own, _)| own).collect();
        let moved = conditional(&quadratic.covariance, &quadratic.mean, &out);
        let entries = structure.entries();
        let mut next = 0..;
        let mut value = |k: usize| match entries[k].prior.is_fitted() {
            true => moved[next.next().expect("an unknown for every fitted entry")]
                .clamp(entries[k].prior.lowest, entries[k].prior.highest),
            false => at.0[k],
        };
        let all: Vec<f64> = (0..entries.len()).map(&mut value).collect();
        let first = moved.len() - 2 * at.1.len();
        let initial =
            (0..at.1.len()).map(|record| [moved[first + 2 * record], moved[first + 2 * record + 1]]).collect();
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
    fn height(&self, fit: &Fit) -> f64 {
        let odds: f64 = fit.structure.terms.iter().map(|term| self.odds_of(term)).sum();
        odds + match self.rule {
            Rule::Posterior => fit.evidence,
            Rule::Bic => {
                let free = fit.structure.entries().iter().filter(|entry| entry.prior.is_fitted()).count() as f64;
                -0.5 * (fit.misfit + free * (self.problem.observations() as f64).ln())
            }
        }
    }

    fn odds_of(&self, term: &Arc<Term>) -> f64 {
        if self.selection.keeps(term) {
            return 0.0;
        }
        let name = term.name();
        let known = self.full.fit.structure.terms.iter().zip(&self.full.log_odds);
        let variants = self.variants.iter().map(|one| (&one.term, &one.log_odds));
        known.chain(variants).find(|(other, _)| other.name() == name).map_or(0.0, |(_, odds)| *odds)
    }

    fn top(&self) -> Option<&Member> {
        self.known
            .values()
            .filter(|one| one.height.is_finite())
            .max_by(|one, other| one.height.total_cmp(&other.height))
    }

    /// A point of the full model: that of a fit, with everything else neutral.
    fn unfold(&self, fit: &Fit) -> (Vec<f64>, Vec<[f64; 2]>) {
        let structure = &self.full.fit.structure;
        let mut theta = fit.theta[..structure.base_count()].to_vec();
        let own: HashMap<TermName, &[f64]> = fit
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
        (theta, fit.initial.clone())
    }

    fn result(self) -> Structures {
        let Self { visibility, support, .. } = self;
        let mut all: Vec<Member> = self.known.into_values().filter(|one| one.height.is_finite()).collect();
        all.sort_by(|one, other| {
            other
                .height
                .total_cmp(&one.height)
                .then_with(|| names(&one.fit.structure).cmp(&names(&other.fit.structure)))
        });
        let highest = all.first().map_or(0.0, |one| one.height);
        let total: f64 = all.iter().map(|one| (one.height - highest).exp()).sum();
        let mut probabilities: HashMap<TermName, f64> = visibility.keys().map(|name| (*name, 0.0)).collect();
        for one in &mut all {
            one.weight = (one.height - highest).exp() / total;
            for term in &one.fit.structure.terms {
                *probabilities.entry(term.name()).or_default() += one.weight;
            }
        }
        Structures { all, probabilities, visibility, support, others: Vec::new() }
    }
}

fn names(structure: &Structure) -> Vec<TermName> {
    structure.terms.iter().map(|term| term.name()).collect()
}

impl Structures {
    /// The members of the average with their weights, which sum to one.
    pub fn members(&self) -> Vec<(f64, &Fit)> {
        let least = self.all.first().map_or(0.0, |one| one.weight) / MEMBERS;
        let kept: Vec<&Member> = self.all.iter().filter(|one| one.weight >= least).collect();
        let total: f64 = kept.iter().map(|one| one.weight).sum();
        kept.iter().map(|one| (one.weight / total, &one.fit)).collect()
    }

    /// Shares the weight with structures under other laws, each with the odds of its law against that of these.
    fn share_with(&mut self, others: Vec<(f64, Structures)>) {
        let total = 1.0 + others.iter().map(|(odds, _)| odds).sum::<f64>();
        self.all.iter_mut().for_each(|one| one.weight /= total);
        for (odds, other) in others {
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
        let has = |names: &[TermName]| names.iter().any(|name| name.0 == id && name.2 == only);
        self.weighed_names().filter(|(_, names)| has(names)).map(|(weight, _)| weight).sum::<f64>().clamp(0.0, 1.0)
    }
}

impl Structures {
    /// Mean square of what the most probable structure leaves that has nothing but the ship in it, rad².
    fn mean_square_of_ship(&self) -> f64 {
        let is_ship = |one: &&Member| one.fit.structure.terms.iter().all(|term| !term.effect.is_of_time());
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

    /// Probability of an effect in any form and any record.
    pub fn anywhere(&self, id: &str) -> f64 {
        let has = |names: &[TermName]| names.iter().any(|name| name.0 == id);
        self.weighed_names().filter(|(_, names)| has(names)).map(|(weight, _)| weight).sum::<f64>().clamp(0.0, 1.0)
    }

    /// Weights of all structures with the names of their terms.
    pub fn weighed_names(&self) -> impl Iterator<Item = (f64, Vec<TermName>)> + '_ {
        let own = self.all.iter().map(|one| (one.weight, names(&one.fit.structure)));
        own.chain(self.others.iter().cloned())
    }
}
