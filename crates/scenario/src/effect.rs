//! Effects of a scenario: their keys with units, declared once in [`NUMBERS`], and from them the parameters of
//! [`ship::effects`], each checked against the range its effect declares.

use std::collections::BTreeMap;
use std::sync::{Arc, LazyLock};

use schemars::{Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::{Map, json};
use ship::Regressor;
use ship::angle::DEGREE;
use ship::effects::{Effect, Formula, listed};
use ship::ships::Model;
use ship::{ResponseModel, Ship, ShortNumber};
use toml::{Table, Value};

use crate::number_table::{self, NamedNumbers, NumberKey, closed};
use crate::problem::{KeyFault, KeyPath, suggestion};
use crate::{limits, reader};

/// The key of a formula in its entry.
const FORMULA: &str = "formula";

/// An entry of `[[effect]]`: an effect of the list with its numbers below, or a formula with values beside it.
#[derive(Debug, Clone, Deserialize, Serialize)]
pub struct EffectWire(Table);

/// A number of an effect: identifier and form of the effect, the key and what it means.
type EffectNumber = (&'static str, &'static str, &'static str, &'static str);

/// What holds when the exponent of the gain is left out; all other numbers are needed.
const GAIN_EXPONENT: (&str, f64) = ("gain-exponent", 2.0);

/// Every number of every effect that a scenario can add, in the order of lists and of the parameters.
#[rustfmt::skip]
const NUMBERS: [EffectNumber; 24] = [
    ("second_order", "sway coupling", "T2-s", "Smaller time constant T2."),
    ("second_order", "sway coupling", "T3-s", "Time constant T3 of the rudder rate."),
    ("nonlinear_damping", "r³", "n3-s2-per-deg2", "+ n3 r³ on the left (Norrbin, Bech)."),
    ("nonlinear_damping", "r|r|", "n2-s-per-deg", "+ n2 r|r| on the left."),
    ("nonlinear_damping", "r²", "n11-s-per-deg", "+ n11 r² on the left."),
    ("wind_moment", "steady wind", "rudder-deg", "Largest moment, as rudder angle."),
    ("wind_moment", "steady wind", "from-deg", "Direction the wind comes from, clockwise from north."),
    ("speed_loss", "modelled speed", "loss-s-per-deg2", "Rate of loss for a squared yaw rate of 1 deg²/s²."),
    ("speed_loss", "modelled speed", "recovery-s", "Time in which the speed comes back."),
    ("speed_loss", "modelled speed", "gain-exponent", "Power of the speed in the gain of the rudder."),
    ("steering_lag", "dead time", "dead-time-s", "Dead time."),
    ("steering_lag", "first-order lag", "first-order-s", "Time constant of a first-order lag."),
    ("rudder_saturation", "stall", "c3-per-deg2", "Coefficient c3."),
    ("rudder_deadband", "backlash", "backlash-deg", "Width of a backlash."),
    ("rudder_deadband", "dead band", "dead-band-deg", "Width of a dead band."),
    ("port_starboard_asymmetry", "gain by side", "gain-share",
     "Share a of K (δ + a |δ|); above 0 the rudder acts more to starboard."),
    ("port_starboard_asymmetry", "moment by drift", "moment-by-drift-s",
     "Time c_r of K (δ + c_r |r|); above 0 the moment is to starboard in any turn."),
    ("moment_drift", "linear trend", "rudder-deg-per-s", "Change of the moment, as rudder angle."),
    ("transient_disturbance", "moment for a while", "rudder-deg", "Largest moment, as rudder angle."),
    ("transient_disturbance", "moment for a while", "centre-s", "Time of its middle."),
    ("transient_disturbance", "moment for a while", "duration-s", "How long it lasts."),
    ("wave_yaw", "narrow band", "sd-deg", "Standard deviation of the heading they add."),
    ("wave_yaw", "narrow band", "frequency-rad-s", "Frequency of encounter."),
    ("wave_yaw", "narrow band", "damping", "Relative damping: the smaller, the narrower the band."),
];

/// What the effects are; of several forms one is given.
const MEANINGS: [(&str, &str); 11] = [
    ("second_order", "Sway coupling: T1 T2 r'' + (T1 + T2) r' + r = K (δ + δ_r) + K T3 δ'."),
    ("nonlinear_damping", "Damping that grows with the yaw rate; one of these."),
    ("wind_moment", "A yaw moment of steady wind, by the heading."),
    ("speed_loss", "Speed that falls in the turn: K ~ U, T ~ 1/U."),
    ("steering_lag", "A rudder that acts later than the one recorded; one of these."),
    ("rudder_saturation", "Stall: the rudder acts as δ − c3 δ³."),
    ("rudder_deadband", "Play between the recorded rudder and the one that acts; one of these."),
    ("port_starboard_asymmetry", "A ship that turns more readily to one side; one of these."),
    ("moment_drift", "A slow trend of the yaw moment."),
    ("transient_disturbance", "A moment for a part of the record."),
    ("wave_yaw", "Narrow-band yaw from waves."),
];

/// An effect in one of the forms in which a scenario adds it, with the keys of its numbers.
struct EffectForm {
    effect: Arc<dyn Effect>,
    keys: Vec<NumberKey>,
}

/// The forms in the order of [`NUMBERS`].
static FORMS: LazyLock<Vec<EffectForm>> = LazyLock::new(|| {
    let mut forms: Vec<EffectForm> = Vec::new();
    for (id, form, key, meaning) in NUMBERS {
        let effect = listed(id, form);
        let number = match key == GAIN_EXPONENT.0 {
            true => NumberKey::optional(key, meaning, Some(GAIN_EXPONENT.1)),
            false => NumberKey::required(key, meaning),
        };
        match forms.last_mut().filter(|last| is_same(last.effect.as_ref(), effect.as_ref())) {
            Some(form) => form.keys.push(number),
            None => forms.push(EffectForm { effect, keys: vec![number] }),
        }
    }
    forms
});

fn is_same(one: &dyn Effect, other: &dyn Effect) -> bool {
    (one.id(), one.form()) == (other.id(), other.form())
}

/// The forms of an effect; none where there is no such effect.
fn forms_of(id: &str) -> Vec<&'static EffectForm> {
    FORMS.iter().filter(|form| form.effect.id() == id).collect()
}

