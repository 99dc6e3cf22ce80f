//! A quadratic approximation of the posterior of the full model, from which any terms may be taken.

use estimation::levenberg_marquardt::Normal;
use estimation::subsets::{MOST_TERMS, Removable, condition, conditional, subsets};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::fit::{deviation, log_normaliser};
use crate::model::{Structure, Term};

/// Structures that are refitted a round, and the log of the odds against the best beyond which none is.
const REFITS: usize = 4;
pub(super) const HOPELESS: f64 = 5.0;

/// Structures with one term more that are refitted a round.
const ADDITIONS: usize = 2;

/// What speaks for a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// Log evidence of the best structure with it less that of the best without it.
    pub gain: f64,
    /// Probability of sizes as far from neutral by chance, beside all other candidates.
    pub p_value: f64,
}

/// A quadratic approximation of the posterior of the full model, and what may be taken from it.
pub(super) struct Quadratic {
    pub covariance: DMatrix<f64>,
    pub mean: DVector<f64>,
    pub removable: Vec<Removable>,
    /// Whether a term has its sizes at the end of their range and would leave it: it is out.
    pinned: Vec<bool>,
    /// Whether an unknown is free, and not that of a size that is out.
    pub free: Vec<bool>,
}

impl Quadratic {
    /// Round a point of the full structure.
    pub fn new(normal: &Normal, structure: &Structure, theta: &[f64], log_odds: &[f64]) -> Option<Self> {
        let unknown = structure.unknowns();
        let count = normal.gradient.len();
        let mut at = DVector::zeros(count);
        unknown.iter().zip(theta).for_each(|(place, value)| {
            if let Some(place) = place {
                at[*place] = *value;
            }
        });
        let factor = normal.matrix.clone().cholesky()?;
        let mut covariance = factor.inverse();
        let mut mean = &at + factor.solve(&normal.gradient);
        let ranges = structure.ranges();
        let mut pinned = vec![false; ranges.len()];
        let removable = |mean: &DVector<f64>, number: usize| {
            let places = ranges[number].clone().map(|place| (place, unknown[place]));
            Removable { log_odds: log_odds[number], ..removable(&structure.terms[number], theta, mean, places) }
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
    pub fn support(&self, effects: &[(&str, Option<usize>)]) -> Vec<Support> {
        let (kept, weights) = self.weighed();
        let of = |number: usize| {
            if !kept.contains(&number) {
                return Support { gain: 0.0, p_value: 1.0 };
            }
            let own = &self.removable[number];
            let p_value = by_chance(&own.sizes, &self.covariance).unwrap_or(1.0);
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
            Support { gain: highest(true) - highest(false) - own.log_odds, p_value }
        };
        (0..self.removable.len()).map(of).collect()
    }

    /// The terms that are weighed, at most [`MOST_TERMS`], and the log weights of all their subsets.
    fn weighed(&self) -> (Vec<usize>, Vec<f64>) {
        let free: Vec<usize> = (0..self.removable.len()).filter(|&k| !self.pinned[k]).collect();
        let (kept, covariance, removable) = self.fewer(free);
        (kept, subsets(&covariance, &removable))
    }

    /// The best subsets of terms. Beside the best of all subsets the best are looked at that have one term more than
    /// `about`: a step so far from here is badly foretold, and only a fit tells.
    pub fn best(&self, about: &[bool]) -> Vec<Vec<bool>> {
        let (kept, weights) = self.weighed();
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
        order.into_iter().map(chosen).collect()
    }

    /// The terms that matter most, with what is left of the posterior when the others are taken away.
    fn fewer(&self, mut kept: Vec<usize>) -> (Vec<usize>, DMatrix<f64>, Vec<Removable>) {
        let mut covariance = self.covariance.clone();
        let mut mean = self.mean.clone();
        let mut removable = self.removable.clone();
        while kept.len() > MOST_TERMS {
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

/// Probability of sizes, each with its place in a covariance, as far from neutral by chance (χ²); `None` of
/// none, and where the covariance is singular.
pub fn by_chance(sizes: &[(usize, f64)], covariance: &DMatrix<f64>) -> Option<f64> {
    let distance = DVector::from_iterator(sizes.len(), sizes.iter().map(|(_, distance)| *distance));
    let matrix = DMatrix::from_fn(sizes.len(), sizes.len(), |i, j| covariance[(sizes[i].0, sizes[j].0)]);
    let square = distance.dot(&matrix.cholesky()?.solve(&distance));
    Some(ChiSquared::new(sizes.len() as f64).ok()?.sf(square))
}

/// A term as it may be taken away, at a point θ of the full model with the unknowns that its places are.
fn removable(
    term: &Term,
    theta: &[f64],
    mean: &DVector<f64>,
    places: impl Iterator<Item = (usize, Option<usize>)>,
) -> Removable {
    let mut own = Removable { sizes: Vec::new(), shapes: Vec::new(), log_prior: 0.0, log_odds: 0.0 };
    for (((place, unknown), prior), neutral) in places.zip(&term.priors).zip(term.neutral()) {
        let Some(unknown) = unknown else { continue };
        let at = if prior.is_shape { theta[place] } else { neutral };
        own.log_prior += log_normaliser(*prior);
        own.log_prior -= 0.5 * deviation(*prior, at).powi(2);
        match prior.is_shape {
            true => own.shapes.push(unknown),
            false => own.sizes.push((unknown, mean[unknown] - neutral)),
        }
    }
    own
}
