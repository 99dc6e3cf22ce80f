//! From what a scenario says to what the engine accepts: names to ships, settings to a simulation, every value checked.

use std::collections::BTreeMap;
use std::path::Path;

use ship::angle::{KNOT, from_deg};
use ship::effects::Parameter;
use ship::linear::SecondOrderIndices;
use ship::ships::Model;
use ship::ships::user::ShipError;
use ship::{Particulars, Ship, Shown, ships};
use simulate::recording::{RudderColumn, Start};
use simulate::settings::{self, Assumption, ManoeuvreSettings};
use simulate::{Disturbances, Manoeuvre, Recording, Sensors, Simulation, Vessel};

use crate::problem::{KeyPath, Problem, suggestion};
use crate::specification::{HULL, Specification};
use crate::wire::{AlsoWire, FirstOrderWire, ScenarioWire, SecondOrderWire, ValidationWire};
use crate::{effect, reader, sweep};

/// Resolves everything about a trial.
pub fn specification(wire: &ScenarioWire, folder: &Path) -> Result<Specification, Problem> {
    let ship = effect::added(ship(&wire.ship)?, &wire.effect)?;
    let simulation = settings::checked(Simulation {
        gear: wire.steering_gear.build(&ship)?,
        helmsman: wire.helmsman.build()?,
        approach: wire.approach.build()?,
        recording: wire.recording.build()?,
        sensors: wire.sensor.build()?,
        disturbances: wire.disturbance.build()?,
        ..Simulation::new(Vessel::ship(&ship), manoeuvre(&wire.manoeuvre, folder)?)
    })?;
    let also = wire.also.iter().enumerate();
    let also =
        also.map(|(index, further)| also_steered(further, index, &simulation, folder)).collect::<Result<_, _>>()?;
    let validation = wire.validation.as_ref().map(|second| validation(second, &simulation, folder)).transpose()?;
    let base = match &ship.model {
        Model::Response(response) => Some(response.first_order()),
        Model::Hull(_) => None,
    };
    let assumed = Assumption::ALL.map(|assumption| assumption.holds(&wire.steering_gear, &simulation));
    Ok(Specification {
        also,
        validation,
        truth: ship.first_order(),
        base,
        missing: missing(&ship, wire),
        assumed,
        simulation,
    })
}

/// What a first-order base lacks in a trial: effects of the ship, and disturbances that are effects by another name.
fn missing(ship: &Ship, wire: &ScenarioWire) -> Vec<String> {
    let mut missing: Vec<String> = match &ship.model {
        Model::Response(response) => response.model().effects().iter().map(|effect| effect.id().to_owned()).collect(),
        Model::Hull(_) => vec![HULL.to_owned()],
    };
    let sea = &wire.disturbance;
    let disturbances = [
        (sea.wind.is_some(), "wind_moment"),
        (sea.drift_deg_per_s != 0.0, "moment_drift"),
        (sea.squall.is_some(), "transient_disturbance"),
        (sea.waves.is_some(), "wave_yaw"),
        (wire.sensor.heading_delay_s != 0.0 || wire.sensor.heading_lag_s != 0.0, "steering_lag"),
    ];
    missing.extend(disturbances.into_iter().filter(|(acts, _)| *acts).map(|(_, id)| id.to_owned()));
    missing.dedup();
    missing
}

/// A further record: the same ship, gear, helmsman, weather and instruments in another manoeuvre.
fn also_steered(wire: &AlsoWire, index: usize, trial: &Simulation, folder: &Path) -> Result<Simulation, Problem> {
    let recording = match &wire.recording {
        Some(own) => own.build(),
        None => Ok(trial.recording),
    };
    let resolved = recording.map_err(Problem::from).and_then(|recording| {
        let manoeuvre = manoeuvre(&wire.manoeuvre, folder)?;
        Ok(settings::checked(Simulation { recording, manoeuvre, ..trial.clone() })?)
    });
    resolved.map_err(|problem| {
        let what = format!("in the further record {}", index + 1);
        inside(problem, KeyPath::dotted("also").child(index), &what)
    })
}

