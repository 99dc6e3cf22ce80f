//! Ship of a scenario: a ship of the registry, or a user's ship by its numbers.

#![expect(non_snake_case, reason = "K, T1, T2 and T3 are the symbols of the field")]

use std::collections::BTreeMap;
use std::sync::LazyLock;

use ::ship::angle::{KNOT, from_deg};
use ::ship::effects::Parameter;
use ::ship::linear::SecondOrderNomotoIndices;
use ::ship::ships::{self, user, user::HullError, user::ShipError};
use ::ship::vessel::prior::{HullParticulars, PARTICULARS, Particular, ParticularsError};
use ::ship::{Particulars, Ship, ShortNumber};
use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use crate::scenario::number_table::{self, NamedNumbers, NumberKey, refuse_incomplete, refuse_unknown};
use crate::scenario::problem::{KeyFault, KeyPath, suggestion};
use crate::scenario::{reader, sweep};

const FIRST_ORDER: &str = "first-order";
const SECOND_ORDER: &str = "second-order";
const USER_HULL: &str = "hull";

const BIAS: NumberKey = NumberKey::optional("rudder-bias-deg", "Rudder bias δ_r.", Some(0.0));
const LENGTH: NumberKey = NumberKey::optional("length-m", "Length L between perpendiculars; with the speed.", None);
const SPEED: NumberKey = NumberKey::optional("speed-kn", "Approach speed U; with the length.", None);

/// Keys of K and T in SI units, or nondimensional: K' = K L/U, T' = T U/L.
const FIRST_ORDER_NUMBERS: [NumberKey; 7] = [
    NumberKey::optional("K-per-s", "Gain K.", None),
    NumberKey::optional("T-s", "Time constant T; below 0 for a ship that is course-unstable.", None),
    NumberKey::optional("K-prime", "K' = K L/U, with length and speed.", None),
    NumberKey::optional("T-prime", "T' = T U/L, with length and speed.", None),
    BIAS,
    LENGTH,
    SPEED,
];

const SECOND_ORDER_NUMBERS: [NumberKey; 7] = [
    NumberKey::required("K-per-s", "Gain K."),
    NumberKey::required("T1-s", "Larger time constant T1."),
    NumberKey::required("T2-s", "Smaller time constant T2."),
    NumberKey::required("T3-s", "Time constant T3 of the rudder rate."),
    BIAS,
    LENGTH,
    SPEED,
];

/// Keys of the particulars of a hull; only length and speed are required.
static HULL_NUMBERS: LazyLock<Vec<NumberKey>> = LazyLock::new(|| {
    let number = |&Particular { key, meaning, .. }: &Particular| match key {
        "length-m" | "speed-m-s" => NumberKey::required(key, meaning),
        _ => NumberKey::optional(key, meaning, None),
    };
    PARTICULARS.iter().map(number).collect()
});

/// Ships of the registry.
static REGISTRY: LazyLock<Vec<Ship>> = LazyLock::new(ships::all_ships);

/// Keys of a user's ship; empty for a ship of the registry.
fn numbers_of(id: &str) -> &'static [NumberKey] {
    match id {
        FIRST_ORDER => &FIRST_ORDER_NUMBERS,
        SECOND_ORDER => &SECOND_ORDER_NUMBERS,
        USER_HULL => &HULL_NUMBERS,
        _ => &[],
    }
}

