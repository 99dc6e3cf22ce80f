//! `study list`: what scenario files can name.

use identify::{IdentifierSettings, registry};
use report::number::MISSING;
use report::{Column, Table};
use ship::angle::KNOT;
use ship::{effects, ships};

use crate::options::{Common, Format, Listed};
use crate::screen;
use scenario::effect_keys;
use scenario::failure::Failure;
use simulate::settings::{self, Key};

/// Prints the list.
pub fn run(what: Listed, common: &Common) -> Result<(), Failure> {
    let table = match what {
        Listed::Identifiers => identifiers()?,
        Listed::Effects => effects(),
        Listed::Ships => ships(),
        Listed::Manoeuvres => keys_below("manoeuvre."),
        Listed::Sensors => keys_below("sensor."),
        Listed::Keys => keys_below(""),
    };
    let head = if (what, common.format) == (Listed::Keys, Format::Markdown) { PAGE } else { "" };
    screen::say(&format!("{head}{}", common.format.render(&table).trim_end()))
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

/// Keys of a trial whose name begins with `part`, without it.
fn keys_below(part: &str) -> Table {
    let mut table =
        Table::new([Column::left("key"), Column::left("unit"), Column::left("default"), Column::left("meaning")]);
    for Key { key, unit, default, meaning } in settings::keys() {
        if let Some(key) = key.strip_prefix(part) {
            // A table shows the marks of code as they are.
            table.push([key, &unit, &default.to_string(), &meaning.replace('`', "")]);
        }
    }
    table
}

/// What stands before the keys in Markdown, which is a page of the documentation.
const PAGE: &str = "\
# Keys of a trial

How a trial is made, key by key. A key that is required may be left out with the whole table it stands in. `study list ships` and
`study list effects` name the keys below `ship` and `effect`. Made by `study list keys --format markdown`.

";
