//! From what a scenario says to what the engine accepts: units to SI, names to ships, every value checked.

use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;
use ship::angle::{DEGREE, KNOT, from_deg};
use ship::effects::{
    Effect, MomentDrift, NonlinearDamping, PortStarboardAsymmetry, RudderDeadband, RudderSaturation, SecondOrder,
    SpeedLoss, SteeringLag, TransientDisturbance, WaveYaw, WindMoment,
};
use ship::linear::SecondOrderIndices;
use ship::narrow_band::NarrowBand;
use ship::ships::{self, Model};
use ship::{Particulars, ResponseModel, Ship};
use simulate::disturbance::{GaussMarkov, Squall, Wind};
use simulate::helm::Watches;
use simulate::manoeuvre::{PullOut, TurnEnd, TurningCircle, ZigZag, ZigZagEnd};
use simulate::recording::Start;
use simulate::sensor::{Bursts, Clock, DropOut, HeadingSensor, Loses, RudderSensor, YawRateSensor};
use simulate::{
    Approach, Disturbances, Helmsman, Manoeuvre, Recording, Sensors, Side, Simulation, SpecificationError, SteeringGear,
    Vessel,
};

use super::wire::*;
use super::{Cell, Method};

/// A value of a scenario that makes no sense.
#[derive(Debug, Clone, PartialEq)]
pub struct ResolveError {
    /// Dotted key.
    pub key: String,
    /// The value found and what was expected.
    pub problem: String,
    /// What to do.
    pub advice: String,
}

impl ResolveError {
    fn new(key: impl Into<String>, problem: impl Into<String>, advice: impl Into<String>) -> Self {
        Self { key: key.into(), problem: problem.into(), advice: advice.into() }
    }
}

/// Resolves one cell; labels and values of the design are filled in by the caller.
pub fn cell(wire: &ScenarioWire, folder: &Path) -> Result<Cell, ResolveError> {
    let ship = with_effects(ship(&wire.ship)?, &wire.effect)?;
    let simulation = Simulation {
        gear: gear(&wire.steering_gear, &ship),
        helmsman: helmsman(&wire.helmsman),
        approach: Approach {
            heading: from_deg(wire.approach.heading_deg),
            yaw_rate: from_deg(wire.approach.yaw_rate_deg_s),
            rudder: from_deg(wire.approach.rudder_deg),
            lead_in: wire.approach.lead_in_s,
        },
        recording: recording(&wire.recording)?,
        sensors: sensors(&wire.sensor)?,
        disturbances: disturbances(&wire.disturbance),
        ..Simulation::new(Vessel::ship(&ship), manoeuvre(&wire.manoeuvre, folder)?)
    };
    simulation.validate().map_err(|error| specification(&error, &wire.manoeuvre))?;
    Ok(Cell {
        labels: Vec::new(),
        values: Vec::new(),
        truth: ship.first_order(),
        simulation,
        methods: methods(&wire.identifier)?,
    })
}

fn ship(wire: &std::collections::BTreeMap<String, toml::Table>) -> Result<Ship, ResolveError> {
    let known = || {
        let ids: Vec<String> = ships::all().iter().map(|ship| ship.id.to_string()).collect();
        format!("expected one of {}, first-order, second-order", ids.join(", "))
    };
    let mut entries = wire.iter();
    let (Some((id, table)), None) = (entries.next(), entries.next()) else {
        return Err(ResolveError::new("ship", format!("{} ships, a scenario has one", wire.len()), known()));
    };
    let key = format!("ship.{id}");
    let settings = |error: toml::de::Error| ResolveError::new(key.clone(), format!("`{key}`: {}", error.message()), "mend the keys of this ship");
    let refused = |error: ships::user::ShipError| ResolveError::new(key.clone(), error.to_string(), "mend the numbers of this ship");
    match id.as_str() {
        "first-order" => {
            let own = FirstOrderWire::deserialize(table.clone()).map_err(settings)?;
            let particulars = particulars(&key, own.length_m, own.speed_kn)?;
            ships::user::first_order(own.K_per_s, own.T_s, from_deg(own.rudder_bias_deg), particulars).map_err(refused)
        }
        "second-order" => {
            let own = SecondOrderWire::deserialize(table.clone()).map_err(settings)?;
            let particulars = particulars(&key, own.length_m, own.speed_kn)?;
            let indices = SecondOrderIndices { K: own.K_per_s, T1: own.T1_s, T2: own.T2_s, T3: own.T3_s };
            ships::user::second_order(indices, from_deg(own.rudder_bias_deg), particulars).map_err(refused)
        }
        _ if table.is_empty() => {
            ships::find(id).ok_or_else(|| ResolveError::new(key.clone(), format!("no ship is called `{id}`"), known()))
        }
        _ => Err(ResolveError::new(key.clone(), format!("`{key}` has settings, a ship of the registry has none"), "write it as {}")),
    }
}

