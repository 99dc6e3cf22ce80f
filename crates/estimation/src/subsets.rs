//! Evidence of every subset of terms, from the posterior of the full model.
//!
//! For a quadratic log density, the evidence of the model without the terms R relative to the full model is
//!
//! log Z_R − log Z = −½ Δᵀ Σ_ss⁻¹ Δ − log p(R neutral) − ½ log |2π Σ_RR|,
//!
//! with the distance Δ of the amplitudes of R from their neutral values, the posterior covariance Σ of all
//! fitted unknowns (Σ_ss its block of these amplitudes, Σ_RR its block of all unknowns of R), and the prior density p.
//! It is the Savage–Dickey density ratio for the amplitudes; shape parameters are unconstrained without their amplitude
//! and count with their prior range.
//!
//! All 2^m subsets share factors: a removed term adds one row to a Cholesky factor.
//!
//! Source: Dickey (1971), Annals of Mathematical Statistics 42:204-223.

use nalgebra::{DMatrix, DVector};

/// Term that may be removed from the model.
#[derive(Debug, Clone)]
pub struct RemovableTerm {
    /// Indices of the amplitudes of the term among the unknowns, each with its distance from the neutral value.
    pub amplitudes: Vec<(usize, f64)>,
    /// Indices of the shape parameters of the term among the unknowns.
    pub shape_parameters: Vec<usize>,
    /// Log prior density at neutral amplitudes and fitted shape parameters.
    pub log_prior_density: f64,
    /// Log prior odds of inclusion.
    pub log_prior_odds: f64,
}

/// Maximum number of terms whose subsets are all weighted.
pub const MAX_SUBSET_TERMS: usize = 12;

/// Cholesky factor that grows row by row, with the solution of L z = Δ.
struct GrowingFactor<'a> {
    covariance: &'a DMatrix<f64>,
    unknowns: Vec<usize>,
    rows: Vec<Vec<f64>>,
    solution: Vec<f64>,
    /// log |L Lᵀ| of every leading block.
    log_determinant: Vec<f64>,
    /// Sum of squares of z up to every row.
    square: Vec<f64>,
}

impl<'a> GrowingFactor<'a> {
    fn new(covariance: &'a DMatrix<f64>) -> Self {
        let (unknowns, rows) = (Vec::new(), Vec::new());
        Self { covariance, unknowns, rows, solution: Vec::new(), log_determinant: Vec::new(), square: Vec::new() }
    }

    fn push(&mut self, unknown: usize, distance: f64) {
        let mut row = Vec::with_capacity(self.rows.len() + 1);
        for (previous, factor) in self.unknowns.iter().zip(&self.rows) {
            let product: f64 = factor.iter().zip(&row).map(|(x, y): (&f64, &f64)| x * y).sum();
            row.push((self.covariance[(unknown, *previous)] - product) / factor[factor.len() - 1]);
        }
        let variance = self.covariance[(unknown, unknown)];
        let conditional = variance - row.iter().map(|x| x * x).sum::<f64>();
        let pivot = conditional.max(1e-12 * variance).sqrt();
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

/// Log evidence plus log prior odds of all 2^m subsets of m terms, relative to the full model with even odds. Bit k of
/// the index is set if term k is included.
///
/// `covariance` is the posterior covariance of the unknowns. `terms` has at most [`MAX_SUBSET_TERMS`] terms.
pub fn subset_log_weights(covariance: &DMatrix<f64>, terms: &[RemovableTerm]) -> Vec<f64> {
    let mut weights = vec![0.0; 1 << terms.len()];
    let mut walk = SubsetWalk {
        terms,
        amplitudes: GrowingFactor::new(covariance),
        all: GrowingFactor::new(covariance),
        weights: &mut weights,
    };
    walk.descend(0, 0, 0.0, 0.0);
    weights
}

struct SubsetWalk<'a> {
    terms: &'a [RemovableTerm],
    /// Factor over the amplitudes of the removed terms.
    amplitudes: GrowingFactor<'a>,
    /// Factor over all unknowns of the removed terms.
    all: GrowingFactor<'a>,
    weights: &'a mut [f64],
}

impl SubsetWalk<'_> {
    fn descend(&mut self, next: usize, subset: usize, log_prior: f64, log_odds: f64) {
        let Some(term) = self.terms.get(next) else {
            let count = self.all.unknowns.len() as f64;
            let square = self.amplitudes.square.last().unwrap_or(&0.0);
            let determinant = self.all.log_determinant.last().unwrap_or(&0.0);
            let evidence = -0.5 * (square + determinant + count * std::f64::consts::TAU.ln()) - log_prior;
            self.weights[subset] = evidence + log_odds;
            return;
        };
        self.descend(next + 1, subset | 1 << next, log_prior, log_odds + term.log_prior_odds);
        let [amplitudes, all] = [self.amplitudes.unknowns.len(), self.all.unknowns.len()];
        for &(unknown, distance) in &term.amplitudes {
            self.amplitudes.push(unknown, distance);
            self.all.push(unknown, 0.0);
        }
        for &unknown in &term.shape_parameters {
            self.all.push(unknown, 0.0);
        }
        self.descend(next + 1, subset, log_prior + term.log_prior_density, log_odds);
        self.amplitudes.truncate(amplitudes);
        self.all.truncate(all);
    }
}

