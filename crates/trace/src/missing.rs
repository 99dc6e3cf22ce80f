//! Missing moments of the fitted records, with the explaining models.

use std::sync::Arc;

use rayon::prelude::*;
use ship::effects::ParameterPrior;

use crate::analysis::Analysis;
use crate::candidates::is_alternative;
use crate::fit::StoppingRule;
use crate::full::start_point;
use crate::law::MIN_HEADING_SD_RAD;
use crate::missing_moment::{MissingMoment, RelativeResponse};
use crate::model::{Structure, TermName};

impl Analysis {
    /// Missing yaw moment of the base on every fitted record; `None` for a record with too few headings.
    ///
    /// The explanations are the structure average, if its most probable structure has terms, then every candidate
    /// without an instant, fitted alone with the base, the most probable first.
    pub fn missing_moments(&self) -> Vec<Option<MissingMoment>> {
        let structure = Structure::base(self.problem.records.len(), self.problem.ship_length_time);
        let whitening = self.problem.whitening(&self.full_model.noise_law);
        let initial: Vec<[f64; 2]> =
            self.identification.iter().map(|fitted| fitted.base_replay.replay.initial_state()).collect();
        let theta = |values: &mut dyn Iterator<Item = f64>| start_point(&structure, &self.base.response, values);
        let base = self.problem.residual(&structure, &theta(&mut std::iter::empty()), &initial);
        let probable = |name: &TermName| self.structures.probabilities.get(name).copied().unwrap_or(0.0);
        let mut alone: Vec<_> = self.candidates.iter().filter(|term| !is_alternative(term.effect.as_ref())).collect();
        alone.sort_by(|a, b| probable(&b.name()).total_cmp(&probable(&a.name())));
        let fits: Vec<(TermName, Vec<Vec<f64>>)> = alone
            .par_iter()
            .filter(|term| !term.effect.has_instant())
            .map(|term| {
                let structure = structure.with_terms(vec![Arc::clone(term)]);
                let mut values = term.priors.iter().map(|prior: &ParameterPrior| prior.mean);
                let fit =
                    self.problem.fit(&structure, theta(&mut values), initial.clone(), &whitening, StoppingRule::COARSE);
                (term.name(), fit.residual)
            })
            .collect();
        let model = self.structures.weighted_members();
        let missing = |number: usize| {
            let difference =
                |residual: &[f64]| base[number].iter().zip(residual).map(|(base, other)| base - other).collect();
            let mut explanations = Vec::new();
            if let Some((_, best)) = model.first().filter(|(_, fit)| !fit.structure.terms.is_empty()) {
                let acting = best.structure.terms.iter().filter(|term| term.record_index.is_none_or(|k| k == number));
                let effects = acting.map(|term| (term.effect.id(), term.effect.form())).collect();
                let rows = self.problem.records[number].observed_rows.len();
                let mut mean = vec![0.0; rows];
                for (weight, fit) in &model {
                    mean.iter_mut().zip(&fit.residual[number]).for_each(|(sum, e)| *sum += weight * e);
                }
                explanations.push(RelativeResponse { effects, heading: difference(&mean) });
            }
            let here = fits.iter().filter(|((_, _, record), _)| record.is_none_or(|record| record == number));
            explanations.extend(here.map(|((id, form, _), residual)| RelativeResponse {
                effects: vec![(*id, *form)],
                heading: difference(&residual[number]),
            }));
            let sd = self.full_model.noise_law.row_variance[number].sqrt().max(MIN_HEADING_SD_RAD);
            MissingMoment::new(&self.problem.records[number], &self.base.response, sd, explanations)
        };
        (0..self.problem.records.len()).into_par_iter().map(missing).collect()
    }
}
