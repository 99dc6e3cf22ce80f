//! From what a scenario says to what the engine accepts: units to SI, names to ships, every value checked.

use std::collections::BTreeMap;
use std::path::Path;

use ship::angle::{KNOT, from_deg};
use ship::effects::Parameter;
use ship::linear::SecondOrderIndices;
use ship::narrow_band::NarrowBand;
use ship::ships::Model;
use ship::ships::user::ShipError;
use ship::{Particulars, Ship, Shown, ships};
use simulate::disturbance::{GaussMarkov, Squall, Wind};
use simulate::helm::Watches;
use simulate::manoeuvre::{PullOut, TurnEnd, TurningCircle, ZigZag, ZigZagEnd};
use simulate::recording::{RudderColumn, Start};
use simulate::sensor::{Bursts, Clock, DropOut, HeadingSensor, Loses, RudderSensor, YawRateSensor};
use simulate::{
    Approach, Disturbances, Helmsman, Manoeuvre, Recording, Sensors, Side, Simulation, SteeringGear, Vessel,
};

use crate::problem::{KeyPath, Problem, suggestion};
use crate::specification::{HULL, Specification};
use crate::wire::*;
use crate::{effect, reader, refusal, sweep};

/// Resolves everything about a trial.
pub fn specification(wire: &ScenarioWire, folder: &Path) -> Result<Specification, Problem> {
    let ship = effect::added(ship(&wire.ship)?, &wire.effect)?;
    let simulation = Simulation {
        gear: gear(&wire.steering_gear, &ship),
        helmsman: helmsman(&wire.helmsman),
        approach: Approach {
            heading: from_deg(wire.approach.heading_deg),
            yaw_rate: from_deg(wire.approach.yaw_rate_deg_s),
            rudder: from_deg(wire.approach.rudder_deg),
            lead_in: wire.approach.lead_in_s,
        },
        recording: recording(&wire.recording, "recording")?,
        sensors: sensors(&wire.sensor)?,
        disturbances: disturbances(&wire.disturbance),
        ..Simulation::new(Vessel::ship(&ship), manoeuvre(&wire.manoeuvre, "manoeuvre", folder)?)
    };
    simulation.validate().map_err(|error| refusal::problem(&error, &wire.manoeuvre, wire.recording.sampling_s))?;
    start_is_reached(&simulation)?;
    orders_are_given(&simulation)?;
    let validation =
        wire.validation.as_ref().map(|second| validation(second, wire, &simulation, folder)).transpose()?;
    let base = match &ship.model {
        Model::Response(response) => Some(response.first_order()),
        Model::Hull(_) => None,
    };
    Ok(Specification { validation, truth: ship.first_order(), base, missing: missing(&ship, wire), simulation })
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

/// The second manoeuvre: the same ship, gear and helmsman in a calm, perfectly recorded from the start of the run, so that
/// the error of a replay is that of the response.
fn validation(
    wire: &ValidationWire,
    first: &ScenarioWire,
    trial: &Simulation,
    folder: &Path,
) -> Result<Simulation, Problem> {
    let recording = match &wire.recording {
        Some(own) => recording(own, "validation.recording")?,
        None => Recording { start: Start::Run, rudder: RudderColumn::Feedback, ..trial.recording },
    };
    let simulation = Simulation {
        recording,
        disturbances: Disturbances::default(),
        sensors: Sensors::default(),
        manoeuvre: manoeuvre(&wire.manoeuvre, "validation.manoeuvre", folder)?,
        ..trial.clone()
    };
    // What both share has been checked with the first manoeuvre, so what is wrong now is of the second.
    let of_second = |problem: Problem| Problem {
        key: problem.key.parts().iter().fold(KeyPath::dotted("validation"), |key, part| key.child(part)),
        found: format!("in the validation manoeuvre, {}", problem.found),
        ..problem
    };
    let sampling_s = wire.recording.as_ref().unwrap_or(&first.recording).sampling_s;
    simulation
        .validate()
        .map_err(|error| refusal::problem(&error, &wire.manoeuvre, sampling_s))
        .and_then(|()| start_is_reached(&simulation))
        .and_then(|()| orders_are_given(&simulation))
        .map_err(of_second)?;
    Ok(simulation)
}

/// A rudder column can be rebuilt only where orders are given.
fn orders_are_given(simulation: &Simulation) -> Result<(), Problem> {
    match (&simulation.manoeuvre, simulation.recording.rudder) {
        (Manoeuvre::Replay(_), RudderColumn::Orders { .. }) => Err(Problem::value(
            KeyPath::dotted("recording.rudder"),
            "`recording.rudder` is \"orders\", and a replayed rudder follows none",
            "expected \"feedback\"",
            "leave the key out",
        )),
        _ => Ok(()),
    }
}

fn ship(wire: &BTreeMap<String, toml::Table>) -> Result<Ship, Problem> {
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

/// Whether the execute after which the record starts can be made at all.
fn start_is_reached(simulation: &Simulation) -> Result<(), Problem> {
    let Start::Execute { number, .. } = simulation.recording.start else { return Ok(()) };
    let made = match &simulation.manoeuvre {
        Manoeuvre::ZigZag(ZigZag { end: ZigZagEnd::Executes(executes), .. }) => *executes,
        Manoeuvre::ZigZag(_) => usize::MAX,
        Manoeuvre::PullOut(_) => 2,
        Manoeuvre::TurningCircle(_) | Manoeuvre::Replay(_) => 1,
    };
    if number <= made {
        return Ok(());
    }
    Err(Problem::value(
        KeyPath::dotted("recording.after-execute"),
        format!("`recording.after-execute` is {number}, and the manoeuvre ends after execute {made}"),
        format!("expected at most {made}"),
        "start the record earlier, or leave the key out to record from the start",
    ))
}

fn side(wire: SideWire) -> Side {
    match wire {
        SideWire::Starboard => Side::Starboard,
        SideWire::Port => Side::Port,
    }
}

/// The manoeuvre at `place`.
fn manoeuvre(wire: &ManoeuvreWire, place: &str, folder: &Path) -> Result<Manoeuvre, Problem> {
    // A path is put together only for a problem: a study with drawn values resolves every trial.
    let place = || KeyPath::dotted(place);
    let both = |name: &str, one: &str, other: &str| {
        let key = place().child(name);
        Problem::name(
            key.child(other),
            format!("`{key}` has both `{one}` and `{other}`"),
            "expected one end of the manoeuvre",
            format!("leave out `{one}` or `{other}`"),
        )
    };
    Ok(match wire {
        ManoeuvreWire::ZigZag(zig_zag) => {
            let end = match (zig_zag.executes, zig_zag.duration_s) {
                (Some(executes), None) => ZigZagEnd::Executes(executes),
                (None, Some(duration)) => ZigZagEnd::Duration(duration),
                (None, None) => ZigZagEnd::Record,
                (Some(_), Some(_)) => return Err(both("zig-zag", "executes", "duration-s")),
            };
            Manoeuvre::ZigZag(ZigZag {
                rudder: from_deg(zig_zag.rudder_deg),
                heading: from_deg(zig_zag.heading_deg),
                first: side(zig_zag.first),
                end,
            })
        }
        ManoeuvreWire::TurningCircle(turn) => {
            let end = match (turn.duration_s, turn.heading_change_deg) {
                (Some(duration), None) => TurnEnd::Duration(duration),
                (None, Some(change)) => TurnEnd::HeadingChange(from_deg(change)),
                (Some(_), Some(_)) => return Err(both("turning-circle", "duration-s", "heading-change-deg")),
                (None, None) => {
                    return Err(Problem::name(
                        place().child("turning-circle"),
                        "nothing ends the turning circle",
                        "expected `duration-s` or `heading-change-deg` here",
                        "add a line `heading-change-deg = 540.0`, or one with `duration-s`",
                    ));
                }
            };
            Manoeuvre::TurningCircle(TurningCircle { rudder: from_deg(turn.rudder_deg), side: side(turn.side), end })
        }
        ManoeuvreWire::PullOut(pull_out) => Manoeuvre::PullOut(PullOut {
            rudder: from_deg(pull_out.rudder_deg),
            side: side(pull_out.side),
            hold: pull_out.hold_s,
            duration: pull_out.duration_s,
        }),
        ManoeuvreWire::Replay(replay) => {
            let path = folder.join(&replay.file);
            let refuse = |found: String| {
                let key = place().child("replay").child("file");
                let advice = "give a record that `study fit` can read, relative to this file; `study fit` says what is wrong with it";
                Problem::value(key, format!("the record to replay: {found}"), "expected a record with a rudder", advice)
            };
            // It is read for every cell, and what has gone through a pipe is gone.
            if path.exists() && !path.is_file() {
                return Err(refuse(format!("{}: this is a folder, a pipe or a device and no file", path.display())));
            }
            // Who runs a scenario need not have named the files in it: what they hold is not shown.
            let reading = trial::reader::read(&path).map_err(|error| refuse(error.without_content()))?;
            Manoeuvre::Replay(reading.trial.rudder_signal().clone())
        }
    })
}

/// No rudder is put further than across the ship, deg.
const LARGEST_RUDDER_DEG: f64 = 90.0;

/// The gear of the scenario; a rate or limit that is left out is that of the ship, where its source gives one.
fn gear(wire: &GearWire, ship: &Ship) -> SteeringGear {
    SteeringGear {
        rate: wire.rate_deg_s.map(from_deg).or(ship.rudder_rate).unwrap_or(f64::INFINITY),
        lag: wire.lag_s,
        dead_time: wire.dead_time_s,
        dead_band: from_deg(wire.dead_band_deg),
        maximum: wire.maximum_deg.map(from_deg).or(ship.largest_rudder).unwrap_or(from_deg(LARGEST_RUDDER_DEG)),
    }
}

fn helmsman(wire: &HelmsmanWire) -> Helmsman {
    let watches = wire.reads_display_every_s.map_or(Watches::TrueHeading, |period| Watches::Display { period });
    Helmsman { watches, reaction_time: wire.reaction_time_s }
}

/// The recording at `place`.
fn recording(wire: &RecordingWire, place: &str) -> Result<Recording, Problem> {
    let rudder = match (wire.rudder, wire.assumed_rudder_rate_deg_s) {
        (RudderWire::Feedback, None) => RudderColumn::Feedback,
        (RudderWire::Orders, Some(rate)) if rate > 0.0 => RudderColumn::Orders { assumed_rate: from_deg(rate) },
        (RudderWire::Orders, Some(rate)) => {
            let key = KeyPath::dotted(place).child("assumed-rudder-rate-deg-s");
            let found = format!("`{key}` is {}", Shown(rate));
            let expected = "expected a number above 0, or inf for a rudder that jumps";
            return Err(Problem::value(key, found, expected, "give the rate the analyst assumes, for instance 2.5"));
        }
        (RudderWire::Orders, None) => {
            return Err(Problem::name(
                KeyPath::dotted(place).child("rudder"),
                format!("`{place}.rudder` is \"orders\", and nothing says how fast the rudder is taken to move"),
                "expected `assumed-rudder-rate-deg-s` as well",
                "add `assumed-rudder-rate-deg-s = 2.5`, or inf for a rudder that jumps",
            ));
        }
        (RudderWire::Feedback, Some(_)) => {
            return Err(Problem::name(
                KeyPath::dotted(place).child("assumed-rudder-rate-deg-s"),
                format!("`{place}` has an assumed rate for a rudder that is recorded"),
                "a rate is assumed for `rudder = \"orders\"` only",
                "add `rudder = \"orders\"`, or leave the rate out",
            ));
        }
    };
    let start = match (wire.after_execute, wire.offset_s) {
        (Some(number), offset) => Start::Execute { number, offset: offset.unwrap_or(0.0) },
        (None, None) => Start::Run,
        (None, Some(_)) => {
            return Err(Problem::name(
                KeyPath::dotted("recording.offset-s"),
                "`recording.offset-s` counts from an execute, and `after-execute` is missing",
                "expected `after-execute` as well",
                "add `after-execute = 1` for the first execute, or leave `offset-s` out",
            ));
        }
    };
    Ok(Recording { start, period: wire.sampling_s, duration: wire.duration_s, rudder })
}

fn sensors(wire: &SensorWire) -> Result<Sensors, Problem> {
    let gyro = [wire.yaw_rate_noise_deg_s, wire.yaw_rate_bias_deg_s, wire.yaw_rate_scale_error];
    let yaw_rate = gyro.iter().any(Option::is_some).then(|| YawRateSensor {
        noise: from_deg(gyro[0].unwrap_or(0.0)),
        bias: from_deg(gyro[1].unwrap_or(0.0)),
        scale_error: gyro[2].unwrap_or(0.0),
    });
    let drop_out = &wire.drop_out;
    let bursts = match (drop_out.burst_probability, drop_out.burst_mean_rows) {
        (Some(probability), Some(mean_rows)) => Some(Bursts { probability, mean_rows }),
        (None, None) => None,
        _ => {
            return Err(Problem::name(
                KeyPath::dotted("sensor.drop-out"),
                "`sensor.drop-out` has only one of `burst-probability` and `burst-mean-rows`",
                "the two belong together",
                "give both, or leave both out",
            ));
        }
    };
    Ok(Sensors {
        heading: HeadingSensor {
            noise: from_deg(wire.heading_noise_deg),
            quantum: from_deg(wire.heading_quantum_deg),
            lag: wire.heading_lag_s,
            bias: from_deg(wire.heading_bias_deg),
        },
        yaw_rate,
        rudder: RudderSensor { noise: from_deg(wire.rudder_noise_deg), quantum: from_deg(wire.rudder_quantum_deg) },
        clock: Clock { jitter: wire.jitter_s, heading_delay: wire.heading_delay_s },
        drop_out: DropOut {
            probability: drop_out.probability,
            bursts,
            loses: if drop_out.whole_row { Loses::Row } else { Loses::Heading },
        },
    })
}

fn disturbances(wire: &DisturbanceWire) -> Disturbances {
    Disturbances {
        wind: wire.wind.as_ref().map(|wind| Wind {
            moment: from_deg(wind.moment_deg),
            from: from_deg(wind.from_deg),
            speed: wind.speed_m_s,
            gusting: wind.gusting.as_ref().map(|g| GaussMarkov { sd: g.sd, correlation_time: g.correlation_s }),
        }),
        gusts: wire.gusts.as_ref().map(|g| GaussMarkov { sd: from_deg(g.sd_deg), correlation_time: g.correlation_s }),
        drift: from_deg(wire.drift_deg_per_s),
        squall: wire.squall.as_ref().map(|squall| Squall {
            moment: from_deg(squall.moment_deg),
            start: squall.start_s,
            duration: squall.duration_s,
            edge: squall.edge_s,
        }),
        random_walk: from_deg(wire.random_walk_deg_per_root_s),
        waves: wire.waves.as_ref().map(|waves| NarrowBand {
            sd: from_deg(waves.sd_deg),
            frequency: waves.frequency_rad_s,
            damping: waves.damping,
        }),
    }
}
