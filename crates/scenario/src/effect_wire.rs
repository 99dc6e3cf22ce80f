//! An entry of `[[effect]]` as it is written: an effect of the list by its name, or a formula with its values.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use ship::ShortNumber;
use simulate::numbers::Numbers;

use crate::number_table::NamedNumbers;
use crate::problem::{KeyFault, KeyPath};

/// The key of a formula.
const FORMULA: &str = "formula";

/// An entry of `[[effect]]`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct EffectWire {
    /// `name = formula`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// Constants of the formula by their names.
    #[serde(flatten)]
    pub values: BTreeMap<String, f64>,
    /// Without a formula: an effect of the list, and its numbers.
    #[serde(flatten)]
    pub named: NamedNumbers,
}

impl EffectWire {
    /// The effect of the list at `place`.
    ///
    /// Fails where a number stands in place of its table.
    pub fn listed(&self, place: &KeyPath) -> Result<&NamedNumbers, KeyFault> {
        match self.values.first_key_value() {
            Some((name, value)) => Err(KeyFault::of(
                place.child(name),
                ShortNumber(*value),
                "expected a table with the numbers of an effect, or `formula` beside it",
                "write `name = { key = number }`, or add `formula = \"name = …\"`",
            )),
            None => Ok(&self.named),
        }
    }
}

impl Numbers for EffectWire {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        self.values.set(key, value) || self.named.set(key, value)
    }
}

impl<'de> Deserialize<'de> for EffectWire {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entry;
        impl<'de> Visitor<'de> for Entry {
            type Value = EffectWire;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a map")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<EffectWire, A::Error> {
                let mut wire = EffectWire::default();
                while let Some(key) = map.next_key::<String>()? {
                    if key == FORMULA {
                        wire.formula = Some(map.next_value()?);
                        continue;
                    }
                    match map.next_value()? {
                        EffectValue::Number(number) => drop(wire.values.insert(key, number)),
                        EffectValue::Table(numbers) => drop(wire.named.insert(key, numbers)),
                    }
                }
                Ok(wire)
            }
        }
        deserializer.deserialize_map(Entry)
    }
}

/// What stands at a key of an entry.
enum EffectValue {
    Number(f64),
    Table(BTreeMap<String, f64>),
}

impl<'de> Deserialize<'de> for EffectValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Value;
        impl<'de> Visitor<'de> for Value {
            type Value = EffectValue;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, or a table of numbers")
            }

            fn visit_f64<E>(self, number: f64) -> Result<EffectValue, E> {
                Ok(EffectValue::Number(number))
            }

            fn visit_i64<E>(self, number: i64) -> Result<EffectValue, E> {
                Ok(EffectValue::Number(number as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<EffectValue, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(map)).map(EffectValue::Table)
            }
        }
        deserializer.deserialize_any(Value)
    }
}
