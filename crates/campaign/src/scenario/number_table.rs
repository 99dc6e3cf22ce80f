//! Tables that hold numbers alone, such as those of an effect or of a ship of one's own: their keys are data, from
//! which they are checked, completed and described to an editor.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::scenario::problem::{KeyFault, KeyPath, suggestion};
use crate::scenario::reader;

/// One name, and below it numbers by their keys.
pub type NamedNumbers = BTreeMap<String, BTreeMap<String, f64>>;

/// A number of such a table.
#[derive(Debug, Clone, Copy)]
pub struct NumberKey {
    /// The key, whose end says the unit.
    pub key: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// Whether it cannot be left out.
    pub is_required: bool,
    /// What holds when it is left out.
    pub default: Option<f64>,
}

impl NumberKey {
    /// A number that cannot be left out.
    pub const fn required(key: &'static str, meaning: &'static str) -> Self {
        Self { key, meaning, is_required: true, default: None }
    }

    /// A number that may be left out.
    pub const fn optional(key: &'static str, meaning: &'static str, default: Option<f64>) -> Self {
        Self { key, meaning, is_required: false, default }
    }
}

/// The one name and its numbers, with the key of the name; else the fault, with the names that are `known`.
pub fn only<'a>(
    named: &'a NamedNumbers,
    place: &KeyPath,
    known: &[&str],
) -> Result<(&'a str, KeyPath, &'a BTreeMap<String, f64>), KeyFault> {
    let mut entries = named.iter();
    match (entries.next(), entries.next()) {
        (Some((name, numbers)), None) => Ok((name, place.child(name), numbers)),
        _ => Err(reader::not_one_name(place.clone(), named.keys(), known)),
    }
}

/// Refuses a key that is not among these.
pub fn refuse_unknown(numbers: &BTreeMap<String, f64>, keys: &[NumberKey], table: &KeyPath) -> Result<(), KeyFault> {
    let known: Vec<&str> = keys.iter().map(|own| own.key).collect();
    numbers.keys().find(|name| !known.contains(&name.as_str())).map_or(Ok(()), |name| {
        let found = format!("`{table}` has no key `{name}`");
        Err(KeyFault::name(table.child(name), found, "no such key here", suggestion(name, &known)))
    })
}

/// Refuses a table without a number that it cannot do without.
pub fn refuse_incomplete(numbers: &BTreeMap<String, f64>, keys: &[NumberKey], table: &KeyPath) -> Result<(), KeyFault> {
    let missing = keys.iter().find(|own| own.is_required && !numbers.contains_key(own.key));
    missing.map_or(Ok(()), |own| Err(reader::missing(table, own.key)))
}

/// Writes down what holds for keys that are left out.
pub fn complete(numbers: &mut BTreeMap<String, f64>, keys: &[NumberKey]) {
    for (own, default) in keys.iter().filter_map(|own| Some((own, own.default?))) {
        numbers.entry(own.key.to_owned()).or_insert(default);
    }
}

/// The schema of such a table.
pub fn schema(keys: &[NumberKey]) -> Value {
    let number = |own: &NumberKey| {
        let mut number = json!({ "type": "number", "format": "double", "description": own.meaning });
        if let Some(default) = own.default {
            number["default"] = default.into();
        }
        (own.key.to_owned(), number)
    };
    let required = keys.iter().filter(|own| own.is_required).map(|own| own.key).collect();
    closed(keys.iter().map(number).collect(), required)
}

/// The schema of a table that has no other keys.
pub fn closed(properties: Map<String, Value>, required: Vec<&str>) -> Value {
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}
