//! What a record can tell apart, computed from the sensitivities of the fitted model: how far an effect, as large as it
//! can be expected, would move the heading beyond what base and known terms could imitate, and how far two rival
//! effects are apart. Both are expected gains in −2 log L, so they are compared with the thresholds of the search; for
//! a trial that was not run yet they say what it would reveal.

use crate::candidates::Candidate;
use crate::fit::{Columns, Fit, Linear, Problem, acts, whiten};
use crate::index::TermPlace;
use crate::noise::Whitener;
use crate::structure::Structure;

/// A fitted model on some records.
pub struct Ground<'a> {
    problem: &'a Problem,
    structure: &'a Structure,
    fit: &'a Fit,
    /// Variance of the whitened residual, rad².
    variance: f64,
    whiteners: Vec<Whitener>,
    /// Sensitivities of the model.
    linear: Linear,
    /// The same, whitened.
    columns: Columns,
    /// Its replayed headings, rad.
    headings: Vec<Vec<f64>>,
}

impl<'a> Ground<'a> {
    /// The ground of a fit of a structure; `variance` is that of its whitened residual, rad².
    pub fn new(problem: &'a Problem, structure: &'a Structure, fit: &'a Fit, variance: f64) -> Self {
        let whiteners = problem.whiteners(&fit.colour);
        let linear = problem.linear(structure, &fit.theta, &fit.initial);
        let headings = problem.replay(structure, &fit.theta, &fit.initial);
        let columns = linear.whitened(&whiteners);
        Self { problem, structure, fit, variance, whiteners, linear, columns, headings }
    }

    /// Expected gain in −2 log L of a candidate that is as large as it can be expected.
    pub fn visibility(&self, candidate: &Candidate) -> f64 {
        let with = self.structure.with(candidate.term.clone());
        let theta = [self.fit.theta.as_slice(), &candidate.large].concat();
        let moved = difference(&self.problem.replay(&with, &theta, &self.fit.initial), &self.headings);
        self.expected(&self.columns, &moved)
    }

    /// Expected gain in −2 log L of the term at `place` against a rival in its stead.
    pub fn distance(&self, place: TermPlace, rival: &Candidate) -> f64 {
        let without = self.structure.without(place);
        let theta = self.structure.drop_from(&self.fit.theta, place);
        let bare = self.problem.replay(&without, &theta, &self.fit.initial);
        let start = rival.starts.first().unwrap_or(&rival.large);
        let (with_rival, theta) = (without.with(rival.term.clone()), [theta.as_slice(), start].concat());
        let (presence, mut new) = self.problem.columns_of_last(&with_rival, &theta, &self.fit.initial, &bare);
        if acts(&presence) {
            new.insert(0, presence);
        }
        // The base may move with the rival in the place of the term: its sensitivities are those at the fitted model.
        let mut columns = self.linear.clone().without(place_of(self.structure, place)).whitened(&self.whiteners);
        columns.insert(columns.unknowns(), &new, &self.whiteners);
        self.expected(&columns, &difference(&self.headings, &bare))
    }

    /// Sum of squares of a change of the heading that no unknown can imitate, in units of the noise.
    fn expected(&self, columns: &Columns, moved: &[Vec<f64>]) -> f64 {
        columns.normal(&whiten(moved, &self.whiteners)).projected(columns.unknowns()) / self.variance
    }

    /// Mean logarithm of the standard deviations of the fitted parameters of the ship; `None` when they are not
    /// determined.
    pub fn uncertainty(&self) -> Option<f64> {
        let covariance = self.columns.covariance()?;
        let entries = self.problem.entries(self.structure);
        let fitted: Vec<_> = entries.iter().filter(|entry| entry.fitted).collect();
        let sum: f64 = fitted
            .iter()
            .enumerate()
            .map(|(k, entry)| 0.5 * (covariance[(k, k)] * self.variance).ln() - entry.scale.abs().ln())
            .sum();
        Some(sum / fitted.len() as f64)
    }
}

/// Places of the unknowns of a term.
fn place_of(structure: &Structure, place: TermPlace) -> std::ops::Range<usize> {
    let before: usize = structure.terms[..place.0].iter().map(|term| term.freedom()).sum();
    let start = structure.base_count() + before;
    start..start + structure.term(place).freedom()
}

fn difference(one: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    one.iter().zip(other).map(|(one, other)| one.iter().zip(other).map(|(x, y)| x - y).collect()).collect()
}
