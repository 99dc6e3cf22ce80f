//! The ship of a scenario: one of the registry, or one by numbers of its own.
#![expect(non_snake_case, reason = "K, T, T1, T2 and T3 are the symbols of the field")]

use std::collections::BTreeMap;

use ::ship::angle::{KNOT, from_deg};
use ::ship::effects::Parameter;
use ::ship::linear::SecondOrderIndices;
use ::ship::ships::{self, user, user::ShipError};
use ::ship::{Particulars, Ship, ShortNumber};
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use simulate::numbers;
use simulate::numbers::Numbers;
use toml::{Table, Value};

use crate::problem::{KeyFault, KeyPath, suggestion};
use crate::{reader, sweep};

/// A ship that a scenario names or describes.
#[derive(Clone)]
pub enum ShipWire {
    /// One of the registry.
    Known(Ship),
    FirstOrder(FirstOrderWire),
    SecondOrder(SecondOrderWire),
}

const FIRST_ORDER: &str = "first-order";
const SECOND_ORDER: &str = "second-order";

/// K and T in SI, or without dimension: K' = K L/U, T' = T U/L.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct FirstOrderWire {
    /// Gain K.
    #[serde(rename = "K-per-s")]
    pub K_per_s: Option<f64>,
    /// Time constant T; below 0 for a ship that is course-unstable.
    #[serde(rename = "T-s")]
    pub T_s: Option<f64>,
    /// K' = K L/U, with length and speed.
    #[serde(rename = "K-prime")]
    pub K_prime: Option<f64>,
    /// T' = T U/L, with length and speed.
    #[serde(rename = "T-prime")]
    pub T_prime: Option<f64>,
    /// Rudder bias δ_r.
    #[serde(default)]
    pub rudder_bias_deg: f64,
    /// Length L between perpendiculars; with the speed.
    pub length_m: Option<f64>,
    /// Approach speed U; with the length.
    pub speed_kn: Option<f64>,
}

#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SecondOrderWire {
    /// Gain K.
    #[serde(rename = "K-per-s")]
    pub K_per_s: f64,
    /// Larger time constant T1.
    #[serde(rename = "T1-s")]
    pub T1_s: f64,
    /// Smaller time constant T2.
    #[serde(rename = "T2-s")]
    pub T2_s: f64,
    /// Time constant T3 of the rudder rate.
    #[serde(rename = "T3-s")]
    pub T3_s: f64,
    /// Rudder bias δ_r.
    #[serde(default)]
    pub rudder_bias_deg: f64,
    /// Length L between perpendiculars; with the speed.
    pub length_m: Option<f64>,
    /// Approach speed U; with the length.
    pub speed_kn: Option<f64>,
}

numbers! {
    FirstOrderWire as written: "K-per-s" K_per_s, "T-s" T_s, "K-prime" K_prime, "T-prime" T_prime,
        "rudder-bias-deg" rudder_bias_deg, "length-m" length_m, "speed-kn" speed_kn;
    SecondOrderWire as written: "K-per-s" K_per_s, "T1-s" T1_s, "T2-s" T2_s, "T3-s" T3_s,
        "rudder-bias-deg" rudder_bias_deg, "length-m" length_m, "speed-kn" speed_kn;
}

impl Numbers for ShipWire {
    fn set(&mut self, key: &[String], value: f64) -> bool {
        let Some((_, below)) = key.split_first() else { return false };
        match self {
            Self::Known(_) => false,
            Self::FirstOrder(own) => own.set(below, value),
            Self::SecondOrder(own) => own.set(below, value),
        }
    }
}