/// Size in SI of the unit of a key.
fn unit(key: &str) -> f64 {
    const PER_DEGREE: f64 = 1.0 / DEGREE;
    match key {
        key if key.ends_with("-per-deg2") => PER_DEGREE * PER_DEGREE,
        key if key.ends_with("-per-deg") => PER_DEGREE,
        key => simulate::error::unit(key),
    }
}

/// The keys a scenario has for an effect in one of its forms; `None` for a form that needs a measured record.
pub fn keys(effect: &dyn Effect) -> Option<String> {
    let form = FORMS.iter().find(|form| is_same(form.effect.as_ref(), effect))?;
    Some(form.keys.iter().map(|own| own.key).collect::<Vec<_>>().join(", "))
}

/// The effects with nothing left out.
pub fn complete(entries: &mut [EffectWire]) {
    for (id, numbers) in entries.iter_mut().flat_map(|entry| &mut entry.0) {
        let keys = forms_of(id).into_iter().flat_map(|form| &form.keys);
        for (own, default) in keys.filter_map(|own| Some((own, own.default?))) {
            let table = numbers.as_table_mut().filter(|table| !table.contains_key(own.key));
            table.map(|table| table.insert(own.key.to_owned(), default.into()));
        }
    }
}

/// The form that an entry asks for, with the key of it and its numbers.
fn asked<'a>(
    entry: &'a NamedNumbers,
    place: &KeyPath,
) -> Result<(&'static EffectForm, KeyPath, &'a BTreeMap<String, f64>), KeyFault> {
    let ids = MEANINGS.map(|(id, _)| id);
    let (id, key, numbers) = number_table::only(entry, place, &ids)?;
    let forms = forms_of(id);
    if forms.is_empty() {
        return Err(KeyFault::name(key, format!("no effect is called `{id}`"), "no such name", suggestion(id, &ids)));
    }
    let known: Vec<NumberKey> = forms.iter().flat_map(|form| form.keys.iter().copied()).collect();
    number_table::refuse_unknown(numbers, &known, &key)?;
    if forms.len() > 1 && numbers.len() != 1 {
        return Err(reader::not_one_name(key, numbers.keys(), &known.iter().map(|own| own.key).collect::<Vec<_>>()));
    }
    let has_all = |form: &&EffectForm| numbers.keys().all(|name| form.keys.iter().any(|own| own.key == name));
    let form = forms.into_iter().find(has_all).expect("every key is known");
    number_table::refuse_incomplete(numbers, &form.keys, &key)?;
    Ok((form, key, numbers))
}

