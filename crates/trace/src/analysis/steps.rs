//! The way from the base to the final model, one term after another in the order of discovery, and what every step did
//! to the error.

use crate::fit::Fit;
use crate::held_out::{self, HeldOut};
use crate::record::Record;
use crate::replay_errors::Errors;
use crate::search::{Model, Search};
use crate::structure::TermName;

/// A model on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Step {
    /// Identifier, form and record of the term that was added; `None` for the base.
    pub added: Option<TermName>,
    /// Root mean square heading error on the fitted records, rad, of their averaged rows.
    pub fitted: f64,
    /// The same of the replays of all held-out records together; `None` without any, or where one is not finite.
    pub held_out: Option<f64>,
    /// Fall of BIC in this step under white noise, and waves; `None` for the base.
    pub gain: Option<f64>,
    /// Every fitted record with the model of this step.
    pub records: Vec<StepOnRecord>,
}

/// A fitted record with the model of a step, at its averaged rows.
#[derive(Debug, Clone, PartialEq)]
pub struct StepOnRecord {
    /// Time, s.
    pub time: Vec<f64>,
    /// Replayed heading, rad.
    pub heading: Vec<f64>,
    /// Measured less replayed heading, rad.
    pub residual: Vec<f64>,
}

impl StepOnRecord {
    fn new(record: &Record, residual: &[f64]) -> Self {
        let of = |values: &[f64]| -> Vec<f64> { record.observed.iter().map(|&row| values[row]).collect() };
        let heading = of(&record.heading).iter().zip(residual).map(|(measured, left)| measured - left).collect();
        Self { time: of(&record.time), heading, residual: residual.to_vec() }
    }
}

/// Sum of the squares of what a fit leaves.
pub(super) fn square(fit: &Fit) -> f64 {
    fit.residual.iter().flatten().map(|e| e * e).sum()
}

/// The base, and the models that became of it term by term, the final one last: each is the next one without its last
/// term.
pub(super) fn way(search: &Search, base: &Model, model: &Model) -> Vec<Model> {
    let mut way = vec![model.clone()];
    for place in model.structure.places().skip(1).rev() {
        let less = search.dropped(&way[way.len() - 1], place, false);
        way.push(less);
    }
    if !model.structure.terms.is_empty() {
        way.push(base.clone());
    }
    way.reverse();
    way
}

/// What the models on the way leave.
pub(super) fn steps(way: &[Model], records: &[Record], held_out: &[HeldOut]) -> Vec<Step> {
    let step = |number: usize, model: &Model| {
        let before = number.checked_sub(1).map(|before| &way[before]);
        let count = model.plain.residual.iter().map(Vec::len).sum::<usize>();
        Step {
            added: before.and(model.structure.terms.last()).map(|term| term.name()),
            fitted: (square(&model.plain) / count as f64).sqrt(),
            held_out: held_out::errors(held_out, &model.structure, &model.plain).and_then(|errors| together(&errors)),
            gain: before.map(|before| before.plain.bic - model.plain.bic),
            records: records
                .iter()
                .zip(&model.plain.residual)
                .map(|(own, left)| StepOnRecord::new(own, left))
                .collect(),
        }
    };
    way.iter().enumerate().map(|(number, model)| step(number, model)).collect()
}

/// Root mean square heading error of all records together; `None` without a row.
fn together(errors: &[Errors]) -> Option<f64> {
    let rows: usize = errors.iter().map(|errors| errors.rows).sum();
    let square: f64 = errors.iter().map(|errors| errors.rows as f64 * errors.heading.powi(2)).sum();
    (rows > 0).then(|| (square / rows as f64).sqrt())
}
