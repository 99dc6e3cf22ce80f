//! The missing moment of every fitted record, with the models that may explain it.

use rayon::prelude::*;
use ship::FirstOrder;

use super::result::Analysis;
use crate::fit::Fit;
use crate::index::RecordNumber;
use crate::missing_moment::{Explanation, MissingMoment};
use crate::structure::Structure;

/// Smallest heading noise that a smoother starts from, rad.
const FINEST: f64 = 1.75e-5;

impl Analysis {
    /// The yaw moment that the base lacks on every fitted record; `None` for a record of too few headings.
    ///
    /// Explanations are first the terms of the final model together, where it has any, then every candidate alone on
    /// the base, the best first.
    pub fn missing_moments(&self) -> Vec<Option<MissingMoment>> {
        let records = self.problem.records.par_iter().enumerate();
        records
            .map(|(number, record)| {
                let number = RecordNumber(number);
                let mut explanations = Vec::new();
                if self.has_terms() {
                    explanations.push(self.explanation(number, &self.told.structure, &self.told.fit));
                }
                let acts = |structure: &Structure| {
                    structure.terms.last().is_none_or(|term| term.only.is_none_or(|only| only == number))
                };
                let alone = self.tried.iter().filter(|tried| acts(&tried.structure));
                explanations.extend(alone.map(|tried| self.explanation(number, &tried.structure, &tried.fit)));
                let theta = &self.start.plain.theta;
                let rudder_bias = theta[2 + if self.start.structure.own_bias { number.0 } else { 0 }];
                let base = FirstOrder { inverse_T: theta[0], K_over_T: theta[1], rudder_bias };
                let sd = self.problem.noise_of_row(&self.model.judged).max(FINEST);
                MissingMoment::new(record, &base, sd, explanations)
            })
            .collect()
    }

    /// Whether the final model has terms beside the base.
    pub fn has_terms(&self) -> bool {
        !self.model.structure.terms.is_empty()
    }

    fn explanation(&self, record: RecordNumber, structure: &Structure, fit: &Fit) -> Explanation {
        let terms = structure.terms.iter().filter(|term| term.only.is_none_or(|only| only == record));
        let residuals = self.start.plain.residual[record.0].iter().zip(&fit.residual[record.0]);
        Explanation {
            effects: terms.map(|term| (term.effect.id(), term.effect.form())).collect(),
            heading: residuals.map(|(base, own)| base - own).collect(),
        }
    }
}