fn particulars(key: &str, length_m: Option<f64>, speed_kn: Option<f64>) -> Result<Option<Particulars>, ResolveError> {
    match (length_m, speed_kn) {
        (Some(length), Some(speed)) => Ok(Some(Particulars { length, speed: speed * KNOT })),
        (None, None) => Ok(None),
        _ => Err(ResolveError::new(key, "`length-m` and `speed-kn` belong together, only one is given", "give both or neither")),
    }
}

fn with_effects(ship: Ship, wire: &[EffectWire]) -> Result<Ship, ResolveError> {
    if wire.is_empty() {
        return Ok(ship);
    }
    let Model::Response(response) = &ship.model else {
        return Err(ResolveError::new("effect", format!("`{}` is a hull with its own equations", ship.id), "effects can be added to response models only"));
    };
    let inverse_time = response.parameters()[0];
    let mut effects = response.model().effects().to_vec();
    let mut parameters = response.parameters().to_vec();
    for (index, wire) in wire.iter().enumerate() {
        let (effect, values) = effect(wire, inverse_time);
        for (description, value) in effect.parameters().iter().zip(&values) {
            if !(description.lowest..=description.highest).contains(value) {
                return Err(ResolveError::new(
                    format!("effect.{index}"),
                    format!("{} = {value} {} (SI): expected {} to {}", description.symbol, description.unit, description.lowest, description.highest),
                    "mend this effect",
                ));
            }
        }
        effects.push(effect);
        parameters.extend(values);
    }
    let model = Model::Response(ResponseModel::new(effects).with(parameters));
    Ok(Ship { model, ..ship })
}

/// The effect and its parameters in SI units; nonlinear damping is divided by T.
fn effect(wire: &EffectWire, inverse_time: f64) -> (Arc<dyn Effect>, Vec<f64>) {
    let per_degree = 1.0 / DEGREE;
    match *wire {
        EffectWire::SecondOrder { T2_s, T3_s } => (Arc::new(SecondOrder), vec![T2_s, T3_s]),
        EffectWire::NonlinearDamping(DampingWire::Cubic(n3)) => {
            (Arc::new(NonlinearDamping::Cubic), vec![n3 * per_degree * per_degree * inverse_time])
        }
        EffectWire::NonlinearDamping(DampingWire::Quadratic(n2)) => {
            (Arc::new(NonlinearDamping::Quadratic), vec![n2 * per_degree * inverse_time])
        }
        EffectWire::NonlinearDamping(DampingWire::Square(n11)) => {
            (Arc::new(NonlinearDamping::Square), vec![n11 * per_degree * inverse_time])
        }
        EffectWire::WindMoment(WindMomentWire { rudder_deg, from_deg: from }) => {
            let (moment, from) = (from_deg(rudder_deg), from_deg(from));
            (Arc::new(WindMoment::Steady), vec![moment * (2.0 * from).sin(), -moment * (2.0 * from).cos()])
        }
        EffectWire::SpeedLoss { loss_s_per_deg2, recovery_s, gain_exponent } => {
            (Arc::new(SpeedLoss::Modelled), vec![loss_s_per_deg2 * per_degree * per_degree, recovery_s, gain_exponent])
        }
        EffectWire::SteeringLag(LagWire::DeadTimeS(time)) => (Arc::new(SteeringLag::DeadTime), vec![time]),
        EffectWire::SteeringLag(LagWire::FirstOrderS(time)) => (Arc::new(SteeringLag::FirstOrder), vec![time]),
        EffectWire::RudderSaturation { c3_per_deg2 } => (Arc::new(RudderSaturation), vec![c3_per_deg2 * per_degree * per_degree]),
        EffectWire::RudderDeadband(DeadBandWire::BacklashDeg(width)) => (Arc::new(RudderDeadband::Backlash), vec![from_deg(width)]),
        EffectWire::RudderDeadband(DeadBandWire::DeadBandDeg(width)) => (Arc::new(RudderDeadband::DeadBand), vec![from_deg(width)]),
        EffectWire::PortStarboardAsymmetry { gain_share } => (Arc::new(PortStarboardAsymmetry), vec![gain_share]),
        EffectWire::MomentDrift { rudder_deg_per_s } => {
            (Arc::new(MomentDrift { reference_time: 0.0 }), vec![from_deg(rudder_deg_per_s)])
        }
        EffectWire::TransientDisturbance { rudder_deg, centre_s, duration_s } => {
            (Arc::new(TransientDisturbance), vec![from_deg(rudder_deg), centre_s, duration_s])
        }
        EffectWire::WaveYaw { sd_deg, frequency_rad_s, damping } => {
            (Arc::new(WaveYaw), vec![from_deg(sd_deg), frequency_rad_s, damping])
        }
    }
}

