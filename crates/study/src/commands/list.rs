//! `study list`: what scenario files can name.

use identify::{IdentifierSettings, registry};
use report::number::MISSING;
use report::{Column, Table};
use ship::angle::KNOT;
use ship::{effects, ships};

use crate::options::{Common, Listed};
use crate::screen;
use scenario::effect_keys;
use scenario::failure::Failure;

/// Prints the list.
pub fn run(what: Listed, common: &Common) -> Result<(), Failure> {
    let table = match what {
        Listed::Identifiers => identifiers()?,
        Listed::Effects => effects(),
        Listed::Ships => ships(),
        Listed::Manoeuvres => pairs(&MANOEUVRES),
        Listed::Sensors => pairs(&SENSORS),
    };
    screen::say(common.format.render(&table).trim_end())
}

fn identifiers() -> Result<Table, Failure> {
    let mut table = Table::new([Column::left("id"), Column::left("method"), Column::left("settings")]);
    for settings in registry::defaults() {
        let method = settings.build().map_err(|error| Failure::work(format!("default settings: {error}")))?;
        table.push([method.id().to_owned(), method.summary().to_owned(), keys(&settings)]);
    }
    Ok(table)
}

/// The default settings as one line of TOML.
fn keys(settings: &IdentifierSettings) -> String {
    let text = toml::Value::try_from(settings).map(|value| value.to_string()).unwrap_or_default();
    text.replace('\n', " ")
}

fn effects() -> Table {
    let mut table = Table::new([
        Column::left("id"),
        Column::left("form"),
        Column::left("keys in a scenario"),
        Column::left("equation"),
        Column::left("parameters"),
    ]);
    for effect in effects::all() {
        let parameters: Vec<String> =
            effect.parameters().iter().map(|parameter| format!("{} [{}]", parameter.symbol, parameter.unit)).collect();
        let keys = effect_keys(effect.as_ref()).unwrap_or(MISSING);
        table.push([effect.id(), effect.form(), keys, effect.equation(), &parameters.join(", ")]);
    }
    table
}

fn ships() -> Table {
    let mut table = Table::new([
        Column::left("id"),
        Column::left("ship"),
        Column::decimal("L").unit("m"),
        Column::decimal("V").unit("kn"),
        Column::left("source"),
    ]);
    for ship in ships::all() {
        let number = |value: Option<f64>| report::number::optional(value, 1);
        table.push([
            ship.id.to_string(),
            ship.name.to_string(),
            number(ship.particulars.map(|particulars| particulars.length)),
            number(ship.particulars.map(|particulars| particulars.speed / KNOT)),
            ship.source.to_string(),
        ]);
    }
    for (id, keys) in [
        ("first-order", "your own: K-per-s, T-s, rudder-bias-deg, length-m, speed-kn"),
        ("second-order", "your own: K-per-s, T1-s, T2-s, T3-s, rudder-bias-deg, length-m, speed-kn"),
    ] {
        table.push([id, keys, "", "", "yours"]);
    }
    table
}

const MANOEUVRES: [(&str, &str); 4] = [
    ("zig-zag", "rudder-deg, heading-deg, first = \"starboard\" | \"port\", executes or duration-s"),
    ("turning-circle", "rudder-deg, side, duration-s or heading-change-deg"),
    ("pull-out", "rudder-deg, side, hold-s, duration-s"),
    ("replay", "file: the rudder of a record, followed as it is"),
];

const SENSORS: [(&str, &str); 12] = [
    ("heading-noise-deg", "standard deviation of white heading noise"),
    ("heading-quantum-deg", "step of the heading display"),
    ("heading-lag-s", "follow-up lag of the gyrocompass"),
    ("heading-bias-deg", "constant heading error"),
    (
        "yaw-rate-noise-deg-s",
        "standard deviation of white yaw-rate noise; any yaw-rate key adds a rate-of-turn indicator",
    ),
    ("yaw-rate-bias-deg-s", "constant yaw-rate error"),
    ("yaw-rate-scale-error", "scale error of the yaw rate, as a share"),
    ("rudder-noise-deg", "standard deviation of white noise of the rudder feedback"),
    ("rudder-quantum-deg", "step of the rudder feedback"),
    ("jitter-s", "standard deviation of the sampling instants about their stamps"),
    ("heading-delay-s", "age of the heading against the rudder in the same row"),
    ("drop-out", "probability, burst-probability, burst-mean-rows, whole-row"),
];

fn pairs(list: &[(&str, &str)]) -> Table {
    let mut table = Table::new([Column::left("key"), Column::left("settings")]);
    for &(key, text) in list {
        table.push([key, text]);
    }
    table
}
