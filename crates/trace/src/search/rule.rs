//! The rules by which one of the structures that a search has tried is believed.
//!
//! All rules share one search and its ledger, and all compare structures under the noise that suits each best, random
//! moments included. n is the number of parameters of the effects of a structure, waves included, N that of headings.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};
use ship::effects::{Effect, WaveYaw};

use super::ledger::{Names, Noted, names};
use super::models::{Model, Search};
use crate::held_out;
use crate::index::RecordNumber;
use crate::structure::{Structure, Term};

/// Which of the structures that were tried is believed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "String", into = "&'static str")]
#[schemars(extend("enum" = Rule::ALL.map(Rule::as_str)))]
pub enum Rule {
    /// The structure in which a search by the thresholds ends: every effect gains what it needs in BIC = −2 log L +
    /// k ln N, where k counts all that was fitted, and passes a test of its likelihood ratio (Schwarz 1978; Kass and
    /// Raftery 1995).
    #[default]
    Bic,
    /// The largest log L − n ln(n₀/p) − (k − n)/2 · ln N, with n₀ the number of candidates and p = 0.001; what is no
    /// effect, such as the level of a random moment, pays as in BIC (Gerardos and Ronceray 2025, arXiv:2501.10339).
    Pastis,
    /// The fewest parameters among the structures whose loss on parts kept from the fit
    /// ([`crate::held_out::losses_on_parts`]) is not larger than the smallest by more than two standard errors
    /// (Breiman, Friedman, Olshen and Stone 1984, with one). It judges the structures nearest to what a search asks
    /// for, and names too much where nothing is missing: probably errors of a replay are alike for longer than the
    /// standard error allows for.
    HeldOut,
    /// Every effect that is in the best structure of more than half of the balanced half-samples of the record
    /// (McCarthy 1969; selection by resampling: Meinshausen and Bühlmann 2010). The best has the lowest sum of BIC and
    /// of the gains that its effects need.
    Bagged,
    /// Every effect whose probability among the structures that were tried exceeds 0.5 (Barbieri and Berger 2004),
    /// each of a menu being expected with probability 1/(its size).
    Probability,
    /// The same with 0.9.
    Probability90,
}

/// A rule that nobody knows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownRule(pub String);

impl fmt::Display for UnknownRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = Rule::ALL.map(Rule::as_str).join(", ");
        write!(f, "there is no rule `{}`; expected one of {known}", self.0)
    }
}

impl std::error::Error for UnknownRule {}

impl Rule {
    /// Every rule.
    pub const ALL: [Self; 6] =
        [Self::Bic, Self::Pastis, Self::HeldOut, Self::Bagged, Self::Probability, Self::Probability90];

    /// The word used in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Bic => "bic",
            Self::Pastis => "pastis",
            Self::HeldOut => "held-out",
            Self::Bagged => "bagged",
            Self::Probability => "probability",
            Self::Probability90 => "probability-0.9",
        }
    }
}

impl FromStr for Rule {
    type Err = UnknownRule;

    fn from_str(name: &str) -> Result<Self, UnknownRule> {
        Self::ALL.into_iter().find(|rule| rule.as_str() == name).ok_or_else(|| UnknownRule(name.to_owned()))
    }
}

impl TryFrom<String> for Rule {
    type Error = UnknownRule;

    fn try_from(name: String) -> Result<Self, UnknownRule> {
        name.parse()
    }
}

impl From<Rule> for &'static str {
    fn from(rule: Rule) -> Self {
        rule.as_str()
    }
}

/// Probability of a false name that `pastis` allows.
const FALSE_NAME: f64 = 0.001;

/// Structures that are predicted on parts kept from the fit.
const PREDICTED: usize = 12;

/// Structures whose best noise may be looked for before one of them is believed.
const JUDGED: usize = 8;

