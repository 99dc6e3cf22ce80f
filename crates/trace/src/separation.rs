//! What a record can tell apart, computed from the sensitivities of the fitted model: how far an effect, as large as it can
//! be expected, would move the heading beyond what base and known terms could imitate, and how far two rival effects are
//! apart. Both are expected gains in −2 log L, so they are compared with the thresholds of the search; for a trial that
//! was not run yet they say what it would reveal.

use crate::candidates::Candidate;
use crate::fit::{Fit, Linear, Problem};
use crate::structure::Structure;

/// A fitted model on some records.
pub struct Ground<'a> {
    /// Records.
    pub problem: &'a Problem,
    /// Structure.
    pub structure: &'a Structure,
    /// Its fit.
    pub fit: &'a Fit,
    /// Variance of the whitened residual, rad².
    pub variance: f64,
}

type Columns = Vec<Option<Vec<f64>>>;

impl Ground<'_> {
    fn linear(&self) -> Linear {
        let entries = self.problem.entries(self.structure);
        self.problem.linear(self.structure, &self.fit.theta, &self.fit.initial, &entries)
    }

    fn headings(&self, structure: &Structure, theta: &[f64]) -> Vec<Vec<f64>> {
        self.problem.replay(structure, theta, &self.fit.initial)
    }

    /// Expected gain in −2 log L of a candidate that is as large as it can be expected.
    pub fn visibility(&self, candidate: &Candidate) -> f64 {
        let with = self.structure.with(candidate.term.clone());
        let theta = [self.fit.theta.as_slice(), &candidate.large].concat();
        let moved = difference(&self.headings(&with, &theta), &self.headings(self.structure, &self.fit.theta));
        self.expected(self.linear().with_residual(moved))
    }

    /// Expected gain in −2 log L of the term at `place` against a rival in its stead.
    pub fn distance(&self, place: usize, rival: &Candidate) -> f64 {
        let here = self.headings(self.structure, &self.fit.theta);
        let without = self.structure.without(place);
        let theta = self.structure.drop_from(&self.fit.theta, place);
        let start = rival.starts.first().unwrap_or(&rival.large);
        let with_rival = |own: &[f64]| {
            let structure = without.with(rival.term.clone());
            self.headings(&structure, &[theta.as_slice(), own].concat())
        };
        let bare = self.headings(&without, &theta);
        // The base may move with the rival in the place of the term: its sensitivities are those at the fitted model.
        let mut linear = self.linear().without(place_of(self.structure, place)).with_residual(difference(&here, &bare));
        let origin = with_rival(start);
        let being = difference(&origin, &bare);
        if being.iter().flatten().any(|&x| x != 0.0) {
            linear.push(acting(being, rival));
        }
        for k in (0..start.len()).filter(|k| !rival.term.held.contains(k)) {
            let mut moved = start.clone();
            moved[k] += 1e-3 * rival.term.scale[k];
            linear.push(acting(difference(&with_rival(&moved), &origin), rival));
        }
        self.expected(linear)
    }

    /// Sum of squares that no unknown can imitate, in units of the noise.
    fn expected(&self, linear: Linear) -> f64 {
        let whiteners = self.problem.whiteners(&self.fit.colour);
        let (rss, _) = linear.projected(&whiteners);
        rss / self.variance
    }

    /// Mean logarithm of the standard deviations of the fitted parameters of the ship; `None` when they are not determined.
    pub fn uncertainty(&self) -> Option<f64> {
        let whiteners = self.problem.whiteners(&self.fit.colour);
        let covariance = self.linear().covariance(&whiteners)?;
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
fn place_of(structure: &Structure, place: usize) -> std::ops::Range<usize> {
    let before: usize = structure.terms[..place].iter().map(|term| term.freedom()).sum();
    let start = structure.base_count() + before;
    start..start + structure.terms[place].freedom()
}

fn difference(one: &[Vec<f64>], other: &[Vec<f64>]) -> Vec<Vec<f64>> {
    one.iter().zip(other).map(|(one, other)| one.iter().zip(other).map(|(x, y)| x - y).collect()).collect()
}

fn acting(columns: Vec<Vec<f64>>, rival: &Candidate) -> Columns {
    let acts = |record| rival.term.only.is_none_or(|only| only == record);
    columns.into_iter().enumerate().map(|(record, column)| acts(record).then_some(column)).collect()
}