/// Conditional mean of the unknowns if the amplitudes of the removed terms are neutral (quadratic approximation about
/// `at`); `at` itself if the covariance of these amplitudes is not positive definite.
pub fn conditional_mean(covariance: &DMatrix<f64>, at: &DVector<f64>, removed: &[&RemovableTerm]) -> DVector<f64> {
    let amplitudes: Vec<(usize, f64)> = removed.iter().flat_map(|term| term.amplitudes.iter().copied()).collect();
    let block =
        DMatrix::from_fn(amplitudes.len(), amplitudes.len(), |i, j| covariance[(amplitudes[i].0, amplitudes[j].0)]);
    let distance = DVector::from_fn(amplitudes.len(), |i, _| amplitudes[i].1);
    let ridge = DMatrix::from_diagonal(&block.diagonal().map(|x| 1e-12 * x));
    let Some(factor) = (block + ridge).cholesky() else { return at.clone() };
    let shares = factor.solve(&distance);
    DVector::from_fn(at.len(), |k, _| {
        at[k]
            - amplitudes
                .iter()
                .zip(shares.iter())
                .map(|((unknown, _), share)| covariance[(k, *unknown)] * share)
                .sum::<f64>()
    })
}

/// Conditions a covariance, in place, on neutral amplitudes of a term.
pub fn condition_on_neutral(covariance: &mut DMatrix<f64>, out: &RemovableTerm) {
    for &(unknown, _) in &out.amplitudes {
        let column: DVector<f64> = covariance.column(unknown).into();
        let variance = column[unknown];
        if variance > 0.0 {
            *covariance -= &column * column.transpose() / variance;
            covariance[(unknown, unknown)] = 1e-12 * variance;
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
    use rand_distr::StandardNormal;

    use super::*;

    /// y = X θ + e with unit noise, with one unknown that is always included, and candidates with normal priors.
    struct LinearModel {
        x: DMatrix<f64>,
        y: DVector<f64>,
        mean: Vec<f64>,
        sd: Vec<f64>,
    }

    impl LinearModel {
        fn drawn(generator: &mut ChaCha8Rng, candidates: usize) -> Self {
            let mut draw = || -> f64 { generator.sample(StandardNormal) };
            let mut x = DMatrix::from_fn(40, candidates + 1, |_, _| draw());
            // Neighbouring columns are similar, like effects in one manoeuvre.
            for k in 1..=candidates {
                let other = x.column(k - 1).into_owned();
                x.column_mut(k).axpy(0.8, &other, 0.6);
            }
            let theta = DVector::from_fn(candidates + 1, |_, _| 0.4 * draw());
            let y = &x * theta + DVector::from_fn(40, |_, _| draw());
            let mean = (0..candidates).map(|_| 0.3 * draw()).collect();
            let sd = (0..candidates).map(|_| 0.3 + draw().abs()).collect();
            Self { x, y, mean, sd }
        }

        /// Posterior precision and mean of the unknown that is always included, and of some candidates.
        fn posterior(&self, kept: &[usize]) -> (DMatrix<f64>, DVector<f64>) {
            let columns: Vec<usize> = [0].into_iter().chain(kept.iter().map(|k| k + 1)).collect();
            let x = self.x.select_columns(&columns);
            let (mut matrix, mut right) = (x.transpose() * &x, x.transpose() * &self.y);
            for (place, &k) in kept.iter().enumerate() {
                matrix[(place + 1, place + 1)] += self.sd[k].powi(-2);
                right[place + 1] += self.mean[k] * self.sd[k].powi(-2);
            }
            let mean = matrix.clone().cholesky().expect("positive").solve(&right);
            (matrix, mean)
        }

        /// Log of the marginal likelihood with some candidates, by a separate fit.
        fn evidence(&self, kept: &[usize]) -> f64 {
            let (precision, mean) = self.posterior(kept);
            let columns: Vec<usize> = [0].into_iter().chain(kept.iter().map(|k| k + 1)).collect();
            let residual = &self.y - self.x.select_columns(&columns) * &mean;
            let penalty: f64 = kept
                .iter()
                .enumerate()
                .map(|(place, &k)| ((mean[place + 1] - self.mean[k]) / self.sd[k]).powi(2) + 2.0 * self.sd[k].ln())
                .sum();
            let determinant = precision.cholesky().expect("positive").ln_determinant();
            -0.5 * (residual.norm_squared() + penalty + determinant)
        }

        fn removable(&self, mean: &DVector<f64>, k: usize) -> RemovableTerm {
            let log_prior = -0.5 * ((self.mean[k] / self.sd[k]).powi(2) + std::f64::consts::TAU.ln()) - self.sd[k].ln();
            RemovableTerm {
                amplitudes: vec![(k + 1, mean[k + 1])],
                shape_parameters: Vec::new(),
                log_prior_density: log_prior,
                log_prior_odds: 0.0,
            }
        }
    }

    /// Evidence of every subset against a separate fit, for 200 random linear problems.
    #[test]
    fn subsets_have_the_evidence_of_their_own_fits() {
        let mut generator = ChaCha8Rng::seed_from_u64(29);
        for number in 0..200 {
            let count = 2 + number % 5;
            let problem = LinearModel::drawn(&mut generator, count);
            let all: Vec<usize> = (0..count).collect();
            let (precision, mean) = problem.posterior(&all);
            let covariance = precision.cholesky().expect("positive").inverse();
            let removable: Vec<RemovableTerm> = all.iter().map(|&k| problem.removable(&mean, k)).collect();
            let weights = subset_log_weights(&covariance, &removable);
            let full = problem.evidence(&all);
            for (subset, log) in weights.iter().enumerate() {
                let kept: Vec<usize> = all.iter().copied().filter(|k| subset >> k & 1 == 1).collect();
                let refitted = problem.evidence(&kept) - full;
                assert!(
                    (log - refitted).abs() < 1e-6 * (1.0 + refitted.abs()),
                    "{number}, {kept:?}: {log} and {refitted}"
                );
            }
        }
    }

    /// Conditional mean after removal of one term against a separate fit of the remaining terms.
    #[test]
    fn what_is_left_moves_to_its_own_fit() {
        let mut generator = ChaCha8Rng::seed_from_u64(3);
        let problem = LinearModel::drawn(&mut generator, 4);
        let (precision, mean) = problem.posterior(&[0, 1, 2, 3]);
        let covariance = precision.cholesky().expect("positive").inverse();
        let out = [problem.removable(&mean, 1), problem.removable(&mean, 3)];
        let moved = conditional_mean(&covariance, &mean, &out.iter().collect::<Vec<_>>());
        let (_, refitted) = problem.posterior(&[0, 2]);
        for (value, expected) in [(moved[0], refitted[0]), (moved[1], refitted[1]), (moved[3], refitted[2])] {
            assert!((value - expected).abs() < 1e-9, "{value} and {expected}");
        }
        assert!(moved[2].abs() < 1e-9 && moved[4].abs() < 1e-9);
    }
}
