//! Reader of typed values from a TOML document in memory. Every fault names its key, the value and the expected one,
//! so that a scenario as written and a scenario changed by a sweep give the same messages.

use std::fmt::Display;

use serde::de::value::{MapAccessDeserializer, MapDeserializer, SeqDeserializer};
use serde::de::{self, Deserializer, Expected, IntoDeserializer, Unexpected, Visitor};
use serde::{Deserialize, forward_to_deserialize_any};
use serde_path_to_error::Segment;
use toml::{Table, Value};

use crate::scenario::name::quoted_beginning;
use crate::scenario::problem::{KeyFault, KeyPath, backquoted_list, suggestion};

/// Value of type `T` from a whole document.
///
/// Fails with the key, the problem and the expected value.
pub fn read_document<'de, T: Deserialize<'de>>(document: &'de Table) -> Result<T, KeyFault> {
    read_table(document, &KeyPath::default())
}

/// Value of type `T` from the table at `key`. Fails as [`read_document`] does.
pub fn read_table<'de, T: Deserialize<'de>>(table: &'de Table, key: &KeyPath) -> Result<T, KeyFault> {
    serde_path_to_error::deserialize(entries(table)).map_err(|error| {
        let mut place = key.clone();
        let mut value: Option<&Value> = None;
        for segment in error.path() {
            let name = match segment {
                Segment::Seq { index } => index.to_string(),
                Segment::Map { key: name } | Segment::Enum { variant: name } => name.clone(),
                Segment::Unknown => continue,
            };
            let below = match value {
                None => table.get(&name),
                Some(Value::Array(items)) => name.parse().ok().and_then(|index: usize| items.get(index)),
                Some(value) => value.get(&name),
            };
            let Some(below) = below else { break };
            (place, value) = (place.child(name), Some(below));
        }
        error.into_inner().at(place, value)
    })
}

/// Entries of a table, each read separately.
fn entries(table: &Table) -> MapDeserializer<'_, impl Iterator<Item = (&str, Node<'_>)>, ReadFault> {
    MapDeserializer::new(table.iter().map(|(name, value)| (name.as_str(), Node(value))))
}

/// Deserialiser of a value. Unlike that of `toml`, it does not accept a list as a table.
struct Node<'de>(&'de Value);

impl<'de> IntoDeserializer<'de, ReadFault> for Node<'de> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Node<'de> {
    type Error = ReadFault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadFault> {
        match self.0 {
            Value::Table(table) => visitor.visit_map(entries(table)),
            Value::Array(items) => visitor.visit_seq(SeqDeserializer::new(items.iter().map(Node))),
            Value::String(text) => visitor.visit_str(text),
            Value::Integer(number) => visitor.visit_i64(*number),
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(answer) => visitor.visit_bool(*answer),
            Value::Datetime(_) => Err(de::Error::invalid_type(Unexpected::Other("date"), &visitor)),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, ReadFault> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, ReadFault> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadFault> {
        match self.0 {
            Value::Table(table) => visitor.visit_map(entries(table)),
            _ => Err(ReadFault::Kind(A_TABLE.to_owned())),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, ReadFault> {
        match self.0 {
            Value::String(name) => visitor.visit_enum(name.as_str().into_deserializer()),
            Value::Table(table) if table.len() == 1 => visitor.visit_enum(MapAccessDeserializer::new(entries(table))),
            Value::Table(_) => Err(ReadFault::NotOneName(names)),
            _ => Err(ReadFault::Kind("a name, with its settings below it".to_owned())),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier ignored_any
    }
}

/// Fault of a table that lacks a key.
pub fn missing_key(table: &KeyPath, name: &'static str) -> KeyFault {
    ReadFault::MissingKey(name).at(table.clone(), None)
}

/// Fault of a table with `names` if exactly one name is expected.
pub fn name_count_fault<'a>(table: KeyPath, names: impl Iterator<Item = &'a String>, choices: &[&str]) -> KeyFault {
    let names: Vec<&String> = names.collect();
    let (problem, advice) = match names.len() {
        0 => (format!("`{table}` names nothing"), format!("use one of {}", backquoted_list(choices))),
        several => (
            format!("`{table}` names {several} things at once: {}", backquoted_list(&names)),
            "keep one of them".into(),
        ),
    };
    KeyFault::name(table, problem, "expected exactly one name below it", advice)
}

/// Fault without its position.
#[derive(Debug, thiserror::Error)]
#[error("{self:?}")]
enum ReadFault {
    UnknownKey(String, &'static [&'static str]),
    UnknownName(String, &'static [&'static str]),
    MissingKey(&'static str),
    NotOneName(&'static [&'static str]),
    Kind(String),
    Other(String),
}

impl de::Error for ReadFault {
    fn custom<T: Display>(message: T) -> Self {
        Self::Other(message.to_string())
    }

    fn unknown_field(name: &str, names: &'static [&'static str]) -> Self {
        Self::UnknownKey(name.to_owned(), names)
    }

    fn unknown_variant(name: &str, names: &'static [&'static str]) -> Self {
        Self::UnknownName(name.to_owned(), names)
    }

