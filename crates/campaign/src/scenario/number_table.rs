//! Tables of numbers, such as those of an effect or of a user's ship. A list of keys serves to check and complete a
//! table, and to describe it in the schema.

use std::collections::BTreeMap;

use serde_json::{Map, Value, json};

use crate::scenario::problem::{KeyFault, KeyPath, suggestion};
use crate::scenario::reader;

/// Tables of numbers by name.
pub type NamedNumbers = BTreeMap<String, BTreeMap<String, f64>>;

/// Key of a number in a table of numbers.
#[derive(Debug, Clone, Copy)]
pub struct NumberKey {
    /// Key, which ends in the unit.
    pub key: &'static str,
    /// Meaning, for documentation.
    pub meaning: &'static str,
    /// `true` if it is required.
    pub is_required: bool,
    /// Value of an omitted key; `None` without a default.
    pub default: Option<f64>,
}

impl NumberKey {
    /// Required number.
    pub const fn required(key: &'static str, meaning: &'static str) -> Self {
        Self { key, meaning, is_required: true, default: None }
    }

    /// Optional number.
    pub const fn optional(key: &'static str, meaning: &'static str, default: Option<f64>) -> Self {
        Self { key, meaning, is_required: false, default }
    }
}

/// Single name of a table, its key and its numbers. Fails for none or several; the message lists the `choices`.
pub fn single_entry<'a>(
    named: &'a NamedNumbers,
    place: &KeyPath,
    choices: &[&str],
) -> Result<(&'a str, KeyPath, &'a BTreeMap<String, f64>), KeyFault> {
    let mut entries = named.iter();
    match (entries.next(), entries.next()) {
        (Some((name, numbers)), None) => Ok((name, place.child(name), numbers)),
        _ => Err(reader::name_count_fault(place.clone(), named.keys(), choices)),
    }
}

/// Refuses a key that is not among `keys`.
pub fn refuse_unknown(numbers: &BTreeMap<String, f64>, keys: &[NumberKey], table: &KeyPath) -> Result<(), KeyFault> {
    let names: Vec<&str> = keys.iter().map(|number| number.key).collect();
    numbers.keys().find(|name| !names.contains(&name.as_str())).map_or(Ok(()), |name| {
        let problem = format!("`{table}` has no key `{name}`");
        Err(KeyFault::name(table.child(name), problem, "no such key here", suggestion(name, &names)))
    })
}

/// Refuses a table without a required number.
pub fn refuse_incomplete(numbers: &BTreeMap<String, f64>, keys: &[NumberKey], table: &KeyPath) -> Result<(), KeyFault> {
    let missing = keys.iter().find(|number| number.is_required && !numbers.contains_key(number.key));
    missing.map_or(Ok(()), |number| Err(reader::missing_key(table, number.key)))
}

/// Adds the defaults of missing keys.
pub fn fill_defaults(numbers: &mut BTreeMap<String, f64>, keys: &[NumberKey]) {
    for (number, default) in keys.iter().filter_map(|number| Some((number, number.default?))) {
        numbers.entry(number.key.to_owned()).or_insert(default);
    }
}

/// JSON schema of a table of numbers with these keys.
pub fn schema(keys: &[NumberKey]) -> Value {
    let number = |entry: &NumberKey| {
        let mut number = json!({ "type": "number", "format": "double", "description": entry.meaning });
        if let Some(default) = entry.default {
            number["default"] = default.into();
        }
        (entry.key.to_owned(), number)
    };
    let required = keys.iter().filter(|entry| entry.is_required).map(|entry| entry.key).collect();
    closed_table_schema(keys.iter().map(number).collect(), required)
}

/// JSON schema of a table without further keys.
pub fn closed_table_schema(properties: Map<String, Value>, required: Vec<&str>) -> Value {
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}
