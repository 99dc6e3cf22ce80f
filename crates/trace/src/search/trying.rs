//! Candidates tried on a model: all of them, or those that its sensitivities recommend.

use std::borrow::Cow;

use rayon::prelude::*;
use ship::effects::{Effect, NonlinearDamping};

use super::evidence::Evidence;
use super::models::{Model, Search};
use crate::candidates::Candidate;
use crate::fit::{Column, Fit, Linearised, acts};
use crate::index::CandidatePlace;
use crate::noise::Colour;
use crate::structure::{Structure, Term};
use crate::transient;

/// How a candidate did.
#[derive(Debug, Clone)]
pub struct Tried {
    /// Which candidate.
    pub candidate: CandidatePlace,
    /// Structure with it.
    pub structure: Structure,
    /// Its fit, under the colour of the fit it is compared with.
    pub fit: Fit,
    /// Its evidence against that fit.
    pub evidence: Evidence,
}

/// Later rounds fit only this many candidates, those with the largest score.
const SHORT_LIST: usize = 6;

impl Search<'_> {
    /// The candidate at a place of the list.
    pub fn candidate(&self, place: CandidatePlace) -> &Candidate {
        &self.candidates[place.0]
    }

    /// Whether a structure has no place for one more term: it has the same effect already (damping by side stands
    /// beside any other damping), or another moment that depends on time. Several of those would be a random moment,
    /// written as a sum.
    pub(super) fn excludes(&self, structure: &Structure, term: &Term) -> bool {
        let by_side = |term: &Term| term.effect.form() == NonlinearDamping::Square.form();
        structure.terms.iter().any(|other| {
            other.only == term.only
                && (other.is(term)
                    || (other.effect.id() == term.effect.id() && !by_side(term) && !by_side(other))
                    || (term.effect.is_of_time() && other.effect.is_of_time()))
        })
    }

    /// Fits a model with one more term from every start of a candidate, under the colour of `from`, a fit of the model.
    fn with_term(&self, model: &Model, candidate: &Candidate, from: &Fit, known: &Linearised) -> (Structure, Fit) {
        let structure = model.structure.with(candidate.term.clone());
        let best = self
            .starts(candidate, from, known)
            .iter()
            .map(|start| self.problem.fit_with(&structure, start, from, known))
            .min_by(|one, other| one.deviance.total_cmp(&other.deviance));
        match best {
            Some(fit) => (structure, fit),
            None => (model.structure.clone(), from.clone()),
        }
    }

    fn starts<'b>(&self, candidate: &'b Candidate, from: &Fit, known: &Linearised) -> Cow<'b, [Vec<f64>]> {
        if candidate.starts.is_empty() {
            Cow::Owned(transient::starts(self.problem, from, known, &candidate.term))
        } else {
            Cow::Borrowed(&candidate.starts)
        }
    }

    /// Approximate gain in −2 log L of a candidate from the sensitivities at a fit: a score test that needs no refit.
    fn score(&self, model: &Model, fit: &Fit, known: &Linearised, candidate: &Candidate) -> f64 {
        self.starts(candidate, fit, known)
            .iter()
            .map(|start| self.gain_of(known, &self.columns_at(model, fit, known, &candidate.term, start)))
            .fold(0.0, f64::max)
    }

    /// What a term at a start does to the heading, and how that changes with its parameters.
    pub(super) fn columns_at(
        &self,
        model: &Model,
        fit: &Fit,
        known: &Linearised,
        term: &Term,
        start: &[f64],
    ) -> Vec<Column> {
        let structure = model.structure.with(term.clone());
        let theta = [fit.theta.as_slice(), start].concat();
        let (presence, mut new) = self.problem.columns_of_last(&structure, &theta, &fit.initial, &known.headings);
        if acts(&presence) {
            new.insert(0, presence);
        }
        new
    }

    /// Fall of −2 log L that columns promise beside the sensitivities of a fit.
    pub(super) fn gain_of(&self, known: &Linearised, new: &[Column]) -> f64 {
        let own = known.columns.unknowns();
        let mut columns = known.columns.clone();
        columns.insert(own, new, &known.whiteners);
        let normal = columns.normal(&known.white);
        let deviance = |unknowns| self.problem.deviance(normal.projected(unknowns), 0.0);
        deviance(own) - deviance(columns.unknowns())
    }

    /// Tries candidates on one fit of a model, all under the colour of that fit; with `short_list` only those with the
    /// best scores are fitted. The lowest BIC comes first.
    pub fn try_all(&self, model: &Model, fit: &Fit, short_list: bool) -> Vec<Tried> {
        let known = Linearised::new(self.problem, &model.structure, fit);
        let mut places: Vec<CandidatePlace> = (0..self.candidates.len())
            .map(CandidatePlace)
            .filter(|&place| !self.excludes(&model.structure, &self.candidate(place).term))
            .collect();
        if short_list {
            let mut scored: Vec<(f64, CandidatePlace)> = places
                .par_iter()
                .map(|&place| (self.score(model, fit, &known, self.candidate(place)), place))
                .collect();
            scored.sort_by(|one, other| other.0.total_cmp(&one.0));
            places = scored.into_iter().take(SHORT_LIST).map(|(_, place)| place).collect();
        }
        self.try_on(model, fit, places, &known)
    }

    /// Tries some candidates on one fit of a model, lowest BIC first.
    pub(super) fn try_these(&self, model: &Model, fit: &Fit, places: Vec<CandidatePlace>) -> Vec<Tried> {
        self.try_on(model, fit, places, &Linearised::new(self.problem, &model.structure, fit))
    }

    fn try_on(&self, model: &Model, fit: &Fit, places: Vec<CandidatePlace>, known: &Linearised) -> Vec<Tried> {
        let mut tried: Vec<Tried> = places
            .into_par_iter()
            .map(|place| {
                let candidate = self.candidate(place);
                let (structure, with) = self.with_term(model, candidate, fit, known);
                let evidence = self.evidence(fit, &with, candidate.term.freedom());
                self.ledger.note(&structure, &with, false);
                Tried { candidate: place, structure, fit: with, evidence }
            })
            .collect();
        tried.sort_by(|one, other| one.fit.bic.total_cmp(&other.fit.bic));
        tried
    }

    /// Whether a candidate that was tried on a model as if the noise were white is believed when both have the noise
    /// that suits them best.
    pub fn stands(&self, model: &Model, tried: &Tried) -> bool {
        let with = self.judge(tried.structure.clone(), tried.fit.clone());
        let term = &self.candidate(tried.candidate).term;
        self.believes(term, &self.evidence(&model.judged, &with.judged, term.freedom()))
    }

    /// The model of a candidate that was tried, with the noise that suits it best.
    pub fn adopted(&self, tried: &Tried) -> Model {
        self.judged_from(&tried.structure, &tried.fit)
    }

    /// The model of a structure that was fitted under some noise, with the noise that suits it best.
    pub(super) fn judged_from(&self, structure: &Structure, fit: &Fit) -> Model {
        if fit.colour.wander.is_none() {
            return self.judge(structure.clone(), fit.clone());
        }
        let colour = Colour { wander: None, ..fit.colour };
        let plain = self.problem.fit(structure, &fit.theta, &fit.initial, &colour);
        let mut model = self.judge(structure.clone(), plain);
        if fit.bic < model.judged.bic {
            model.judged = fit.clone();
        }
        model
    }
}
