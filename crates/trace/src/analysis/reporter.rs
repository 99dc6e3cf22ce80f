//! What is said of a finished search: effects with their evidence and aliases, what became of every candidate, and what
//! is left.

use std::collections::BTreeSet;

use rayon::prelude::*;
use ship::Regressor;
use ship::effects::{self, Effect, WaveYaw};
use trial::{Quantity, Trial};

use super::elsewhere::Predicted;
use super::result::{ALIAS, Considered, Empirical, Fitted, OnRecord, Outcome, Traced};
use super::settings::Settings;
use super::steps::square;
use super::told::Told;
use crate::candidates::{Candidate, Sizes};
use crate::change;
use crate::diagnostics::{self, Signature};
use crate::index::{CandidatePlace, TermPlace};
use crate::monomial::{self, LIBRARY};
use crate::offset;
use crate::search::{Evidence, Model, NAMELESS, Search, Tested, Tried, Weights};
use crate::separation::Ground;
use crate::structure::Term;

/// Why an effect was no candidate, where the user did not want it.
const EXCLUDED: &str = "excluded on request";

/// What is said about a finished search.
pub(super) struct Reporter<'a> {
    pub search: &'a Search<'a>,
    pub settings: &'a Settings,
    pub names: &'a [String],
    pub start: &'a Model,
    pub model: &'a Model,
    /// The models from the base to the final one.
    pub way: &'a [Model],
    /// All candidates on the base.
    pub tried: &'a [Tried],
    /// Terms that are believed for what they predict.
    pub predicted: &'a [Predicted],
}

/// Terms without a name that are fitted with the noise that suits them best.
const ADOPTED: usize = 6;

