//! The evidence of every subset of the candidates at once, from the posterior of the full model.
//!
//! Where log-density is quadratic, a structure without the candidates R has against the full model the evidence
//!
//! log Z_R − log Z = −½ Δᵀ Σ_ss⁻¹ Δ − log p(R neutral) − ½ log |2π Σ_RR|,
//!
//! with the distance Δ of the sizes of R from their neutral values, the posterior covariance Σ of all that was fitted,
//! and the prior density p. It is the density ratio of Dickey (1971) for sizes; parameters that only shape an effect
//! are free while its size is taken away and pay with their prior range.
//!
//! All 2^m subsets share their factors: one row of a Cholesky factor is added for every candidate that is left out.

use nalgebra::{DMatrix, DVector};

/// A candidate as the evidence sees it.
#[derive(Debug, Clone)]
pub struct Removable {
    /// Unknowns of its sizes, and how far they are from neutral.
    pub sizes: Vec<(usize, f64)>,
    /// Unknowns that only shape it.
    pub shapes: Vec<usize>,
    /// Log prior density with the sizes at their neutral values and the shapes as they are.
    pub log_prior: f64,
    /// Log of the prior odds that it is there.
    pub log_odds: f64,
}

/// Most candidates whose subsets are all weighed.
pub const MOST: usize = 12;

/// A Cholesky factor that grows by a row, with the solution of L z = Δ.
struct Factor<'a> {
    covariance: &'a DMatrix<f64>,
    unknowns: Vec<usize>,
    rows: Vec<Vec<f64>>,
    solution: Vec<f64>,
    log_determinant: Vec<f64>,
    square: Vec<f64>,
}

impl<'a> Factor<'a> {
    fn new(covariance: &'a DMatrix<f64>) -> Self {
        let (unknowns, rows) = (Vec::new(), Vec::new());
        Self { covariance, unknowns, rows, solution: Vec::new(), log_determinant: Vec::new(), square: Vec::new() }
    }

    fn push(&mut self, unknown: usize, distance: f64) {
        let mut row = Vec::with_capacity(self.rows.len() + 1);
        for (other, known) in self.unknowns.iter().zip(&self.rows) {
            let own: f64 = known.iter().zip(&row).map(|(x, y): (&f64, &f64)| x * y).sum();
            row.push((self.covariance[(unknown, *other)] - own) / known[known.len() - 1]);
        }
        let variance = self.covariance[(unknown, unknown)];
        let left = variance - row.iter().map(|x| x * x).sum::<f64>();
        let pivot = left.max(1e-12 * variance).sqrt();
        let solved = row.iter().zip(&self.solution).map(|(x, y)| x * y).sum::<f64>();
        let z = (distance - solved) / pivot;
        row.push(pivot);
        self.log_determinant.push(self.log_determinant.last().unwrap_or(&0.0) + 2.0 * pivot.ln());
        self.square.push(self.square.last().unwrap_or(&0.0) + z * z);
        self.unknowns.push(unknown);
        self.rows.push(row);
        self.solution.push(z);
    }

    fn truncate(&mut self, length: usize) {
        self.unknowns.truncate(length);
        self.rows.truncate(length);
        self.solution.truncate(length);
        self.log_determinant.truncate(length);
        self.square.truncate(length);
    }
}

/// Log evidence plus log prior odds of every subset against that of the full model with even odds; bit k of the place
/// says that candidate k is in.
///
/// `covariance` is that of the unknowns. At most [`MOST`] candidates.
pub fn subsets(covariance: &DMatrix<f64>, candidates: &[Removable]) -> Vec<f64> {
    let mut weights = vec![0.0; 1 << candidates.len()];
    let mut walk =
        Walk { candidates, sizes: Factor::new(covariance), all: Factor::new(covariance), weights: &mut weights };
    walk.descend(0, 0, 0.0, 0.0);
    weights
}

struct Walk<'a> {
    candidates: &'a [Removable],
    /// Sizes of what is left out.
    sizes: Factor<'a>,
    /// Everything of what is left out.
    all: Factor<'a>,
    weights: &'a mut [f64],
}

impl Walk<'_> {
    fn descend(&mut self, next: usize, subset: usize, log_prior: f64, log_odds: f64) {
        let Some(candidate) = self.candidates.get(next) else {
            let count = self.all.unknowns.len() as f64;
            let square = self.sizes.square.last().unwrap_or(&0.0);
            let determinant = self.all.log_determinant.last().unwrap_or(&0.0);
            let evidence = -0.5 * (square + determinant + count * std::f64::consts::TAU.ln()) - log_prior;
            self.weights[subset] = evidence + log_odds;
            return;
        };
        self.descend(next + 1, subset | 1 << next, log_prior, log_odds + candidate.log_odds);
        let [sizes, all] = [self.sizes.unknowns.len(), self.all.unknowns.len()];
        for &(unknown, distance) in &candidate.sizes {
            self.sizes.push(unknown, distance);
            self.all.push(unknown, 0.0);
        }
        for &unknown in &candidate.shapes {
            self.all.push(unknown, 0.0);
        }
        self.descend(next + 1, subset, log_prior + candidate.log_prior, log_odds);
        self.sizes.truncate(sizes);
        self.all.truncate(all);
    }
}

/// Where the unknowns go when the sizes of what is not in a subset become neutral, in the quadratic approximation.
pub fn conditional(covariance: &DMatrix<f64>, at: &DVector<f64>, removed: &[&Removable]) -> DVector<f64> {
    let sizes: Vec<(usize, f64)> = removed.iter().flat_map(|one| one.sizes.iter().copied()).collect();
    let own = DMatrix::from_fn(sizes.len(), sizes.len(), |i, j| covariance[(sizes[i].0, sizes[j].0)]);
    let distance = DVector::from_fn(sizes.len(), |i, _| sizes[i].1);
    let ridge = DMatrix::from_diagonal(&own.diagonal().map(|x| 1e-12 * x));
    let Some(factor) = (own + ridge).cholesky() else { return at.clone() };
    let shares = factor.solve(&distance);
    DVector::from_fn(at.len(), |k, _| {
        at[k]
            - sizes
                .iter()
                .zip(shares.iter())
                .map(|((unknown, _), share)| covariance[(k, *unknown)] * share)
                .sum::<f64>()
    })
}