fn side(wire: SideWire) -> Side {
    match wire {
        SideWire::Starboard => Side::Starboard,
        SideWire::Port => Side::Port,
    }
}

fn manoeuvre(wire: &ManoeuvreWire, folder: &Path) -> Result<Manoeuvre, ResolveError> {
    let both = |key: &str, one: &str, other: &str| {
        ResolveError::new(key, format!("`{one}` and `{other}` cannot both end the manoeuvre"), "leave one out")
    };
    Ok(match wire {
        ManoeuvreWire::ZigZag(zig_zag) => {
            let end = match (zig_zag.executes, zig_zag.duration_s) {
                (Some(executes), None) => ZigZagEnd::Executes(executes),
                (None, Some(duration)) => ZigZagEnd::Duration(duration),
                (None, None) => ZigZagEnd::Record,
                (Some(_), Some(_)) => return Err(both("manoeuvre.zig-zag", "executes", "duration-s")),
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
                (Some(_), Some(_)) => return Err(both("manoeuvre.turning-circle", "duration-s", "heading-change-deg")),
                (None, None) => {
                    return Err(ResolveError::new("manoeuvre.turning-circle", "nothing ends the turning circle", "give `duration-s` or `heading-change-deg`"));
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
            let reading = trial::reader::read(&path)
                .map_err(|error| ResolveError::new("manoeuvre.replay.file", error.to_string(), "give a record with a rudder"))?;
            Manoeuvre::Replay(reading.trial.rudder_signal().clone())
        }
    })
}

/// The gear of the scenario; a rate or limit that is left out is that of the ship, where its source gives one.
fn gear(wire: &GearWire, ship: &Ship) -> SteeringGear {
    SteeringGear {
        rate: wire.rate_deg_s.map(from_deg).or(ship.rudder_rate).unwrap_or(f64::INFINITY),
        lag: wire.lag_s,
        dead_time: wire.dead_time_s,
        dead_band: from_deg(wire.dead_band_deg),
        maximum: wire.maximum_deg.map(from_deg).or(ship.largest_rudder).unwrap_or(f64::INFINITY),
    }
}

fn helmsman(wire: &HelmsmanWire) -> Helmsman {
    let watches = wire.reads_display_every_s.map_or(Watches::TrueHeading, |period| Watches::Display { period });
    Helmsman { watches, reaction_time: wire.reaction_time_s }
}

fn recording(wire: &RecordingWire) -> Result<Recording, ResolveError> {
    let start = match (wire.after_execute, wire.offset_s) {
        (Some(number), offset) => Start::Execute { number, offset: offset.unwrap_or(0.0) },
        (None, None) => Start::Run,
        (None, Some(_)) => {
            return Err(ResolveError::new("recording.offset-s", "`offset-s` counts from an execute, and none is given", "give `after-execute` as well"));
        }
    };
    Ok(Recording { start, period: wire.sampling_s, duration: wire.duration_s })
}

fn sensors(wire: &SensorWire) -> Result<Sensors, ResolveError> {
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
            return Err(ResolveError::new("sensor.drop-out", "`burst-probability` and `burst-mean-rows` belong together", "give both or neither"));
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

fn methods(wire: &[IdentifierWire]) -> Result<Vec<Method>, ResolveError> {
    let mut methods: Vec<Method> = Vec::with_capacity(wire.len());
    for (index, entry) in wire.iter().enumerate() {
        let key = format!("identifier.{index}");
        let identifier = entry.method.build().map_err(|error| {
            ResolveError::new(format!("{key}.method"), error.to_string(), format!("mend `{}`", error.key))
        })?;
        let label = entry.label.clone().unwrap_or_else(|| identifier.id().to_owned());
        if methods.iter().any(|method| method.label == label) {
            return Err(ResolveError::new(key, format!("two methods are called `{label}`"), "give each its own `label`"));
        }
        methods.push(Method { label, id: identifier.id(), settings: entry.method.clone(), identifier });
    }
    if methods.is_empty() {
        return Err(ResolveError::new("identifier", "no method is named", "add [[identifier]] with `method.output-error = {}`"));
    }
    Ok(methods)
}

/// Keys of specifications, the keys a scenario has for them, and whether the value is an angle.
const KEYS: [(&str, &str, bool); 42] = [
    ("zig_zag.rudder", "manoeuvre.zig-zag.rudder-deg", true),
    ("zig_zag.heading", "manoeuvre.zig-zag.heading-deg", true),
    ("zig_zag.executes", "manoeuvre.zig-zag.executes", false),
    ("zig_zag.duration", "manoeuvre.zig-zag.duration-s", false),
    ("turning_circle.rudder", "manoeuvre.turning-circle.rudder-deg", true),
    ("turning_circle.duration", "manoeuvre.turning-circle.duration-s", false),
    ("turning_circle.heading_change", "manoeuvre.turning-circle.heading-change-deg", true),
    ("pull_out.rudder", "manoeuvre.pull-out.rudder-deg", true),
    ("pull_out.hold", "manoeuvre.pull-out.hold-s", false),
    ("pull_out.duration", "manoeuvre.pull-out.duration-s", false),
    ("replay.duration", "manoeuvre.replay.file", false),
    ("gear.rate", "steering-gear.rate-deg-s", true),
    ("gear.lag", "steering-gear.lag-s", false),
    ("gear.dead_time", "steering-gear.dead-time-s", false),
    ("gear.dead_band", "steering-gear.dead-band-deg", true),
    ("gear.maximum", "steering-gear.maximum-deg", true),
    ("helmsman.period", "helmsman.reads-display-every-s", false),
    ("helmsman.reaction_time", "helmsman.reaction-time-s", false),
    ("approach.heading", "approach.heading-deg", true),
    ("approach.rudder", "approach.rudder-deg", true),
    ("approach.yaw_rate", "approach.yaw-rate-deg-s", true),
    ("approach.lead_in", "approach.lead-in-s", false),
    ("recording.period", "recording.sampling-s", false),
    ("recording.duration", "recording.duration-s", false),
    ("recording.start.execute", "recording.after-execute", false),
    ("recording.start.offset", "recording.offset-s", false),
    ("sensors.heading.noise", "sensor.heading-noise-deg", true),
    ("sensors.heading.quantum", "sensor.heading-quantum-deg", true),
    ("sensors.heading.lag", "sensor.heading-lag-s", false),
    ("sensors.yaw_rate.noise", "sensor.yaw-rate-noise-deg-s", true),
    ("sensors.rudder.noise", "sensor.rudder-noise-deg", true),
    ("sensors.rudder.quantum", "sensor.rudder-quantum-deg", true),
    ("sensors.clock.jitter", "sensor.jitter-s", false),
    ("sensors.drop_out.probability", "sensor.drop-out.probability", false),
    ("sensors.drop_out.bursts.probability", "sensor.drop-out.burst-probability", false),
    ("sensors.drop_out.bursts.mean_rows", "sensor.drop-out.burst-mean-rows", false),
    ("disturbances.gusts.sd", "disturbance.gusts.sd-deg", true),
    ("disturbances.gusts.correlation_time", "disturbance.gusts.correlation-s", false),
    ("disturbances.random_walk", "disturbance.random-walk-deg-per-root-s", true),
    ("disturbances.squall.edge", "disturbance.squall.edge-s", false),
    ("disturbances.waves.frequency", "disturbance.waves.frequency-rad-s", false),
    ("disturbances.waves.damping", "disturbance.waves.damping", false),
];

/// A refused specification in the words and units of the scenario.
fn specification(error: &SpecificationError, manoeuvre: &ManoeuvreWire) -> ResolveError {
    use simulate::Expected;
    let own_rudder = match manoeuvre {
        ManoeuvreWire::ZigZag(_) => "zig_zag.rudder",
        ManoeuvreWire::TurningCircle(_) => "turning_circle.rudder",
        ManoeuvreWire::PullOut(_) => "pull_out.rudder",
        ManoeuvreWire::Replay(_) => "replay.duration",
    };
    let name = if error.key == "manoeuvre.rudder" { own_rudder } else { error.key };
    let Some(&(_, key, angle)) = KEYS.iter().find(|(specification, ..)| *specification == name) else {
        return ResolveError::new(error.key, error.to_string(), "mend this value");
    };
    let unit = if angle { 1.0 / DEGREE } else { 1.0 };
    // Conversion to radians and back must not show.
    let shown = |value: f64| (value * unit * 1e9).round() / 1e9;
    let expected = match error.expected {
        Expected::Between(low, high) => Expected::Between(shown(low), shown(high)),
        Expected::AtMost(limit) => Expected::AtMost(shown(limit)),
        other => other,
    };
    let found = if error.value.is_nan() { "is not given".to_owned() } else { format!("is {}", shown(error.value)) };
    ResolveError::new(key, format!("`{key}` {found}"), format!("expected {expected}"))
}
