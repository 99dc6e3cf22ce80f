//! Records made of a known hull: what the fit finds again, and what it refuses.

use std::collections::BTreeMap;

use approx::assert_relative_eq;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use ship::angle::from_deg;
use ship::{Dynamics, Input};
use trial::{Channel, Columns, Origin, Trial};

use super::steered::{Helm, steer};
use super::{coefficients, sd};
use crate::motion::{
    HULL_COEFFICIENTS, IdentifiedHull, MotionError, Planar, PlanarCoefficients, Spread, Yaw, fit_hull,
};

const LENGTH: f64 = 7.0;
const SPEED: f64 = 1.2;
const PLANAR: [f64; 8] = [0.066, 1.5, 0.11, 0.2, 0.36, 2.5, 0.42, 0.14];
const YAW: [f64; 6] = [1.6, 2.5, -4.0, 0.4, 0.55, 0.01];

fn hull() -> IdentifiedHull {
    let planar = Planar::new(PlanarCoefficients::from_array(PLANAR), LENGTH, SPEED).expect("a ship");
    IdentifiedHull::new(planar, Yaw::from_array(YAW))
}

/// A zig-zag at 8 Hz with noise in all channels (rad, rad/s, m/s, m/s).
fn record(rudder: f64, change: f64, seed: u64) -> Trial {
    let rate = from_deg(15.0);
    let rows = steer(&hull(), &Helm::ZigZag(from_deg(rudder), from_deg(change)), rate, 120.0);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = |deviation: f64| deviation * Distribution::<f64>::sample(&StandardNormal, &mut random);
    let mut columns = Columns::default();
    for row in &rows {
        columns.time.push(row.time);
        let [heading, yaw_rate, surge, sway] = row.state;
        let mut push = |channel, value| columns.channels.entry(channel).or_default().push(value);
        push(Channel::Rudder, row.rudder);
        push(Channel::Heading, heading + noise(5e-4));
        push(Channel::YawRate, yaw_rate + noise(2e-4));
        push(Channel::Surge, surge + noise(2e-3));
        push(Channel::Sway, sway + noise(2e-3));
    }
    let origin = Origin::Measured { file: "made up".into(), sha256: String::new() };
    Trial::new(format!("{rudder}/{change}"), origin, columns).expect("a record")
}

fn zig_zags() -> Vec<Trial> {
    [(10.0, 10.0, 1), (-20.0, 20.0, 2), (20.0, 10.0, 3), (-35.0, 10.0, 4)]
        .map(|(rudder, change, seed)| record(rudder, change, seed))
        .into()
}

/// A record with its channels changed.
fn changed(trial: &Trial, change: impl Fn(Channel, &[f64]) -> Vec<f64>) -> Trial {
    let mut channels: BTreeMap<_, _> =
        trial.channels().map(|(channel, values)| (channel, change(channel, values))).collect();
    channels.insert(Channel::Rudder, change(Channel::Rudder, trial.rudder()));
    let columns = Columns { time: trial.time().to_vec(), channels, unknown: Vec::new() };
    Trial::new("changed", trial.origin().clone(), columns).expect("a record")
}

#[test]
fn zig_zags_give_all_coefficients_back() {
    let found = fit_hull(&zig_zags(), LENGTH).expect("a fit");
    assert_eq!((found.spread, found.records.len()), (Spread::Records, 4));
    for (i, ((symbol, value), (_, truth))) in coefficients(&found).into_iter().zip(coefficients(&hull())).enumerate() {
        let deviation = sd(&found.covariance, i);
        assert!((value - truth).abs() < 0.05 * truth.abs().max(0.05), "{symbol}: {value} {truth}");
        assert!(deviation < 0.05 * truth.abs().max(0.1), "{symbol}: ± {deviation}");
    }
    // Nothing random was put in but the noise of the readings.
    println!("{:?} {:?}", found.moment, found.records);
    assert!(found.moment.deviation < from_deg(0.5), "{:?}", found.moment);
    let text = serde_json::to_string(&found).expect("text");
    assert_eq!(serde_json::from_str::<IdentifiedHull>(&text).expect("the same"), found);
}

#[test]
fn few_records_and_no_yaw_rate_are_enough() {
    let trials: Vec<Trial> = zig_zags()[1..3].iter().map(|trial| trial.clone().without(&[Channel::YawRate])).collect();
    let found = fit_hull(&trials, LENGTH).expect("a fit");
    assert_eq!(found.spread, Spread::Scores);
    for ((symbol, value), (_, truth)) in coefficients(&found).into_iter().zip(coefficients(&hull())) {
        assert!((value - truth).abs() < 0.25 * truth.abs().max(0.05), "{symbol}: {value} {truth}");
    }
    assert!((0..HULL_COEFFICIENTS).all(|i| sd(&found.covariance, i) > 0.0), "{:?}", found.covariance);
}

