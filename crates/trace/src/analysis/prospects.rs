//! What another trial would tell: which aliases it would separate and which blind spots it would reveal.

use rayon::prelude::*;
use ship::Response;
use trial::Trial;

use super::result::{ALIAS, Analysis, Outcome};
use crate::candidates::Candidate;
use crate::fit::{Fit, Problem};
use crate::held_out;
use crate::index::RecordNumber;
use crate::record::Record;
use crate::replay_errors;
use crate::separation::Ground;
use crate::structure::{Structure, Term};

/// What another trial would tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Prospect {
    /// The manoeuvre.
    pub name: String,
    /// Rivals (the term in the model, the other one) that this trial together with the records would tell apart.
    pub separated: Vec<[String; 2]>,
    /// Rivals it would not.
    pub still_alike: Vec<[String; 2]>,
    /// Effects that the records could not show and this trial would.
    pub revealed: Vec<String>,
    /// Effects that stay hidden.
    pub still_hidden: Vec<String>,
    /// Σ log(1 + expected gain in −2 log L) over all of these: what decides between trials that settle as many.
    pub information: f64,
    /// Mean logarithm of the standard deviations of the parameters, less that of the records alone.
    pub sharpening: Option<f64>,
}

impl Analysis {
    /// The fitted ship, without terms that belong to the weather of one record: what a next trial would be run with.
    pub fn ship(&self) -> Response {
        held_out::portable(&self.model.structure, &self.told.fit.theta)
    }

    /// What each of some planned trials would tell beside the records, best first.
    ///
    /// A planned trial is a record of the fitted ship itself, made by the caller; only its rudder and its times count.
    pub fn prospects(&self, planned: &[(String, Trial)]) -> Vec<Prospect> {
        let now = self.ground(&self.problem, &self.model.structure, &self.told.fit).uncertainty();
        let mut prospects: Vec<Prospect> =
            planned.par_iter().map(|(name, trial)| self.prospect(name, trial, now)).collect();
        let rank = |prospect: &Prospect| prospect.separated.len() + prospect.revealed.len();
        prospects.sort_by(|one, other| {
            let by_information = other.information.total_cmp(&one.information);
            let sharp = |prospect: &Prospect| prospect.sharpening.unwrap_or(0.0);
            rank(other).cmp(&rank(one)).then(by_information).then(sharp(one).total_cmp(&sharp(other)))
        });
        prospects
    }

    fn ground<'a>(&self, problem: &'a Problem, structure: &'a Structure, fit: &'a Fit) -> Ground<'a> {
        Ground::new(problem, structure, fit, self.problem.variance(&self.told.fit))
    }

    fn prospect(&self, name: &str, trial: &Trial, now: Option<f64>) -> Prospect {
        let count = self.problem.records.len();
        let mut records = self.problem.records.clone();
        let record = Record::averaged(trial, self.base.response.T().abs());
        let ship = self.ship();
        let rest = vec![[record.heading[record.observed[0]], 0.0]];
        let initial = replay_errors::full(&ship, &record, &rest).map_or(rest[0], |replay| replay.initial());
        records.push(record);
        let problem = self.problem.on(records);
        let mut structure = self.model.structure.clone();
        structure.records = count + 1;
        let of_first = |term: &mut Term| {
            if term.effect.is_of_time() && term.only.is_none() {
                term.only = Some(RecordNumber(0));
            }
        };
        structure.terms.iter_mut().for_each(of_first);
        let mut fit = self.told.fit.clone();
        if structure.own_bias {
            fit.theta.insert(2 + count, ship.parameters()[2]);
        }
        fit.initial.push(initial);
        let ground = self.ground(&problem, &structure, &fit);
        let log_n = (problem.observations() as f64).ln();
        let mut prospect = Prospect {
            name: name.to_owned(),
            separated: Vec::new(),
            still_alike: Vec::new(),
            revealed: Vec::new(),
            still_hidden: Vec::new(),
            information: 0.0,
            sharpening: ground.uncertainty().zip(now).map(|(then, now)| then - now),
        };
        let label = |id: &str, form: &str| format!("{id} ({form})");
        for (place, effect) in structure.places().zip(&self.effects) {
            let term = structure.term(place);
            for (id, form) in &effect.aliases {
                let is = |c: &&Candidate| (c.term.effect.id(), c.term.effect.form()) == (*id, *form);
                let Some(rival) = self.candidate_terms.iter().find(is) else { continue };
                let mut rival = rival.clone();
                of_first(&mut rival.term);
                let gain = ground.distance(place, &rival);
                prospect.information += gain.max(0.0).ln_1p();
                let pair = [label(term.effect.id(), term.effect.form()), label(id, form)];
                if gain > 2.0 * ALIAS { prospect.separated.push(pair) } else { prospect.still_alike.push(pair) }
            }
        }
        for hidden in self.candidates.iter().filter(|c| c.outcome == Outcome::NotObservable && c.visibility.is_some()) {
            let is = |c: &&Candidate| (c.term.effect.id(), c.term.effect.form()) == (hidden.id, hidden.form);
            let Some(candidate) = self.candidate_terms.iter().find(is) else { continue };
            let gain = ground.visibility(candidate);
            prospect.information += gain.max(0.0).ln_1p();
            let needed = self.thresholds.gain + candidate.term.freedom() as f64 * log_n;
            let name = label(hidden.id, hidden.form);
            if gain > needed { prospect.revealed.push(name) } else { prospect.still_hidden.push(name) }
        }
        prospect
    }
}
