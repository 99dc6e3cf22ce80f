//! Words that a shell completes: parsers of options that know what they take, beside reading it.

use ::trace::EffectId;
use campaign::benchmark::BenchTask;
use campaign::scenario::{STRAIGHT_ON, TRACE};
use clap::builder::{PossibleValue, TypedValueParser};
use clap::{Arg, Command, Error};
use identify::registry;
use std::ffi::OsStr;

/// Stands for every method where methods are named.
pub const ALL: &str = "all";

/// A parser with words that it takes. Whether it takes others is for the parser to say, and how it refuses them.
#[derive(Clone)]
pub struct Completed<P> {
    parser: P,
    words: fn() -> Vec<String>,
}

/// What `parser` reads, and some `words` that it takes.
pub fn completed<P: TypedValueParser>(parser: P, words: fn() -> Vec<String>) -> Completed<P> {
    Completed { parser, words }
}

impl<P: TypedValueParser> TypedValueParser for Completed<P> {
    type Value = P::Value;

    fn parse_ref(&self, command: &Command, argument: Option<&Arg>, value: &OsStr) -> Result<P::Value, Error> {
        self.parser.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new((self.words)().into_iter().map(PossibleValue::new)))
    }
}

/// Methods of the project.
pub fn methods() -> Vec<String> {
    let built = registry::defaults().into_iter().filter_map(|settings| settings.build().ok());
    built.map(|method| method.id().to_owned()).collect()
}

/// The same, and the word for all of them.
pub fn methods_or_all() -> Vec<String> {
    methods().into_iter().chain([String::from(ALL)]).collect()
}

/// Methods of a scenario.
pub fn entrants() -> Vec<String> {
    methods().into_iter().chain([TRACE, STRAIGHT_ON].map(str::to_owned)).collect()
}

/// Tasks of the benchmark.
pub fn tasks() -> Vec<String> {
    BenchTask::ALL.map(|task| task.id().to_owned()).into()
}

/// Effects that a first-order response may lack.
pub fn effects() -> Vec<String> {
    EffectId::all().into_iter().map(|id| id.as_str().to_owned()).collect()
}

/// Rules by which structures are weighed.
pub fn rules() -> Vec<String> {
    ::trace::Rule::ALL.map(|rule| rule.as_str().to_owned()).into()
}