/// All but the moment of the propeller, which changes its side.
#[test]
fn the_mirrored_records_give_the_mirrored_hull() {
    let ahead = [Channel::Surge, Channel::Speed, Channel::North];
    let mirrored = |channel: Channel, values: &[f64]| {
        let side = if ahead.contains(&channel) { 1.0 } else { -1.0 };
        values.iter().map(|value| side * value).collect()
    };
    let trials = &zig_zags()[1..3];
    let other: Vec<Trial> = trials.iter().map(|trial| changed(trial, mirrored)).collect();
    let (one, other) = (fit_hull(trials, LENGTH).expect("a fit"), fit_hull(&other, LENGTH).expect("a fit"));
    for ((symbol, one), (_, other)) in coefficients(&one).into_iter().zip(coefficients(&other)) {
        let side = if symbol == "N_0" { -1.0 } else { 1.0 };
        assert_relative_eq!(one, side * other, max_relative = 1e-4);
    }
}

#[test]
fn a_hull_at_the_same_froude_number_moves_alike() {
    let ratio: f64 = 320.0 / LENGTH;
    let (model, time) = (hull(), f64::sqrt(ratio));
    let ship = model.scaled_to(320.0, SPEED * time).expect("a ship");
    let state = [0.3, 0.05, 0.9, -0.2];
    let of = |hull: &IdentifiedHull, state: [f64; 4]| {
        let mut rate = [0.0; 4];
        hull.rates(0.0, &state, &Input { rudder: 0.3, disturbance: 0.02, ..Input::default() }, &mut rate);
        rate
    };
    let small = of(&model, state);
    let large = of(&ship, [state[0], state[1] / time, state[2] * time, state[3] * time]);
    for (small, large) in small.iter().zip([large[0] * time, large[1] * ratio, large[2], large[3]]) {
        assert_relative_eq!(*small, large, max_relative = 1e-12);
    }
    assert_relative_eq!(ship.largest_step(), model.largest_step() * time, max_relative = 1e-12);
    let random =
        IdentifiedHull { moment: crate::motion::RandomYawMoment { deviation: 0.01, correlation_time: 2.0 }, ..model };
    let random = random.scaled_to(320.0, SPEED * time).expect("a ship").moment;
    assert_relative_eq!(random.correlation_time, 2.0 * time, max_relative = 1e-12);
}

#[test]
fn a_hull_that_is_steered_shows_its_motion() {
    let (ship, mut state) = (hull(), [f64::NAN; 4]);
    ship.approach(0.2, 0.01, &mut state);
    assert_eq!(state, [0.2, 0.01, SPEED, 0.0]);
    let state = [0.2, 0.01, 0.9, -0.3];
    let with = |disturbance| Input { rudder: 0.1, disturbance, ..Input::default() };
    let (still, disturbed) = (ship.motion(0.0, &state, &with(0.0)), ship.motion(0.0, &state, &with(0.1)));
    assert_eq!(
        (still.heading, still.yaw_rate, still.speed, still.sway),
        (0.2, 0.01, Some(0.9f64.hypot(-0.3)), Some(-0.3))
    );
    let expected = ship.yaw_acceleration(0.9, -0.3, 0.01, 0.2, 0.0);
    assert_relative_eq!(disturbed.yaw_acceleration, expected, max_relative = 1e-12);
}

#[test]
fn records_that_do_not_tell_yaw_are_refused() {
    let trials = zig_zags();
    let without = |channel| trials.iter().map(|trial| trial.clone().without(&[channel])).collect::<Vec<_>>();
    for channel in [Channel::Surge, Channel::Sway] {
        assert_eq!(fit_hull(&without(channel), LENGTH), Err(MotionError::NoDrift { records: 4 }));
    }
    assert_eq!(fit_hull(&[], LENGTH), Err(MotionError::NoDrift { records: 0 }));
    for length in [0.0, -7.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(fit_hull(&trials, length), Err(MotionError::NotPositive { quantity: "length", .. })));
    }
    let fixed = |channel: Channel, values: &[f64]| match channel {
        Channel::Rudder => vec![0.0; values.len()],
        _ => values.to_vec(),
    };
    let found = fit_hull(&[changed(&trials[1], fixed)], LENGTH);
    assert!(matches!(found, Err(MotionError::Undetermined { .. })), "{found:?}");
    let wild = |channel: Channel, values: &[f64]| match channel {
        Channel::YawRate => vec![1e300; values.len()],
        _ => values.to_vec(),
    };
    assert!(fit_hull(&[changed(&trials[1], wild)], LENGTH).is_err());
}

#[test]
fn numbers_that_are_no_hull_are_refused() {
    let known = hull();
    let mut step = [0.0; HULL_COEFFICIENTS];
    assert_eq!(known.stepped(&step), known);
    step[8] = -10.0;
    assert_eq!(known.stepped(&step).yaw.N_r, 1e-3);
    assert!(matches!(known.scaled_to(7.0, 0.0), Err(MotionError::NotPositive { .. })));
}
