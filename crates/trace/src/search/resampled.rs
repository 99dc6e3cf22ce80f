//! How often an effect is chosen when the record is resampled: balanced half-samples of its parts, no replay needed.
//!
//! The record is cut in 15 parts, and each of 15 samples holds eight of them, twice: every part is in eight samples and
//! every two parts together in four (the columns of a Hadamard matrix of order 16; McCarthy 1969). Each structure is
//! linear in its parameters near its own fit, and its whitened rows are independent, so the likelihood of a sample
//! follows from sums over its parts:
//!
//! −2 log L = N ln(RSS/m) + N/m · Σ log S, with RSS after the best linear step and both sums over the m rows held.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::{DMatrix, DVector};

use super::ledger::{Names, Noted};
use super::models::Search;
use super::rule::{Place, places};
use crate::fit::{Normal, part_of};

/// Parts of every record, and samples of them.
const PARTS: usize = 15;

/// Structures that compete in every sample.
const COMPETING: usize = 30;

/// Whether a sample holds a part: where ones of the binary numbers of both meet an odd number of times.
fn holds(sample: usize, part: usize) -> bool {
    ((sample + 1) & (part + 1)).count_ones() % 2 == 1
}

/// Normal equations, Σ log S and the rows of one part.
struct Part {
    normal: Normal,
    log_variance: f64,
    rows: usize,
}

impl Search<'_> {
    fn parts(&self, noted: &Noted) -> Vec<Part> {
        let linear = self.problem.linear(&noted.structure, &noted.fit.theta, &noted.fit.initial);
        let whiteners = self.problem.whiteners(&noted.fit.colour);
        let (columns, white) = (linear.whitened(&whiteners), linear.whitened_residual(&whiteners));
        let part = |number: usize| {
            let rows = || whiteners.iter().zip(&white).map(|(whitener, e)| (whitener, part_of(e.len(), number, PARTS)));
            Part {
                normal: columns.normal_of_part(&white, number, PARTS),
                log_variance: rows().flat_map(|(filter, rows)| rows.map(|row| filter.log_variance_of(row))).sum(),
                rows: rows().map(|(_, rows)| rows.len()).sum(),
            }
        };
        (0..PARTS).map(part).collect()
    }

    /// BIC in every sample, with what the effects of the structure have to gain.
    fn in_samples(&self, noted: &Noted) -> [f64; PARTS] {
        let parts = self.parts(noted);
        let fixed = noted.fit.freedom as f64 * self.log_n()
            + noted.fit.lost
            + self.price(&noted.structure, noted.fit.colour.waves.is_some());
        std::array::from_fn(|sample| {
            let unknowns = parts[0].normal.matrix.nrows();
            let (matrix, gradient) = (DMatrix::zeros(unknowns, unknowns), DVector::zeros(unknowns));
            let mut whole = Part { normal: Normal { matrix, gradient, rss: 0.0 }, log_variance: 0.0, rows: 0 };
            for (_, part) in parts.iter().enumerate().filter(|(number, _)| holds(sample, *number)) {
                whole.normal.matrix += &part.normal.matrix;
                whole.normal.gradient += &part.normal.gradient;
                whole.normal.rss += part.normal.rss;
                whole.log_variance += part.log_variance;
                whole.rows += part.rows;
            }
            let times = self.problem.observations() as f64 / whole.rows.max(1) as f64;
            let rss = whole.normal.projected(unknowns);
            self.problem.deviance(times * rss, times * whole.log_variance) + fixed
        })
    }

    /// Places that are in the best structure of more than half of the samples; the likeliest contenders come first.
    pub(super) fn frequent(&self, contenders: &[(&Names, &Noted)]) -> BTreeSet<Place> {
        let competing = &contenders[..contenders.len().min(COMPETING)];
        let scores: Vec<[f64; PARTS]> = competing.iter().map(|(_, noted)| self.in_samples(noted)).collect();
        let taken: Vec<BTreeSet<Place>> = competing.iter().map(|(names, _)| places(names)).collect();
        most_frequent(&scores, &taken)
    }
}

/// Places in more than half of the sets of lowest score.
fn most_frequent<const N: usize>(scores: &[[f64; N]], taken: &[BTreeSet<Place>]) -> BTreeSet<Place> {
    let mut counts: BTreeMap<Place, usize> = BTreeMap::new();
    for sample in 0..N {
        let best = (0..scores.len()).min_by(|&one, &other| scores[one][sample].total_cmp(&scores[other][sample]));
        for place in best.into_iter().flat_map(|best| &taken[best]) {
            *counts.entry(*place).or_default() += 1;
        }
    }
    counts.into_iter().filter(|(_, count)| 2 * count > N).map(|(place, _)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every sample has eight parts, every part is in eight samples, every two are together in four.
    #[test]
    fn samples_are_balanced() {
        let all = || 0..PARTS;
        assert!(all().all(|sample| all().filter(|&part| holds(sample, part)).count() == 8));
        for one in all() {
            for other in all() {
                let both = all().filter(|&sample| holds(sample, one) && holds(sample, other)).count();
                assert_eq!(both, if one == other { 8 } else { 4 }, "{one} {other}");
            }
        }
    }

    /// Three samples, three structures: wind is in the best of two of them, damping in that of one.
    #[test]
    fn what_is_best_more_often_than_not_is_frequent() {
        let [damping, wind]: [Place; 2] = [("nonlinear_damping", None), ("wind_moment", None)];
        let taken = [vec![], vec![wind], vec![damping, wind]].map(|set| set.into_iter().collect());
        let scores = [[0.0, 5.0, 5.0], [1.0, 2.0, 3.0], [2.0, 3.0, 1.0]];
        assert_eq!(most_frequent(&scores, &taken), [wind].into());
        // Exactly half is not more than half.
        let halves = [[0.0, 5.0, 5.0, 0.0], [1.0, 2.0, 3.0, 1.0], [2.0, 3.0, 1.0, 2.0]];
        assert_eq!(most_frequent(&halves, &taken), BTreeSet::new());
    }
}
