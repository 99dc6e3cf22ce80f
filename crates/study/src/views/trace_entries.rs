//! Effects, candidates and structures as entries of `trace.json`.

use std::collections::BTreeMap;

use ::trace::analysis::{Considered, Fitted, Outcome, Step, Traced};
use ::trace::search::{Weighted, Weights};
use ::trace::structure::TermName;
use serde::Serialize;
use ship::Particulars;
use ship::angle::to_deg;
use ship::particulars::prime_unit;
use trial::Quantity;

/// A parameter.
#[derive(Debug, Clone, Serialize, schemars::JsonSchema)]
pub struct ParameterEntry {
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit.
    pub unit: &'static str,
    /// The same without dimension, where length and speed of the ship are known and it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub prime: Option<PrimeEntry>,
    /// The one record it belongs to.
    pub only: Option<String>,
    /// Whether it ends at an end of its range; left out where it does not.
    #[serde(skip_serializing_if = "is_false")]
    pub at_bound: bool,
}

/// A number without dimension; angles in radians.
#[derive(Debug, Clone, Serialize, schemars::JsonSchema)]
pub struct PrimeEntry {
    /// Value, standard deviation and 95 % interval.
    #[serde(flatten)]
    pub quantity: Quantity,
    /// Unit: 1, or one of angles.
    pub unit: String,
}

/// Whether a flag is left out.
pub fn is_false(flag: &bool) -> bool {
    !flag
}

/// A model on the way from the base to the final one.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct StepEntry {
    /// Identifier of the effect that was added; null for the base.
    added: Option<&'static str>,
    form: Option<&'static str>,
    heading_rmse_deg: f64,
    held_out_heading_rmse_deg: Option<f64>,
    delta_bic: Option<f64>,
}

impl From<&Step> for StepEntry {
    fn from(step: &Step) -> Self {
        Self {
            added: step.added.map(|(id, ..)| id),
            form: step.added.map(|(_, form, _)| form),
            heading_rmse_deg: to_deg(step.fitted),
            held_out_heading_rmse_deg: step.held_out.map(to_deg),
            delta_bic: step.gain,
        }
    }
}

/// An effect that was found.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct EffectEntry {
    id: &'static str,
    form: &'static str,
    equation: &'static str,
    only: Option<String>,
    /// Whether it is in the model on request; left out where it was found.
    #[serde(skip_serializing_if = "is_false")]
    asked: bool,
    aliases: Vec<&'static str>,
    alias_forms: Vec<String>,
    parameters: BTreeMap<&'static str, ParameterEntry>,
    probability: f64,
    delta_bic: f64,
    p_value: f64,
    residual_share: Option<f64>,
    evidence: String,
}

/// An effect of the list.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct CandidateEntry {
    id: &'static str,
    outcome: &'static str,
    probability: f64,
    delta_bic: Option<f64>,
    p_value: Option<f64>,
    reason: Option<&'static str>,
    forms: Vec<FormEntry>,
}

/// An effect in one form.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct FormEntry {
    form: &'static str,
    only: Option<String>,
    outcome: &'static str,
    probability: f64,
    delta_bic: Option<f64>,
    p_value: Option<f64>,
    delta_bic_alone: Option<f64>,
    visibility: Option<f64>,
}

/// A structure that the records cannot tell from the best.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct StructureEntry {
    effects: Vec<TermEntry>,
    weight: f64,
    delta_bic: f64,
}

/// A term of a structure.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct TermEntry {
    id: &'static str,
    form: &'static str,
    only: Option<String>,
}

/// What the probabilities rest on.
#[derive(Debug, Serialize, schemars::JsonSchema)]
pub struct PriorEntry {
    /// Places of the menu: effects, and moments of time once for every record.
    menu: usize,
    /// Prior probability of each.
    probability_of_each: f64,
    /// Structures that were weighed.
    structures: usize,
}

