//! Effects of a scenario, from the parameter keys that [`ship::effects`] declares; every value is checked against the
//! range that its effect declares.

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, json};
use ship::RegressorChannel;
use ship::effects::{Effect, Formula, NumberConversion, ScenarioKey, effect_meaning};
use ship::ships::ShipModel;
use ship::{ResponseModel, Ship, ShortNumber};
use toml::{Table, Value};

use crate::scenario::number_table::{self, NamedNumbers, NumberKey, closed_table_schema};
use crate::scenario::physics::{self, MissingPhysics, PhysicsWire};
use crate::scenario::problem::{KeyFault, KeyPath, suggestion};
use crate::scenario::{limits, reader};

/// Key of a formula.
const FORMULA: &str = "formula";

/// Entry of `[[effect]]`: a listed effect with its numbers, or a formula with its constants.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub struct EffectWire(Table);

/// One form of an effect, with the keys of its numbers.
struct EffectForm {
    effect: Arc<dyn Effect>,
    keys: Vec<NumberKey>,
}

/// Forms in the order of the list of effects, keys in the order of parameters.
static FORMS: LazyLock<Vec<EffectForm>> = LazyLock::new(|| {
    let form = |effect: Arc<dyn Effect>| {
        let keys = effect.scenario_keys()?.into_iter().map(NumberKey::from).collect();
        Some(EffectForm { effect, keys })
    };
    ship::effects::all_effects().into_iter().filter_map(form).collect()
});

/// Identifiers of the effects that a scenario can add.
static IDS: LazyLock<Vec<&str>> = LazyLock::new(|| {
    let mut ids: Vec<&str> = FORMS.iter().map(|form| form.effect.id()).collect();
    ids.dedup();
    ids
});

impl From<ScenarioKey> for NumberKey {
    fn from(ScenarioKey { key, meaning, default, .. }: ScenarioKey) -> Self {
        Self { key, meaning, is_required: default.is_none(), default }
    }
}

/// Forms of an effect; empty for an unknown one.
fn forms_of(id: &str) -> Vec<&'static EffectForm> {
    FORMS.iter().filter(|form| form.effect.id() == id).collect()
}

/// Adds the default numbers that entries omit.
pub fn fill_defaults(entries: &mut [EffectWire]) {
    for (id, numbers) in entries.iter_mut().flat_map(|entry| &mut entry.0) {
        let keys = forms_of(id).into_iter().flat_map(|form| &form.keys);
        for (number, default) in keys.filter_map(|number| Some((number, number.default?))) {
            let table = numbers.as_table_mut().filter(|table| !table.contains_key(number.key));
            table.map(|table| table.insert(number.key.to_owned(), default.into()));
        }
    }
}

/// Form selected by an entry, with its key and numbers.
fn asked<'a>(
    entry: &'a NamedNumbers,
    place: &KeyPath,
) -> Result<(&'static EffectForm, KeyPath, &'a BTreeMap<String, f64>), KeyFault> {
    let (id, key, numbers) = number_table::single_entry(entry, place, &IDS)?;
    let forms = forms_of(id);
    if forms.is_empty() {
        return Err(KeyFault::name(key, format!("no effect is called `{id}`"), "no such name", suggestion(id, &IDS)));
    }
    let keys: Vec<NumberKey> = forms.iter().flat_map(|form| form.keys.iter().copied()).collect();
    number_table::refuse_unknown(numbers, &keys, &key)?;
    if forms.len() > 1 && numbers.len() != 1 {
        let names: Vec<_> = keys.iter().map(|entry| entry.key).collect();
        return Err(reader::name_count_fault(key, numbers.keys(), &names));
    }
    let has_all = |form: &&EffectForm| numbers.keys().all(|name| form.keys.iter().any(|number| number.key == name));
    let form = forms.into_iter().find(has_all).expect("every key is known");
    number_table::refuse_incomplete(numbers, &form.keys, &key)?;
    Ok((form, key, numbers))
}