impl ShipWire {
    /// Reads `[ship]`, which has one key.
    pub fn read(wire: &BTreeMap<String, Table>) -> Result<Self, KeyFault> {
        let registry = || ships::all().into_iter().map(|ship| ship.id.to_string());
        let known = || registry().chain([FIRST_ORDER, SECOND_ORDER].map(str::to_owned)).collect::<Vec<_>>();
        let mut entries = wire.iter();
        let (Some((id, table)), None) = (entries.next(), entries.next()) else {
            let names: Vec<&str> = wire.keys().map(String::as_str).collect();
            let found = match names.as_slice() {
                [] => "`ship` names no ship".to_owned(),
                several => format!("`ship` names {} ships: {}", several.len(), several.join(", ")),
            };
            let advice = suggestion("", &known());
            return Err(KeyFault::name(KeyPath::dotted("ship"), found, "expected exactly one ship", advice));
        };
        let key = key_of(id);
        match id.as_str() {
            FIRST_ORDER => reader::table(table, &key).map(Self::FirstOrder),
            SECOND_ORDER => reader::table(table, &key).map(Self::SecondOrder),
            _ => match ships::find(id) {
                None => {
                    let found = format!("no ship is called `{id}`");
                    Err(KeyFault::name(key, found, "no such ship", suggestion(id, &known())))
                }
                Some(ship) if table.is_empty() => Ok(Self::Known(ship)),
                Some(_) => Err(KeyFault::name(
                    key,
                    format!("the ship `{id}` has settings below it, and its numbers are fixed"),
                    "expected no keys below this ship",
                    format!("write [ship.{id}] and nothing below it; for numbers of your own use [ship.first-order]"),
                )),
            },
        }
    }

    /// The ship.
    ///
    /// Fails with the number that makes none.
    pub fn build(&self) -> Result<Ship, KeyFault> {
        match self {
            Self::Known(ship) => Ok(ship.clone()),
            Self::FirstOrder(own) => {
                let key = key_of(FIRST_ORDER);
                let particulars = particulars(&key, own.length_m, own.speed_kn)?;
                let (k, t) = own.indices(&key, particulars)?;
                user::first_order(k, t, from_deg(own.rudder_bias_deg), particulars).map_err(|error| {
                    let numbers = [
                        ("K", "K-per-s", own.K_per_s),
                        ("K", "K-prime", own.K_prime),
                        ("T", "T-s", own.T_s),
                        ("T", "T-prime", own.T_prime),
                    ];
                    not_a_ship(&key, &numbers, own.rudder_bias_deg, &error)
                })
            }
            Self::SecondOrder(own) => {
                let key = key_of(SECOND_ORDER);
                let particulars = particulars(&key, own.length_m, own.speed_kn)?;
                let indices = SecondOrderIndices { K: own.K_per_s, T1: own.T1_s, T2: own.T2_s, T3: own.T3_s };
                user::second_order(indices, from_deg(own.rudder_bias_deg), particulars).map_err(|error| {
                    let SecondOrderIndices { K, T1, T2, T3 } = indices;
                    let numbers = [("K", "K-per-s", K), ("T1", "T1-s", T1), ("T2", "T2-s", T2), ("T3", "T3-s", T3)];
                    let numbers = numbers.map(|(symbol, key, value)| (symbol, key, Some(value)));
                    not_a_ship(&key, &numbers, own.rudder_bias_deg, &error)
                })
            }
        }
    }

    /// What stands below its key when nothing is left out.
    pub fn complete(&self) -> Table {
        let table = match self {
            Self::Known(_) => Ok(Table::new()),
            Self::FirstOrder(own) => Table::try_from(own),
            Self::SecondOrder(own) => Table::try_from(own),
        };
        table.expect("numbers can be written")
    }
}

fn key_of(id: &str) -> KeyPath {
    KeyPath::dotted("ship").child(id)
}

