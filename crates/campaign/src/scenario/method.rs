//! Methods of a scenario: labels, settings and procedures.

use std::sync::Arc;

use ::trace::{EffectId, Selection, WeightingRule, empirical};
use identify::settings::SettingsError;
use identify::{Estimate, Identifier, IdentifierSettings, IdentifyError};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use ship::effects::Formula;
use simulate::{RngPurpose, StreamKey};
use trial::Trial;

use crate::scenario::outside_estimates::{self, OutsideEstimates};
use crate::scenario::problem::{KeyFault, KeyPath, text_fault};
use crate::scenario::{effect, limits, name};

/// Method as named in a scenario.
#[derive(Clone)]
pub struct Method {
    /// Label in tables and plots; unique in the scenario.
    pub label: String,
    /// Procedure on the trial.
    pub procedure: Procedure,
}

/// Procedure of a method on a trial.
#[derive(Clone)]
pub enum Procedure {
    /// Identifies a first-order response.
    Identify {
        /// Settings of the method; `None` for a method outside the registry.
        settings: Option<IdentifierSettings>,
        /// Method with its settings.
        identifier: Arc<dyn Identifier>,
    },
    /// Traces the effects missing from a first-order response.
    Trace(::trace::Settings),
    /// Estimates of an outside estimator, by trial.
    OutsideEstimates(Arc<OutsideEstimates>),
    /// Null model: the ship keeps her heading, which is fitted.
    StraightOn,
}

impl Procedure {
    /// Id of the method.
    pub fn id(&self) -> &'static str {
        match self {
            Self::Identify { identifier, .. } => identifier.id(),
            Self::Trace(_) => TRACE_ID,
            Self::OutsideEstimates(_) => outside_estimates::METHOD_ID,
            Self::StraightOn => STRAIGHT_ON_ID,
        }
    }

    /// One-line summary.
    pub fn summary(&self) -> &str {
        match self {
            Self::Identify { identifier, .. } => identifier.summary(),
            Self::Trace(settings) if settings.uses_minimal_channels => {
                "a trace of heading, yaw rate and rudder alone, the signals that all other methods read"
            }
            Self::Trace(_) => {
                "a first-order response with the effects it lacks; it also reads speed, sway and wind, those of a \
                 measured validation record included"
            }
            Self::OutsideEstimates(_) => "answers of an outside estimator",
            Self::StraightOn => "a ship that keeps her heading: the null model",
        }
    }

    /// First-order estimate from all records of one trial; `None` for procedures without one. A randomised method uses
    /// the random stream of this trial.
    pub fn identify(&self, trials: &[Trial], key: &StreamKey) -> Option<Result<Estimate, IdentifyError>> {
        match self {
            Self::Identify { identifier, .. } => Some(identify(identifier.as_ref(), trials, key)),
            Self::Trace(_) | Self::StraightOn => None,
            Self::OutsideEstimates(answers) => Some(answers.estimate((key.cell, key.replicate))),
        }
    }
}

/// First-order estimate from all records of one trial; a randomised method uses the random stream of this trial.
pub fn identify(identifier: &dyn Identifier, trials: &[Trial], key: &StreamKey) -> Result<Estimate, IdentifyError> {
    let seeded = identifier.with_seed(key.rng(RngPurpose::Method).random());
    seeded.as_deref().unwrap_or(identifier).identify(trials)
}

/// Method id of a trace.
pub const TRACE_ID: &str = "trace";

/// Method id of the null model, a ship that keeps her heading.
pub const STRAIGHT_ON_ID: &str = "straight-on";

/// Label and id of a method.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct MethodName {
    /// Label in tables and plots.
    pub label: String,
    /// Id of the method.
    pub id: String,
}

/// Method with its settings: one key in addition to the label, the id of the method; or a trace of what the base
/// lacks; or the floor of all errors.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct IdentifierWire {
    /// Label in tables and plots; the id of the method if omitted.
    pub label: Option<String>,
    /// Method by its id, with its settings.
    pub method: Option<IdentifierSettings>,
    /// In place of a method: a trace of the effects missing from the first-order response.
    pub trace: Option<TraceWire>,
    /// In place of a method: a ship that keeps her heading, the floor of all errors.
    pub straight_on: Option<StraightOnWire>,
}

/// Settings of a ship that keeps her heading: none.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct StraightOnWire {}

/// Settings of a trace.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct TraceWire {
    /// Weighting rule of the structures.
    rule: WeightingRule,
    /// Minimum probability of a named effect.
    probability: f64,
    /// Effects that may be missing; all if omitted.
    menu: Option<Vec<String>>,
    /// Number of monomials among the candidates.
    monomials: usize,
    /// `true` if speed, sway, propeller and wind are not used.
    heading_alone: bool,
    /// Effects as lines of text, `bank = c * tanh(k * psi)`, candidates like those of the list.
    formulas: Vec<String>,
}

impl Default for TraceWire {
    fn default() -> Self {
        let ::trace::Settings { rule, min_probability: probability, monomial_count: monomials, .. } =
            ::trace::Settings::default();
        Self { rule, probability, menu: None, monomials, heading_alone: false, formulas: Vec::new() }
    }
}

