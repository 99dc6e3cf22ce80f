//! Resolution of a scenario into specifications: names into ships, settings into a simulation, with every value
//! checked.

use std::path::Path;
use std::sync::Arc;

use ::ship::ships::ShipModel;
use ::ship::{Particulars, RegressorChannel, Ship, ShortNumber};
use simulate::motion::{PlanarModel, PlanarShip};
use simulate::{Disturbances, Manoeuvre, Recording, Sensors, SimulatedShip, Simulation};

use crate::scenario::problem::{KeyFault, KeyPath};
use crate::scenario::specification::{HULL_ID, Specification};
use crate::scenario::wire::{FurtherWire, ScenarioWire};
use crate::scenario::{effect, ship};

/// Checked specification of a trial of the scenario `name`; paths are relative to `folder`. Fails for the first invalid
/// value.
pub fn trial_specification(wire: &ScenarioWire, name: &str, folder: &Path) -> Result<Specification, KeyFault> {
    let ship = effect::with_effects(ship::build(&wire.ship)?, &wire.effect, &lacking(wire))?;
    let simulation = Simulation {
        scenario_name: name.to_owned(),
        gear: wire.steering_gear.with_ship_defaults(&ship),
        helmsman: wire.helmsman,
        approach: wire.approach,
        recording: wire.recording,
        sensors: wire.sensor,
        disturbances: wire.disturbance,
        ..Simulation::new(simulated_ship(&ship, wire)?, manoeuvre(&wire.manoeuvre, folder)?)
    };
    simulation.check()?;
    // A further record has the same ship, gear, helmsman, weather and instruments.
    let further_records = wire.also.iter().enumerate().map(|(index, entry)| {
        let context = format!("in the further record {}", index + 1);
        let record = Simulation { recording: entry.recording.unwrap_or(wire.recording), ..simulation.clone() };
        further(entry, record, KeyPath::from_dotted("also").child(index), &context, folder)
    });
    let further_records = further_records.collect::<Result<_, _>>()?;
    // A validation is in a calm and without measurement error, so that the error of a replay is that of the response.
    let validation = wire.validation.as_ref().map(|entry| {
        let record = Simulation {
            recording: entry.recording.unwrap_or_else(|| validation_recording(&wire.recording)),
            disturbances: Disturbances::default(),
            sensors: Sensors::default(),
            ..simulation.clone()
        };
        further(entry, record, KeyPath::from_dotted("validation"), "in the validation manoeuvre", folder)
    });
    let validation = validation.transpose()?;
    let base = match &ship.model {
        ShipModel::Response(response) => Some(response.first_order()),
        ShipModel::Hull(_) => None,
    };
    let (truth, missing, stated) = (ship.first_order(), missing(&ship, wire), effect::stated_physics(&wire.effect)?);
    Ok(Specification {
        further_simulations: further_records,
        validation,
        true_response: truth,
        base_response: base,
        missing_effects: missing,
        stated_physics: stated,
        simulation,
    })
}

/// Channels absent from the trials of a scenario.
fn lacking(wire: &ScenarioWire) -> Vec<RegressorChannel> {
    let moves = wire.speed_and_sway.is_some();
    let blows = wire.disturbance.wind.is_some_and(|wind| wind.speed.is_some());
    let has = [
        (RegressorChannel::Sway, moves),
        (RegressorChannel::Speed, moves),
        (RegressorChannel::Wind, blows),
        (RegressorChannel::Propeller, false),
    ];
    has.into_iter().filter(|(_, is_there)| !is_there).map(|(channel, _)| channel).collect()
}

