//! The rounds of a search: terms are added, exchanged and dropped until none is missing and none needless.

use super::models::{Model, Search, Tested};
use super::trying::Tried;
use crate::index::TermPlace;
use crate::innovations::Innovations;

/// Gain in BIC for which one term takes the place of another.
const SWAP: f64 = 2.0;

/// Difference in BIC up to which two forms of a set cannot be told apart.
const ALIKE: f64 = 10.0;

/// Sets of different effects that are looked at term by term, until one stands.
const PRUNED: usize = 2;

impl Search<'_> {
    /// Whether a model gains over the base what all of its terms need together: two terms that are each other's reason
    /// explain nothing.
    fn pays(&self, model: &Model, base: &Model) -> bool {
        let found = model.structure.terms.iter().filter(|term| !self.wanted.keeps(term));
        let needed: f64 = found.map(|term| self.needed(term)).sum();
        base.judged.bic - model.judged.bic > needed
    }

    /// Places of the terms that were not asked for: what a search may drop.
    fn found<'b>(&'b self, model: &'b Model) -> impl DoubleEndedIterator<Item = TermPlace> + use<'b> {
        model.structure.places().filter(|&place| !self.wanted.keeps(model.structure.term(place)))
    }

    /// Drops terms that are not believed, the weakest first.
    fn prune(&self, mut model: Model, base: &Model, under_moment: bool) -> Model {
        while !model.structure.terms.is_empty() {
            let tests = self.tested(&model, self.found(&model), under_moment);
            let surplus = |tested: &Tested| tested.evidence.gain - self.needed(model.structure.term(tested.place));
            let weakest = tests.into_iter().min_by(|one, other| surplus(one).total_cmp(&surplus(other)));
            match weakest {
                Some(Tested { place, evidence, less })
                    if !self.believes(model.structure.term(place), &evidence) || !self.pays(&model, base) =>
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
        while !model.structure.terms.is_empty() && model.judged.colour.wander.is_some() {
            let all = self.found(&model).map(|place| (place, self.dropped(&model, place, true)));
            let gain = |less: &Model| less.plain.bic - model.plain.bic;
            match all.min_by(|one, other| gain(&one.1).total_cmp(&gain(&other.1))) {
                Some((place, less)) if gain(&less) < self.needed(model.structure.term(place)) => model = less,
                _ => break,
            }
        }
        model
    }

    /// The believed candidate of lowest BIC.
    fn best(&self, tried: impl IntoIterator<Item = Tried>) -> Option<Tried> {
        tried.into_iter().find(|tried| self.believes(&self.candidate(tried.candidate).term, &tried.evidence))
    }

    /// Adds what is missing under white noise, one at a time, dropping what a later term made needless; `timeless`
    /// without moments that depend on time alone.
    fn add_plainly(&self, base: &Model, first: &[Tried], timeless: bool) -> Model {
        let mut model = base.clone();
        let plain = Model { judged: base.plain.clone(), ..base.clone() };
        for round in 0..self.thresholds.most_effects {
            let tried = if round == 0 { first.to_vec() } else { self.try_all(&model, &model.plain, true) };
            let allowed = |tried: &Tried| !timeless || !self.candidate(tried.candidate).term.effect.is_of_time();
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
        for place in self.found(&model) {
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
        if self.found(plain).next().is_none() {
            return base.clone();
        }
        let judged = self.judge(plain.structure.clone(), plain.plain.clone());
        let model = self.prune(judged, base, true);
        if self.found(&model).next().is_none() { base.clone() } else { model }
    }

    /// The better of a model and the best set of effects that pay together: every term of either stands against a
    /// random moment, so a set has to be better under one and nearer to the records without.
    fn with_a_set(&self, model: Model, base: &Model) -> Model {
        let ids = |set: &Model| -> Vec<&str> { set.structure.terms.iter().map(|term| term.effect.id()).collect() };
        let mut sets: Vec<Model> = Vec::new();
        for set in self.together(base).into_iter().filter(|set| set.judged.bic < model.judged.bic) {
            match sets.iter_mut().find(|other| ids(other) == ids(&set)) {
                // Of forms that cannot be told apart, the one that replays the record best.
                Some(other) if set.judged.bic < other.judged.bic + ALIKE && set.plain.bic < other.plain.bic => {
                    *other = set;
                }
                Some(_) => {}
                None => sets.push(set),
            }
        }
        let mut pruned = sets.into_iter().take(PRUNED).map(|set| self.prune(set, base, true));
        let better = |set: &Model| set.judged.bic < model.judged.bic && set.plain.bic < model.plain.bic;
        pruned.find(better).unwrap_or(model)
    }

    /// Whether a base is all there is: a random moment describes what is left, neither a candidate nor two together
    /// promise to pay beside it, and no moment of time pays, which a linear promise does not tell.
    fn is_enough(&self, base: &Model, first: &[Tried]) -> bool {
        let mut of_time = first.iter().filter(|tried| self.candidate(tried.candidate).term.effect.is_of_time());
        base.judged.colour.wander.is_some()
            && Innovations::of(self.problem, &base.judged).agree()
            && !self.promises_anything(base)
            && !of_time.any(|tried| self.stands(base, tried))
            && self.twice(base, first).is_none()
    }

    /// Two moments that come or go in one record, if they pay together: one alone may be nothing but a part of what
    /// wanders.
    fn twice(&self, base: &Model, first: &[Tried]) -> Option<Model> {
        let located: Vec<&Tried> =
            first.iter().filter(|tried| self.candidate(tried.candidate).term.effect.has_instant()).collect();
        let only = |tried: &Tried| self.candidate(tried.candidate).term.only;
        let with_second = |tried: &&Tried| {
            let one = self.plainly((*tried).clone());
            let places = located.iter().filter(|other| only(other) == only(tried)).map(|other| other.candidate);
            self.try_these(&one, &one.plain, places.collect())
        };
        let both = located.iter().flat_map(with_second).map(|both| self.judge(both.structure, both.fit));
        let best = both.min_by(|one, other| one.judged.bic.total_cmp(&other.judged.bic));
        best.filter(|best| self.pays(best, base))
    }

    /// The whole search. `base` holds what was asked for; `first` are all candidates tried on it.
    pub fn run(&self, base: &Model, first: &[Tried]) -> Model {
        if self.is_enough(base, first) {
            return base.clone();
        }
        let plain = self.add_plainly(base, first, false);
        let mut model = self.confirmed(base, &plain);
        // A moment for a while is so flexible that it may come first and send the search astray.
        if self.found(&plain).count() > 1 && plain.structure.terms.iter().any(|term| term.effect.is_of_time()) {
            let timeless = self.confirmed(base, &self.add_plainly(base, first, true));
            if timeless.judged.bic < model.judged.bic {
                model = timeless;
            }
        }
        if model.judged.colour.wander.is_some() {
            model = self.with_a_set(model, base);
            let twice = self.twice(base, first).map(|twice| self.prune(twice, base, true));
            let priced = |model: &Model| model.judged.bic + self.price(&model.structure, false);
            model = twice.filter(|twice| priced(twice) < priced(&model)).unwrap_or(model);
        }
        while self.found(&model).count() < self.thresholds.most_effects && model.judged.colour.wander.is_some() {
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
