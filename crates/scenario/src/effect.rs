//! Effects of a scenario: their keys with units, declared once in [`FORMS`], and from them the parameters of
//! [`ship::effects`], each checked against the range its effect declares.

use std::collections::BTreeMap;
use std::sync::Arc;

use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::{Map, json};
use ship::angle::{DEGREE, from_deg};
use ship::effects::{
    Effect, MomentDrift, NonlinearDamping, PortStarboardAsymmetry, RudderDeadband, RudderSaturation, SecondOrder,
    SpeedLoss, SteeringLag, TransientDisturbance, WaveYaw, WindMoment,
};
use ship::ships::Model;
use ship::{ResponseModel, Ship, Shown};

use crate::problem::{KeyFault, KeyPath, suggestion};
use crate::{limits, reader};

/// An effect as it is written: its id, and below it its numbers by their keys.
pub type EffectEntry = BTreeMap<String, BTreeMap<String, f64>>;

/// A number of an effect in a scenario.
struct EffectKey {
    name: &'static str,
    /// Size of its unit in SI.
    unit: f64,
    meaning: &'static str,
    default: Option<f64>,
}

/// An effect in one of the forms in which a scenario adds it.
struct EffectForm {
    effect: fn() -> Arc<dyn Effect>,
    meaning: &'static str,
    keys: &'static [EffectKey],
}

const fn form(effect: fn() -> Arc<dyn Effect>, meaning: &'static str, keys: &'static [EffectKey]) -> EffectForm {
    EffectForm { effect, meaning, keys }
}

const fn key(name: &'static str, unit: f64, meaning: &'static str) -> EffectKey {
    EffectKey { name, unit, meaning, default: None }
}

const PER_DEGREE: f64 = 1.0 / DEGREE;
const DAMPING: &str = "Damping that grows with the yaw rate; one of these.";
const LAG: &str = "A rudder that acts later than the one recorded; one of these.";
const PLAY: &str = "Play between the recorded rudder and the one that acts; one of these.";
const ASYMMETRY: &str = "A ship that turns more readily to one side; one of these.";

/// Every effect that a scenario can add, in the order of lists; of several forms of one effect one is given.
static FORMS: [EffectForm; 16] = [
    form(
        || Arc::new(SecondOrder),
        "Sway coupling: T1 T2 r'' + (T1 + T2) r' + r = K (δ + δ_r) + K T3 δ'.",
        &[key("T2-s", 1.0, "Smaller time constant T2."), key("T3-s", 1.0, "Time constant T3 of the rudder rate.")],
    ),
    form(
        || Arc::new(NonlinearDamping::Cubic),
        DAMPING,
        &[key("n3-s2-per-deg2", PER_DEGREE * PER_DEGREE, "+ n3 r³ on the left (Norrbin, Bech).")],
    ),
    form(
        || Arc::new(NonlinearDamping::Quadratic),
        DAMPING,
        &[key("n2-s-per-deg", PER_DEGREE, "+ n2 r|r| on the left.")],
    ),
    form(|| Arc::new(NonlinearDamping::Square), DAMPING, &[key("n11-s-per-deg", PER_DEGREE, "+ n11 r² on the left.")]),
    form(
        || Arc::new(WindMoment::Steady),
        "A yaw moment of steady wind, by the heading.",
        &[
            key("rudder-deg", DEGREE, "Largest moment, as rudder angle."),
            key("from-deg", DEGREE, "Direction the wind comes from, clockwise from north."),
        ],
    ),
    form(
        || Arc::new(SpeedLoss::Modelled),
        "Speed that falls in the turn: K ~ U, T ~ 1/U.",
        &[
            key("loss-s-per-deg2", PER_DEGREE * PER_DEGREE, "Rate of loss for a squared yaw rate of 1 deg²/s²."),
            key("recovery-s", 1.0, "Time in which the speed comes back."),
            EffectKey {
                default: Some(2.0),
                ..key("gain-exponent", 1.0, "Power of the speed in the gain of the rudder.")
            },
        ],
    ),
    form(|| Arc::new(SteeringLag::DeadTime), LAG, &[key("dead-time-s", 1.0, "Dead time.")]),
    form(
        || Arc::new(SteeringLag::FirstOrder),
        LAG,
        &[key("first-order-s", 1.0, "Time constant of a first-order lag.")],
    ),
    form(
        || Arc::new(RudderSaturation),
        "Stall: the rudder acts as δ − c3 δ³.",
        &[key("c3-per-deg2", PER_DEGREE * PER_DEGREE, "Coefficient c3.")],
    ),
    form(|| Arc::new(RudderDeadband::Backlash), PLAY, &[key("backlash-deg", DEGREE, "Width of a backlash.")]),
    form(|| Arc::new(RudderDeadband::DeadBand), PLAY, &[key("dead-band-deg", DEGREE, "Width of a dead band.")]),
    form(
        || Arc::new(PortStarboardAsymmetry::Gain),
        ASYMMETRY,
        &[key("gain-share", 1.0, "Share a of K (δ + a |δ|); above 0 the rudder acts more to starboard.")],
    ),
    form(
        || Arc::new(PortStarboardAsymmetry::Drift),
        ASYMMETRY,
        &[key(
            "moment-by-drift-s",
            1.0,
            "Time c_r of K (δ + c_r |r|); above 0 the moment is to starboard in any turn.",
        )],
    ),
    form(
        || Arc::new(MomentDrift { reference_time: 0.0 }),
        "A slow trend of the yaw moment.",
        &[key("rudder-deg-per-s", DEGREE, "Change of the moment, as rudder angle.")],
    ),
    form(
        || Arc::new(TransientDisturbance::Passing),
        "A moment for a part of the record.",
        &[
            key("rudder-deg", DEGREE, "Largest moment, as rudder angle."),
            key("centre-s", 1.0, "Time of its middle."),
            key("duration-s", 1.0, "How long it lasts."),
        ],
    ),
    form(
        || Arc::new(WaveYaw),
        "Narrow-band yaw from waves.",
        &[
            key("sd-deg", DEGREE, "Standard deviation of the heading they add."),
            key("frequency-rad-s", 1.0, "Frequency of encounter."),
            key("damping", 1.0, "Relative damping: the smaller, the narrower the band."),
        ],
    ),
];

