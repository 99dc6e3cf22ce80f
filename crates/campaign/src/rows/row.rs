//! The result of one method on one trial.

use std::sync::Arc;

/// Best standard deviations an unbiased method can have on a trial (Cramér–Rao), for its own noise and true K and T.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// Of K, 1/s.
    pub k_per_s: f64,
    /// Of T, s.
    pub t_s: f64,
    /// Of K/T, 1/s².
    pub k_over_t_per_s2: f64,
}

/// What a trace said of one trial.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TracedCells {
    /// `clean`, `traced` or `unexplained`.
    pub verdict: Box<str>,
    /// Identifiers of the effects named, joined by `+`; empty where none was.
    pub named: Box<str>,
    /// The same with the aliases of each, joined by `|`.
    pub groups: Box<str>,
    /// Gain in BIC of the one missing effect over the best other one.
    pub margin: Option<f64>,
    /// Likelihood ratio of the truth against the nearest first-order response, on average.
    pub expected: Option<f64>,
}

/// The result of one method on one trial. Units are in the names; `None` is "not defined".
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Row {
    /// Index of the cell in the design.
    pub cell: u64,
    /// Index of the replicate in the cell.
    pub replicate: u64,
    /// Index of the method in the scenario.
    pub method: usize,
    /// Why the method failed; `None` when it did not.
    pub failure: Option<Box<str>>,
    /// K that a method should find, 1/s: that of the ship where it is exactly first order, else of the first-order response
    /// that comes nearest to its undisturbed trial.
    pub true_k_per_s: Option<f64>,
    /// T that a method should find, s.
    pub true_t_s: Option<f64>,
    /// Cramér–Rao bound of this trial.
    pub bound: Option<Bound>,
    /// K, 1/s.
    pub k_per_s: Option<f64>,
    /// Lower and upper end of the 95 % interval of K, 1/s.
    pub k_ci95_per_s: Option<[f64; 2]>,
    /// T, s.
    pub t_s: Option<f64>,
    /// 95 % interval of T, s.
    pub t_ci95_s: Option<[f64; 2]>,
    /// δ_r, deg.
    pub rudder_bias_deg: Option<f64>,
    /// 95 % interval of δ_r, deg.
    pub rudder_bias_ci95_deg: Option<[f64; 2]>,
    /// Root mean square error of the replayed heading on the trial itself, deg.
    pub heading_rmse_deg: Option<f64>,
    /// The same on the validation manoeuvre, which the method has not seen, deg.
    pub validation_rmse_deg: Option<f64>,
    /// Model evaluations of the method.
    pub evaluations: Option<u64>,
    /// Why the method stopped.
    pub stop: Option<&'static str>,
    /// What a trace said.
    pub traced: Option<Box<TracedCells>>,
    /// Drawn values of the trial, in the order and units of the scenario's draws; shared by the rows of a trial.
    pub drawn: Option<Arc<[f64]>>,
}

impl Row {
    /// Relative error of K, (K̂ − K)/K.
    pub fn k_error(&self) -> Option<f64> {
        relative(self.k_per_s?, self.true_k_per_s?)
    }

    /// Relative error of T.
    pub fn t_error(&self) -> Option<f64> {
        relative(self.t_s?, self.true_t_s?)
    }

    /// Relative error of K/T, the slope of the response to the rudder at its beginning.
    pub fn k_over_t_error(&self) -> Option<f64> {
        relative(self.k_per_s? / self.t_s?, self.true_k_per_s? / self.true_t_s?)
    }
}

fn relative(found: f64, truth: f64) -> Option<f64> {
    Some(found / truth - 1.0).filter(|error| error.is_finite())
}
