//! Quadratic (Laplace) approximation of the posterior of the full model, and the log weights of all subsets of its
//! terms.

use estimation::levenberg_marquardt::NormalEquations;
use estimation::subsets::{
    MAX_SUBSET_TERMS, RemovableTerm, condition_on_neutral, conditional_mean, subset_log_weights,
};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::fit::{log_prior_normaliser, prior_deviation};
use crate::model::{Structure, Term};

/// Maximum number of best structures that are refitted after a screening.
const MAX_REFITS: usize = 4;

/// Maximum log odds of the best structure against a structure that is refitted.
pub(super) const MAX_LOG_ODDS: f64 = 5.0;

/// Maximum number of further structures, with one more term, that are refitted after a screening.
const MAX_ADDITIONS: usize = 2;

/// Evidence for a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TermEvidence {
    /// Log evidence ratio of the best structure with the candidate to the best structure without it.
    pub log_ratio: f64,
    /// p value (χ²) of the coefficients with all other candidates present.
    pub p_value: f64,
}

/// Quadratic approximation of the posterior of the full model, with its removable terms.
pub(super) struct QuadraticPosterior {
    /// Posterior covariance of the unknowns, given that pinned terms are absent.
    pub covariance: DMatrix<f64>,
    pub mean: DVector<f64>,
    pub removable: Vec<RemovableTerm>,
    /// `true` for a term with a coefficient whose estimate is below its lower bound, the neutral value; it is removed.
    pinned: Vec<bool>,
    /// `false` for an amplitude of a removed term.
    pub free: Vec<bool>,
}

impl QuadraticPosterior {
    /// Approximation about a point of the full structure; `None` if the precision is singular.
    pub fn new(normal: &NormalEquations, structure: &Structure, theta: &[f64], log_odds: &[f64]) -> Option<Self> {
        let unknowns = structure.unknown_indices();
        let count = normal.right_hand_side.len();
        let mut at = DVector::zeros(count);
        unknowns.iter().zip(theta).for_each(|(place, value)| {
            if let Some(place) = place {
                at[*place] = *value;
            }
        });
        let factor = normal.matrix.clone().cholesky()?;
        let mut covariance = factor.inverse();
        let mut mean = &at + factor.solve(&normal.right_hand_side);
        let ranges = structure.term_ranges();
        let mut pinned = vec![false; ranges.len()];
        let removable = |mean: &DVector<f64>, number: usize| {
            let places = ranges[number].clone().map(|place| (place, unknowns[place]));
            RemovableTerm {
                log_prior_odds: log_odds[number],
                ..removable(&structure.terms[number], theta, mean, places)
            }
        };
        // A term with a coefficient below its lower bound, the neutral value, is removed, the worst first.
        for _ in 0..ranges.len() {
            let leaves = |number: &usize| {
                let term = &structure.terms[*number];
                let coefficients = ranges[*number].clone().zip(&term.priors).zip(term.neutral());
                !pinned[*number]
                    && coefficients.into_iter().any(|((place, prior), neutral)| {
                        let value = unknowns[place].map_or(neutral, |unknown| mean[unknown]);
                        !prior.is_shape && (prior.lowest == neutral && value < neutral)
                    })
            };
            let Some(worst) = (0..ranges.len()).filter(leaves).min_by(|&a, &b| {
                let depth = |number: usize| {
                    removable(&mean, number)
                        .amplitudes
                        .iter()
                        .map(|&(k, distance)| distance / covariance[(k, k)].sqrt())
                        .fold(0.0, f64::min)
                };
                depth(a).total_cmp(&depth(b))
            }) else {
                break;
            };
            let out = removable(&mean, worst);
            pinned[worst] = true;
            mean = conditional_mean(&covariance, &mean, &[&out]);
            condition_on_neutral(&mut covariance, &out);
        }
        let removable: Vec<RemovableTerm> = (0..ranges.len()).map(|number| removable(&mean, number)).collect();
        let mut free = vec![true; count];
        for (term, _) in removable.iter().zip(&pinned).filter(|(_, pinned)| **pinned) {
            let term: &RemovableTerm = term;
            term.amplitudes.iter().for_each(|(unknown, _)| free[*unknown] = false);
        }
        Some(Self { covariance, mean, removable, pinned, free })
    }

    /// Evidence for every term from the log weights of all subsets. The log ratio is for the effect in any form;
    /// `effects` identifies the terms that are forms of one effect.
    pub fn evidence(&self, effects: &[(&str, Option<usize>)]) -> Vec<TermEvidence> {
        let (kept, weights) = self.weighed();
        let evidence = |number: usize| {
            if !kept.contains(&number) {
                return TermEvidence { log_ratio: 0.0, p_value: 1.0 };
            }
            let term = &self.removable[number];
            let p_value = chi_square_p_value(&term.amplitudes, &self.covariance).unwrap_or(1.0);
            let forms: usize = kept
                .iter()
                .enumerate()
                .filter(|(_, other)| effects[**other] == effects[number])
                .map(|(bit, _)| 1 << bit)
                .sum();
            let highest = |with: bool| {
                let all = weights.iter().enumerate().filter(|(subset, _)| (subset & forms != 0) == with);
                all.map(|(_, weight)| *weight).fold(f64::NEG_INFINITY, f64::max)
            };
            TermEvidence { log_ratio: highest(true) - highest(false) - term.log_prior_odds, p_value }
        };
        (0..self.removable.len()).map(evidence).collect()
    }