impl EffectForm {
    fn names(&self) -> Vec<&'static str> {
        self.keys.iter().map(|key| key.name).collect()
    }

    fn takes(&self, name: &str) -> bool {
        self.keys.iter().any(|key| key.name == name)
    }
}

/// The ids of effects in the order of [`FORMS`], each with its forms.
fn by_id() -> Vec<(&'static str, Vec<&'static EffectForm>)> {
    let mut list: Vec<(&str, Vec<&EffectForm>)> = Vec::new();
    for form in &FORMS {
        let id = (form.effect)().id();
        match list.last_mut().filter(|(last, _)| *last == id) {
            Some((_, forms)) => forms.push(form),
            None => list.push((id, vec![form])),
        }
    }
    list
}

/// The keys a scenario has for an effect in one of its forms; `None` for a form that needs a measured record.
pub fn keys(effect: &dyn Effect) -> Option<String> {
    let form = FORMS.iter().find(|form| {
        let own = (form.effect)();
        (own.id(), own.form()) == (effect.id(), effect.form())
    });
    form.map(|form| form.names().join(", "))
}

/// The effects with nothing left out.
pub fn complete(entries: &mut [EffectEntry]) {
    for (id, forms) in by_id() {
        for numbers in entries.iter_mut().filter_map(|entry| entry.get_mut(id)) {
            for (key, default) in forms[0].keys.iter().filter_map(|key| Some((key, key.default?))) {
                numbers.entry(key.name.to_owned()).or_insert(default);
            }
        }
    }
}

/// The form that an entry asks for, with the key of it and its numbers.
fn asked<'a>(
    entry: &'a EffectEntry,
    place: &KeyPath,
) -> Result<(&'static EffectForm, KeyPath, &'a BTreeMap<String, f64>), KeyFault> {
    let all = by_id();
    let ids: Vec<&str> = all.iter().map(|(id, _)| *id).collect();
    let mut names = entry.iter();
    let (Some((id, numbers)), None) = (names.next(), names.next()) else {
        return Err(reader::not_one_name(place.clone(), entry.keys(), &ids));
    };
    let key = place.child(id);
    let Some((_, forms)) = all.iter().find(|(known, _)| known == id) else {
        return Err(KeyFault::name(key, format!("no effect is called `{id}`"), "no such name", suggestion(id, &ids)));
    };
    let known: Vec<&str> = forms.iter().flat_map(|form| form.names()).collect();
    if let Some(name) = numbers.keys().find(|name| !known.contains(&name.as_str())) {
        let found = format!("`{key}` has no key `{name}`");
        return Err(KeyFault::name(key.child(name), found, "no such key here", suggestion(name, &known)));
    }
    let form = match forms.as_slice() {
        [form] => form,
        forms => match numbers.keys().collect::<Vec<_>>().as_slice() {
            [name] => forms.iter().find(|form| form.takes(name)).expect("it is known"),
            _ => return Err(reader::not_one_name(key, numbers.keys(), &known)),
        },
    };
    let missing = form.keys.iter().find(|key| key.default.is_none() && !numbers.contains_key(key.name));
    missing.map_or(Ok((*form, key.clone(), numbers)), |missing| Err(reader::missing(&key, missing.name)))
}