/// What both share has been checked with the first manoeuvre, so what is wrong now is of the other one.
fn inside(problem: Problem, place: KeyPath, what: &str) -> Problem {
    Problem {
        key: problem.key.parts().iter().fold(place, |key, part| key.child(part)),
        found: format!("{what}, {}", problem.found),
        ..problem
    }
}

/// The second manoeuvre: the same ship, gear and helmsman in a calm, perfectly recorded from the start of the run, so
/// that the error of a replay is that of the response.
fn validation(wire: &ValidationWire, trial: &Simulation, folder: &Path) -> Result<Simulation, Problem> {
    let resolved = || {
        let recording = match &wire.recording {
            Some(own) => own.build()?,
            None => Recording { start: Start::Run, rudder: RudderColumn::Feedback, ..trial.recording },
        };
        let simulation = Simulation {
            recording,
            disturbances: Disturbances::default(),
            sensors: Sensors::default(),
            manoeuvre: manoeuvre(&wire.manoeuvre, folder)?,
            ..trial.clone()
        };
        Ok(settings::checked(simulation)?)
    };
    resolved().map_err(|problem| inside(problem, KeyPath::dotted("validation"), "in the validation manoeuvre"))
}

/// The ship that a scenario names, or describes by numbers of its own.
pub fn ship(wire: &BTreeMap<String, toml::Table>) -> Result<Ship, Problem> {
    let known = || -> Vec<String> {
        let registry = ships::all().into_iter().map(|ship| ship.id.to_string());
        registry.chain(["first-order", "second-order"].map(str::to_owned)).collect()
    };
    let mut entries = wire.iter();
    let (Some((id, table)), None) = (entries.next(), entries.next()) else {
        let names: Vec<&str> = wire.keys().map(String::as_str).collect();
        let found = match names.as_slice() {
            [] => "`ship` names no ship".to_owned(),
            several => format!("`ship` names {} ships: {}", several.len(), several.join(", ")),
        };
        let advice = suggestion("", &known());
        return Err(Problem::name(KeyPath::dotted("ship"), found, "expected exactly one ship", advice));
    };
    let key = KeyPath::dotted("ship").child(id);
    match id.as_str() {
        "first-order" => {
            let own: FirstOrderWire = reader::table(table, &key)?;
            let particulars = particulars(&key, own.length_m, own.speed_kn)?;
            let (k, t) = indices(&own, &key, particulars)?;
            ships::user::first_order(k, t, from_deg(own.rudder_bias_deg), particulars)
                .map_err(|error| not_a_ship(&key, table, &error))
        }
        "second-order" => {
            let own: SecondOrderWire = reader::table(table, &key)?;
            let particulars = particulars(&key, own.length_m, own.speed_kn)?;
            let indices = SecondOrderIndices { K: own.K_per_s, T1: own.T1_s, T2: own.T2_s, T3: own.T3_s };
            ships::user::second_order(indices, from_deg(own.rudder_bias_deg), particulars)
                .map_err(|error| not_a_ship(&key, table, &error))
        }
        _ if table.is_empty() => ships::find(id).ok_or_else(|| {
            Problem::name(key, format!("no ship is called `{id}`"), "no such ship", suggestion(id, &known()))
        }),
        _ if ships::find(id).is_none() => {
            Err(Problem::name(key, format!("no ship is called `{id}`"), "no such ship", suggestion(id, &known())))
        }
        _ => Err(Problem::name(
            key,
            format!("the ship `{id}` has settings below it, and its numbers are fixed"),
            "expected no keys below this ship",
            format!("write [ship.{id}] and nothing below it; for numbers of your own use [ship.first-order]"),
        )),
    }
}

