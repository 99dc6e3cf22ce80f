//! What can be wrong with a document as it is read, and the words for it.

use std::fmt;

use serde::de;

use crate::problem::{KeyPath, Mark, Problem, listed, suggestion};

/// Where a node stands: a chain through the nodes above it, put together only when there is a fault to tell.
#[derive(Debug, Clone, Copy)]
pub enum Place<'a> {
    Root(&'a KeyPath),
    Name(&'a Place<'a>, &'a str),
    Index(&'a Place<'a>, usize),
}

impl Place<'_> {
    fn path(&self) -> KeyPath {
        match self {
            Self::Root(key) => (*key).clone(),
            Self::Name(above, name) => above.path().child(name),
            Self::Index(above, index) => above.path().child(index),
        }
    }
}

/// What is wrong, before it is put into words.
#[derive(Debug)]
pub enum Fault {
    UnknownKey { name: String, known: &'static [&'static str] },
    UnknownName { name: String, known: &'static [&'static str], mark: Mark },
    MissingKey { name: &'static str },
    NotOneName { found: Vec<String>, known: &'static [&'static str] },
    NoSettings { name: String },
    Type { found: String, expected: &'static str },
    Other { message: String },
}

/// A fault and the key it belongs to, as soon as that is known.
#[derive(Debug)]
pub struct Error {
    key: Option<KeyPath>,
    pub fault: Fault,
}

impl Error {
    pub fn new(place: &Place, fault: Fault) -> Self {
        Self { key: Some(place.path()), fault }
    }

    /// The same error at `place`, unless a more precise one is known.
    pub fn at(self, place: &Place) -> Self {
        Self { key: Some(self.key.unwrap_or_else(|| place.path())), ..self }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} at {:?}", self.fault, self.key)
    }
}

impl std::error::Error for Error {}

impl de::Error for Error {
    fn custom<T: fmt::Display>(message: T) -> Self {
        Self { key: None, fault: Fault::Other { message: message.to_string() } }
    }

    fn unknown_field(name: &str, known: &'static [&'static str]) -> Self {
        Self { key: None, fault: Fault::UnknownKey { name: name.to_owned(), known } }
    }

    fn unknown_variant(name: &str, known: &'static [&'static str]) -> Self {
        Self { key: None, fault: Fault::UnknownName { name: name.to_owned(), known, mark: Mark::Name } }
    }

    fn missing_field(name: &'static str) -> Self {
        Self { key: None, fault: Fault::MissingKey { name } }
    }
}

impl From<Error> for Problem {
    fn from(error: Error) -> Self {
        let key = error.key.unwrap_or_default();
        let place = if key.parts().is_empty() { "a scenario".to_owned() } else { format!("`{key}`") };
        match error.fault {
            Fault::UnknownKey { name, known } => Problem::name(
                key.child(&name),
                format!("{place} has no key `{name}`"),
                "no such key here",
                suggestion(&name, known),
            ),
            Fault::UnknownName { name, known, mark: Mark::Value } => {
                Problem::value(key, format!("{place} is the text \"{name}\""), "no such name", suggestion(&name, known))
            }
            Fault::UnknownName { name, known, mark: Mark::Name } => {
                let found = format!("no {} is called `{name}`", kind_of(&key));
                Problem::name(key, found, "no such name", suggestion(&name, known))
            }
            Fault::MissingKey { name } => Problem::name(
                key,
                format!("{place} has no key `{name}`"),
                format!("expected `{name}` here"),
                match name {
                    "ship" => "add the ship, for instance [ship.yukun]; `study list ships` names them".to_owned(),
                    "manoeuvre" => "add the manoeuvre, for instance [manoeuvre.zig-zag]; `study list manoeuvres` names them".to_owned(),
                    "identifier" => "add a method: [[identifier]] and below it `method.output-error = {}`; `study list identifiers` names them".to_owned(),
                    "recording" => "add [recording] and below it `sampling-s` and `duration-s`".to_owned(),
                    _ => format!("add a line `{name} = …`"),
                },
            ),
            Fault::NotOneName { found, known } if found.is_empty() => Problem::name(
                key,
                format!("{place} names nothing"),
                "expected exactly one name below it",
                format!("use one of {}", listed(known)),
            ),
            Fault::NotOneName { found, .. } => Problem::name(
                key,
                format!("{place} names {} things at once: {}", found.len(), listed(&found)),
                "expected exactly one name below it",
                "keep one of them",
            ),
            Fault::NoSettings { name } => {
                let advice = format!("write `{}.{name} = {{}}`", key.last());
                Problem::value(key, format!("{place} is the text \"{name}\""), "expected a name with its settings", advice)
            }
            Fault::Type { found, expected } => {
                let advice = match expected {
                    A_TABLE if key.parts() == ["ship"] => "write [ship.yukun] on a line of its own".to_owned(),
                    A_LIST if found == "a table" => format!("write [[{key}]] with two brackets"),
                    _ => "change the value".to_owned(),
                };
                Problem::value(key, format!("{place} is {found}"), format!("expected {expected}"), advice)
            }
            Fault::Other { message } => Problem::value(key, format!("{place}: {message}"), "not accepted", "change the value"),
        }
    }
}

/// What the names at a key stand for.
fn kind_of(key: &KeyPath) -> &'static str {
    match key.parts() {
        [manoeuvre, _] if manoeuvre == "manoeuvre" => "manoeuvre",
        [effect, _, _] if effect == "effect" => "effect",
        [_, _, method, _] if method == "method" => "method",
        _ => "setting",
    }
}

pub const A_TABLE: &str = "a table: `[name]`, or `{ key = value }`";
pub const A_LIST: &str = "a list: `[…]`, or tables under `[[name]]`";
