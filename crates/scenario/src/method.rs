//! The methods of a scenario: what each is called, and what it does with a trial.

use std::sync::Arc;

use ::trace::search::Thresholds;
use identify::{Estimate, Identifier, IdentifierSettings, IdentifyError};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use ship::Shown;
use simulate::{Purpose, StreamKey};
use trial::Trial;

use crate::problem::{KeyPath, Problem, of_text};
use crate::{limits, name};

/// A method as a scenario names it.
#[derive(Clone)]
pub struct Method {
    /// Label in tables and figures; unique in the scenario.
    pub label: String,
    /// Id of the method.
    pub id: &'static str,
    /// What it does.
    pub procedure: Procedure,
}

/// What a method does with a trial.
#[derive(Clone)]
pub enum Procedure {
    /// Identifies a first-order response.
    Identify {
        /// Settings of the method; `None` for one that comes from outside the registry.
        settings: Option<IdentifierSettings>,
        /// The method with its settings.
        identifier: Arc<dyn Identifier>,
    },
    /// Traces what a first-order response lacks.
    Trace(::trace::Settings),
}

/// Id of a trace among the methods.
pub const TRACE: &str = "trace";

/// What a method is called, and which it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MethodName {
    /// Label in tables and figures.
    pub label: String,
    /// Id of the method.
    pub id: String,
}

/// Identifies one trial; a method that draws at random draws from the stream of this trial.
pub fn identify(identifier: &dyn Identifier, trial: &Trial, key: &StreamKey) -> Result<Estimate, IdentifyError> {
    let own = identifier.with_seed(key.rng(Purpose::Method).random());
    own.as_deref().unwrap_or(identifier).identify(std::slice::from_ref(trial))
}

/// A method with its settings: one key beside the label, the id of the method; or a trace of what the base lacks.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct IdentifierWire {
    pub label: Option<String>,
    pub method: Option<IdentifierSettings>,
    pub trace: Option<TraceWire>,
}

/// Thresholds of a trace.
#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub(crate) struct TraceWire {
    /// Smallest gain in BIC.
    pub gain: f64,
    /// Probability of naming any effect where there is none.
    pub false_discovery: f64,
    /// Most effects.
    pub most_effects: usize,
}

impl Default for TraceWire {
    fn default() -> Self {
        let Thresholds { gain, false_discovery, most_terms } = ::trace::Settings::default().thresholds;
        Self { gain, false_discovery, most_effects: most_terms }
    }
}

/// The methods, all with names of their own.
pub(crate) fn methods(wire: &[IdentifierWire]) -> Result<Vec<Method>, Problem> {
    limits::entries("identifier", wire.len(), limits::MOST_METHODS)?;
    let list = KeyPath::dotted("identifier");
    let mut methods: Vec<Method> = Vec::with_capacity(wire.len());
    for (index, entry) in wire.iter().enumerate() {
        let key = list.child(index);
        let procedure = procedure(entry, &key)?;
        let id = match &procedure {
            Procedure::Identify { identifier, .. } => identifier.id(),
            Procedure::Trace(_) => TRACE,
        };
        let label = entry.label.clone().unwrap_or_else(|| id.to_owned());
        name::label(&label).map_err(|unfit| of_text(key.child("label"), &label, unfit))?;
        if methods.iter().any(|method| method.label == label) {
            return Err(Problem::name(
                key.child("label"),
                format!("two methods are called `{label}`"),
                "expected every method to have a name of its own",
                format!("add a label to one of them, for instance `label = \"{label} (2)\"`"),
            ));
        }
        methods.push(Method { label, id, procedure });
    }
    if methods.is_empty() {
        return Err(Problem::name(
            list,
            "`identifier` names no method",
            "expected at least one method",
            "add [[identifier]] and below it `method.output-error = {}`",
        ));
    }
    Ok(methods)
}

/// What one entry asks for.
fn procedure(entry: &IdentifierWire, key: &KeyPath) -> Result<Procedure, Problem> {
    match (&entry.method, &entry.trace) {
        (Some(settings), None) => {
            let identifier = settings.build().map_err(|error| {
                let id = registry_id(settings);
                let setting = error.key.split('.').fold(key.child("method").child(id), |key, part| key.child(part));
                let found = format!("`{setting}` is {}", error.found);
                Problem::value(
                    setting,
                    found,
                    format!("expected {}", error.expected),
                    "change the value, or leave the key out",
                )
            })?;
            Ok(Procedure::Identify { settings: Some(settings.clone()), identifier: identifier.into() })
        }
        (None, Some(trace)) => tracing(trace, &key.child("trace")).map(Procedure::Trace),
        (method, _) => Err(Problem::name(
            key.clone(),
            format!("`{key}` names {}", if method.is_some() { "a method and a trace" } else { "no method" }),
            "expected one of the two",
            "write `method.output-error = {}` for a method, or `trace = {}` to trace what the base lacks",
        )),
    }
}

/// Settings of a trace; a benchmark needs no errors of restarted replays and no proposals.
fn tracing(wire: &TraceWire, key: &KeyPath) -> Result<::trace::Settings, Problem> {
    let refuse = |name: &str, value: f64, expected: &str| {
        let key = key.child(name);
        let found = format!("`{key}` is {}", Shown(value));
        Problem::value(key, found, format!("expected {expected}"), "change the value, or leave the key out")
    };
    if !(wire.gain.is_finite() && wire.gain >= 0.0) {
        return Err(refuse("gain", wire.gain, "a gain in BIC of at least 0"));
    }
    if !(wire.false_discovery > 0.0 && wire.false_discovery <= 1.0) {
        return Err(refuse("false-discovery", wire.false_discovery, "a probability above 0 and up to 1"));
    }
    if wire.most_effects > limits::MOST_EFFECTS {
        let key = key.child("most-effects");
        let found = format!("`{key}` is {}", wire.most_effects);
        let expected = format!("expected at most {}", limits::MOST_EFFECTS);
        return Err(Problem::value(key, found, expected, "change the value, or leave the key out"));
    }
    Ok(::trace::Settings {
        thresholds: Thresholds {
            gain: wire.gain,
            false_discovery: wire.false_discovery,
            most_terms: wire.most_effects,
        },
        discovery: false,
        thorough: false,
        ..::trace::Settings::default()
    })
}

/// The key of a method in a scenario.
fn registry_id(settings: &IdentifierSettings) -> String {
    let table = toml::Table::try_from(settings).unwrap_or_default();
    table.keys().next().cloned().unwrap_or_default()
}
