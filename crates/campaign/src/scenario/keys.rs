//! List of the keys of a scenario, generated from the schema, thus from the types that read the file.

use serde_json::{Map, Value};

use crate::scenario::key_units::key_unit;
use crate::scenario::schema::simulated_schema;

/// Key of a scenario with unit, default and meaning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenarioKey {
    /// Dotted path from the root; `[]` marks an entry of a list.
    pub key: String,
    /// Unit of a number, or type of another value.
    pub unit: String,
    /// Value of an omitted key.
    pub default: KeyDefault,
    /// Meaning, from the documentation of the field.
    pub meaning: String,
}

/// Value of an omitted key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum KeyDefault {
    /// Not allowed: the key is required in its table.
    Required,
    /// Absence, whose effect the description of the key states.
    Nothing,
    /// Default, as TOML text.
    Value(String),
}

impl std::fmt::Display for KeyDefault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Required => "required",
            Self::Nothing => "–",
            Self::Value(value) => value,
        })
    }
}

/// All keys of a scenario, in the order of its types.
pub fn scenario_keys() -> Vec<ScenarioKey> {
    let schema = simulated_schema().to_value();
    let mut keys = Vec::new();
    SchemaWalk { definitions: &schema["definitions"] }.below("", &schema, &mut keys);
    keys
}

/// Tables with the keys of `manoeuvre` or `recording`, which are listed only once.
const AS_BEFORE: [&str; 4] = ["also[].manoeuvre", "also[].recording", "validation.manoeuvre", "validation.recording"];

/// Traversal of the schema with its definitions.
struct SchemaWalk<'a> {
    definitions: &'a Value,
}

impl<'a> SchemaWalk<'a> {
    /// Adds the keys of a table and of the tables in it, with names that begin with `path`.
    fn below(&self, path: &str, table: &'a Value, keys: &mut Vec<ScenarioKey>) {
        let is_required =
            |name: &str| table["required"].as_array().is_some_and(|names| names.iter().any(|key| key == name));
        for (name, value) in fields(table) {
            self.key(&format!("{path}{name}"), value, &Value::Null, is_required(name), keys);
        }
        // The key of a choice is described at the choice.
        for variant in table["oneOf"].as_array().into_iter().flatten() {
            for (name, value) in fields(variant) {
                self.key(&format!("{path}{name}"), value, variant, false, keys);
            }
        }
    }

    /// Adds a key and the keys below it; `written` is its schema in a `variant` of the table.
    fn key(&self, key: &str, written: &'a Value, variant: &'a Value, is_required: bool, keys: &mut Vec<ScenarioKey>) {
        let mut value = self.resolved(written);
        let kind = |value: &'a Value| value["type"].as_str().or(value["type"][0].as_str());
        let list = kind(value).filter(|kind| *kind == "array").map(|_| self.resolved(&value["items"]));
        let is_list_of_tables = list.is_some_and(is_table);
        value = list.filter(|_| is_list_of_tables).unwrap_or(value);
        let names = names(value);
        let unit = match (list.is_some(), names.is_empty(), kind(value)) {
            (true, ..) => String::from(if is_list_of_tables { "list of tables" } else { "list" }),
            (_, false, _) => names.join(" or "),
            (.., Some("integer")) => String::from("whole number"),
            (.., Some("number")) => key_unit(key).to_owned(),
            (.., Some("boolean")) => String::from("true or false"),
            (.., Some("string")) => String::from("text"),
            _ => String::from("table"),
        };
        // A variant with one key has the description of the key.
        let descriptions =
            if fields(variant).count() > 1 { [written, value, variant] } else { [variant, written, value] };
        let meaning = descriptions.into_iter().find_map(|schema| schema["description"].as_str()).unwrap_or_default();
        let default = match &written["default"] {
            _ if is_required => KeyDefault::Required,
            Value::Null | Value::Array(_) | Value::Object(_) => KeyDefault::Nothing,
            Value::Number(number) => KeyDefault::Value(number.as_f64().map_or_else(String::new, |x| x.to_string())),
            value => KeyDefault::Value(value.as_str().map_or_else(|| value.to_string(), str::to_owned)),
        };
        let meaning = meaning.split_whitespace().collect::<Vec<_>>().join(" ");
        keys.push(ScenarioKey { key: key.to_owned(), unit, default, meaning });
        // A further manoeuvre has the keys of the first.
        if !AS_BEFORE.contains(&key) {
            let mark = if is_list_of_tables { "[]." } else { "." };
            self.below(&format!("{key}{mark}"), value, keys);
        }
    }

    /// Schema of a value after following references and removing the null of an option.
    fn resolved(&self, value: &'a Value) -> &'a Value {
        let inner = match value["anyOf"].as_array().or(value["allOf"].as_array()) {
            Some(several) => several.iter().find(|schema| schema["type"] != "null").unwrap_or(value),
            None => value,
        };
        match inner["$ref"].as_str().and_then(|place| place.strip_prefix("#/definitions/")) {
            Some(name) => self.resolved(&self.definitions[name]),
            None => inner,
        }
    }
}

/// Keys of a table with their schemas.
fn fields(table: &Value) -> impl Iterator<Item = (&str, &Value)> {
    table["properties"].as_object().into_iter().flat_map(Map::iter).map(|(name, value)| (name.as_str(), value))
}

fn is_table(value: &Value) -> bool {
    value["properties"].is_object() || (value["oneOf"].is_array() && names(value).is_empty())
}

/// Names allowed as the value of a key.
fn names(value: &Value) -> Vec<&str> {
    let several = value["oneOf"].as_array().map_or(std::slice::from_ref(value), Vec::as_slice);
    several
        .iter()
        .flat_map(|schema| schema["enum"].as_array().into_iter().flatten().chain(Some(&schema["const"])))
        .filter_map(Value::as_str)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_has_a_meaning_and_no_link() {
        let keys = scenario_keys();
        let silent: Vec<&str> = keys.iter().filter(|key| key.meaning.is_empty()).map(|key| key.key.as_str()).collect();
        assert!(silent.is_empty(), "{}", silent.join("\n"));
        let linked: Vec<&ScenarioKey> =
            keys.iter().filter(|key| key.meaning.contains("](") || key.meaning.contains("[`")).collect();
        assert!(linked.is_empty(), "{linked:?}");
    }

    #[test]
    fn units_defaults_and_names_are_those_of_the_types() {
        let keys = scenario_keys();
        let of = |wanted: &str| keys.iter().find(|key| key.key == wanted).unwrap_or_else(|| panic!("no {wanted}"));
        assert_eq!(of("steering-gear.rate-deg-s").unit, "deg/s");
        assert_eq!(of("steering-gear.lag-s").default, KeyDefault::Value("0".into()));
        assert_eq!(of("steering-gear.rate-deg-s").default, KeyDefault::Nothing);
        assert_eq!(of("manoeuvre.zig-zag.rudder-deg").default, KeyDefault::Required);
        assert_eq!(of("manoeuvre.zig-zag.first").unit, "starboard or port");
        assert_eq!(of("sweep[].points[].label").unit, "text");
        assert_eq!(of("identifier[].method.output-error.iterations").unit, "whole number");
        assert_eq!(of("output.figures").unit, "list");
        assert_eq!(of("recording.weather").unit, "none");
        assert_eq!(of("ship.hull.rudder-area-m2").unit, "m²");
        assert_eq!(of("ship.hull.displacement-t").unit, "t");
        assert!(of("effect[].stands-for").meaning.starts_with("Effects of the list"));
        assert!(of("effect[].nonlinear_damping.n3-s2-per-deg2").unit == "s²/deg²");
    }
}