/// An effect, or a moment of time in one record: what a menu has once, in whatever form.
pub(super) type Place = (&'static str, Option<RecordNumber>);

/// The places that a structure takes.
pub(super) fn places(names: &Names) -> BTreeSet<Place> {
    names.iter().map(|(id, _, only)| (*id, *only)).collect()
}

/// log L − n ln(n₀/p) with the terms of BIC for what is no effect, for `free` = n parameters of effects.
fn pastis(bic: f64, free: usize, menu: usize, log_n: f64) -> f64 {
    let free = free as f64;
    -0.5 * (bic - free * log_n) - free * (menu as f64 / FALSE_NAME).ln()
}

/// The structure of fewest parameters whose loss is not larger than the smallest; of equals that of smaller loss.
fn simplest(losses: &[Vec<Vec<f64>>], free: &[usize]) -> Option<usize> {
    let sum = |k: usize| losses[k].iter().flatten().sum::<f64>();
    let finite = || (0..losses.len()).filter(|&k| sum(k).is_finite());
    let best = finite().min_by(|&one, &other| sum(one).total_cmp(&sum(other)))?;
    let alike = finite().filter(|&k| k == best || !held_out::is_larger(&losses[k], &losses[best]));
    alike.min_by(|&one, &other| free[one].cmp(&free[other]).then(sum(one).total_cmp(&sum(other))))
}

/// The structure that takes most of some places and no other; of equals that of lower BIC.
fn taking(contenders: &[(&Names, &Noted)], included: &BTreeSet<Place>) -> Option<usize> {
    let taken: Vec<BTreeSet<Place>> = contenders.iter().map(|(names, _)| places(names)).collect();
    let allowed = (0..contenders.len()).filter(|&k| taken[k].is_subset(included));
    let bic = |k: usize| contenders[k].1.fit.bic;
    allowed.min_by(|&one, &other| taken[other].len().cmp(&taken[one].len()).then(bic(one).total_cmp(&bic(other))))
}

impl Search<'_> {
    /// What a rule believes among the structures that were tried and hold what was asked for. `found` is where the
    /// search has ended.
    pub fn decide(&self, rule: Rule, base: &Model, found: Model) -> Model {
        if rule == Rule::Bic {
            return found;
        }
        self.try_neighbours(&found);
        let mut model = found.clone();
        for _ in 0..JUDGED {
            let Some(chosen) = self.chosen(rule, base) else { break };
            let own = names(&chosen.structure, &chosen.fit);
            let known = [base, &found].into_iter().find(|known| names(&known.structure, &known.plain) == own);
            model = known.cloned().unwrap_or_else(|| self.judged_from(&chosen.structure, &chosen.fit));
            if chosen.judged || known.is_some() {
                break;
            }
        }
        model
    }

    /// Notes the neighbours of a model: each of its terms dropped, each candidate added.
    fn try_neighbours(&self, model: &Model) {
        let places = model.structure.places().filter(|&place| !self.wanted.keeps(model.structure.term(place)));
        self.tested(model, places, true);
        let fit = if model.judged.colour.wander.is_some() { &model.judged } else { &model.plain };
        self.try_all(model, fit, false);
    }

    /// The structure that a rule takes from the ledger as it stands.
    fn chosen(&self, rule: Rule, base: &Model) -> Option<Noted> {
        let known = self.ledger.known();
        let least = names(&base.structure, &base.plain);
        let asked: Vec<_> = least.iter().filter(|(id, ..)| self.wanted.asks_for(id)).collect();
        let most = base.structure.terms.len() + self.thresholds.most_effects;
        let mut contenders: Vec<(&Names, &Noted)> = known
            .iter()
            .filter(|(names, noted)| {
                asked.iter().all(|name| names.contains(name)) && noted.structure.terms.len() <= most
            })
            .collect();
        // What a search would end with comes first.
        contenders.sort_by(|one, other| self.priced(one.1).total_cmp(&self.priced(other.1)));
        let place = match rule {
            // The search itself has decided.
            Rule::Bic => None,
            Rule::Pastis => {
                let score = |noted: &Noted| pastis(noted.fit.bic, self.free(noted), self.menu(), self.log_n());
                (0..contenders.len()).max_by(|&k, &l| score(contenders[k].1).total_cmp(&score(contenders[l].1)))
            }
            Rule::HeldOut => {
                let simple = contenders.iter().skip(PREDICTED).filter(|(names, _)| **names == least);
                let models: Vec<&Noted> = contenders.iter().take(PREDICTED).chain(simple).map(|one| one.1).collect();
                let pairs: Vec<_> = models.iter().map(|noted| (&noted.structure, &noted.fit)).collect();
                let free: Vec<usize> = models.iter().map(|noted| self.free(noted)).collect();
                let best = simplest(&held_out::losses_on_parts(self.problem, &pairs), &free)?;
                return Some(models[best].clone());
            }
            Rule::Bagged => taking(&contenders, &self.frequent(&contenders)),
            Rule::Probability => taking(&contenders, &self.probable(&contenders, 0.5)),
            Rule::Probability90 => taking(&contenders, &self.probable(&contenders, 0.9)),
        };
        Some(contenders.get(place?)?.1.clone())
    }

    /// Places whose probability exceeds a level.
    fn probable(&self, contenders: &[(&Names, &Noted)], level: f64) -> BTreeSet<Place> {
        let tried: BTreeMap<Names, f64> =
            contenders.iter().map(|(names, noted)| ((*names).clone(), noted.fit.bic)).collect();
        let weights = self.weigh(&tried);
        let all: BTreeSet<Place> = contenders.iter().flat_map(|(names, _)| places(names)).collect();
        all.into_iter().filter(|(id, only)| weights.of_place(id, *only) > level).collect()
    }

    /// Number of candidates, waves included.
    fn menu(&self) -> usize {
        self.candidates.len() + usize::from(self.wanted.allows(WaveYaw.id()))
    }

    /// Number of parameters of the effects of a structure.
    fn free(&self, noted: &Noted) -> usize {
        let waves = noted.fit.colour.waves.map_or(0, |_| WaveYaw.parameters().len());
        noted.structure.terms.iter().map(Term::freedom).sum::<usize>() + waves
    }

    /// What the effects of a structure have to gain together.
    pub(super) fn price(&self, structure: &Structure, waves: bool) -> f64 {
        let terms: f64 = structure.terms.iter().map(|term| self.needed(term)).sum();
        terms + if waves { self.thresholds.gain } else { 0.0 }
    }

    fn priced(&self, noted: &Noted) -> f64 {
        noted.fit.bic + self.price(&noted.structure, noted.fit.colour.waves.is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Fit;
    use crate::noise::Colour;

    const CUBIC: (&str, &str, Option<RecordNumber>) = ("nonlinear_damping", "r³", None);
    const SQUARE: (&str, &str, Option<RecordNumber>) = ("nonlinear_damping", "r|r|", None);
    const WIND: (&str, &str, Option<RecordNumber>) = ("wind_moment", "steady wind", None);

    fn noted(bic: f64) -> Noted {
        let fit = Fit {
            theta: Vec::new(),
            initial: Vec::new(),
            colour: Colour::WHITE,
            residual: Vec::new(),
            rss: 1.0,
            deviance: bic,
            freedom: 0,
            lost: 0.0,
            bic,
        };
        Noted { structure: Structure::base(1, false), fit, judged: true }
    }

    #[test]
    fn rules_are_known_by_their_words() {
        assert!(Rule::ALL.into_iter().all(|rule| rule.as_str().parse() == Ok(rule)));
        assert_eq!(Rule::default(), Rule::Bic);
        let error = "aic".parse::<Rule>().expect_err("no such rule");
        assert_eq!(
            error.to_string(),
            "there is no rule `aic`; expected one of bic, pastis, held-out, bagged, probability, probability-0.9"
        );
    }

    /// By hand, N = 300, n₀ = 19: ln N = 5.703782, ln(19/0.001) = 9.852194. Two parameters at BIC 100:
    /// −(100 − 11.407565)/2 − 19.704389. They have to gain 4 · 9.852194 −
    /// 2 · 5.703782 = 28.001212 in BIC over nothing at all.
    #[test]
    fn pastis_charges_every_parameter_the_logarithm_of_the_menu() {
        let log_n = 300f64.ln();
        assert!((pastis(100.0, 2, 19, log_n) + 64.000_606).abs() < 1e-6);
        assert_eq!(pastis(150.0, 0, 19, log_n), -75.0);
        let worth = 28.001_212;
        assert!(pastis(100.0 - worth - 1e-3, 2, 19, log_n) > pastis(100.0, 0, 19, log_n));
        assert!(pastis(100.0 - worth + 1e-3, 2, 19, log_n) < pastis(100.0, 0, 19, log_n));
        // A menu of 190 asks for 2 · 2 · ln 10 more.
        assert!((pastis(100.0, 2, 19, log_n) - pastis(100.0, 2, 190, log_n) - 2.0 * 10f64.ln()).abs() < 1e-12);
    }

    /// Ten headings, so the variance of a sum is that of independent numbers. The richer model is better by 0.1 ± 1 a
    /// heading: 1 in all with a standard error of √10. Better by 3 ± 1 it is better by 30.
    #[test]
    fn the_simplest_of_models_that_predict_alike_is_taken() {
        let losses = |shift: f64| vec![(0..10).map(|k| 5.0 - shift + if k % 2 == 0 { 1.0 } else { -1.0 }).collect()];
        let simple = vec![vec![5.0; 10]];
        assert_eq!(simplest(&[losses(0.1), simple.clone()], &[1, 0]), Some(1));
        assert_eq!(simplest(&[losses(3.0), simple.clone()], &[1, 0]), Some(0));
        // The standard error is 3.16: 6 in all is within two of them, 7 is not.
        assert_eq!(simplest(&[losses(0.6), simple.clone()], &[1, 0]), Some(1));
        assert_eq!(simplest(&[losses(0.7), simple.clone()], &[1, 0]), Some(0));
        let broken = vec![vec![f64::NAN; 10]];
        assert_eq!(simplest(&[broken.clone(), simple], &[0, 1]), Some(1));
        assert_eq!(simplest(&[broken], &[0]), None);
    }

    /// Nothing is added that is not among the places; of two forms of one place that of lower BIC is taken.
    #[test]
    fn a_structure_takes_all_it_may_and_nothing_else() {
        let names: [Names; 5] = [vec![], vec![CUBIC], vec![SQUARE], vec![WIND], vec![CUBIC, WIND]];
        let fits = [100.0, 50.0, 60.0, 90.0, 40.0].map(noted);
        let contenders: Vec<(&Names, &Noted)> = names.iter().zip(&fits).collect();
        let [damping, wind] = [("nonlinear_damping", None), ("wind_moment", None)];
        let took = |included: &[Place]| taking(&contenders, &included.iter().copied().collect());
        assert_eq!(took(&[]), Some(0));
        assert_eq!(took(&[damping]), Some(1));
        assert_eq!(took(&[wind]), Some(3));
        assert_eq!(took(&[damping, wind]), Some(4));
        // Nobody has tried all three together.
        assert_eq!(took(&[damping, wind, ("speed_loss", None)]), Some(4));
        assert_eq!(taking(&contenders[1..], &BTreeSet::new()), None);
    }
}