/// Ship named or described by `[ship]`.
///
/// Fails with the invalid name or number.
pub fn build(named: &NamedNumbers) -> Result<Ship, KeyFault> {
    let ids: Vec<&str> = REGISTRY.iter().map(|ship| &*ship.id).chain([FIRST_ORDER, SECOND_ORDER, USER_HULL]).collect();
    let (id, key, numbers) = number_table::single_entry(named, &KeyPath::from_dotted("ship"), &ids)?;
    let keys = numbers_of(id);
    if !keys.is_empty() {
        refuse_unknown(numbers, keys, &key)?;
        refuse_incomplete(numbers, keys, &key)?;
        return if id == USER_HULL { hull(key, numbers) } else { UserShip { key, numbers }.build(id) };
    }
    match REGISTRY.iter().find(|ship| ship.id == id) {
        None => {
            let problem = format!("no ship is called `{id}`");
            Err(KeyFault::name(key, problem, "no such ship", suggestion(id, &ids)))
        }
        Some(ship) if numbers.is_empty() => Ok(ship.clone()),
        Some(_) => Err(KeyFault::name(
            key,
            format!("the ship `{id}` has settings below it, and its numbers are fixed"),
            "expected no keys below this ship",
            format!("write [ship.{id}] and nothing below it; for numbers of your own use [ship.first-order]"),
        )),
    }
}

/// Hull with MMG coefficients estimated from its particulars; fails with the key of an invalid particular.
fn hull(key: KeyPath, numbers: &BTreeMap<String, f64>) -> Result<Ship, KeyFault> {
    let mut particulars = HullParticulars::default();
    for (name, value) in numbers {
        if let Some(particular) = Particular::find(name) {
            particular.set(&mut particulars, *value);
        }
    }
    user::hull(&particulars).map_err(|error| match error {
        HullError::Particulars(ParticularsError { key: particular, quantity, value, range, advice, .. }) => {
            let place = if numbers.contains_key(particular) { key.child(particular) } else { key };
            let [value, lowest, highest] = [value, range[0], range[1]].map(|number| ShortNumber::rounded(number, 4));
            KeyFault::name(place, format!("{quantity} is {value}"), format!("expected {lowest} to {highest}"), advice)
        }
        HullError::Mmg(error) => {
            KeyFault::name(key, error.to_string(), "expected particulars of a ship that sails", "change the numbers")
        }
    })
}

/// Adds the defaults to the numbers of a user's ship.
pub fn fill_defaults(named: &mut NamedNumbers) {
    named.iter_mut().for_each(|(id, numbers)| number_table::fill_defaults(numbers, numbers_of(id)));
}

/// User's ship with its key and numbers.
struct UserShip<'a> {
    key: KeyPath,
    numbers: &'a BTreeMap<String, f64>,
}