    fn missing_field(name: &'static str) -> Self {
        Self::MissingKey(name)
    }

    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::Kind(expected.to_string())
    }

    fn invalid_value(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::Kind(expected.to_string())
    }

    fn invalid_length(_: usize, expected: &dyn Expected) -> Self {
        Self::Kind(expected.to_string())
    }
}

impl ReadFault {
    /// Fault at a key with its value; without a value, fault of the whole document.
    fn at(self, key: KeyPath, value: Option<&Value>) -> KeyFault {
        let called = |key: &KeyPath| match key.names() {
            [] => "a scenario".to_owned(),
            _ => format!("`{key}`"),
        };
        let place = called(&key);
        let text = value.and_then(Value::as_str);
        match self {
            Self::UnknownKey(name, names) => {
                let problem = format!("{} has no key `{name}`", called(&key.parent()));
                KeyFault::name(key, problem, "no such key here", suggestion(&name, names))
            }
            Self::UnknownName(name, names) if text == Some(&name) => KeyFault::value(
                key,
                format!("{place} is the text \"{name}\""),
                "no such name",
                suggestion(&name, names),
            ),
            Self::UnknownName(name, names) => {
                let key = key.child(&name);
                let problem = format!("no {} is called `{name}`", kind_of(&key));
                KeyFault::name(key, problem, "no such name", suggestion(&name, names))
            }
            Self::MissingKey(name) => KeyFault::name(
                key,
                format!("{place} lacks the key `{name}`"),
                format!("expected `{name}` here"),
                match name {
                    "ship" => "add the ship, for instance [ship.yukun]; `study list ships` names them".to_owned(),
                    "manoeuvre" => {
                        "add the manoeuvre, for instance [manoeuvre.zig-zag]; `study list manoeuvres` names them"
                            .to_owned()
                    }
                    "identifier" => "add a method: [[identifier]] and below it `method.output-error = {}`; `study \
                        list identifiers` names them"
                        .to_owned(),
                    "recording" => "add [recording] and below it `sampling-s` and `duration-s`".to_owned(),
                    _ => format!("add a line `{name} = …`"),
                },
            ),
            Self::NotOneName(names) => {
                name_count_fault(key, value.and_then(Value::as_table).into_iter().flat_map(Table::keys), names)
            }
            Self::Kind(expected) => {
                let expected = in_toml(&expected);
                let advice = match (expected, text) {
                    (SETTINGS, Some(name)) => format!("write `{}.{name} = {{}}`", key.last()),
                    (A_TABLE, _) if key.names() == ["ship"] => "write [ship.yukun] on a line of its own".to_owned(),
                    (A_LIST, _) if value.is_some_and(Value::is_table) => format!("write [[{key}]] with two brackets"),
                    _ => "change the value".to_owned(),
                };
                let written = value.map_or_else(|| "a table".to_owned(), described);
                KeyFault::value(key, format!("{place} is {written}"), format!("expected {expected}"), advice)
            }
            Self::Other(message) => {
                KeyFault::value(key, format!("{place}: {message}"), "not accepted", "change the value")
            }
        }
    }
}

const A_TABLE: &str = "a table: `[name]`, or `{ key = value }`";
const A_LIST: &str = "a list: `[…]`, or tables under `[[name]]`";
const SETTINGS: &str = "a name with its settings";

/// Name in TOML of the type that serde expected.
fn in_toml(expected: &str) -> &str {
    match expected {
        "f64" => "a number",
        "u64" | "usize" => "a whole number, 0 or above",
        "a boolean" => "true or false, without quotes",
        "a string" => "a text in quotes",
        "unit" => "the name alone, as a text in quotes",
        "newtype variant" => SETTINGS,
        "a map" => A_TABLE,
        "a sequence" => A_LIST,
        "an array of length 2" => "a list of two numbers",
        other => other,
    }
}

/// Description of a value in a message.
fn described(value: &Value) -> String {
    match value {
        Value::String(text) => format!("the text {}", quoted_beginning(text)),
        Value::Table(_) => "a table".to_owned(),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Datetime(date) => format!("the date {date}"),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::Boolean(answer) => answer.to_string(),
    }
}

/// Kind of object that the names at a key denote.
fn kind_of(key: &KeyPath) -> &'static str {
    match key.names() {
        [manoeuvre, _] if manoeuvre == "manoeuvre" => "manoeuvre",
        [effect, _, _] if effect == "effect" => "effect",
        [_, _, method, _] if method == "method" => "method",
        _ => "setting",
    }
}
