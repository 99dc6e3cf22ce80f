//! A value the simulator refuses, in the words and units of a scenario: its own key, degrees, and what to do.

use ship::Shown;
use ship::angle::DEGREE;
use simulate::limits::LONGEST_TIME;
use simulate::{Expected, SpecificationError};

use crate::problem::{KeyPath, Problem};
use crate::wire::ManoeuvreWire;

/// Keys of specifications, the keys a scenario has for them, and whether the value is an angle.
const KEYS: [(&str, &str, bool); 56] = [
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
    ("sensors.heading.bias", "sensor.heading-bias-deg", true),
    ("sensors.yaw_rate.noise", "sensor.yaw-rate-noise-deg-s", true),
    ("sensors.yaw_rate.bias", "sensor.yaw-rate-bias-deg-s", true),
    ("sensors.yaw_rate.scale_error", "sensor.yaw-rate-scale-error", false),
    ("sensors.rudder.noise", "sensor.rudder-noise-deg", true),
    ("sensors.rudder.quantum", "sensor.rudder-quantum-deg", true),
    ("sensors.clock.jitter", "sensor.jitter-s", false),
    ("sensors.clock.heading_delay", "sensor.heading-delay-s", false),
    ("sensors.drop_out.probability", "sensor.drop-out.probability", false),
    ("sensors.drop_out.bursts.probability", "sensor.drop-out.burst-probability", false),
    ("sensors.drop_out.bursts.mean_rows", "sensor.drop-out.burst-mean-rows", false),
    ("disturbances.wind.moment", "disturbance.wind.moment-deg", true),
    ("disturbances.wind.from", "disturbance.wind.from-deg", true),
    ("disturbances.wind.speed", "disturbance.wind.speed-m-s", false),
    ("disturbances.wind.gusting.sd", "disturbance.wind.gusting.sd", false),
    ("disturbances.wind.gusting.correlation_time", "disturbance.wind.gusting.correlation-s", false),
    ("disturbances.gusts.sd", "disturbance.gusts.sd-deg", true),
    ("disturbances.gusts.correlation_time", "disturbance.gusts.correlation-s", false),
    ("disturbances.drift", "disturbance.drift-deg-per-s", true),
    ("disturbances.random_walk", "disturbance.random-walk-deg-per-root-s", true),
    ("disturbances.squall.moment", "disturbance.squall.moment-deg", true),
    ("disturbances.squall.start", "disturbance.squall.start-s", false),
    ("disturbances.squall.duration", "disturbance.squall.duration-s", false),
    ("disturbances.squall.edge", "disturbance.squall.edge-s", false),
    ("disturbances.waves.sd", "disturbance.waves.sd-deg", true),
    ("disturbances.waves.frequency", "disturbance.waves.frequency-rad-s", false),
    ("disturbances.waves.damping", "disturbance.waves.damping", false),
];

/// Parts of a scenario whose every key may be left out.
const OPTIONAL: [&str; 4] = ["steering-gear.", "helmsman.", "approach.", "sensor."];

/// The problem behind a refused specification.
pub fn problem(error: &SpecificationError, manoeuvre: &ManoeuvreWire, sampling_s: f64) -> Problem {
    let own = match manoeuvre {
        ManoeuvreWire::ZigZag(_) => "zig_zag",
        ManoeuvreWire::TurningCircle(_) => "turning_circle",
        ManoeuvreWire::PullOut(_) => "pull_out",
        ManoeuvreWire::Replay(_) => "replay",
    };
    let name = match error.key.strip_prefix("manoeuvre.") {
        Some(part) => format!("{own}.{part}"),
        None => error.key.to_owned(),
    };
    if name == "vessel.dead_time" {
        return Problem::name(
            KeyPath::dotted("effect"),
            format!("the dead times of all effects add up to {} s", Shown(error.value)),
            format!("expected {}", error.expected),
            "give dead times of 0 s or more: a rudder does not act before it moves",
        );
    }
    let known = KEYS.iter().find(|(specification, ..)| *specification == name);
    let Some(&(_, key, angle)) = known else {
        return Problem::value(KeyPath::dotted("manoeuvre"), error.to_string(), "not accepted", "change the value");
    };
    let unit = if angle { DEGREE } else { 1.0 };
    let found = match error.expected {
        Expected::Duration => format!("`{key}` is missing"),
        _ => format!("`{key}` is {}", shown(error.value / unit)),
    };
    let expected = match error.expected {
        Expected::Finite => "expected a finite number".to_owned(),
        Expected::Positive if error.value.is_finite() => "expected a number above 0".to_owned(),
        Expected::Positive => "expected a finite number above 0".to_owned(),
        Expected::NotNegative if error.value.is_finite() => "expected a number, 0 or above".to_owned(),
        Expected::NotNegative => "expected a finite number, 0 or above".to_owned(),
        Expected::PositiveOrInfinite => "expected a number above 0, or inf for no limit".to_owned(),
        Expected::Between(low, high) => {
            format!("expected a number from {} to {}", shown(low / unit), shown(high / unit))
        }
        Expected::AtMost(limit) => format!("expected at most {}", shown(limit / unit)),
        Expected::Steps { .. } => format!("expected {}", error.expected),
        Expected::Duration => "expected a duration, because nothing else ends the run".to_owned(),
    };
    Problem::value(KeyPath::dotted(key), found, expected, advice(key, error.expected, sampling_s))
}

fn advice(key: &str, expected: Expected, sampling_s: f64) -> String {
    match (key, expected) {
        ("recording.duration-s", Expected::Duration) => {
            "add `duration-s = …` (seconds), or let `executes` end the zig-zag".to_owned()
        }
        (_, Expected::AtMost(limit)) if limit == LONGEST_TIME => "give a time in seconds".to_owned(),
        (_, Expected::AtMost(limit)) if key.ends_with("duration-s") => format!(
            "record less, or more rarely: with `sampling-s` = {sampling_s} that limit is {:.0} rows",
            limit / sampling_s
        ),
        (_, Expected::AtMost(_)) if key.ends_with("rudder-deg") => {
            "give less rudder, or set `steering-gear.maximum-deg` if the rudder of this ship goes further".to_owned()
        }
        ("manoeuvre.zig-zag.executes" | "recording.after-execute", Expected::Steps { .. }) => {
            "wait for fewer executes, each of which counts with the longest wait for it; or end the zig-zag by `duration-s`".to_owned()
        }
        (_, Expected::Steps { .. }) => "make the run shorter".to_owned(),
        ("recording.sampling-s", _) => "give the time between two rows of the record, in seconds".to_owned(),
        ("recording.after-execute", _) => {
            "count the executes from 1, or leave the key out to record from the start".to_owned()
        }
        ("manoeuvre.replay.file", _) => "give a record that lasts longer than an instant".to_owned(),
        _ if OPTIONAL.iter().any(|part| key.starts_with(part)) => "change the value, or leave the key out".to_owned(),
        _ => "change the value".to_owned(),
    }
}

/// A number as it was written: conversion to radians and back must not show.
fn shown(value: f64) -> Shown {
    Shown::rounded(value, 14)
}