/// Effect written as a formula, with the values of its constants.
fn formula(entry: &Table, place: &KeyPath) -> Result<(Arc<Formula>, Vec<f64>), KeyFault> {
    let (mut values, key) = (entry.clone(), place.child(FORMULA));
    let line = match values.remove(FORMULA) {
        Some(Value::String(line)) => line,
        other => {
            let value = other.map_or_else(String::new, |value| value.to_string());
            return Err(KeyFault::new(key, value, "expected a text in quotes", "write `name = formula` in quotes"));
        }
    };
    let formula = parse_formula(&line, key)?;
    values.retain(|name, _| !physics::PHYSICS_KEYS.contains(&name));
    let values: BTreeMap<String, f64> = reader::read_table(&values, place)?;
    let keys: Vec<NumberKey> =
        formula.parameters().iter().map(|entry| NumberKey::required(entry.key, "A constant of the formula.")).collect();
    number_table::refuse_unknown(&values, &keys, place)?;
    number_table::refuse_incomplete(&values, &keys, place)?;
    for constant in formula.parameters() {
        let value = values[constant.key];
        if !constant.is_in_range(value) {
            let expected =
                format!("expected a number from {} to {}", ShortNumber(constant.lowest), ShortNumber(constant.highest));
            return Err(KeyFault::new(place.child(constant.key), ShortNumber(value), expected, "change the value"));
        }
    }
    let values = formula.parameters().iter().map(|constant| values[constant.key]).collect();
    Ok((formula, values))
}

/// Missing physics stated with the only formula of a ship; `None` without such keys.
///
/// Fails for inconsistent keys, and for a further effect.
pub fn stated_physics(entries: &[EffectWire]) -> Result<Option<MissingPhysics>, KeyFault> {
    for (index, EffectWire(entry)) in entries.iter().enumerate() {
        let of_physics = entry.iter().filter(|(name, _)| physics::PHYSICS_KEYS.contains(&name.as_str()));
        let keys: Table = of_physics.map(|(name, value)| (name.clone(), value.clone())).collect();
        let place = KeyPath::from_dotted("effect").child(index);
        let Some(first) = keys.keys().next() else { continue };
        if entries.len() > 1 {
            let problem = format!("`{first}` is given for a ship with {} effects", entries.len());
            return Err(KeyFault::name(
                place.child(first),
                problem,
                "expected a ship with this effect alone",
                "leave the key out",
            ));
        }
        return reader::read_table::<PhysicsWire>(&keys, &place)?.resolve(&place).map(Some);
    }
    Ok(None)
}

/// Effect from a line `name = formula`; faults refer to `key`.
pub fn parse_formula(line: &str, key: KeyPath) -> Result<Arc<Formula>, KeyFault> {
    ship::effects::parse_formula(line).map_err(|error| {
        let advice = "docs/src/howto/own-effect.md says what a formula may hold";
        KeyFault::within_text(error.position, key.clone(), format!("`{key}`: {}", error.problem), "here", advice)
    })
}

/// Refuses a formula of a channel absent from the trials, since its moment would be zero.
fn refuse_without(formula: &Formula, lacking: &[RegressorChannel], key: KeyPath) -> Result<(), KeyFault> {
    let Some(channel) = lacking.iter().find(|channel| formula.is_inactive_without(**channel)) else { return Ok(()) };
    let (signal, advice) = match channel {
        RegressorChannel::Sway => ("sway velocity", "add `[speed-and-sway]`"),
        RegressorChannel::Speed => ("speed", "add `[speed-and-sway]`"),
        RegressorChannel::Wind => ("relative wind", "add `[disturbance.wind]` with `speed-m-s`"),
        RegressorChannel::Propeller => ("propeller revolutions", "leave the effect out"),
    };
    let problem = format!("`{}` needs {signal}, and the simulated ship has none", formula.id());
    Err(KeyFault::value(key, problem, "expected a formula over signals of the ship", advice))
}