impl UserShip<'_> {
    fn number(&self, key: &str) -> Option<f64> {
        self.numbers.get(key).copied()
    }

    fn build(&self, id: &str) -> Result<Ship, KeyFault> {
        let bias_deg = self.number(BIAS.key).unwrap_or_default();
        let (bias, particulars) = (from_deg(bias_deg), self.particulars()?);
        let ship = match id {
            FIRST_ORDER => {
                let (k, t) = self.indices(particulars)?;
                user::first_order(k, t, bias, particulars)
            }
            _ => {
                let [K, T1, T2, T3] =
                    ["K-per-s", "T1-s", "T2-s", "T3-s"].map(|key| self.number(key).unwrap_or(f64::NAN));
                user::second_order(SecondOrderNomotoIndices { K, T1, T2, T3 }, bias, particulars)
            }
        };
        ship.map_err(|error| self.refused(bias_deg, &error))
    }

    /// K (1/s) and T (s), given in SI units or nondimensional.
    fn indices(&self, particulars: Option<Particulars>) -> Result<(f64, f64), KeyFault> {
        let key = &self.key;
        let given = ["K-per-s", "T-s", "K-prime", "T-prime"].map(|key| self.number(key));
        match (given, particulars) {
            ([Some(k), Some(t), None, None], _) => Ok((k, t)),
            ([None, None, Some(k), Some(t)], Some(Particulars { length, speed })) => {
                Ok((k * speed / length, t * length / speed))
            }
            ([None, None, Some(_), Some(_)], None) => Err(KeyFault::name(
                key.clone(),
                format!("`{key}` has K' and T' without length and speed"),
                "expected `length-m` and `speed-kn` as well",
                "add both, or give `K-per-s` and `T-s`",
            )),
            ([Some(_), None, None, None], _) => Err(reader::missing_key(key, "T-s")),
            ([None, _, None, None], _) => Err(reader::missing_key(key, "K-per-s")),
            ([None, None, Some(_), None], _) => Err(reader::missing_key(key, "T-prime")),
            ([None, None, None, Some(_)], _) => Err(reader::missing_key(key, "K-prime")),
            _ => Err(KeyFault::name(
                key.clone(),
                format!("`{key}` gives K and T both with and without dimension"),
                "expected `K-per-s` and `T-s`, or `K-prime` and `T-prime`",
                "give one pair and leave out the other",
            )),
        }
    }

    /// Fault of invalid numbers, at the faulty key; faults without a key are attributed to the rudder bias.
    fn refused(&self, bias_deg: f64, error: &ShipError) -> KeyFault {
        let (symbol, expected) = match *error {
            ShipError::Value { symbol, reason, .. } => (symbol, reason.to_owned()),
            ShipError::Range { symbol, parameter, value } => {
                let Parameter { symbol: of, unit, lowest, highest, .. } = parameter;
                let range = format!("from {} to {} {unit}", ShortNumber(*lowest), ShortNumber(*highest));
                (symbol, format!("expected {of} {range}, and this makes it {}", ShortNumber(value)))
            }
        };
        let written = self.numbers.iter().find(|(key, _)| key.split('-').next() == Some(symbol));
        let (name, value) = written.map_or((BIAS.key, bias_deg), |(key, value)| (key, *value));
        KeyFault::new(self.key.child(name), sweep::toml_text(&toml::Value::Float(value)), expected, "change the number")
    }

    fn particulars(&self) -> Result<Option<Particulars>, KeyFault> {
        let key = &self.key;
        let half = |given: &str, missing: &str| {
            let problem = format!("`{key}` has `{given}` without `{missing}`");
            let advice = format!("add `{missing}`, or leave both out");
            KeyFault::name(key.child(given), problem, "length and speed belong together", advice)
        };
        let checked = |name: &str, value: f64| match value.is_finite() && value > 0.0 {
            true => Ok(value),
            false => {
                let expected = "expected a finite number above 0";
                Err(KeyFault::new(key.child(name), ShortNumber(value), expected, "change the number"))
            }
        };
        match (self.number(LENGTH.key), self.number(SPEED.key)) {
            (Some(length), Some(speed)) => {
                let (length, speed) = (checked(LENGTH.key, length)?, checked(SPEED.key, speed)?);
                Ok(Some(Particulars { length, speed: speed * KNOT }))
            }
            (None, None) => Ok(None),
            (Some(_), None) => Err(half(LENGTH.key, SPEED.key)),
            (None, Some(_)) => Err(half(SPEED.key, LENGTH.key)),
        }
    }
}

/// JSON schema of `[ship]`: one key, the id of a registered ship or of a user's ship with its numbers.
pub fn schema(_: &mut SchemaGenerator) -> Schema {
    let user_ships = [
        (FIRST_ORDER, "A ship of your own: K-per-s and T-s, or K-prime and T-prime"),
        (SECOND_ORDER, "A ship of your own by K, T1, T2, T3"),
        (USER_HULL, "A hull of your own by her particulars"),
    ];
    let user_ships = user_ships.map(|(id, what)| (id, what, number_table::schema(numbers_of(id))));
    let registry =
        REGISTRY.iter().map(|ship| (&*ship.id, &*ship.name, json!({ "type": "object", "maxProperties": 0 })));
    let described = user_ships.into_iter().chain(registry).map(|(id, what, mut schema)| {
        schema["description"] = what.into();
        (id.to_owned(), schema)
    });
    let ships: Map<String, Value> = described.collect();
    json_schema!({
        "type": "object", "minProperties": 1, "maxProperties": 1, "additionalProperties": false, "properties": ships,
    })
}
