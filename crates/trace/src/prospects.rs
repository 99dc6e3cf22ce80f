//! What another trial would tell: which aliases it would separate and which blind spots it would reveal.

use std::ops::Range;
use std::sync::Arc;

use document::names;
use document::trace::{EffectEntry, Outcome, TermEntry};
use nalgebra::DMatrix;
use rayon::prelude::*;
use trial::Trial;

use crate::analysis::Analysis;
use crate::fit::FittedRecords;
use crate::model::Term;
use crate::record::PreparedRecord;
use crate::weights::NoiseLaw;

/// Expected square of a size over its error from which an effect can be told from all others.
const TOLD: f64 = 20.0;

/// What another trial would tell. An effect is written with its form: "wind moment (steady wind)".
#[derive(Debug, Clone, PartialEq)]
pub struct Prospect {
    /// The manoeuvre.
    pub name: String,
    /// Rivals (the named effect, the other one) that this trial together with the records would tell apart.
    pub separated: Vec<[String; 2]>,
    /// Rivals it would not.
    pub still_alike: Vec<[String; 2]>,
    /// Effects that the records could not show and this trial would.
    pub revealed: Vec<String>,
    /// Effects that stay hidden.
    pub still_hidden: Vec<String>,
    /// Σ log(1 + expected squared size over error) of all candidates: what decides between trials that settle as many.
    pub information: f64,
}

impl Analysis {
    /// What each of some planned trials would tell beside the records, best first.
    ///
    /// A planned trial is a record of the fitted ship itself, made by the caller; only its rudder and its times count.
    pub fn prospects(&self, planned: &[(String, Trial)]) -> Vec<Prospect> {
        let mut prospects: Vec<Prospect> =
            planned.par_iter().filter_map(|(name, trial)| self.prospect(name, trial)).collect();
        let rank = |prospect: &Prospect| prospect.separated.len() + prospect.revealed.len();
        prospects.sort_by(|one, other| rank(other).cmp(&rank(one)).then(other.information.total_cmp(&one.information)));
        prospects
    }

    fn prospect(&self, name: &str, trial: &Trial) -> Option<Prospect> {
        let seen = self.seen_with(trial)?;
        let is_told = |label: &String| seen.iter().any(|(own, seen)| own == label && *seen > TOLD);
        let pair = |effect: &EffectEntry, other: &TermEntry| {
            [(&effect.id, &effect.form), (&other.id, &other.form)].map(|(id, form)| names::effect_form(id, form))
        };
        let effects = self.document.effects.iter();
        let rivals = effects.flat_map(|effect| effect.alias_forms.iter().map(|other| pair(effect, other)));
        let (separated, still_alike) = rivals.partition(|pair| pair.iter().all(is_told));
        let hidden = self.document.candidates.iter().flat_map(|candidate| {
            let forms = candidate.forms.iter();
            let hidden = forms.filter(|form| form.outcome == Outcome::NotObservable && form.only.is_none());
            hidden.map(|form| names::effect_form(&candidate.id, &form.form))
        });
        let (revealed, still_hidden) = hidden.partition(is_told);
        let information = seen.iter().map(|(_, seen)| seen.ln_1p()).sum();
        Some(Prospect { name: name.to_owned(), separated, still_alike, revealed, still_hidden, information })
    }

    /// Expected squared size over error of every candidate of the ship, from the records and another trial.
    fn seen_with(&self, trial: &Trial) -> Option<Vec<(String, f64)>> {
        let full = &self.full.fit;
        let (structure, theta) = full.structure.alone(None, &full.theta);
        let record = PreparedRecord::averaged(trial, self.problem.time);
        let problem = FittedRecords::new(vec![record], theta[0], self.problem.time);
        let variance = self.full.law.variance.iter().sum::<f64>() / self.full.law.variance.len() as f64;
        let law = NoiseLaw { variance: vec![variance], power: vec![1.0], ..self.full.law.clone() };
        let initial = [trial.heading()[trial.observed_rows().next()?], 0.0];
        let (normal, _) = problem.linear(&structure, &theta, &[initial]).normal(&problem.weights(&law));
        let known = full.kept_covariance(None)?.try_inverse()?;
        let count = known.nrows();
        let mut precision = normal.matrix;
        precision.view_mut((0, 0), (count, count)).zip_apply(&known, |own, known| *own += known);
        let covariance = regular(precision)?;
        let places = structure.unknowns();
        let seen = |(term, range): (&Arc<Term>, Range<usize>)| {
            let own = range.zip(&term.priors).zip(term.neutral()).filter_map(|((place, prior), neutral)| {
                let place = places[place].filter(|_| !prior.is_shape)?;
                Some((prior.sd.powi(2) + (prior.mean - neutral).powi(2)) / covariance[(place, place)])
            });
            (names::effect_form(term.effect.id(), term.effect.form()), own.fold(0.0, f64::max))
        };
        Some(structure.terms.iter().zip(structure.ranges()).map(seen).collect())
    }
}

/// Inverse of a precision that may lack an unknown.
fn regular(mut precision: DMatrix<f64>) -> Option<DMatrix<f64>> {
    for k in 0..precision.nrows() {
        precision[(k, k)] += 1e-12 * precision[(k, k)] + f64::MIN_POSITIVE;
    }
    Some(precision.cholesky()?.inverse())
}