/// Ship with effects added to its response.
///
/// Fails for a hull, whose equations contain such effects, for a second-order effect on a second-order ship, for a
/// parameter outside its range, and for a formula of a channel in `lacking`, the channels absent from the trials.
pub fn with_effects(ship: Ship, entries: &[EffectWire], lacking: &[RegressorChannel]) -> Result<Ship, KeyFault> {
    if entries.is_empty() {
        return Ok(ship);
    }
    limits::check_count("effect", entries.len(), limits::MAX_EFFECTS)?;
    let list = KeyPath::from_dotted("effect");
    let places = entries.iter().enumerate().map(|(index, entry)| (&entry.0, list.child(index)));
    let (formulas, listed): (Vec<_>, Vec<_>) = places.partition(|(entry, _)| entry.contains_key(FORMULA));
    let listed = listed.into_iter().map(|(entry, place)| Ok((reader::read_table(entry, &place)?, place)));
    let listed = listed.collect::<Result<Vec<(NamedNumbers, KeyPath)>, KeyFault>>()?;
    let asked = listed.iter().map(|(entry, place)| asked(entry, place)).collect::<Result<Vec<_>, _>>()?;
    let ShipModel::Response(response) = &ship.model else {
        return Err(KeyFault::name(
            list,
            format!("an effect is added to `{}`, a hull with its own equations", ship.id),
            "effects belong to response models",
            "leave the effects out, or use a response ship such as yukun, first-order or second-order",
        ));
    };
    let inverse_time = response.parameters()[0];
    let mut effects = response.model().effects().to_vec();
    let mut parameters = response.parameters().to_vec();
    for (form, key, numbers) in asked {
        let effect = Arc::clone(&form.effect);
        if effect.id() == "second_order" && effects.iter().any(|other| other.id() == effect.id()) {
            return Err(KeyFault::name(
                key,
                format!("the ship `{}` is of second order already", ship.id),
                "expected at most one such effect",
                "leave it out, or use a first-order ship",
            ));
        }
        let settings = settings(form, numbers, inverse_time);
        for (description, setting) in effect.parameters().iter().zip(&settings) {
            if !description.is_in_range(setting.value) {
                let key = key.child(setting.key);
                let mut ends =
                    [description.lowest, description.highest].map(|end| ShortNumber::rounded(end / setting.unit, 4));
                // For negative T, of a course-unstable ship, the ends swap after the division.
                ends.sort_by(|a, b| a.0.total_cmp(&b.0));
                let expected = format!("expected a number from {} to {}", ends[0], ends[1]);
                let advice = format!("change the value; the effect is {}", effect.equation());
                return Err(KeyFault::new(key, ShortNumber(setting.written), expected, advice));
            }
        }
        effects.push(effect);
        parameters.extend(settings.iter().map(|setting| setting.value));
    }
    for (entry, place) in formulas {
        let (formula, values) = formula(entry, &place)?;
        refuse_without(&formula, lacking, place.child(FORMULA))?;
        effects.push(Arc::new(formula.with_length(ship.particulars.map_or(1.0, |ship| ship.length))));
        parameters.extend(values);
    }
    let model = ShipModel::Response(ResponseModel::new(effects).with_parameters(parameters));
    Ok(Ship { model, ..ship })
}

/// Parameter of an effect, with its key.
struct EffectParameter {
    /// Value, SI and rad.
    value: f64,
    /// Key below the effect.
    key: &'static str,
    /// Number as written.
    written: f64,
    /// Ratio of the value to that number: the unit in SI, divided by T for [`NumberConversion::OverT`].
    unit: f64,
}

/// Parameters of an effect on a ship with 1/T `inverse_time`, 1/s.
fn settings(form: &EffectForm, numbers: &BTreeMap<String, f64>, inverse_time: f64) -> Vec<EffectParameter> {
    let keys = form.effect.scenario_keys().unwrap_or_default();
    let setting = |number: &ScenarioKey| {
        let written = numbers.get(number.key).copied().or(number.default).unwrap_or(f64::NAN);
        let unit = number.unit * if number.conversion == NumberConversion::OverT { inverse_time } else { 1.0 };
        EffectParameter { value: written * unit, key: number.key, written, unit }
    };
    let settings: Vec<EffectParameter> = keys.iter().map(setting).collect();
    if let ([_, ScenarioKey { conversion: NumberConversion::Direction, .. }], [strength, from]) =
        (&keys[..], &settings[..])
    {
        // The parameters are the components of strength · sin 2(ψ_w − ψ) along cos 2ψ and sin 2ψ.
        let twice = 2.0 * from.value;
        let component = |share: f64| match from.written.is_finite() {
            true => EffectParameter { value: strength.value * share, ..*strength },
            false => EffectParameter { ..*from },
        };
        return vec![component(twice.sin()), component(-twice.cos())];
    }
    settings
}

/// JSON schema of `[[effect]]`.
pub fn schema(generator: &mut SchemaGenerator) -> Schema {
    let effects = IDS.iter().map(|&id| {
        let forms: Vec<_> = forms_of(id).iter().map(|form| number_table::schema(&form.keys)).collect();
        let (below, end) = match forms.as_slice() {
            [form] => (form.clone(), "."),
            _ => (json!({ "oneOf": forms }), "; one of these."),
        };
        let mut effect = closed_table_schema(Map::from_iter([(id.to_owned(), below)]), vec![id]);
        effect["description"] = (effect_meaning(id).to_owned() + end).into();
        effect
    });
    let mut properties = PhysicsWire::json_schema(generator).to_value()["properties"].take();
    properties[FORMULA] = json!({
        "type": "string",
        "description": "`name = formula`, as in `bank = c * tanh(k * psi)`; the constants `c` and `k` are further keys.",
    });
    let formula = json!({
        "type": "object",
        "description": "A moment as a formula, an angle of the rudder in rad, with the values of its constants beside it.",
        "properties": properties,
        "required": ["formula"],
        "additionalProperties": { "type": "number" }
    });
    json_schema!({ "type": "array", "items": { "oneOf": effects.chain([formula]).collect::<Vec<_>>() } })
}