    /// Weighed terms, at most [`MAX_SUBSET_TERMS`], and the log weights of all their subsets.
    fn weighed(&self) -> (Vec<usize>, Vec<f64>) {
        let free: Vec<usize> = (0..self.removable.len()).filter(|&k| !self.pinned[k]).collect();
        let (kept, covariance, removable) = self.most_relevant(free);
        (kept, subset_log_weights(&covariance, &removable))
    }

    /// Best subsets of terms: the best overall, and the best with one term more than `about`, for which the quadratic
    /// approximation is most accurate.
    pub fn best(&self, about: &[bool]) -> Vec<Vec<bool>> {
        let (kept, weights) = self.weighed();
        let chosen = |subset: usize| {
            let mut chosen = vec![false; self.removable.len()];
            kept.iter().enumerate().for_each(|(bit, &k)| chosen[k] = subset >> bit & 1 == 1);
            chosen
        };
        let by_weight = |a: &usize, b: &usize| weights[*b].total_cmp(&weights[*a]);
        let mut order: Vec<usize> = (0..weights.len()).collect();
        if order.len() > MAX_REFITS {
            order.select_nth_unstable_by(MAX_REFITS - 1, by_weight);
            order.truncate(MAX_REFITS);
        }
        order.sort_by(by_weight);
        let least = weights[order[0]] - MAX_LOG_ODDS;
        order.retain(|subset| weights[*subset] > least);
        let current: usize = kept.iter().enumerate().filter(|(_, k)| about[**k]).map(|(bit, _)| 1 << bit).sum();
        let mut more: Vec<usize> = (0..kept.len())
            .map(|bit| current | 1 << bit)
            .filter(|subset| *subset != current && !order.contains(subset))
            .collect();
        more.sort_by(by_weight);
        order.extend(more.into_iter().take(MAX_ADDITIONS));
        order.into_iter().map(chosen).collect()
    }

    /// Subset of the [`MAX_SUBSET_TERMS`] most relevant terms, with the covariance after removal of the other terms.
    fn most_relevant(&self, mut kept: Vec<usize>) -> (Vec<usize>, DMatrix<f64>, Vec<RemovableTerm>) {
        let mut covariance = self.covariance.clone();
        let mut mean = self.mean.clone();
        let mut removable = self.removable.clone();
        while kept.len() > MAX_SUBSET_TERMS {
            let loss = |&k: &usize| {
                subset_log_weights(&covariance, std::slice::from_ref(&removable[k]))[0] - removable[k].log_prior_odds
            };
            let place = (0..kept.len()).max_by(|&i, &j| loss(&kept[i]).total_cmp(&loss(&kept[j]))).expect("many");
            let out = removable[kept.remove(place)].clone();
            let moved = conditional_mean(&covariance, &mean, &[&out]);
            condition_on_neutral(&mut covariance, &out);
            for &k in &kept {
                removable[k]
                    .amplitudes
                    .iter_mut()
                    .for_each(|(unknown, distance)| *distance += moved[*unknown] - mean[*unknown]);
            }
            mean = moved;
        }
        let terms = kept.iter().map(|&k| removable[k].clone()).collect();
        (kept, covariance, terms)
    }
}

/// p value (χ², Wald 1943) of coefficients, each given as its index in a covariance and its distance from neutral;
/// `None` without coefficients, or if the covariance is singular.
pub fn chi_square_p_value(sizes: &[(usize, f64)], covariance: &DMatrix<f64>) -> Option<f64> {
    let distance = DVector::from_iterator(sizes.len(), sizes.iter().map(|(_, distance)| *distance));
    let matrix = DMatrix::from_fn(sizes.len(), sizes.len(), |i, j| covariance[(sizes[i].0, sizes[j].0)]);
    let square = distance.dot(&matrix.cholesky()?.solve(&distance));
    Some(ChiSquared::new(sizes.len() as f64).ok()?.sf(square))
}

/// Term that can be removed from the full model, at a point θ; `places` are the indices of its parameters in θ, each
/// with its index among the unknowns if it is fitted.
fn removable(
    term: &Term,
    theta: &[f64],
    mean: &DVector<f64>,
    places: impl Iterator<Item = (usize, Option<usize>)>,
) -> RemovableTerm {
    let mut removable = RemovableTerm {
        amplitudes: Vec::new(),
        shape_parameters: Vec::new(),
        log_prior_density: 0.0,
        log_prior_odds: 0.0,
    };
    for (((place, unknown), prior), neutral) in places.zip(&term.priors).zip(term.neutral()) {
        let Some(unknown) = unknown else { continue };
        let at = if prior.is_shape { theta[place] } else { neutral };
        removable.log_prior_density += log_prior_normaliser(*prior);
        removable.log_prior_density -= 0.5 * prior_deviation(*prior, at).powi(2);
        match prior.is_shape {
            true => removable.shape_parameters.push(unknown),
            false => removable.amplitudes.push((unknown, mean[unknown] - neutral)),
        }
    }
    removable
}
