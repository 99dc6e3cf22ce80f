//! Option parsers with the values that a shell completes.

use ::trace::EffectId;
use campaign::benchmark::BenchTask;
use campaign::scenario::{STRAIGHT_ON_ID, TRACE_ID};
use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error};
use identify::registry;
use std::ffi::OsStr;

/// Value of `--method` that selects all methods.
pub const ALL_METHODS: &str = "all";

/// Parser with values for completion. The parser alone decides which values are valid.
#[derive(Clone)]
pub struct Completed<P> {
    parser: P,
    values: fn() -> Vec<String>,
}

/// The `parser`, with `values` that a shell completes.
pub fn completed<P: TypedValueParser>(parser: P, values: fn() -> Vec<String>) -> Completed<P> {
    Completed { parser, values }
}

impl<P: TypedValueParser> TypedValueParser for Completed<P> {
    type Value = P::Value;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<P::Value, Error> {
        self.parser.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new((self.values)().into_iter().map(PossibleValue::new)))
    }
}

/// Ids of all methods that do not combine other methods.
pub fn method_names() -> Vec<String> {
    let built = registry::default_settings().into_iter().filter_map(|settings| settings.build().ok());
    built.map(|method| method.id().to_owned()).collect()
}

/// Ids of [`method_names`], and [`ALL_METHODS`].
pub fn method_names_or_all() -> Vec<String> {
    method_names().into_iter().chain([String::from(ALL_METHODS)]).collect()
}

/// Ids of the methods of a scenario: those of [`method_names`], a trace, and the straight-on forecast.
pub fn scenario_method_names() -> Vec<String> {
    method_names().into_iter().chain([TRACE_ID, STRAIGHT_ON_ID].map(str::to_owned)).collect()
}

/// Ids of the tasks of the benchmark.
pub fn task_names() -> Vec<String> {
    BenchTask::ALL.map(|task| task.id().to_owned()).into()
}

/// Ids of the effects that a first-order response may lack.
pub fn effect_ids() -> Vec<String> {
    EffectId::all().into_iter().map(|id| id.as_str().to_owned()).collect()
}

/// Names of the rules that weight structures.
pub fn rule_names() -> Vec<String> {
    ::trace::WeightingRule::ALL.map(|rule| rule.as_str().to_owned()).into()
}