/// The ship with effects added to its response.
///
/// Fails for a hull, whose equations hold such effects already, for a second-order effect on a ship that has one, and
/// for a parameter outside its range.
pub fn added(ship: Ship, entries: &[EffectEntry]) -> Result<Ship, KeyFault> {
    if entries.is_empty() {
        return Ok(ship);
    }
    limits::entries("effect", entries.len(), limits::MOST_EFFECTS)?;
    let list = KeyPath::dotted("effect");
    let asked = entries.iter().enumerate().map(|(index, entry)| asked(entry, &list.child(index)));
    let asked = asked.collect::<Result<Vec<_>, _>>()?;
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
        let effect = (form.effect)();
        if effect.id() == "second_order" && effects.iter().any(|other| other.id() == effect.id()) {
            return Err(KeyFault::name(
                key,
                format!("the ship `{}` is of second order already", ship.id),
                "expected at most one such effect",
                "leave it out, or use a first-order ship",
            ));
        }
        let settings = settings(form, effect.as_ref(), numbers, inverse_time);
        for (description, setting) in effect.parameters().iter().zip(&settings) {
            if !description.holds(setting.value) {
                let key = key.child(setting.key);
                let mut ends =
                    [description.lowest, description.highest].map(|end| Shown::rounded(end / setting.unit, 4));
                // Divided by the T of a course-unstable ship, the lower end becomes the upper.
                ends.sort_by(|one, other| one.0.total_cmp(&other.0));
                return Err(KeyFault::value(
                    key.clone(),
                    format!("`{key}` is {}", Shown(setting.written)),
                    format!("expected a number from {} to {}", ends[0], ends[1]),
                    format!("change the value; the effect is {}", effect.equation()),
                ));
            }
        }
        effects.push(effect);
        parameters.extend(settings.iter().map(|setting| setting.value));
    }
    let model = Model::Response(ResponseModel::new(effects).with(parameters));
    Ok(Ship { model, ..ship })
}

/// One parameter and the key it comes from.
struct EffectNumber {
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
fn settings(
    form: &EffectForm,
    effect: &dyn Effect,
    numbers: &BTreeMap<String, f64>,
    inverse_time: f64,
) -> Vec<EffectNumber> {
    let one = |key: &EffectKey| {
        let written = numbers.get(key.name).copied().or(key.default).unwrap_or(f64::NAN);
        let unit = if effect.id() == "nonlinear_damping" { key.unit * inverse_time } else { key.unit };
        EffectNumber { value: written * unit, key: key.name, written, unit }
    };
    let mut settings: Vec<EffectNumber> = form.keys.iter().map(one).collect();
    if let ("wind_moment", [moment, from]) = (effect.id(), settings.as_mut_slice()) {
        // w sin 2(ψ_w − ψ) by its components along sin and cos of 2ψ.
        let (largest, twice) = (moment.value, 2.0 * from_deg(from.written));
        let number = |share: f64| match from.written.is_finite() {
            true => EffectNumber { value: largest * share, ..*moment },
            false => EffectNumber { ..*from },
        };
        return vec![number(twice.sin()), number(-twice.cos())];
    }
    settings
}

/// The effects: a list, each with one key, its id.
pub fn schema(_: &mut SchemaGenerator) -> Schema {
    let table = |form: &EffectForm, description: Option<&str>| {
        let number = |key: &EffectKey| {
            let mut number = json!({ "type": "number", "format": "double", "description": key.meaning });
            if let Some(default) = key.default {
                number["default"] = default.into();
            }
            (key.name.to_owned(), number)
        };
        let required = form.keys.iter().filter(|key| key.default.is_none()).map(|key| key.name);
        let mut table = json!({
            "type": "object",
            "properties": form.keys.iter().map(number).collect::<Map<_, _>>(),
            "required": required.collect::<Vec<_>>(),
            "additionalProperties": false,
        });
        if let Some(description) = description {
            table["description"] = description.into();
        }
        table
    };
    let effects = by_id().into_iter().map(|(id, forms)| {
        let below = match forms.as_slice() {
            [form] => table(form, None),
            forms => {
                let choice = forms.iter().map(|form| table(form, Some(form.keys[0].meaning)));
                json!({ "oneOf": choice.collect::<Vec<_>>() })
            }
        };
        json!({
            "type": "object",
            "description": forms[0].meaning,
            "properties": { id: below },
            "required": [id],
            "additionalProperties": false,
        })
    });
    json_schema!({ "type": "array", "items": { "oneOf": effects.collect::<Vec<_>>() } })
}