impl FirstOrderWire {
    /// K (1/s) and T (s), given as they are or without dimension.
    fn indices(&self, key: &KeyPath, particulars: Option<Particulars>) -> Result<(f64, f64), KeyFault> {
        match (self.K_per_s, self.T_s, self.K_prime, self.T_prime, particulars) {
            (Some(k), Some(t), None, None, _) => Ok((k, t)),
            (None, None, Some(k), Some(t), Some(Particulars { length, speed })) => {
                Ok((k * speed / length, t * length / speed))
            }
            (None, None, Some(_), Some(_), None) => Err(KeyFault::name(
                key.clone(),
                format!("`{key}` has K' and T' without length and speed"),
                "expected `length-m` and `speed-kn` as well",
                "add both, or give `K-per-s` and `T-s`",
            )),
            (Some(_), None, None, None, _) => Err(reader::missing(key, "T-s")),
            (None, _, None, None, _) => Err(reader::missing(key, "K-per-s")),
            (None, None, Some(_), None, _) => Err(reader::missing(key, "T-prime")),
            (None, None, None, Some(_), _) => Err(reader::missing(key, "K-prime")),
            _ => Err(KeyFault::name(
                key.clone(),
                format!("`{key}` gives K and T both with and without dimension"),
                "expected `K-per-s` and `T-s`, or `K-prime` and `T-prime`",
                "give one pair and leave out the other",
            )),
        }
    }
}

/// Numbers that make no ship, at the key of the one at fault; of all other faults that is the rudder bias.
fn not_a_ship(key: &KeyPath, numbers: &[(&str, &str, Option<f64>)], bias_deg: f64, error: &ShipError) -> KeyFault {
    let (symbol, expected) = match *error {
        ShipError::Value { symbol, reason, .. } => (symbol, reason.to_owned()),
        ShipError::Range { symbol, parameter, value } => {
            let Parameter { symbol: of, unit, lowest, highest, .. } = parameter;
            let range = format!("from {} to {} {unit}", ShortNumber(*lowest), ShortNumber(*highest));
            (symbol, format!("expected {of} {range}, and this makes it {}", ShortNumber(value)))
        }
    };
    let mut own = numbers.iter().filter(|number| number.0 == symbol);
    let (name, value) = own.find_map(|&(_, key, value)| Some((key, value?))).unwrap_or(("rudder-bias-deg", bias_deg));
    let key = key.child(name);
    let found = format!("`{key}` is {}", sweep::written(&Value::Float(value)));
    KeyFault::value(key, found, expected, "change the number")
}

fn particulars(key: &KeyPath, length_m: Option<f64>, speed_kn: Option<f64>) -> Result<Option<Particulars>, KeyFault> {
    let half = |given: &str, missing: &str| {
        let found = format!("`{key}` has `{given}` without `{missing}`");
        KeyFault::name(
            key.child(given),
            found,
            "length and speed belong together",
            format!("add `{missing}`, or leave both out"),
        )
    };
    let checked = |name: &str, value: f64| {
        let is_right = value.is_finite() && value > 0.0;
        is_right.then_some(value).ok_or_else(|| {
            let key = key.child(name);
            let found = format!("`{key}` is {}", ShortNumber(value));
            KeyFault::value(key, found, "expected a finite number above 0", "change the number")
        })
    };
    match (length_m, speed_kn) {
        (Some(length), Some(speed)) => {
            let (length, speed) = (checked("length-m", length)?, checked("speed-kn", speed)?);
            Ok(Some(Particulars { length, speed: speed * KNOT }))
        }
        (None, None) => Ok(None),
        (Some(_), None) => Err(half("length-m", "speed-kn")),
        (None, Some(_)) => Err(half("speed-kn", "length-m")),
    }
}

/// The ship: one key, the id of a ship of the registry or one with numbers of its own.
pub fn schema(generator: &mut SchemaGenerator) -> Schema {
    let mut schema = json_schema!({
        "type": "object",
        "minProperties": 1,
        "maxProperties": 1,
        "additionalProperties": false,
        "properties": {
            "first-order": generator.subschema_for::<FirstOrderWire>(),
            "second-order": generator.subschema_for::<SecondOrderWire>(),
        }
    });
    for (id, what) in
        [("first-order", "A ship of your own by K and T"), ("second-order", "A ship of your own by K, T1, T2, T3")]
    {
        let one = &mut schema.ensure_object()["properties"][id];
        *one = json_schema!({ "description": what, "allOf": [one.take()] }).to_value();
    }
    for ship in ships::all() {
        let one = json_schema!({ "type": "object", "description": ship.name, "maxProperties": 0 });
        schema.ensure_object()["properties"][ship.id.to_string()] = one.to_value();
    }
    schema
}
