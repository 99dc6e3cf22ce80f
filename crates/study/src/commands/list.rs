//! `study list`: methods, effects, ships, manoeuvres, sensors, keys, column names and priors.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use identify::{IdentifierSettings, registry};
use report::number::MISSING;
use report::{Table, TableHead};
use ship::angle::KNOT;
use ship::vessel::prior::{self, AssumedParticular, CoefficientFormula, Particular};
use ship::{effects, ships};

use crate::documents::{self, answers::ListAnswer};
use crate::options::{CommonOptions, Format, ListSubject, ShipOptions};
use crate::screen;
use trial::Channel;
use trial::names::{self, ColumnMeaning};
use trial::sidecar::{self, Sidecar, SidecarKey};

use campaign::failure::Failure;
use campaign::scenario::keys::{ScenarioKey, scenario_keys as keys_of_scenario};

/// Arguments of `study list`.
#[derive(Debug, Clone, Args)]
pub struct ListRequest {
    /// What to list
    pub what: ListSubject,
    /// For priors: sidecar whose tables `ship` and `form` give the particulars of the ship
    #[arg(long, value_name = "FILE.toml")]
    pub columns: Option<PathBuf>,
    /// For priors: particulars of the ship
    #[command(flatten)]
    pub ship: ShipOptions,
}

/// Prints a list.
///
/// Fails if particulars are given for a list other than that of priors, or if they do not determine the priors.
pub fn run(request: &ListRequest, common: &CommonOptions) -> Result<(), Failure> {
    let what = request.what;
    if what != ListSubject::Priors && !(request.columns.is_none() && request.ship.is_empty()) {
        return Err(Failure::input("particulars of a ship apply to `study list priors` only; leave them out"));
    }
    let table = match what {
        ListSubject::Identifiers => identifiers()?,
        ListSubject::Effects => effects(),
        ListSubject::Ships => ships(),
        ListSubject::Manoeuvres => keys_below("manoeuvre."),
        ListSubject::Sensors => keys_below("sensor."),
        ListSubject::Keys => keys_below(""),
        ListSubject::Columns => columns(),
        ListSubject::Sidecar => sidecar(),
        ListSubject::Priors => priors(request)?,
    };
    if common.format == Format::Json {
        let name = what.to_possible_value().map(|value| value.get_name().to_owned());
        return documents::print_document(&ListAnswer { what: name.unwrap_or_default(), entries: table.to_records() });
    }
    // Head of a list in Markdown, which is a page of the documentation.
    let head = match what {
        _ if common.format != Format::Markdown => "",
        ListSubject::Identifiers => include_str!("../../templates/list-identifiers.md"),
        ListSubject::Effects => include_str!("../../templates/list-effects.md"),
        ListSubject::Ships => include_str!("../../templates/list-ships.md"),
        ListSubject::Keys => include_str!("../../templates/list-keys.md"),
        ListSubject::Columns => include_str!("../../templates/list-columns.md"),
        ListSubject::Sidecar => include_str!("../../templates/list-sidecar.md"),
        ListSubject::Manoeuvres | ListSubject::Sensors | ListSubject::Priors => "",
    };
    let body = match (what, common.format) {
        (ListSubject::Keys, Format::Markdown) => keys_by_table(),
        (_, format) => format.render(&table),
    };
    screen::print_lines(&format!("{head}{}", body.trim_end()))
}

fn identifiers() -> Result<Table, Failure> {
    let mut table = Table::new(TableHead::default().texts(["id", "method", "settings"]));
    for settings in registry::default_settings() {
        let method = settings.build().map_err(|error| Failure::execution(format!("default settings: {error}")))?;
        table.push([method.id().to_owned(), method.summary().to_owned(), keys(&settings)]);
    }
    Ok(table)
}

/// Default settings as one line of TOML.
fn keys(settings: &IdentifierSettings) -> String {
    let text = toml::Value::try_from(settings).map(|value| value.to_string()).unwrap_or_default();
    text.replace('\n', " ")
}

fn effects() -> Table {
    let mut table =
        Table::new(TableHead::default().texts(["id", "form", "keys in a scenario", "equation", "parameters"]));
    for effect in effects::all_effects() {
        let parameters: Vec<String> =
            effect.parameters().iter().map(|parameter| format!("{} [{}]", parameter.symbol, parameter.unit)).collect();
        let numbers = effect.scenario_keys();
        let keys = numbers.map(|numbers| numbers.iter().map(|entry| entry.key).collect::<Vec<_>>().join(", "));
        let keys = keys.unwrap_or_else(|| MISSING.to_owned());
        table.push([effect.id(), effect.form(), &keys, effect.equation(), &parameters.join(", ")]);
    }
    table
}

fn ships() -> Table {
    let head = TableHead::default().texts(["id", "ship"]).numbers(["L"]).unit("m").numbers(["V"]).unit("kn");
    let mut table = Table::new(head.texts(["source"]));
    for ship in ships::all_ships() {
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
        (
            "hull",
            "your own MMG hull: length-m, speed-m-s, and what is known of beam-m, draught-m, … (study list priors)",
        ),
    ] {
        table.push([id, keys, "", "", "yours"]);
    }
    table
}

