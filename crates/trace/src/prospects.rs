//! Value of a planned trial: the aliases it would separate and the unobservable effects it would reveal.
//!
//! Expected posterior covariance of the full model: Gaussian experiment design (Chaloner and Verdinelli 1995).

use std::ops::Range;
use std::sync::Arc;

use document::names;
use document::trace::{CandidateOutcome, EffectEntry, TermEntry};
use nalgebra::DMatrix;
use rayon::prelude::*;
use trial::Trial;

use crate::analysis::Analysis;
use crate::fit::FittedRecords;
use crate::model::Term;
use crate::noise_law::NoiseLaw;
use crate::record::PreparedRecord;

/// Minimum expected visibility (squared coefficient over its variance) of a distinguishable effect.
const MIN_VISIBILITY: f64 = 20.0;

/// Value of a planned trial: the aliases it would separate and the effects it would reveal. Effects are named with
/// their form: "wind moment (steady wind)".
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedTrialValue {
    /// Name of the manoeuvre.
    pub name: String,
    /// Pairs (named effect, alias) that the records and this trial together would separate.
    pub separated_pairs: Vec<[String; 2]>,
    /// Pairs (named effect, alias) that would stay inseparable.
    pub inseparable_pairs: Vec<[String; 2]>,
    /// Unobservable effects that this trial would reveal.
    pub revealed_effects: Vec<String>,
    /// Effects that would stay unobservable.
    pub unobservable_effects: Vec<String>,
    /// Σ log(1 + visibility) over all candidates; ranks trials that separate and reveal equally many.
    pub information: f64,
}

impl Analysis {
    /// Values of planned trials, given the fitted records, the best first. A trial with a singular precision is left
    /// out.
    ///
    /// A planned trial is a simulated record of the fitted ship. Of its headings only the first value and the times are
    /// used.
    pub fn planned_trial_values(&self, planned: &[(String, Trial)]) -> Vec<PlannedTrialValue> {
        let mut values: Vec<PlannedTrialValue> =
            planned.par_iter().filter_map(|(name, trial)| self.planned_trial_value(name, trial)).collect();
        let rank = |value: &PlannedTrialValue| value.separated_pairs.len() + value.revealed_effects.len();
        values.sort_by(|a, b| rank(b).cmp(&rank(a)).then(b.information.total_cmp(&a.information)));
        values
    }

    fn planned_trial_value(&self, name: &str, trial: &Trial) -> Option<PlannedTrialValue> {
        let visibility = self.visibility_with(trial)?;
        let is_visible = |label: &String| visibility.iter().any(|(name, x)| name == label && *x > MIN_VISIBILITY);
        let pair = |effect: &EffectEntry, other: &TermEntry| {
            [(&effect.id, &effect.form), (&other.id, &other.form)].map(|(id, form)| names::effect_form_name(id, form))
        };
        let effects = self.document.effects.iter();
        let pairs = effects.flat_map(|effect| effect.alias_forms.iter().map(|other| pair(effect, other)));
        let (separated, inseparable) = pairs.partition(|pair| pair.iter().all(is_visible));
        let hidden = self.document.candidates.iter().flat_map(|candidate| {
            let forms = candidate.forms.iter();
            let hidden = forms.filter(|form| form.outcome == CandidateOutcome::NotObservable && form.only.is_none());
            hidden.map(|form| names::effect_form_name(&candidate.id, &form.form))
        });
        let (revealed, unobservable) = hidden.partition(is_visible);
        let information = visibility.iter().map(|(_, visibility)| visibility.ln_1p()).sum();
        Some(PlannedTrialValue {
            name: name.to_owned(),
            separated_pairs: separated,
            inseparable_pairs: inseparable,
            revealed_effects: revealed,
            unobservable_effects: unobservable,
            information,
        })
    }

    /// Expected visibility of every candidate of the ship from the records and another trial; `None` if the
    /// precision is singular.
    fn visibility_with(&self, trial: &Trial) -> Option<Vec<(String, f64)>> {
        let full = &self.full_model.fit;
        let (structure, theta) = full.structure.for_record(None, &full.theta);
        let record = PreparedRecord::averaged(trial, self.problem.ship_length_time);
        let problem = FittedRecords::new(vec![record], theta[0], self.problem.ship_length_time);
        let variance = self.full_model.noise_law.row_variance.iter().sum::<f64>()
            / self.full_model.noise_law.row_variance.len() as f64;
        let law =
            NoiseLaw { row_variance: vec![variance], likelihood_power: vec![1.0], ..self.full_model.noise_law.clone() };
        let initial = [trial.heading()[trial.observed_rows().next()?], 0.0];
        let (normal, _) = problem.linearise(&structure, &theta, &[initial]).normal_equations(&problem.whitening(&law));
        let fitted = full.record_covariance(None)?.try_inverse()?;
        let count = fitted.nrows();
        let mut precision = normal.matrix;
        precision.view_mut((0, 0), (count, count)).zip_apply(&fitted, |sum, fitted| *sum += fitted);
        let covariance = regular(precision)?;
        let places = structure.unknown_indices();
        let visibility = |(term, range): (&Arc<Term>, Range<usize>)| {
            let squares = range.zip(&term.priors).zip(term.neutral()).filter_map(|((place, prior), neutral)| {
                let place = places[place].filter(|_| !prior.is_shape)?;
                Some((prior.sd.powi(2) + (prior.mean - neutral).powi(2)) / covariance[(place, place)])
            });
            (names::effect_form_name(term.effect.id(), term.effect.form()), squares.fold(0.0, f64::max))
        };
        Some(structure.terms.iter().zip(structure.term_ranges()).map(visibility).collect())
    }
}

/// Inverse of a precision with a small ridge, which keeps the variance of an undetermined unknown finite; `None` if the
/// precision is singular.
fn regular(mut precision: DMatrix<f64>) -> Option<DMatrix<f64>> {
    for k in 0..precision.nrows() {
        precision[(k, k)] += 1e-12 * precision[(k, k)] + f64::MIN_POSITIVE;
    }
    Some(precision.cholesky()?.inverse())
}
