//! A fitted model with its heading linear in all unknowns: what all candidates that are tried on it share.

use super::linear::Columns;
use super::outcome::Fit;
use super::problem::Problem;
use crate::noise::Whitener;
use crate::record::Record;
use crate::structure::Structure;

/// A fit with its sensitivities.
pub struct Linearised {
    /// Filters of its colour.
    pub whiteners: Vec<Whitener>,
    /// Whitened sensitivities.
    pub columns: Columns,
    /// Sensitivities under white noise.
    pub plain: Columns,
    /// Whitened residual.
    pub white: Vec<Vec<f64>>,
    /// Replayed headings, rad.
    pub headings: Vec<Vec<f64>>,
}

impl Linearised {
    /// Sensitivities of a structure at a fit, whitened as the fit was.
    pub fn new(problem: &Problem, structure: &Structure, fit: &Fit) -> Self {
        let whiteners = problem.whiteners(&fit.colour);
        let linear = problem.linear(structure, &fit.theta, &fit.initial);
        let replayed = |(record, residual): (&Record, &Vec<f64>)| {
            record.observed.iter().zip(residual).map(|(&row, e)| record.heading[row] - e).collect()
        };
        Self {
            plain: problem.under_white(&linear),
            columns: linear.whitened(&whiteners),
            white: linear.whitened_residual(&whiteners),
            headings: problem.records.iter().zip(&fit.residual).map(replayed).collect(),
            whiteners,
        }
    }
}
