//! Models under the noise that suits them best, and their evidence against each other.

use std::sync::OnceLock;

use rayon::prelude::*;
use ship::effects::{Effect, WaveYaw};
use ship::narrow_band::NarrowBand;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::evidence::{Evidence, Thresholds};
use super::ledger::Ledger;
use crate::candidates::Candidate;
use crate::fit::{Fit, Linear, Problem};
use crate::index::TermPlace;
use crate::noise::{Colour, Wander};
use crate::structure::{Structure, Term};
use crate::wanted::{EffectId, Wanted};
use crate::waves;

/// A structure with its fit under the noise that suits it best.
#[derive(Debug, Clone)]
pub struct Model {
    /// Structure.
    pub structure: Structure,
    /// Fit under white noise (and waves): what minimises the heading error.
    pub plain: Fit,
    /// Fit under the noise of lowest BIC; the same as `plain` when no random moment is worth its parameter.
    pub judged: Fit,
}

/// A trend needs this many times the gain of another term: in one record a random moment has one, too.
const TREND: f64 = 1.4;

/// A term that comes or goes at an instant needs this many times the gain: a random moment has many instants.
const LOCATED: f64 = 2.0;

/// A term without a name that lets stand a random moment needs this many times the gain.
pub const NAMELESS: f64 = 2.5;

/// Search over one problem.
pub struct Search<'a> {
    /// Records.
    pub problem: &'a Problem,
    /// What may be missing.
    pub candidates: &'a [Candidate],
    /// When to believe it.
    pub thresholds: Thresholds,
    /// What is asked for and what excluded.
    pub wanted: Wanted,
    /// What was tried so far.
    pub ledger: Ledger,
    /// Kinds of random moment that are worth a look, from the first model that was judged.
    kinds: OnceLock<Vec<Wander>>,
}

/// A term of a model, held against the model without it.
#[derive(Debug, Clone)]
pub struct Tested {
    /// The term.
    pub place: TermPlace,
    /// How much it explains.
    pub evidence: Evidence,
    /// The model without it, fitted anew.
    pub less: Model,
}

impl<'a> Search<'a> {
    /// A search for whatever may be missing.
    pub fn new(problem: &'a Problem, candidates: &'a [Candidate], thresholds: Thresholds) -> Self {
        Self {
            problem,
            candidates,
            thresholds,
            wanted: Wanted::default(),
            ledger: Ledger::default(),
            kinds: OnceLock::new(),
        }
    }
}

