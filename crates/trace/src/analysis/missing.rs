//! The missing moment of every fitted record, with the models that may explain it.

use rayon::prelude::*;
use ship::FirstOrder;

use super::result::Analysis;
use crate::fit::Fit;
use crate::index::RecordNumber;
use crate::missing_moment::{Explanation, MissingMoment};
use crate::structure::{SpeedScaling, Structure, Term};

/// Smallest heading noise that a smoother starts from, rad.
const FINEST: f64 = 1.75e-5;

impl Analysis {
    /// The yaw moment that a base of constant K and T lacks on every fitted record; `None` for a record of too few
    /// headings.
    ///
    /// Explanations are first the final model, where it is more than that, then every candidate alone on the base, the
    /// best first.
    pub fn missing_moments(&self) -> Vec<Option<MissingMoment>> {
        let records = self.problem.records.par_iter().enumerate();
        records
            .map(|(number, record)| {
                let number = RecordNumber(number);
                let mut explanations = Vec::new();
                if self.explains_something() {
                    explanations.push(self.explanation(number, &self.told.structure, &self.told.fit));
                }
                let acts = |structure: &Structure| {
                    structure.terms.last().is_none_or(|term| term.only.is_none_or(|only| only == number))
                };
                let alone = self.tried.iter().filter(|tried| acts(&tried.structure));
                explanations.extend(alone.map(|tried| self.explanation(number, &tried.structure, &tried.fit)));
                let theta = &self.constant.plain.theta;
                let rudder_bias = theta[2 + if self.constant.structure.own_bias { number.0 } else { 0 }];
                let base = FirstOrder { inverse_T: theta[0], K_over_T: theta[1], rudder_bias };
                let sd = self.problem.noise_of_row(&self.model.judged).max(FINEST);
                MissingMoment::new(record, &base, sd, explanations)
            })
            .collect()
    }

    /// Whether the final model is more than a base of constant K and T.
    pub fn explains_something(&self) -> bool {
        !self.told.structure.is_constant()
    }

    fn explanation(&self, record: RecordNumber, structure: &Structure, fit: &Fit) -> Explanation {
        let scaled = structure.scaled().map(SpeedScaling::name).into_iter();
        let terms = structure.terms.iter().filter(|term| term.only.is_none_or(|only| only == record));
        let residuals = self.constant.plain.residual[record.0].iter().zip(&fit.residual[record.0]);
        Explanation {
            effects: scaled.chain(terms.map(Term::name)).map(|(id, form, _)| (id, form)).collect(),
            heading: residuals.map(|(base, own)| base - own).collect(),
        }
    }
}