/// Keys of a scenario whose name begins with `part`, listed without that part.
fn keys_below(part: &str) -> Table {
    let keys = keys_of_scenario().into_iter().filter(|key| key.key.starts_with(part));
    key_table(part, &keys.collect::<Vec<_>>())
}

/// Table of `keys`, each without the prefix `part`.
fn key_table(part: &str, keys: &[ScenarioKey]) -> Table {
    let mut table = Table::new(TableHead::default().texts(["key", "unit", "default", "meaning"]));
    for ScenarioKey { key, unit, default, meaning } in keys {
        // A table shows backquotes as they are.
        table.push([key.strip_prefix(part).unwrap_or(key), unit, &default.to_string(), &meaning.replace('`', "")]);
    }
    table
}

/// Markdown with a heading and a table of keys for every table of a scenario.
fn keys_by_table() -> String {
    let keys = keys_of_scenario();
    let first = |key: &ScenarioKey| key.key.split('.').next().unwrap_or_default().to_owned();
    let is_in_table = |name: &str| keys.iter().any(|key| key.key.starts_with(&format!("{name}.")));
    let heading = |key: &ScenarioKey| match first(key) {
        name if name.ends_with("[]") || is_in_table(&format!("{name}[]")) => {
            format!("`[[{}]]`", name.trim_end_matches("[]"))
        }
        name if is_in_table(&name) => format!("`[{name}]`"),
        _ => "Before the first table".to_owned(),
    };
    let section = |keys: &[ScenarioKey]| {
        let table = Format::Markdown.render(&key_table("", keys));
        format!("## {}\n\n{}\n\n", heading(&keys[0]), table.trim_end())
    };
    keys.chunk_by(|key, next| heading(key) == heading(next)).map(section).collect()
}

/// Names of columns, by channel.
fn columns() -> Table {
    let mut table = Table::new(TableHead::default().texts(["holds", "names", "understood as well"]));
    let usual = |wanted: &dyn Fn(ColumnMeaning) -> bool| {
        let names: Vec<&str> =
            names::known_column_names().filter(|(_, meaning)| wanted(*meaning)).map(|(name, _)| name).collect();
        names.join(", ")
    };
    let time = usual(&|meaning| matches!(meaning, ColumnMeaning::Time(_)));
    table.push(["time", "t_s, t_ms, t_min", &format!("{time}; seconds, or stamps of date and time")]);
    table.push(["date beside the time", "", &usual(&|meaning| meaning == ColumnMeaning::Date)]);
    for channel in Channel::ALL {
        let accepted = channel.accepted_names().replace(" or ", ", ");
        let of_channel = |meaning| matches!(meaning, ColumnMeaning::Channel(held, _) if held == channel);
        let over_ground = |meaning| channel == Channel::Speed && matches!(meaning, ColumnMeaning::SpeedOverGround(_));
        let holds = ::document::names::with_blanks(channel.quantity());
        table.push([&holds, &accepted, &usual(&|meaning| of_channel(meaning) || over_ground(meaning))]);
    }
    table.push([
        "position, deg",
        "",
        &usual(&|meaning| matches!(meaning, ColumnMeaning::Latitude | ColumnMeaning::Longitude)),
    ]);
    table.push(["course over ground, not used", "", &usual(&|meaning| meaning == ColumnMeaning::CourseOverGround)]);
    table
}

fn sidecar() -> Table {
    let mut table = Table::new(TableHead::default().texts(["key", "value", "meaning"]));
    for SidecarKey { key, value_kind, meaning } in sidecar::sidecar_keys() {
        table.push([&key, &value_kind, &meaning.replace('`', "")]);
    }
    table
}

/// Values assumed for missing particulars, and the prior of every coefficient.
fn priors(ListRequest { columns, ship, .. }: &ListRequest) -> Result<Table, Failure> {
    let declared = columns.as_deref().map(Sidecar::load).transpose().map_err(Failure::input)?;
    let mut hull = declared.map(|sidecar| sidecar.conditions.hull).unwrap_or_default();
    hull.length = ship.scale.length_m.unwrap_or(hull.length);
    hull.speed = ship.scale.speed().unwrap_or(hull.speed);
    ship.form.apply(&mut hull);
    if hull.length == 0.0 || hull.speed == 0.0 {
        return Err(Failure::input(
            "priors need the length and the approach speed of the ship; give --length-m with --speed-m-s or --speed-kn, or \
             a sidecar with [ship] as --columns",
        ));
    }
    let prior = prior::hull_prior(&hull).map_err(|error| match columns {
        Some(file) => Failure::in_file(file, error),
        None => Failure::input(error),
    })?;
    let mut table =
        Table::new(TableHead::default().texts(["key", "symbol"]).numbers(["mean", "sd"]).texts(["formula", "source"]));
    let digits = |value: f64| report::number::significant(value, 3);
    for AssumedParticular { key, value, sd, formula } in prior.assumed_particulars {
        let symbol = Particular::find(key).map_or("", |particular| particular.symbol);
        table.push([key, symbol, &digits(value), &digits(sd), &formula, prior::RATIO_SOURCE]);
    }
    for coefficient in &prior.coefficient_priors {
        let CoefficientFormula { key, symbol, text, source, .. } = *coefficient.formula;
        table.push([key, symbol, &digits(coefficient.mean), &digits(coefficient.sd), text, source]);
    }
    Ok(table)
}