impl Search<'_> {
    pub(super) fn log_n(&self) -> f64 {
        (self.problem.observations() as f64).ln()
    }

    /// Evidence of `freedom` parameters that lead from one fit to another.
    pub fn evidence(&self, without: &Fit, with: &Fit, freedom: usize) -> Evidence {
        let ratio = (without.deviance + without.lost - with.deviance - with.lost).max(0.0);
        let chance = ChiSquared::new(freedom as f64).map_or(1.0, |chi| chi.sf(ratio));
        Evidence { gain: without.bic - with.bic, p_value: (chance * self.candidates.len() as f64).min(1.0) }
    }

    /// How many times the gain of a plain term a term needs.
    fn times(term: &Term) -> f64 {
        match (term.effect.has_instant(), term.effect.is_of_time()) {
            (true, _) => LOCATED,
            (false, true) => TREND,
            (false, false) => 1.0,
        }
    }

    /// Gain in BIC that a term needs.
    pub fn needed(&self, term: &Term) -> f64 {
        Self::times(term) * self.thresholds.gain
    }

    /// Whether evidence passes both thresholds, where so many times the gain of a plain term is needed.
    pub fn passes(&self, evidence: &Evidence, times: f64) -> bool {
        evidence.gain > times * self.thresholds.gain && evidence.p_value < self.thresholds.false_discovery
    }

    /// Whether the evidence for a term passes both thresholds.
    pub fn believes(&self, term: &Term, evidence: &Evidence) -> bool {
        self.passes(evidence, Self::times(term))
    }

    /// The base, fitted and judged.
    pub fn base(&self, structure: Structure, theta: &[f64], initial: &[[f64; 2]]) -> Model {
        let plain = self.problem.fit(&structure, theta, initial, &Colour::WHITE);
        self.with_waves(self.judge(structure, plain))
    }

    /// Whether an effect is a colour of the noise.
    pub(super) fn is_of_noise(&self, id: EffectId) -> bool {
        id.as_str() == WaveYaw.id()
    }

    /// A model with the waves that its residual shows, if they are worth their three parameters or asked for.
    fn with_waves(&self, model: Model) -> Model {
        if !self.wanted.allows(WaveYaw.id()) {
            return model;
        }
        // A random moment imitates waves badly but well enough to hide them: they are looked for without one, too.
        let mut besides = vec![Colour::WHITE];
        besides.extend(Some(Colour { waves: None, ..model.judged.colour }).filter(|moment| !moment.is_white()));
        let best = besides
            .iter()
            .filter_map(|beside| waves::find(self.problem, &model.plain.residual, beside))
            .map(|waves| self.coloured(&model, Some(waves)))
            .min_by(|one, other| one.judged.bic.total_cmp(&other.judged.bic));
        match best {
            Some(with) if self.needs_waves(&with, &model) => with,
            _ => model,
        }
    }

    /// Whether a model with waves stands against the same without them, or has them on request.
    fn needs_waves(&self, with: &Model, calm: &Model) -> bool {
        self.wanted.asks_for(WaveYaw.id()) || calm.judged.bic - with.judged.bic > self.thresholds.gain
    }

    /// A model fitted anew with or without waves.
    pub fn coloured(&self, model: &Model, waves: Option<NarrowBand>) -> Model {
        let Model { structure, plain, .. } = model;
        let plain = self.problem.fit(structure, &plain.theta, &plain.initial, &Colour { wander: None, waves });
        self.judge(structure.clone(), plain)
    }

    /// Asks again whether there are waves, once the terms are known.
    pub(super) fn revise_waves(&self, model: Model) -> Model {
        if model.judged.colour.waves.is_none() {
            return if model.structure.terms.is_empty() { model } else { self.with_waves(model) };
        }
        let calm = self.coloured(&model, None);
        if self.needs_waves(&model, &calm) { model } else { calm }
    }

    fn linear(&self, structure: &Structure, fit: &Fit) -> Linear {
        self.problem.linear(structure, &fit.theta, &fit.initial)
    }

    /// The best random moment of the kinds that are worth a look, with its −2 log L after a linear step and what it
    /// takes from the price of the unknowns.
    fn best_moment(&self, linear: &Linear, waves: Option<NarrowBand>) -> (Colour, f64) {
        let kinds = self.kinds.get_or_init(|| self.problem.kinds(linear, waves));
        self.problem.best_of(linear, kinds, waves).unwrap_or((Colour { wander: None, waves }, f64::INFINITY))
    }

    /// Kinds of random moment that are worth a look, once a first model was judged.
    pub(super) fn kinds(&self) -> &[Wander] {
        self.kinds.get().map_or(&[Wander::White, Wander::Walk], Vec::as_slice)
    }

    /// Finds the noise that suits a plainly fitted structure best.
    pub fn judge(&self, structure: Structure, plain: Fit) -> Model {
        let mut judged = plain.clone();
        if plain.rss.is_finite() {
            let waves = plain.colour.waves;
            let (mut colour, deviance) = self.best_moment(&self.linear(&structure, &plain), waves);
            let mut start = plain.clone();
            let mut reached = deviance;
            // Level and parameters are found in turn. A random moment that does not pay for its one parameter is not
            // tried.
            for _ in 0..2 {
                let price = colour.wander.map_or(0, |(kind, _)| kind.freedom()) as f64 * self.log_n();
                if reached + price >= plain.deviance + plain.lost {
                    break;
                }
                let fit = self.problem.fit(&structure, &start.theta, &start.initial, &colour);
                if fit.bic < judged.bic {
                    judged = fit.clone();
                }
                (colour, reached) = self.best_moment(&self.linear(&structure, &fit), waves);
                start = fit;
            }
        }
        self.ledger.note(&structure, &judged, true);
        Model { structure, plain, judged }
    }

    /// A model without one of its terms, fitted anew.
    pub fn dropped(&self, model: &Model, place: TermPlace, under_moment: bool) -> Model {
        let structure = model.structure.without(place);
        let theta = model.structure.drop_from(&model.plain.theta, place);
        let colour = Colour { wander: None, waves: model.plain.colour.waves };
        let plain = self.problem.fit(&structure, &theta, &model.plain.initial, &colour);
        if !under_moment {
            return Model { structure, judged: plain.clone(), plain };
        }
        let mut less = self.judge(structure, plain);
        if !model.judged.colour.is_white() {
            let theta = model.structure.drop_from(&model.judged.theta, place);
            let under = self.problem.fit(&less.structure, &theta, &model.judged.initial, &model.judged.colour);
            self.ledger.note(&less.structure, &under, false);
            if under.bic < less.judged.bic {
                less.judged = under;
            }
        }
        less
    }

    /// Some terms of a model, each tested against the model without it.
    pub fn tested(
        &self,
        model: &Model,
        places: impl IntoIterator<Item = TermPlace>,
        under_moment: bool,
    ) -> Vec<Tested> {
        let places: Vec<TermPlace> = places.into_iter().collect();
        places
            .into_par_iter()
            .map(|place| {
                let less = self.dropped(model, place, under_moment);
                let with = if under_moment { &model.judged } else { &model.plain };
                let evidence = self.evidence(&less.judged, with, model.structure.term(place).freedom());
                Tested { place, evidence, less }
            })
            .collect()
    }
}