impl Reporter<'_> {
    fn only(&self, term: &Term) -> Option<String> {
        term.only.map(|only| self.names[only.0].clone())
    }

    pub fn effects(&self, parameters: &[Fitted]) -> Vec<Traced> {
        let structure = &self.model.structure;
        let tests = self.search.tested(self.model, structure.places(), true);
        let mut effects: Vec<Traced> = tests
            .into_par_iter()
            .zip(self.shares())
            .map(|(Tested { place, evidence, less }, share)| {
                let term = structure.term(place);
                let stands = self.search.believes(term, &evidence);
                let predicted = self.predicted.iter().find(|predicted| predicted.term.is(term)).filter(|_| !stands);
                let aliases = self.aliases(place, &less, predicted.is_some());
                let (evidence, sentence) = match predicted {
                    Some(predicted) => (predicted.evidence, self.prediction(predicted, share)),
                    None => (evidence, self.sentence(term, &evidence, share, &aliases)),
                };
                Traced {
                    id: term.effect.id(),
                    form: term.effect.form(),
                    equation: term.effect.equation(),
                    only: self.only(term),
                    aliases,
                    parameters: parameters[structure.range(place)].to_vec(),
                    asked: self.search.wanted.keeps(term),
                    probability: 0.0,
                    evidence,
                    residual_share: Some(share),
                    sentence,
                }
            })
            .collect();
        effects.extend(self.waves());
        effects
    }

    /// Share of the mean square of the base that every term took away in its turn.
    fn shares(&self) -> Vec<f64> {
        let all = square(&self.start.plain);
        let squares: Vec<f64> = self.way.iter().map(|model| square(&model.plain)).collect();
        squares.windows(2).map(|pair| ((pair[0] - pair[1]) / all).max(0.0)).collect()
    }

    /// Rivals that explain the records as well as the term at `place` does in its stead, under the same noise. A term
    /// that is believed for what it predicts is compared as it was found, under white noise.
    fn aliases(&self, place: TermPlace, less: &Model, predicted: bool) -> Vec<(&'static str, &'static str)> {
        let own = self.model.structure.term(place);
        let with = if predicted { &self.model.plain } else { &self.model.judged };
        let tried;
        let rivals = if less.structure.terms.is_empty() && with.colour == self.start.plain.colour {
            self.tried
        } else {
            // The model without the term, under the noise of the model with it.
            let without =
                self.search.problem.fit(&less.structure, &less.plain.theta, &less.plain.initial, &with.colour);
            tried = self.search.try_all(less, &without, false);
            &tried
        };
        let mut aliases: Vec<(&'static str, &'static str)> = rivals
            .iter()
            .filter(|tried| tried.fit.bic < with.bic + ALIAS)
            .map(|tried| &self.search.candidate(tried.candidate).term)
            .filter(|rival| !rival.is(own) && !self.model.structure.terms.iter().any(|term| term.is(rival)))
            .map(|rival| (rival.effect.id(), rival.effect.form()))
            .collect();
        aliases.sort_unstable();
        aliases.dedup();
        aliases
    }

    fn sentence(
        &self,
        term: &Term,
        evidence: &Evidence,
        share: f64,
        aliases: &[(&'static str, &'static str)],
    ) -> String {
        let whom = match (&self.model.judged.colour.wander, aliases.is_empty()) {
            (None, true) => "against the best model without it, random moments included",
            (Some(_), true) => "against the best model without it, while a random moment takes what neither explains",
            (_, false) => "against the best model without any of its aliases",
        };
        let fall = match evidence.gain {
            gain if gain < 0.0 => format!("BIC rises by {:.0}", -gain),
            gain => format!("BIC falls by {gain:.0}"),
        };
        let (id, form, percent) = (term.effect.id(), term.effect.form(), 100.0 * share);
        let takes =
            format!("{id} ({form}) takes away {percent:.0} % of the mean square error of the base; {fall} {whom}");
        match (self.search.wanted.keeps(term), self.search.believes(term, evidence)) {
            (false, _) => takes,
            (true, true) => format!("asked for, not found, but believed: {takes}"),
            (true, false) => {
                format!("asked for, not found: {takes}, and {:.0} are needed to believe it", self.search.needed(term))
            }
        }
    }

    fn prediction(&self, predicted: &Predicted, share: f64) -> String {
        format!(
            "{} ({}) takes away {:.0} % of the mean square error of the base; against a random moment its evidence does not \
             stand, but it multiplies the error on held-out records by {:.2} (full replay) and {:.2} (full and restarted \
             replays together); BIC falls by {:.0} under white noise",
            predicted.term.effect.id(),
            predicted.term.effect.form(),
            100.0 * share,
            predicted.comparison.full,
            predicted.comparison.mean,
            predicted.evidence.gain
        )
    }

    /// Waves as an effect, where they are part of the noise.
    fn waves(&self) -> Option<Traced> {
        let waves = self.model.judged.colour.waves?;
        let white = self.search.problem.variance(&self.model.judged).sqrt();
        let calm = self.search.coloured(self.model, None);
        let evidence = self.search.evidence(&calm.judged, &self.model.judged, 3);
        let effect = &WaveYaw;
        let values = [waves.sd * white, waves.frequency, waves.damping];
        let parameters =
            effect.parameters().iter().zip(values).map(|(parameter, value)| Fitted::bare(parameter, value)).collect();
        Some(Traced {
            id: effect.id(),
            form: effect.form(),
            equation: effect.equation(),
            only: None,
            aliases: Vec::new(),
            parameters,
            asked: self.search.wanted.asks_for(effect.id()),
            probability: 0.0,
            evidence,
            residual_share: None,
            sentence: format!(
                "a narrow band at {:.2} rad/s with a standard deviation of {:.2} deg lies on the heading; BIC falls by {:.0}",
                waves.frequency,
                ship::angle::to_deg(waves.sd * white),
                evidence.gain
            ),
        })
    }

    pub fn candidates(&self, effects: &[Traced]) -> Vec<Considered> {
        let structure = &self.model.structure;
        let judged = self.model.judged.colour.wander.is_some();
        let fit = if judged { &self.model.judged } else { &self.model.plain };
        // On the base itself the first round has told already.
        let last = if structure.terms.is_empty() && !judged {
            self.tried.to_vec()
        } else {
            self.search.try_all(self.model, fit, false)
        };
        let variance = self.search.problem.variance(fit);
        let ground = Ground::new(self.search.problem, structure, fit, variance);
        let log_n = (self.search.problem.observations() as f64).ln();
        let mut list: Vec<Considered> = self
            .search
            .candidates
            .par_iter()
            .enumerate()
            .map(|(place, candidate)| {
                let (place, term) = (CandidatePlace(place), &candidate.term);
                let alone = self.tried.iter().find(|tried| tried.candidate == place).map(|tried| tried.evidence.gain);
                let added = structure.terms.iter().any(|own| own.is(term));
                let alias =
                    effects.iter().any(|effect| effect.aliases.contains(&(term.effect.id(), term.effect.form())));
                let evidence = if added {
                    let own = |effect: &&Traced| (effect.id, effect.form) == (term.effect.id(), term.effect.form());
                    effects.iter().find(own).map(|effect| effect.evidence)
                } else {
                    last.iter().find(|tried| tried.candidate == place).map(|tried| tried.evidence)
                };
                let visibility = (!added && self.settings.thorough).then(|| ground.visibility(candidate));
                let needed = self.settings.thresholds.gain + term.freedom() as f64 * log_n;
                let outcome = match (added, alias, visibility) {
                    (true, ..) => Outcome::Added,
                    (_, true, _) => Outcome::Alias,
                    // What would explain the base alone is seen, even if something else explains it better.
                    (.., Some(visibility)) if visibility < needed && alone.is_none_or(|gain| gain < needed) => {
                        Outcome::NotObservable
                    }
                    _ => Outcome::Rejected,
                };
                Considered {
                    id: term.effect.id(),
                    form: term.effect.form(),
                    only: self.only(term),
                    probability: 0.0,
                    outcome,
                    evidence,
                    gain_alone: alone,
                    needed: self.search.needed(term),
                    visibility,
                    reason: None,
                }
            })
            .collect();
        list.extend(self.without_channel(&list));
        list.extend(self.random_considered(effects));
        list
    }

    /// Weights of all structures that the search and this report have tried; every effect and candidate gets its
    /// probability.
    pub fn weigh(&self, effects: &mut [Traced], considered: &mut [Considered]) -> Weights {
        let weights = self.search.weights();
        let terms = &self.model.structure.terms;
        for (number, effect) in effects.iter_mut().enumerate() {
            let only = terms.get(number).and_then(|term| term.only);
            effect.probability = weights.of_place(effect.id, only);
        }
        for (number, one) in considered.iter_mut().enumerate() {
            let only = self.search.candidates.get(number).and_then(|candidate| candidate.term.only);
            one.probability = weights.of_term((one.id, one.form, only));
        }
        weights
    }

    /// Effects of which no form can be a candidate, because they need a channel that the records do not have.
    fn without_channel(&self, list: &[Considered]) -> Vec<Considered> {
        effects::all()
            .into_iter()
            .filter(|effect| !effect.is_random() && list.iter().all(|other| other.id != effect.id()))
            .map(|effect| {
                if !self.search.wanted.allows(effect.id()) {
                    return self.unfitted(effect.as_ref(), Outcome::Rejected, None, Some(EXCLUDED));
                }
                let lacking = effect.needs().map(Regressor::lacking);
                self.unfitted(effect.as_ref(), Outcome::NotObservable, None, lacking)
            })
            .collect()
    }

    /// Effects that are a colour of the noise, found or not.
    fn random_considered(&self, traced: &[Traced]) -> Vec<Considered> {
        effects::all()
            .into_iter()
            .filter(|effect| effect.is_random())
            .map(|effect| match traced.iter().find(|traced| traced.id == effect.id()) {
                Some(found) => self.unfitted(effect.as_ref(), Outcome::Added, Some(found.evidence), None),
                None => {
                    let allowed = self.search.wanted.allows(effect.id());
                    let reason =
                        if allowed { "no band above five times the frequency of the manoeuvre" } else { EXCLUDED };
                    self.unfitted(effect.as_ref(), Outcome::Rejected, None, Some(reason))
                }
            })
            .collect()
    }

    /// An effect that was not fitted as a term.
    fn unfitted(
        &self,
        effect: &dyn Effect,
        outcome: Outcome,
        evidence: Option<Evidence>,
        reason: Option<&'static str>,
    ) -> Considered {
        Considered {
            id: effect.id(),
            form: effect.form(),
            only: None,
            probability: 0.0,
            outcome,
            evidence,
            gain_alone: None,
            needed: self.settings.thresholds.gain,
            visibility: None,
            reason,
        }
    }

    /// Whether structure is left: a random moment is needed, and either it is no description of what is left, or a
    /// term without a name gains beside it.
    pub fn is_unexplained(&self, told: &Told, nameless: Option<&Empirical>) -> bool {
        let gain = self.model.plain.bic - self.model.judged.bic;
        told.random && gain > self.settings.thresholds.gain && (!told.noise_holds || nameless.is_some())
    }

    /// Where what is left lives, in the record with the largest error.
    pub fn signature(&self, trials: &[Trial], after: &[OnRecord]) -> Option<Signature> {
        let worst = (0..trials.len())
            .max_by(|&one, &other| after[one].errors.heading.total_cmp(&after[other].errors.heading))?;
        let (trial, replayed) = (&trials[worst], &after[worst].replay);
        let first = trial.observed_rows().next().unwrap_or(0);
        let rudder = &trial.rudder()[first..first + replayed.time.len()];
        Some(diagnostics::signature(
            worst,
            &replayed.time,
            &replayed.residual,
            &replayed.heading,
            rudder,
            trial.sampling_period(),
        ))
    }

    /// The term without a name that carries most of what is left, with those that cannot be told from it.
    pub fn nameless(&self, sizes: &Sizes) -> Option<Empirical> {
        let records = &self.search.problem.records;
        let mut library: Vec<Candidate> = monomial::candidates(records, sizes, LIBRARY.iter()).collect();
        library.extend(offset::candidate(records, sizes));
        library.extend(change::candidate(records, sizes));
        let search = Search::new(self.search.problem, &library, self.search.thresholds);
        let mut tried = search.try_all(self.model, &self.model.judged, false);
        let believed = |tried: &Tried| search.believes(&search.candidate(tried.candidate).term, &tried.evidence);
        if !tried.first().is_some_and(believed) {
            // Under the noise of the model without it a slow term looks like more of that noise: it is held against
            // the model with the noise that suits it best, fitted from where either noise has led it, and needs what a
            // moment of time needs.
            tried.truncate(ADOPTED);
            tried.extend(search.try_all(self.model, &self.model.plain, true));
            for tried in &mut tried {
                let with = search.adopted(tried);
                let freedom = search.candidate(tried.candidate).term.freedom();
                tried.evidence = search.evidence(&self.model.judged, &with.judged, freedom);
                tried.fit = with.judged;
            }
            tried.retain(|tried| search.passes(&tried.evidence, NAMELESS));
            tried.sort_by(|one, other| one.fit.bic.total_cmp(&other.fit.bic));
            let mut seen = BTreeSet::new();
            tried.retain(|one| seen.insert(one.candidate));
        }
        let best = tried.first()?;
        let near = tried.iter().take_while(|tried| tried.fit.bic < best.fit.bic + ALIAS);
        let term = &search.candidate(best.candidate).term;
        let own = best.fit.theta.len() - term.effect.parameters().len()..best.fit.theta.len();
        let square: f64 = search.adopted(best).plain.residual.iter().flatten().map(|e| e * e).sum();
        Some(Empirical {
            group: near.map(|tried| search.candidate(tried.candidate).term.effect.form()).collect(),
            equation: term.effect.equation(),
            parameters: self.search.problem.entries(&best.structure)[own.clone()]
                .iter()
                .zip(&best.fit.theta[own])
                .map(|(entry, &value)| Fitted {
                    parameter: entry.parameter,
                    quantity: Quantity::bare(value),
                    only: None,
                    at_bound: entry.ends_at(value),
                })
                .collect(),
            evidence: best.evidence,
            error: (square / self.search.problem.observations() as f64).sqrt(),
        })
    }
}
