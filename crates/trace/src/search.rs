//! The search for what is missing: terms are added one at a time, needless ones dropped again, and what remains has to
//! explain the records better than the best random moment.
//!
//! First as if the noise were white (or white with waves): the candidate with the lowest BIC is added while it gains more
//! than the threshold. Then every term so found is confronted with the random moments of [`crate::noise`]: it stays if its
//! likelihood ratio against the model without it, each with the noise that suits it best, passes the threshold. If a random
//! moment is still needed, terms are looked for once more under it.

use std::borrow::Cow;

use rayon::prelude::*;
use ship::effects::{Effect, NonlinearDamping};
use ship::narrow_band::NarrowBand;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::candidates::Candidate;
use crate::fit::{Column, Columns, Fit, Linear, Problem};
use crate::noise::{Colour, Moment, Whitener};
use crate::record::Record;
use crate::structure::{Structure, Term};
use crate::{transient, waves};

/// What decides whether a term is believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds {
    /// Smallest gain in BIC (Kass and Raftery 1995: above 10 is very strong).
    pub gain: f64,
    /// Probability of naming any effect where there is none, shared by all candidates (Bonferroni).
    pub false_discovery: f64,
    /// Most terms.
    pub most_terms: usize,
}

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

/// How much a term explains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// BIC without it less BIC with it.
    pub gain: f64,
    /// Probability of a likelihood ratio as large by chance, times the number of candidates.
    pub p_value: f64,
}

/// How a candidate did.
#[derive(Debug, Clone)]
pub struct Tried {
    /// The candidate's place in the list.
    pub place: usize,
    /// Structure with it.
    pub structure: Structure,
    /// Its fit, under the colour of the fit it is compared with.
    pub fit: Fit,
    /// Its evidence against that fit.
    pub evidence: Evidence,
}

/// Later rounds fit only this many candidates, those with the largest score.
const SHORT_LIST: usize = 6;

/// A moment that depends on time alone needs this many times the gain of another term.
const OF_TIME: f64 = 2.5;

/// Gain in BIC for which one term takes the place of another.
const SWAP: f64 = 2.0;

/// What is known of a fit and shared by all candidates that are tried on it.
pub struct Known {
    /// Filters of its colour.
    pub whiteners: Vec<Whitener>,
    /// Whitened sensitivities.
    pub columns: Columns,
    /// Whitened residual.
    pub white: Vec<Vec<f64>>,
    /// Replayed headings, rad.
    pub headings: Vec<Vec<f64>>,
}

/// Search over one problem.
pub struct Search<'a> {
    /// Records.
    pub problem: &'a Problem,
    /// What may be missing.
    pub candidates: &'a [Candidate],
    /// When to believe it.
    pub thresholds: Thresholds,
}