/// An effect that is written as a formula, with the value of every constant of it.
fn formula(entry: &Table, place: &KeyPath) -> Result<(Arc<Formula>, Vec<f64>), KeyFault> {
    let (mut values, key) = (entry.clone(), place.child(FORMULA));
    let line = match values.remove(FORMULA) {
        Some(Value::String(line)) => line,
        other => {
            let found = other.map_or_else(String::new, |value| value.to_string());
            return Err(KeyFault::of(key, found, "expected a text in quotes", "write `name = formula` in quotes"));
        }
    };
    let formula = read(&line, key)?;
    let values: BTreeMap<String, f64> = reader::table(&values, place)?;
    let keys: Vec<NumberKey> =
        formula.parameters().iter().map(|own| NumberKey::required(own.key, "A constant of the formula.")).collect();
    number_table::refuse_unknown(&values, &keys, place)?;
    number_table::refuse_incomplete(&values, &keys, place)?;
    for own in formula.parameters() {
        let value = values[own.key];
        if !own.holds(value) {
            let expected =
                format!("expected a number from {} to {}", ShortNumber(own.lowest), ShortNumber(own.highest));
            return Err(KeyFault::of(place.child(own.key), ShortNumber(value), expected, "change the value"));
        }
    }
    let values = formula.parameters().iter().map(|own| values[own.key]).collect();
    Ok((formula, values))
}

/// The effect of a line `name = formula` at a key.
pub fn read(line: &str, key: KeyPath) -> Result<Arc<Formula>, KeyFault> {
    ship::effects::formula(line).map_err(|error| {
        let advice = "docs/src/howto/own-effect.md says what a formula may hold";
        KeyFault::within(error.at, key.clone(), format!("`{key}`: {}", error.problem), "here", advice)
    })
}

/// Refuses a formula over a channel that the trials lack: its moment would be zero.
fn refuse_without(formula: &Formula, lacking: &[Regressor], key: KeyPath) -> Result<(), KeyFault> {
    let Some(channel) = lacking.iter().find(|channel| formula.is_idle_without(**channel)) else { return Ok(()) };
    let (signal, advice) = match channel {
        Regressor::Sway => ("sway velocity", "add `[speed-and-sway]`"),
        Regressor::Speed => ("speed", "add `[speed-and-sway]`"),
        Regressor::Wind => ("relative wind", "add `[disturbance.wind]` with `speed-m-s`"),
        Regressor::Propeller => ("propeller revolutions", "leave the effect out"),
    };
    let found = format!("`{}` needs {signal}, and the simulated ship has none", formula.id());
    Err(KeyFault::value(key, found, "expected a formula over signals of the ship", advice))
}

