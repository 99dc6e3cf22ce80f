//! Stepwise replay errors from the base to the most probable structure, one effect per step, by backward elimination
//! (Draper and Smith 1998).
//!
//! Every step is refitted under white noise, which gives the replay with the least heading error. The term whose
//! removal raises this error least is removed first, so the last step adds the least important effect.

use rayon::prelude::*;

use crate::analysis::Analysis;
use crate::fit::{StoppingRule, StructureFit};
use crate::model::TermName;
use crate::noise::NoiseColour;
use crate::noise_law::NoiseLaw;

/// Nested models from the base to the most probable structure, one term added per step.
#[derive(Debug, Clone)]
pub struct InclusionPath {
    /// Times of the observed rows of the first record, s.
    pub row_times: Vec<f64>,
    /// Steps, the base first.
    pub steps: Vec<InclusionStep>,
}

/// Step of an inclusion path: the term it adds, and the replay error of the model with it.
#[derive(Debug, Clone)]
pub struct InclusionStep {
    /// Term added to the step before; `None` for the base.
    pub term: Option<TermName>,
    /// Root mean square heading error over the rows of all fitted records, rad.
    pub heading_rmse: f64,
    /// Heading residual (measured minus replayed) of the first record, rad.
    pub heading_residual: Vec<f64>,
}

impl InclusionStep {
    fn new(term: Option<TermName>, fit: &StructureFit) -> Self {
        Self { term, heading_rmse: root_mean_square(fit), heading_residual: fit.residual[0].clone() }
    }
}

fn root_mean_square(fit: &StructureFit) -> f64 {
    let rows = fit.residual.iter().map(Vec::len).sum::<usize>() as f64;
    (fit.residual.iter().flatten().map(|e| e * e).sum::<f64>() / rows).sqrt()
}

impl Analysis {
    /// Steps to the most probable structure; `None` if it has no terms, or if an error is not finite.
    pub fn inclusion_path(&self) -> Option<InclusionPath> {
        let problem = &self.problem;
        let best = &self.structures.weighed.first().filter(|best| !best.fit.structure.terms.is_empty())?.fit;
        let law = NoiseLaw { colour: NoiseColour::WHITE, ..self.full_model.noise_law.clone() };
        let whitening = problem.whitening(&law);
        let mut fit =
            problem.fit(&best.structure, best.theta.clone(), best.initial.clone(), &whitening, StoppingRule::FINE);
        let mut steps = Vec::new();
        while !fit.structure.terms.is_empty() {
            let places = 0..fit.structure.terms.len();
            let without = |out: usize| (out, fit.refit_without(out, problem, &whitening, StoppingRule::FINE));
            let fewer: Vec<(usize, StructureFit)> = places.into_par_iter().map(without).collect();
            let nearest = |(_, a): &(usize, StructureFit), (_, b): &(usize, StructureFit)| {
                root_mean_square(a).total_cmp(&root_mean_square(b))
            };
            let (out, next) = fewer.into_iter().min_by(nearest)?;
            steps.push(InclusionStep::new(Some(fit.structure.terms[out].name()), &fit));
            fit = next;
        }
        steps.push(InclusionStep::new(None, &fit));
        steps.reverse();
        let record = &problem.records[0];
        let time = record.observed_rows.iter().map(|&row| record.time[row]).collect();
        steps.iter().all(|step| step.heading_rmse.is_finite()).then_some(InclusionPath { row_times: time, steps })
    }
}
