//! The ships that the records cannot tell apart, as a prediction draws from them.

use nalgebra::DMatrix;
use ship::Response;

use super::parameters::parameter_covariance;
use super::result::Analysis;
use crate::fit::{Fit, Problem};
use crate::held_out::{portable_covariance, portable_structure};
use crate::index::RecordNumber;
use crate::search::{Search, Weights};
use crate::structure::{Structure, fitted};

/// One of the ships that the records cannot tell apart, without terms that belong to the weather of one record.
#[derive(Debug, Clone)]
pub struct Plausible {
    /// Its probability among them.
    pub weight: f64,
    /// The ship.
    pub response: Response,
    /// Places among its parameters of those that were fitted.
    pub fitted: Vec<usize>,
    /// Their covariance; `None` where the records do not tell them apart.
    pub covariance: Option<DMatrix<f64>>,
}

/// Fits of the structures that cannot be told apart, with their weights, the largest first.
pub(super) fn rivals(search: &Search, weights: &Weights) -> Vec<(f64, Structure, Fit)> {
    let known = search.ledger.known();
    let of = |one: &crate::search::Weighted| {
        let noted = known.get(&one.terms)?;
        Some((one.weight, noted.structure.clone(), noted.fit.clone()))
    };
    weights.alike().iter().filter_map(of).collect()
}

fn plausible(problem: &Problem, weight: f64, (structure, fit): (&Structure, &Fit), coloured: bool) -> Plausible {
    let (kept, values) = portable_structure(structure, &fit.theta);
    let response = kept.response(RecordNumber(0), &values);
    // Exponents of a base that follows the measured speed stand between base and terms, and are not fitted.
    let inserted = response.parameters().len() - values.len();
    let place = |theta: usize| if theta < kept.base_count() { theta } else { theta + inserted };
    let fitted = fitted(&problem.entries(&kept)).into_iter().map(|theta| place(theta.0)).collect();
    let covariance = parameter_covariance(problem, (structure, fit), coloured && fit.colour.wander.is_none());
    let covariance = covariance.map(|all| portable_covariance(problem, structure, &all));
    Plausible { weight, response, fitted, covariance }
}

impl Analysis {
    /// The ships that the records cannot tell apart, the one that is told first. Those of the same effects count
    /// together: they differ by the weather of the records alone.
    pub fn plausible(&self) -> Vec<Plausible> {
        let told = (&self.told.structure, &self.told.fit);
        let mut ships = vec![plausible(&self.problem, 0.0, told, self.coloured)];
        let names = |ship: &Response| -> Vec<(&'static str, &'static str)> {
            let mut names: Vec<_> = ship.model().effects().iter().map(|effect| (effect.id(), effect.form())).collect();
            names.sort_unstable();
            names
        };
        for (weight, structure, fit) in &self.rivals {
            let (kept, values) = portable_structure(structure, &fit.theta);
            let own = names(&kept.response(RecordNumber(0), &values));
            match ships.iter_mut().find(|ship| names(&ship.response) == own) {
                Some(ship) => ship.weight += weight,
                None => ships.push(plausible(&self.problem, *weight, (structure, fit), self.coloured)),
            }
        }
        // A structure that was judged by other records has no weight of its own, but it is the one that is told.
        if ships[0].weight <= 0.0 {
            ships[0].weight = ships.iter().map(|ship| ship.weight).fold(0.0, f64::max).max(1.0);
        }
        let sum: f64 = ships.iter().map(|ship| ship.weight).sum();
        ships.iter_mut().for_each(|ship| ship.weight /= sum);
        ships
    }

    /// Root mean square of the fitted yaw rates with which the records begin, rad/s.
    pub fn initial_yaw_rate(&self) -> f64 {
        let initial = &self.told.fit.initial;
        (initial.iter().map(|state| state[1] * state[1]).sum::<f64>() / initial.len() as f64).sqrt()
    }
}