/// Methods with unique labels.
pub(crate) fn methods(wire: &[IdentifierWire]) -> Result<Vec<Method>, KeyFault> {
    limits::check_count("identifier", wire.len(), limits::MAX_METHODS)?;
    let list = KeyPath::from_dotted("identifier");
    let mut methods: Vec<Method> = Vec::with_capacity(wire.len());
    for (index, entry) in wire.iter().enumerate() {
        let key = list.child(index);
        let procedure = procedure(entry, &key)?;
        let label = entry.label.clone().unwrap_or_else(|| procedure.id().to_owned());
        name::check_label(&label).map_err(|unfit| text_fault(key.child("label"), &label, unfit))?;
        if methods.iter().any(|method| method.label == label) {
            return Err(KeyFault::name(
                key.child("label"),
                format!("two methods are called `{label}`"),
                "expected every method to have a name of its own",
                format!("add a label to one of them, for instance `label = \"{label} (2)\"`"),
            ));
        }
        methods.push(Method { label, procedure });
    }
    if methods.is_empty() {
        return Err(KeyFault::name(
            list,
            "`identifier` names no method",
            "expected at least one method",
            "add [[identifier]] and below it `method.output-error = {}`",
        ));
    }
    Ok(methods)
}

/// Method, trace or null model of an entry. Fails unless exactly one is named, and for an invalid setting.
fn procedure(entry: &IdentifierWire, key: &KeyPath) -> Result<Procedure, KeyFault> {
    match (&entry.method, &entry.trace, &entry.straight_on) {
        (Some(settings), None, None) => {
            let table = key.child("method").child(registry_id(settings));
            let identifier = settings.build().map_err(|error| refused(&table, &error))?;
            Ok(Procedure::Identify { settings: Some(settings.clone()), identifier: identifier.into() })
        }
        (None, None, Some(StraightOnWire {})) => Ok(Procedure::StraightOn),
        (None, Some(wire), None) => {
            let table = key.child("trace");
            let lines = wire.formulas.iter().enumerate();
            let read = lines.map(|(index, line)| effect::parse_formula(line, table.child("formulas").child(index)));
            let formulas = read.collect::<Result<_, _>>()?;
            tracing(wire, formulas).map(Procedure::Trace).map_err(|error| refused(&table, &error))
        }
        (None, None, None) => Err(KeyFault::name(
            key.clone(),
            format!("`{key}` names no method"),
            "expected one of `method`, `trace` and `straight-on`",
            "write `method.output-error = {}` for a method, or `trace = {}` to trace what the base lacks",
        )),
        _ => Err(KeyFault::name(
            key.clone(),
            format!("`{key}` names several methods"),
            "expected one of `method`, `trace` and `straight-on`",
            "give each an [[identifier]] of its own",
        )),
    }
}

/// Fault of a refused setting, at its key.
fn refused(table: &KeyPath, error: &SettingsError) -> KeyFault {
    let key = error.key.split('.').fold(table.clone(), |key, part| key.child(part));
    KeyFault::new(key, &error.value, format!("expected {}", error.expected), "change the value, or leave the key out")
}

/// Settings of a trace, without restarted replays and proposals, which a study does not use.
fn tracing(wire: &TraceWire, formulas: Vec<Arc<Formula>>) -> Result<::trace::Settings, SettingsError> {
    let TraceWire { rule, probability, ref menu, monomials, heading_alone, .. } = *wire;
    let selection = menu.as_deref().map_or_else(|| Ok(Selection::default()), selection_from)?;
    let selection = Selection { formulas, ..selection };
    if monomials > empirical::all_monomials().len() {
        return Err(SettingsError::new("monomials", monomials, "at most as many as there are, which is 59"));
    }
    let usual = ::trace::Settings { is_thorough: false, ..::trace::Settings::default() };
    let settings = ::trace::Settings {
        min_probability: probability,
        rule,
        monomial_count: monomials,
        selection,
        uses_minimal_channels: heading_alone,
        ..usual
    };
    settings.check()?;
    Ok(settings)
}

/// Selection of the effects of a menu.
fn selection_from(menu: &[String]) -> Result<Selection, SettingsError> {
    let id = |name: &String| {
        EffectId::find(name).ok_or_else(|| SettingsError::new("menu", name, "an effect of `study list effects`"))
    };
    Ok(Selection::among(&menu.iter().map(id).collect::<Result<Vec<_>, _>>()?))
}

/// Identifier of a method: the key of its settings in a scenario.
fn registry_id(settings: &IdentifierSettings) -> String {
    let table = toml::Table::try_from(settings).unwrap_or_default();
    table.keys().next().cloned().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn traced(keys: &str) -> Result<::trace::Settings, String> {
        let wire: IdentifierWire =
            toml::from_str(&format!("trace = {{ {keys} }}")).map_err(|error| error.to_string())?;
        tracing(&wire.trace.expect("a trace"), Vec::new()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_trace_has_a_rule_and_a_menu() {
        let usual = traced("").expect("the usual");
        assert_eq!(usual, ::trace::Settings { is_thorough: false, ..::trace::Settings::default() });
        let keys = "rule = \"bic\", menu = [\"wind_moment\"], monomials = 59, probability = 0.9";
        let other = traced(keys).expect("settings in range");
        assert_eq!((other.rule, other.monomial_count, other.min_probability), (WeightingRule::Bic, 59, 0.9));
        let allowed = ["wind_moment", "speed_loss", "wave_yaw"].map(|id| other.selection.allows(id));
        assert_eq!(allowed, [true, false, false]);
    }

    #[test]
    fn what_a_trace_does_not_know_is_refused_by_name() {
        let refused = |keys: &str, name: &str| {
            let error = traced(keys).expect_err("out of range");
            assert!(error.contains(name), "{error}");
        };
        refused("rule = \"aic\"", "expected `posterior` or `bic`");
        refused("probability = 0.4", "probability");
        refused("gain = 6.0", "gain");
        refused("menu = [\"wind\"]", "wind");
        refused("monomials = 60", "59");
        assert_eq!(empirical::all_monomials().len(), 59);
    }
}