impl ParameterEntry {
    /// The entry of a parameter of a ship of these particulars.
    pub fn new(fitted: &Fitted, ship: Option<Particulars>) -> Self {
        let Fitted { parameter, quantity, ref only, at_bound } = *fitted;
        let prime = ship
            .filter(|_| parameter.dimension() != [0, 0])
            .map(|ship| PrimeEntry { quantity: fitted.prime(ship), unit: prime_unit(parameter.unit) });
        Self { quantity, unit: parameter.unit, prime, only: only.clone(), at_bound }
    }
}

impl EffectEntry {
    /// The entry of an effect of a ship of these particulars.
    pub fn new(effect: &Traced, ship: Option<Particulars>) -> Self {
        let mut aliases: Vec<&'static str> =
            effect.aliases.iter().map(|(id, _)| *id).filter(|id| *id != effect.id).collect();
        aliases.dedup();
        let parameter = |fitted: &Fitted| (fitted.parameter.symbol, ParameterEntry::new(fitted, ship));
        Self {
            id: effect.id,
            form: effect.form,
            equation: effect.equation,
            only: effect.only.clone(),
            asked: effect.asked,
            aliases,
            alias_forms: effect.aliases.iter().map(|(id, form)| format!("{id} ({form})")).collect(),
            parameters: effect.parameters.iter().map(parameter).collect(),
            probability: effect.probability,
            delta_bic: -effect.evidence.gain,
            p_value: effect.evidence.p_value,
            residual_share: effect.residual_share,
            evidence: effect.sentence.clone(),
        }
    }
}

/// Outcomes from the one that says most about an effect to the one that says least.
const RANK: [Outcome; 4] = [Outcome::Added, Outcome::Alias, Outcome::Rejected, Outcome::NotObservable];

/// One entry an effect: its best form speaks for it.
pub fn candidates(all: &[Considered], weights: &Weights) -> Vec<CandidateEntry> {
    let mut ids: Vec<&'static str> = Vec::new();
    for one in all {
        if !ids.contains(&one.id) {
            ids.push(one.id);
        }
    }
    ids.into_iter()
        .map(|id| {
            let forms = || all.iter().filter(|one| one.id == id);
            let place = |one: &Considered| RANK.iter().position(|outcome| *outcome == one.outcome);
            let gain = |one: &Considered| one.evidence.map_or(f64::NEG_INFINITY, |evidence| evidence.gain);
            let best = forms()
                .min_by(|one, other| place(one).cmp(&place(other)).then(gain(other).total_cmp(&gain(one))))
                .expect("every identifier was taken from a form");
            CandidateEntry {
                id,
                outcome: best.outcome.as_str(),
                probability: weights.of_effect(id),
                delta_bic: best.evidence.map(|evidence| -evidence.gain),
                p_value: best.evidence.map(|evidence| evidence.p_value),
                reason: best.reason,
                forms: forms()
                    .map(|one| FormEntry {
                        form: one.form,
                        only: one.only.clone(),
                        outcome: one.outcome.as_str(),
                        probability: one.probability,
                        delta_bic: one.evidence.map(|evidence| -evidence.gain),
                        p_value: one.evidence.map(|evidence| evidence.p_value),
                        delta_bic_alone: one.gain_alone.map(|gain| -gain),
                        visibility: one.visibility,
                    })
                    .collect(),
            }
        })
        .collect()
}

impl StructureEntry {
    /// The entry of a weighted structure; `names` are those of the records.
    pub fn new(weighted: &Weighted, names: &[String]) -> Self {
        let term = |&(id, form, only): &TermName| TermEntry { id, form, only: only.map(|only| names[only.0].clone()) };
        Self { effects: weighted.terms.iter().map(term).collect(), weight: weighted.weight, delta_bic: weighted.bic }
    }
}

impl PriorEntry {
    /// The prior of these weights.
    pub fn new(weights: &Weights) -> Self {
        Self { menu: weights.menu, probability_of_each: weights.prior, structures: weights.structures.len() }
    }
}