/// K (1/s) and T (s), given as they are or without dimension.
fn indices(own: &FirstOrderWire, key: &KeyPath, particulars: Option<Particulars>) -> Result<(f64, f64), Problem> {
    match (own.K_per_s, own.T_s, own.K_prime, own.T_prime, particulars) {
        (Some(k), Some(t), None, None, _) => Ok((k, t)),
        (None, None, Some(k), Some(t), Some(Particulars { length, speed })) => {
            Ok((k * speed / length, t * length / speed))
        }
        (None, None, Some(_), Some(_), None) => Err(Problem::name(
            key.clone(),
            format!("`{key}` has K' and T' without length and speed"),
            "expected `length-m` and `speed-kn` as well",
            "add both, or give `K-per-s` and `T-s`",
        )),
        (Some(_), None, None, None, _) => Err(reader::missing(key, "T-s")),
        (None, Some(_), None, None, _) | (None, None, None, None, _) => Err(reader::missing(key, "K-per-s")),
        (None, None, Some(_), None, _) => Err(reader::missing(key, "T-prime")),
        (None, None, None, Some(_), _) => Err(reader::missing(key, "K-prime")),
        _ => Err(Problem::name(
            key.clone(),
            format!("`{key}` gives K and T both with and without dimension"),
            "expected `K-per-s` and `T-s`, or `K-prime` and `T-prime`",
            "give one pair and leave out the other",
        )),
    }
}

/// Numbers that make no ship, with the key of the number where there is one.
fn not_a_ship(key: &KeyPath, table: &toml::Table, error: &ShipError) -> Problem {
    let (symbol, expected) = match *error {
        ShipError::Value { symbol, reason, .. } => (symbol, reason.to_owned()),
        ShipError::Range { symbol, parameter, value } => {
            let Parameter { symbol: of, unit, lowest, highest, .. } = parameter;
            let range = format!("from {} to {} {unit}", Shown(*lowest), Shown(*highest));
            (symbol, format!("expected {of} {range}, and this makes it {}", Shown(value)))
        }
    };
    let own = match symbol {
        "K" if table.contains_key("K-prime") => "K-prime",
        "T" if table.contains_key("T-prime") => "T-prime",
        "K" => "K-per-s",
        "T" => "T-s",
        "T1" => "T1-s",
        "T2" => "T2-s",
        "T3" => "T3-s",
        _ => "rudder-bias-deg",
    };
    let key = key.child(own);
    let value = table.get(own).map_or_else(String::new, sweep::written);
    Problem::value(key.clone(), format!("`{key}` is {value}"), expected, "change the number")
}

fn particulars(key: &KeyPath, length_m: Option<f64>, speed_kn: Option<f64>) -> Result<Option<Particulars>, Problem> {
    let half = |given: &str, missing: &str| {
        let found = format!("`{key}` has `{given}` without `{missing}`");
        Problem::name(
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
            let found = format!("`{key}` is {}", Shown(value));
            Problem::value(key, found, "expected a finite number above 0", "change the number")
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

/// The manoeuvre; a record to replay is in `folder` or near it.
fn manoeuvre(settings: &ManoeuvreSettings, folder: &Path) -> Result<Manoeuvre, Problem> {
    settings.build(|file| {
        let path = folder.join(file);
        let refuse = |found: String| {
            let key = KeyPath::dotted("manoeuvre.replay.file");
            let advice = "give a record that `study fit` can read, relative to this file; `study fit` says what is wrong with it";
            Problem::value(key, format!("the record to replay: {found}"), "expected a record with a rudder", advice)
        };
        // It is read for every cell, and what has gone through a pipe is gone.
        if path.exists() && !path.is_file() {
            return Err(refuse(format!("{}: this is a folder, a pipe or a device and no file", path.display())));
        }
        // Who runs a scenario need not have named the files in it: what they hold is not shown.
        let reading = trial::reader::read(&path).map_err(|error| refuse(error.without_content()))?;
        Ok(reading.trial.rudder_signal().clone())
    })
}