/// Ship of the simulation: the ship, with speed and sway added to its yaw response if the scenario has them.
///
/// With speed and sway it fails for a hull, for a ship without length and speed, and for a coefficient outside its
/// range.
fn simulated_ship(ship: &Ship, wire: &ScenarioWire) -> Result<SimulatedShip, KeyFault> {
    let simulated = SimulatedShip::from_ship(ship);
    let Some(coefficients) = wire.speed_and_sway else { return Ok(simulated) };
    let key = KeyPath::from_dotted("speed-and-sway");
    let (ShipModel::Response(response), Some(Particulars { length, speed })) = (&ship.model, ship.particulars) else {
        let expected = "expected a response model with length and speed";
        let advice = "leave the table out, or use yukun, or first-order with `length-m` and `speed-kn`";
        return Err(KeyFault::name(key, format!("speed and sway are added to `{}`", ship.id), expected, advice));
    };
    if let Some((symbol, value, [low, high])) = coefficients.first_out_of_bounds() {
        let expected = format!("expected a number from {} to {}", ShortNumber(low), ShortNumber(high));
        return Err(KeyFault::new(key.child(symbol), ShortNumber(value), expected, "change the number"));
    }
    let planar = PlanarModel::new(coefficients, length, speed).map_err(|error| {
        KeyFault::name(key, error.to_string(), "not accepted", "change length and speed of the ship")
    })?;
    Ok(simulated.with_dynamics(Arc::new(PlanarShip { response: response.clone(), planar })))
}

/// Identifiers of the effects missing from a first-order base in a trial: effects of the ship, and effects equal to a
/// disturbance or to a delay or lag of the heading sensor; [`HULL_ID`] for a hull.
fn missing(ship: &Ship, wire: &ScenarioWire) -> Vec<String> {
    let mut missing: Vec<String> = match &ship.model {
        ShipModel::Response(response) => response.model().effects().iter().map(|effect| effect.id().into()).collect(),
        ShipModel::Hull(_) => vec![HULL_ID.to_owned()],
    };
    let sea = &wire.disturbance;
    let disturbances = [
        (sea.wind.is_some(), "wind_moment"),
        (sea.moment_drift != 0.0, "moment_drift"),
        (sea.squall.is_some(), "transient_disturbance"),
        (sea.waves.is_some(), "wave_yaw"),
        (wire.sensor.heading_delay != 0.0 || wire.sensor.heading_lag != 0.0, "steering_lag"),
    ];
    missing.extend(disturbances.into_iter().filter(|(acts, _)| *acts).map(|(_, id)| id.to_owned()));
    missing.dedup();
    missing
}

/// Default recording of a validation.
pub fn validation_recording(trial: &Recording) -> Recording {
    Recording { duration: trial.duration, ..Recording::every(trial.sampling_period) }
}

/// Simulation of a further manoeuvre of the ship; `record` has the settings shared with the first one, which are
/// checked already, so that any fault concerns this manoeuvre.
fn further(
    wire: &FurtherWire,
    record: Simulation,
    place: KeyPath,
    context: &str,
    folder: &Path,
) -> Result<Simulation, KeyFault> {
    let checked = manoeuvre(&wire.manoeuvre, folder).and_then(|manoeuvre| {
        let simulation = Simulation { manoeuvre, ..record };
        simulation.check()?;
        Ok(simulation)
    });
    checked.map_err(|fault| KeyFault {
        key: fault.key.names().iter().fold(place, |key, part| key.child(part)),
        problem: format!("{context}, {}", fault.problem),
        ..fault
    })
}

/// Manoeuvre, with the record to replay, whose path is relative to `folder`.
fn manoeuvre(manoeuvre: &Manoeuvre, folder: &Path) -> Result<Manoeuvre, KeyFault> {
    let Manoeuvre::Replay { file, .. } = manoeuvre else { return Ok(manoeuvre.clone()) };
    let path = folder.join(file);
    let refuse = |problem: String| {
        let key = KeyPath::from_dotted("manoeuvre.replay.file");
        let advice =
            "give a record that `study fit` can read, relative to this file; `study fit` says what is wrong with it";
        KeyFault::value(key, format!("the record to replay: {problem}"), "expected a record with a rudder", advice)
    };
    // The file is read for every cell, which a pipe does not allow.
    if path.exists() && !path.is_file() {
        return Err(refuse(format!("{}: this is a folder, a pipe or a device, not a file", path.display())));
    }
    // The content is not shown: the author of the scenario may be another person than the user.
    let reading = trial::reader::read(&path).map_err(|error| refuse(error.without_content()))?;
    Ok(Manoeuvre::Replay { file: file.clone(), rudder: Some(reading.trial.rudder_signal().clone()) })
}