impl Search<'_> {
    fn log_n(&self) -> f64 {
        (self.problem.observations() as f64).ln()
    }

    /// Evidence of `freedom` parameters that lead from one fit to another.
    pub fn evidence(&self, without: &Fit, with: &Fit, freedom: usize) -> Evidence {
        let ratio = (without.deviance - with.deviance).max(0.0);
        let chance = ChiSquared::new(freedom as f64).map_or(1.0, |chi| chi.sf(ratio));
        Evidence { gain: without.bic - with.bic, p_value: (chance * self.candidates.len() as f64).min(1.0) }
    }

    /// Gain in BIC that a term needs: a trend, or a moment for a while, is also what a random moment looks like in one record.
    pub fn needed(&self, term: &Term) -> f64 {
        if term.effect.is_of_time() { OF_TIME * self.thresholds.gain } else { self.thresholds.gain }
    }

    /// Whether the evidence for a term passes both thresholds.
    pub fn believes(&self, term: &Term, evidence: &Evidence) -> bool {
        evidence.gain > self.needed(term) && evidence.p_value < self.thresholds.false_discovery
    }

    /// Whether a structure has no place for one more term: it has the same effect already (damping by side stands beside
    /// any other damping), or another moment that depends on time. Several of those would be a random moment, written as
    /// a sum.
    fn excludes(&self, structure: &Structure, term: &Term) -> bool {
        let by_side = |term: &Term| term.effect.form() == NonlinearDamping::Square.form();
        structure.terms.iter().any(|other| {
            other.only == term.only
                && (other.is(term)
                    || (other.effect.id() == term.effect.id() && !by_side(term) && !by_side(other))
                    || (term.effect.is_of_time() && other.effect.is_of_time()))
        })
    }

    /// The base, fitted and judged.
    pub fn base(&self, structure: Structure, theta: &[f64], initial: &[[f64; 2]]) -> Model {
        let plain = self.problem.fit(&structure, theta, initial, &Colour::WHITE);
        self.with_waves(self.judge(structure, plain))
    }

    /// A model with the waves that its residual shows, if they are worth their three parameters.
    fn with_waves(&self, model: Model) -> Model {
        // A random moment imitates waves badly but well enough to hide them: they are looked for without one, too.
        let mut besides = vec![Colour::WHITE];
        besides.extend(Some(Colour { waves: None, ..model.judged.colour }).filter(|moment| !moment.is_white()));
        let best = besides
            .iter()
            .filter_map(|beside| waves::find(self.problem, &model.plain.residual, beside))
            .map(|waves| self.coloured(&model, Some(waves)))
            .min_by(|one, other| one.judged.bic.total_cmp(&other.judged.bic));
        match best {
            Some(with) if model.judged.bic - with.judged.bic > self.thresholds.gain => with,
            _ => model,
        }
    }

    /// A model fitted anew with or without waves.
    pub fn coloured(&self, model: &Model, waves: Option<NarrowBand>) -> Model {
        let Model { structure, plain, .. } = model;
        let plain = self.problem.fit(structure, &plain.theta, &plain.initial, &Colour { moment: None, waves });
        self.judge(structure.clone(), plain)
    }

    /// Asks again whether there are waves, once the terms are known.
    fn revise_waves(&self, model: Model) -> Model {
        if model.judged.colour.waves.is_none() {
            return if model.structure.terms.is_empty() { model } else { self.with_waves(model) };
        }
        let calm = self.coloured(&model, None);
        if calm.judged.bic - model.judged.bic > self.thresholds.gain { model } else { calm }
    }

    fn linear(&self, structure: &Structure, fit: &Fit) -> Linear {
        self.problem.linear(structure, &fit.theta, &fit.initial)
    }

    fn known(&self, structure: &Structure, fit: &Fit) -> Known {
        let whiteners = self.problem.whiteners(&fit.colour);
        let linear = self.linear(structure, fit);
        let replayed = |(record, residual): (&Record, &Vec<f64>)| {
            record.observed.iter().zip(residual).map(|(&row, e)| record.heading[row] - e).collect()
        };
        Known {
            columns: linear.whitened(&whiteners),
            white: linear.whitened_residual(&whiteners),
            headings: self.problem.records.iter().zip(&fit.residual).map(replayed).collect(),
            whiteners,
        }
    }

    /// The better of the two random moments, and its deviance after a linear step.
    fn best_moment(&self, linear: &Linear, waves: Option<NarrowBand>) -> (Colour, f64) {
        let one = self.problem.best_moment(linear, Moment::White, waves);
        let other = self.problem.best_moment(linear, Moment::Walk, waves);
        if one.1 <= other.1 { one } else { other }
    }

    /// Finds the noise that suits a plainly fitted structure best.
    pub fn judge(&self, structure: Structure, plain: Fit) -> Model {
        let mut judged = plain.clone();
        if plain.rss.is_finite() {
            let waves = plain.colour.waves;
            let (mut colour, deviance) = self.best_moment(&self.linear(&structure, &plain), waves);
            let mut start = plain.clone();
            let mut reached = deviance;
            // Level and parameters are found in turn. A random moment that does not pay for its one parameter is not tried.
            for _ in 0..2 {
                if reached + self.log_n() >= plain.deviance {
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
        Model { structure, plain, judged }
    }

    /// Fits a model with one more term from every start of a candidate, under the colour of `from`, a fit of the model.
    fn with_term(&self, model: &Model, candidate: &Candidate, from: &Fit, known: &Known) -> (Structure, Fit) {
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

    fn starts<'b>(&self, candidate: &'b Candidate, from: &Fit, known: &Known) -> Cow<'b, [Vec<f64>]> {
        if candidate.starts.is_empty() {
            Cow::Owned(transient::starts(self.problem, from, known, &candidate.term))
        } else {
            Cow::Borrowed(&candidate.starts)
        }
    }

    /// Approximate gain in −2 log L of a candidate from the sensitivities at a fit: a score test that needs no refit.
    fn score(&self, model: &Model, fit: &Fit, known: &Known, candidate: &Candidate) -> f64 {
        let structure = model.structure.with(candidate.term.clone());
        let own = known.columns.unknowns();
        self.starts(candidate, fit, known)
            .iter()
            .map(|start| {
                let theta = [fit.theta.as_slice(), start].concat();
                let (being, mut new) = self.problem.columns_of_last(&structure, &theta, &fit.initial, &known.headings);
                if acts(&being) {
                    new.insert(0, being);
                }
                let mut columns = known.columns.clone();
                columns.insert(own, &new, &known.whiteners);
                let normal = columns.normal(&known.white);
                let deviance = |unknowns| self.problem.deviance(normal.projected(unknowns), 0.0);
                deviance(own) - deviance(columns.unknowns())
            })
            .fold(0.0, f64::max)
    }

    /// Tries candidates on one fit of a model, all under the colour of that fit; with `short_list` only those with the
    /// best scores are fitted. The lowest BIC comes first.
    pub fn try_all(&self, model: &Model, fit: &Fit, short_list: bool) -> Vec<Tried> {
        let known = self.known(&model.structure, fit);
        let mut places: Vec<usize> = (0..self.candidates.len())
            .filter(|&k| !self.excludes(&model.structure, &self.candidates[k].term))
            .collect();
        if short_list {
            let mut scored: Vec<(f64, usize)> = places
                .par_iter()
                .map(|&place| (self.score(model, fit, &known, &self.candidates[place]), place))
                .collect();
            scored.sort_by(|one, other| other.0.total_cmp(&one.0));
            places = scored.into_iter().take(SHORT_LIST).map(|(_, place)| place).collect();
        }
        let mut tried: Vec<Tried> = places
            .into_par_iter()
            .map(|place| {
                let candidate = &self.candidates[place];
                let (structure, with) = self.with_term(model, candidate, fit, &known);
                let evidence = self.evidence(fit, &with, candidate.term.freedom());
                Tried { place, structure, fit: with, evidence }
            })
            .collect();
        tried.sort_by(|one, other| one.fit.bic.total_cmp(&other.fit.bic));
        tried
    }

    /// The model of a candidate that was tried, with the noise that suits it best.
    pub fn adopted(&self, tried: &Tried) -> Model {
        let Tried { structure, fit, .. } = tried;
        if fit.colour.moment.is_none() {
            return self.judge(structure.clone(), fit.clone());
        }
        let colour = Colour { moment: None, ..fit.colour };
        let plain = self.problem.fit(structure, &fit.theta, &fit.initial, &colour);
        let mut model = self.judge(structure.clone(), plain);
        if fit.bic < model.judged.bic {
            model.judged = fit.clone();
        }
        model
    }

    /// A model without one of its terms, fitted anew.
    pub fn dropped(&self, model: &Model, place: usize, under_moment: bool) -> Model {
        let structure = model.structure.without(place);
        let theta = model.structure.drop_from(&model.plain.theta, place);
        let colour = Colour { moment: None, waves: model.plain.colour.waves };
        let plain = self.problem.fit(&structure, &theta, &model.plain.initial, &colour);
        if !under_moment {
            return Model { structure, judged: plain.clone(), plain };
        }
        let mut less = self.judge(structure, plain);
        if !model.judged.colour.is_white() {
            let theta = model.structure.drop_from(&model.judged.theta, place);
            let under = self.problem.fit(&less.structure, &theta, &model.judged.initial, &model.judged.colour);
            if under.bic < less.judged.bic {
                less.judged = under;
            }
        }
        less
    }

    /// Evidence of every term of a model against the model without it, and those models.
    pub fn tested(&self, model: &Model, under_moment: bool) -> Vec<(Evidence, Model)> {
        (0..model.structure.terms.len())
            .into_par_iter()
            .map(|place| {
                let less = self.dropped(model, place, under_moment);
                let with = if under_moment { &model.judged } else { &model.plain };
                let evidence = self.evidence(&less.judged, with, model.structure.terms[place].freedom());
                (evidence, less)
            })
            .collect()
    }

    /// Whether a model gains over the base what all of its terms need together: two terms that are each other's reason
    /// explain nothing.
    fn pays(&self, model: &Model, base: &Model) -> bool {
        let needed: f64 = model.structure.terms.iter().map(|term| self.needed(term)).sum();
        base.judged.bic - model.judged.bic > needed
    }

    /// Drops terms that are not believed, the weakest first.
    fn prune(&self, mut model: Model, base: &Model, under_moment: bool) -> Model {
        while !model.structure.terms.is_empty() {
            let tests = self.tested(&model, under_moment);
            let surplus =
                |place: usize, evidence: &Evidence| evidence.gain - self.needed(&model.structure.terms[place]);
            let weakest = tests
                .into_iter()
                .enumerate()
                .min_by(|(i, one), (j, other)| surplus(*i, &one.0).total_cmp(&surplus(*j, &other.0)));
            match weakest {
                Some((place, (evidence, less)))
                    if !self.believes(&model.structure.terms[place], &evidence) || !self.pays(&model, base) =>
                {
                    model = less;
                }
                _ => break,
            }
        }
        model
    }

    /// Drops terms that do not lower the heading error itself: what helps only under a random moment mends no replay.
    fn helpful(&self, mut model: Model) -> Model {
        while !model.structure.terms.is_empty() && model.judged.colour.moment.is_some() {
            let all = (0..model.structure.terms.len()).map(|place| (place, self.dropped(&model, place, true)));
            let gain = |less: &Model| less.plain.bic - model.plain.bic;
            match all.min_by(|one, other| gain(&one.1).total_cmp(&gain(&other.1))) {
                Some((place, less)) if gain(&less) < self.needed(&model.structure.terms[place]) => model = less,
                _ => break,
            }
        }
        model
    }

    /// The believed candidate of lowest BIC.
    fn best(&self, tried: impl IntoIterator<Item = Tried>) -> Option<Tried> {
        tried.into_iter().find(|tried| self.believes(&self.candidates[tried.place].term, &tried.evidence))
    }

    /// Adds what is missing under white noise, one at a time, dropping what a later term made needless; `timeless` without
    /// moments that depend on time alone.
    fn add_plainly(&self, base: &Model, first: &[Tried], timeless: bool) -> Model {
        let mut model = base.clone();
        let plain = Model { judged: base.plain.clone(), ..base.clone() };
        for round in 0..self.thresholds.most_terms {
            let tried = if round == 0 { first.to_vec() } else { self.try_all(&model, &model.plain, true) };
            let allowed = |tried: &Tried| !timeless || !self.candidates[tried.place].term.effect.is_of_time();
            let Some(best) = self.best(tried.into_iter().filter(allowed)) else { break };
            let before = model.structure.terms.len();
            let next = Model { structure: best.structure, judged: best.fit.clone(), plain: best.fit };
            model = self.prune(next, &plain, false);
            if !timeless {
                model = self.swapped(model, &plain);
            }
            if model.structure.terms.len() <= before && round > 0 {
                break;
            }
        }
        model
    }

    /// Puts a better candidate in the place of a term that was added before its company was known.
    fn swapped(&self, model: Model, base: &Model) -> Model {
        if model.structure.terms.len() < 2 {
            return model;
        }
        for place in 0..model.structure.terms.len() {
            let less = self.dropped(&model, place, false);
            let tried = self.try_all(&less, &less.plain, true);
            let Some(best) = self.best(tried).filter(|best| best.fit.bic < model.plain.bic - SWAP) else { continue };
            let next = Model { structure: best.structure, judged: best.fit.clone(), plain: best.fit };
            return self.prune(next, base, false);
        }
        model
    }

    /// The terms of a plain search that stand against random moments.
    fn confirmed(&self, base: &Model, plain: &Model) -> Model {
        if plain.structure.terms.is_empty() {
            return base.clone();
        }
        let judged = self.judge(plain.structure.clone(), plain.plain.clone());
        let model = self.prune(judged, base, true);
        if model.structure.terms.is_empty() { base.clone() } else { model }
    }

    /// The whole search. `first` are all candidates tried on the base.
    pub fn run(&self, base: &Model, first: &[Tried]) -> Model {
        let plain = self.add_plainly(base, first, false);
        let mut model = self.confirmed(base, &plain);
        // A moment for a while is so flexible that it may come first and send the search astray.
        if plain.structure.terms.len() > 1 && plain.structure.terms.iter().any(|term| term.effect.is_of_time()) {
            let timeless = self.confirmed(base, &self.add_plainly(base, first, true));
            if timeless.judged.bic < model.judged.bic {
                model = timeless;
            }
        }
        while model.structure.terms.len() < self.thresholds.most_terms && model.judged.colour.moment.is_some() {
            let Some(best) = self.best(self.try_all(&model, &model.judged, true)) else { break };
            let before = model.structure.terms.len();
            let next = self.prune(self.adopted(&best), base, true);
            if next.structure.terms.len() <= before {
                break;
            }
            model = next;
        }
        self.revise_waves(self.helpful(model))
    }
}

/// Whether being there at all changes the heading anywhere.
pub(crate) fn acts(being: &Column) -> bool {
    being.iter().flatten().flatten().any(|&x| x != 0.0)
}