/// The ship with effects added to its response.
///
/// Fails for a hull, whose equations hold such effects already, for a second-order effect on a ship that has one, for a
/// parameter outside its range, and for a formula over channels that the trials are `lacking`.
pub fn added(ship: Ship, entries: &[EffectWire], lacking: &[Regressor]) -> Result<Ship, KeyFault> {
    if entries.is_empty() {
        return Ok(ship);
    }
    limits::entries("effect", entries.len(), limits::MOST_EFFECTS)?;
    let list = KeyPath::dotted("effect");
    let places = entries.iter().enumerate().map(|(index, entry)| (&entry.0, list.child(index)));
    let (formulas, listed): (Vec<_>, Vec<_>) = places.partition(|(entry, _)| entry.contains_key(FORMULA));
    let listed = listed.into_iter().map(|(entry, place)| Ok((reader::table(entry, &place)?, place)));
    let listed = listed.collect::<Result<Vec<(NamedNumbers, KeyPath)>, KeyFault>>()?;
    let asked = listed.iter().map(|(entry, place)| asked(entry, place)).collect::<Result<Vec<_>, _>>()?;
    let Model::Response(response) = &ship.model else {
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
            if !description.holds(setting.value) {
                let key = key.child(setting.key);
                let mut ends =
                    [description.lowest, description.highest].map(|end| ShortNumber::rounded(end / setting.unit, 4));
                // Divided by the T of a course-unstable ship, the lower end becomes the upper.
                ends.sort_by(|one, other| one.0.total_cmp(&other.0));
                let expected = format!("expected a number from {} to {}", ends[0], ends[1]);
                let advice = format!("change the value; the effect is {}", effect.equation());
                return Err(KeyFault::of(key, ShortNumber(setting.written), expected, advice));
            }
        }
        effects.push(effect);
        parameters.extend(settings.iter().map(|setting| setting.value));
    }
    for (entry, place) in formulas {
        let (formula, values) = formula(entry, &place)?;
        refuse_without(&formula, lacking, place.child(FORMULA))?;
        effects.push(Arc::new(formula.with_length(ship.particulars.map_or(1.0, |own| own.length))));
        parameters.extend(values);
    }
    let model = Model::Response(ResponseModel::new(effects).with(parameters));
    Ok(Ship { model, ..ship })
}

/// One parameter and the key it comes from.
struct EffectParameter {
    /// Value, SI and rad.
    value: f64,
    /// Key below the effect.
    key: &'static str,
    /// The number behind the key.
    written: f64,
    /// The unit of that number in SI.
    unit: f64,
}

/// The parameters of an effect; nonlinear damping is written for T r' + r and stored for r', divided by T.
fn settings(form: &EffectForm, numbers: &BTreeMap<String, f64>, inverse_time: f64) -> Vec<EffectParameter> {
    let one = |own: &NumberKey| {
        let written = numbers.get(own.key).copied().or(own.default).unwrap_or(f64::NAN);
        let unit = unit(own.key) * if form.effect.id() == "nonlinear_damping" { inverse_time } else { 1.0 };
        EffectParameter { value: written * unit, key: own.key, written, unit }
    };
    let settings: Vec<EffectParameter> = form.keys.iter().map(one).collect();
    if let ("wind_moment", [moment, from]) = (form.effect.id(), settings.as_slice()) {
        // w sin 2(ψ_w − ψ) by its components along sin and cos of 2ψ.
        let twice = 2.0 * from.value;
        let component = |share: f64| match from.written.is_finite() {
            true => EffectParameter { value: moment.value * share, ..*moment },
            false => EffectParameter { ..*from },
        };
        return vec![component(twice.sin()), component(-twice.cos())];
    }
    settings
}

/// The effects: a list, each with one key, its id.
pub fn schema(_: &mut SchemaGenerator) -> Schema {
    let effects = MEANINGS.into_iter().map(|(id, meaning)| {
        let forms: Vec<_> = forms_of(id).iter().map(|form| number_table::schema(&form.keys)).collect();
        let below = if let [form] = forms.as_slice() { form.clone() } else { json!({ "oneOf": forms }) };
        let mut effect = closed(Map::from_iter([(id.to_owned(), below)]), vec![id]);
        effect["description"] = meaning.into();
        effect
    });
    let formula = json!({
        "type": "object",
        "description": "A moment as a formula, an angle of the rudder in rad, with the values of its constants beside it.",
        "properties": { "formula": {
            "type": "string",
            "description": "`name = formula`, as in `bank = c * tanh(k * psi)`; the constants `c` and `k` are further keys.",
        } },
        "required": ["formula"],
        "additionalProperties": { "type": "number" }
    });
    json_schema!({ "type": "array", "items": { "oneOf": effects.chain([formula]).collect::<Vec<_>>() } })
}
