//! Effects that are in the model because somebody asked for them.

use super::models::{Model, Search};
use super::trying::Tried;
use crate::index::{CandidatePlace, RecordNumber, TermPlace};
use crate::structure::Term;
use crate::wanted::EffectId;

/// An effect that was asked for and cannot be in the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotFitted(pub EffectId);

impl Search<'_> {
    /// The base with every effect that was asked for, each in the form of lowest BIC; a moment that depends on time is
    /// one of every record. Fails where the records allow no form of one.
    pub fn with_asked(&self, base: &Model) -> Result<Model, NotFitted> {
        let mut model = base.clone();
        let mut places = Vec::new();
        for &id in &self.wanted.with {
            if self.is_of_noise(id) {
                if base.plain.colour.waves.is_none() {
                    return Err(NotFitted(id));
                }
                continue;
            }
            let forms = |only: &Option<RecordNumber>| -> Vec<CandidatePlace> {
                let is = |term: &Term| term.effect.id() == id.as_str() && term.only == *only;
                let of_id = (0..self.candidates.len()).map(CandidatePlace);
                of_id.filter(|&place| is(&self.candidate(place).term)).collect()
            };
            let records = (0..base.structure.records).map(|record| Some(RecordNumber(record)));
            let groups: Vec<_> = std::iter::once(None).chain(records).map(|only| forms(&only)).collect();
            let groups: Vec<_> = groups.into_iter().filter(|forms| !forms.is_empty()).collect();
            if groups.is_empty() {
                return Err(NotFitted(id));
            }
            for forms in groups {
                model = self.plainly(self.best_form(&model, &forms).ok_or(NotFitted(id))?);
                places.push(forms);
            }
        }
        // A form was chosen before the company of the term was known.
        for (place, forms) in places.iter().enumerate().filter(|(_, forms)| forms.len() > 1) {
            let less = self.dropped(&model, TermPlace(place), false);
            let better = self.best_form(&less, forms).filter(|best| best.fit.bic < model.plain.bic);
            if let Some(better) = better.map(|best| self.plainly(best)) {
                model = self.moved_to(better, TermPlace(place));
            }
        }
        if model.structure.terms.is_empty() { Ok(model) } else { Ok(self.judge(model.structure, model.plain)) }
    }

    /// The best of some candidates on a model under plain noise.
    fn best_form(&self, model: &Model, forms: &[CandidatePlace]) -> Option<Tried> {
        let tried = self.try_these(model, &model.plain, forms.to_vec());
        tried.into_iter().find(|tried| tried.structure.terms.len() > model.structure.terms.len())
    }

    pub(super) fn plainly(&self, tried: Tried) -> Model {
        Model { structure: tried.structure, judged: tried.fit.clone(), plain: tried.fit }
    }

    /// The last term put at a place, which is where the rudder passes through it.
    fn moved_to(&self, model: Model, place: TermPlace) -> Model {
        let Some(last) = model.structure.places().next_back() else { return model };
        let mut structure = model.structure.without(last);
        structure.terms.insert(place.0, model.structure.term(last).clone());
        let mut theta = model.structure.drop_from(&model.plain.theta, last);
        let at = structure.range(place).start;
        theta.splice(at..at, model.plain.theta[model.structure.range(last)].iter().copied());
        let plain = self.problem.fit(&structure, &theta, &model.plain.initial, &model.plain.colour);
        Model { structure, judged: plain.clone(), plain }
    }
}
