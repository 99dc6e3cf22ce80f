//! Records made of known coefficients: what the fit finds again, and what it refuses.

use approx::assert_relative_eq;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use ship::angle::from_deg;
use ship::effects::SpeedLoss;
use ship::replay::{Recorded, replay_states};
use ship::{Dynamics, FirstOrder, Particulars, Polyline, Response, ResponseModel};
use std::sync::Arc;
use trial::{Channel, Columns, Origin, Trial};

use super::{changed, mirrored, sd};
use crate::identified_ship::IdentifiedShip;
use crate::motion::planar::pooled;
use crate::motion::{
    COEFFICIENTS, MotionError, MotionOutput, Planar, PlanarCoefficients, PlanarShip, SYMBOLS, fit, track,
};
use crate::testing;

const LENGTH: f64 = 7.0;
const SPEED: f64 = 1.2;
const TRUTH: [f64; COEFFICIENTS] = [0.066, 1.5, 0.11, 0.2, 0.36, 2.5, 0.42, 0.14];

fn planar() -> Planar {
    Planar::new(PlanarCoefficients::from_array(TRUTH), LENGTH, SPEED).expect("a ship")
}

fn ship() -> PlanarShip {
    let response = Response::first_order_ship(FirstOrder { inverse_T: 0.1, K_over_T: 0.015, rudder_bias: 0.0 });
    PlanarShip { response, planar: planar() }
}

/// Rudder angles that follow one another from 3 s on, each for some time; 15°/s between them.
fn rudder(first: f64, angle: f64, hold: f64, holds: usize, end: f64) -> Polyline {
    let (mut time, mut value) = (vec![0.0, 3.0], vec![0.0, 0.0]);
    let mut now = 3.0;
    for index in 0..holds {
        let next = if index % 2 == 0 { first * from_deg(angle) } else { -first * from_deg(angle) };
        time.push(now + (next - value[value.len() - 1]).abs().max(0.01) / from_deg(15.0));
        value.push(next);
        now += hold;
        if index + 1 < holds {
            time.push(now);
            value.push(next);
        }
    }
    time.push(end);
    value.push(value[value.len() - 1]);
    Polyline::new(time, value).expect("a rudder")
}

/// Standard deviations: yaw rate rad/s, heading rad, velocity m/s, position m.
const NOISE: [f64; 4] = [2e-4, 5e-4, 5e-3, 0.02];

/// A record at 5 Hz with all channels, in a current.
fn record(name: &str, rudder: &Polyline, current: [f64; 2], noise: [f64; 4], seed: u64) -> Trial {
    let ship = ship();
    let end = rudder.times()[rudder.times().len() - 1];
    let time: Vec<f64> = (0..).map(|row| 0.2 * f64::from(row)).take_while(|t| *t <= end).collect();
    let mut state = vec![0.0; ship.dimension()];
    ship.approach(0.3, 0.0, &mut state);
    let mut columns: [Vec<f64>; 4] = Default::default();
    let step = ship.largest_step();
    let record = |_: usize, state: &[f64], _: &ship::Input| {
        columns.iter_mut().zip(state).for_each(|(column, value)| column.push(*value));
    };
    replay_states(&ship, &Recorded::rudder(rudder), &time, |_, _| step, &mut state, record);
    let [heading, rate, surge, sway] = columns;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = |values: Vec<f64>, deviation: f64| -> Vec<f64> {
        values
            .into_iter()
            .map(|value| value + deviation * Distribution::<f64>::sample(&StandardNormal, &mut random))
            .collect()
    };
    let velocity: Vec<[f64; 2]> = surge.iter().zip(&sway).map(|(u, v)| [*u, *v]).collect();
    let path = track(&time, &heading, &velocity);
    let along = |axis: usize| path.iter().zip(&time).map(|(p, t)| 50.0 + p[axis] + current[axis] * t).collect();
    let channels = [
        (Channel::Rudder, time.iter().map(|t| rudder.at(*t)).collect()),
        (Channel::North, noisy(along(0), noise[3])),
        (Channel::East, noisy(along(1), noise[3])),
        (Channel::Speed, noisy(surge.iter().zip(&sway).map(|(u, v)| u.hypot(*v)).collect(), noise[2])),
        (Channel::YawRate, noisy(rate, noise[0])),
        (Channel::Heading, noisy(heading, noise[1])),
        (Channel::Surge, noisy(surge, noise[2])),
        (Channel::Sway, noisy(sway, noise[2])),
    ];
    let origin = Origin::Measured { file: name.into(), sha256: String::new() };
    Trial::new(name, origin, Columns { time, channels: channels.into(), unknown: Vec::new() }).expect("a record")
}

const VELOCITIES: [Channel; 3] = [Channel::Surge, Channel::Sway, Channel::Speed];
const POSITIONS: [Channel; 2] = [Channel::North, Channel::East];

fn zig_zags(side: f64) -> Vec<Trial> {
    let made = |angle: f64, hold: f64, holds: usize, seed: u64| {
        let rudder = rudder(side, angle, hold, holds, 3.0 + hold * holds as f64);
        record("zig-zag", &rudder, [0.0; 2], NOISE, seed)
    };
    vec![made(10.0, 18.0, 5, 1), made(20.0, 16.0, 8, 2), made(35.0, 12.0, 10, 3)]
}

/// 720° and more, and the pull-out after it.
fn circles(current: [f64; 2]) -> Vec<Trial> {
    [(35.0, 1.0, 220.0, 4), (-20.0, 1.0, 330.0, 5), (35.0, -1.0, 200.0, 6)]
        .map(|(angle, side, end, seed)| record("circle", &rudder(side, angle, 400.0, 1, end), current, NOISE, seed))
        .into()
}

fn assert_found(planar: &Planar, most: f64) {
    for (i, (found, symbol)) in planar.coefficients.to_array().into_iter().zip(SYMBOLS).enumerate() {
        let deviation = sd(&planar.covariance, i);
        assert!((found - TRUTH[i]).abs() < 3.0 * deviation, "{symbol}: {found} ± {deviation}");
        assert!(deviation < most * TRUTH[i], "{symbol}: {found} ± {deviation}");
    }
}

fn rms(planar: &Planar, output: MotionOutput) -> Option<f64> {
    pooled(&planar.records, output)
}

#[test]
fn surge_and_sway_give_the_coefficients_back() {
    let planar = fit(&zig_zags(1.0), LENGTH).expect("a fit");
    assert_found(&planar, 0.1);
    assert_relative_eq!(rms(&planar, MotionOutput::Surge).expect("surge"), NOISE[2], max_relative = 0.05);
    assert_relative_eq!(rms(&planar, MotionOutput::Sway).expect("sway"), NOISE[2], max_relative = 0.05);
    assert_eq!((rms(&planar, MotionOutput::Speed), rms(&planar, MotionOutput::Position)), (None, None));
    assert_eq!(planar.records.len(), 3);
    let text = serde_json::to_string(&planar).expect("text");
    assert_eq!(serde_json::from_str::<Planar>(&text).expect("the same"), planar);
}

#[test]
fn speed_alone_beside_positions_is_enough() {
    let trials: Vec<Trial> =
        zig_zags(1.0).iter().map(|t| t.clone().without(&[Channel::Surge, Channel::Sway])).collect();
    let planar = fit(&trials, LENGTH).expect("a fit");
    assert_found(&planar, 0.3);
    assert!(rms(&planar, MotionOutput::Speed).is_some() && rms(&planar, MotionOutput::Position).is_some());
    assert!(planar.records.iter().all(|record| record.current.is_none()));
}

/// √(u² + v²) is the same with more surge and less sway.
#[test]
fn speed_alone_does_not_tell_drift() {
    let only = |kept: &[Channel]| -> Planar {
        let left_out: Vec<Channel> =
            VELOCITIES.into_iter().chain(POSITIONS).filter(|channel| !kept.contains(channel)).collect();
        let trials: Vec<Trial> = zig_zags(1.0).into_iter().map(|trial| trial.without(&left_out)).collect();
        fit(&trials, LENGTH).expect("a fit")
    };
    let speed = only(&[Channel::Speed]);
    assert!(!speed.tells_drift());
    assert!(only(&POSITIONS).tells_drift() && only(&[Channel::Surge, Channel::Sway]).tells_drift());
    let known = IdentifiedShip { motion: Some(speed), ..testing::known() };
    let kind = "turning-circle:35".parse().expect("known");
    let turn = testing::mixture(known).predict(&kind, 20, false).expect("a turn");
    let names: Vec<&str> = turn.figures.keys().map(String::as_str).collect();
    assert_eq!(names, ["time_to_90_s", "time_to_180_s", "steady_rate_deg_s", "speed_loss_share"]);
    assert!(turn.curves.tracks.is_empty() && turn.curves.most_probable.expect("sails").track().is_none());
}

/// Coefficients that are hardly known: of the sizes of the circle those below zero are left out and named.
#[test]
fn a_size_whose_interval_reaches_below_zero_is_left_out() {
    let mut doubtful = planar();
    for (place, value) in TRUTH.into_iter().enumerate() {
        doubtful.covariance[place][place] = (20.0 * value).powi(2);
    }
    let known = IdentifiedShip { motion: Some(doubtful), ..testing::known() };
    let kind = "turning-circle:35".parse().expect("known");
    let turn = testing::mixture(known).predict(&kind, 100, false).expect("a turn");
    let [left_out, kept]: [Vec<&str>; 2] = [
        turn.undetermined.iter().map(|(name, _)| name.as_str()).collect(),
        turn.figures.keys().map(String::as_str).collect(),
    ];
    assert!(left_out.contains(&"transfer_m") && !kept.contains(&"transfer_m"), "{left_out:?} {kept:?}");
    assert!(turn.undetermined.iter().all(|(_, interval)| interval.ci90[0] <= 0.0));
}

#[test]
fn positions_alone_are_enough_with_and_without_a_current() {
    for current in [[0.0, 0.0], [0.08, -0.05]] {
        let mut trials: Vec<Trial> = circles(current).iter().map(|t| t.clone().without(&VELOCITIES)).collect();
        if current == [0.0; 2] {
            trials.extend(zig_zags(1.0).iter().map(|t| t.clone().without(&VELOCITIES)));
        }
        let planar = fit(&trials, LENGTH).expect("a fit");
        println!("current {current:?}: U0 {} {:?}", planar.approach_speed, planar.records[0]);
        assert_found(&planar, 1.0);
        for found in &planar.records[..3] {
            let found = found.current.expect("a current");
            assert!((0..2).all(|axis| (found[axis] - current[axis]).abs() < 2e-3), "{found:?}");
        }
        assert_relative_eq!(rms(&planar, MotionOutput::Position).expect("positions"), NOISE[3], max_relative = 0.1);
    }
}

#[test]
fn a_yaw_rate_that_is_missing_is_the_slope_of_the_heading() {
    let without = |trial: &Trial| trial.clone().without(&[Channel::YawRate]);
    let planar = fit(&zig_zags(1.0).iter().map(without).collect::<Vec<_>>(), LENGTH).expect("a fit");
    for (found, truth) in planar.coefficients.to_array().into_iter().zip(TRUTH) {
        assert_relative_eq!(found, truth, max_relative = 0.1);
    }
}

#[test]
fn missing_rows_do_no_harm() {
    let gaps = |trial: &Trial| {
        changed(trial, |channel, values| {
            let is_missing = |row: usize| channel != Channel::Rudder && row >= 11 && (row - 11).is_multiple_of(3);
            values.iter().enumerate().map(|(row, value)| if is_missing(row) { f64::NAN } else { *value }).collect()
        })
    };
    assert_found(&fit(&zig_zags(1.0).iter().map(gaps).collect::<Vec<_>>(), LENGTH).expect("a fit"), 0.1);
}

#[test]
fn the_mirrored_records_give_the_mirrored_answer() {
    let trials = zig_zags(1.0);
    let (one, other) = (fit(&trials, LENGTH), fit(&trials.iter().map(mirrored).collect::<Vec<_>>(), LENGTH));
    let (one, other) = (one.expect("a fit"), other.expect("a fit"));
    for (one, other) in one.coefficients.to_array().into_iter().zip(other.coefficients.to_array()) {
        assert_relative_eq!(one, other, max_relative = 1e-9);
    }
    assert_relative_eq!(one.records[0].start[1], -other.records[0].start[1], max_relative = 1e-9);
}

#[test]
fn a_ship_at_the_same_froude_number_has_the_track_times_the_ratio_of_lengths() {
    let trial = &zig_zags(1.0)[2];
    let ratio = 320.0 / LENGTH;
    let model = planar();
    let ship = model.scaled_to(320.0, SPEED * f64::sqrt(ratio)).expect("a ship");
    let of = |planar: &Planar, scale: f64| {
        let time: Vec<f64> = trial.time().iter().map(|t| t * f64::sqrt(scale)).collect();
        let rate: Vec<f64> = trial.yaw_rate().expect("a rate").iter().map(|r| r / f64::sqrt(scale)).collect();
        let found = planar.drive(&time, &rate, trial.rudder(), [planar.approach_speed, 0.0]);
        track(&time, trial.heading(), &found)
    };
    for (small, large) in of(&model, 1.0).iter().zip(of(&ship, ratio)) {
        for axis in 0..2 {
            assert_relative_eq!(small[axis] * ratio, large[axis], max_relative = 1e-6, epsilon = 1e-6);
        }
    }
}

/// A turn of many circles ends in one state, below the approach speed, whatever the rudder.
#[test]
fn no_rudder_makes_the_ship_faster() {
    for rate in [0.005, 0.02, 0.05] {
        for rudder in [-0.6, -0.2, 0.0, 0.2, 0.6] {
            let rows = 2000;
            let time: Vec<f64> = (0..rows).map(f64::from).collect();
            let found = planar().drive(&time, &vec![rate; time.len()], &vec![rudder; time.len()], [SPEED, 0.0]);
            assert!(found.iter().all(|[u, v]| u.hypot(*v) <= 1.02 * SPEED), "r {rate} rudder {rudder}");
            let [last, before] = [found[rows as usize - 1], found[rows as usize - 2]];
            assert!((last[0] - before[0]).abs() < 1e-9 && last[0] > 0.0, "{last:?}");
        }
    }
}

#[test]
fn a_response_sees_the_speed_of_its_ship() {
    let rudder = rudder(1.0, 35.0, 400.0, 1, 200.0);
    let model = ResponseModel::new(vec![Arc::new(SpeedLoss::Measured { approach_speed: SPEED })]);
    let steered = |exponents: [f64; 2]| {
        let response = model.clone().with(vec![0.1, 0.015, 0.0, exponents[0], exponents[1]]);
        let ship = PlanarShip { response, planar: planar() };
        let mut state = vec![f64::NAN; ship.dimension()];
        ship.approach(0.0, 0.0, &mut state);
        assert_eq!(state[state.len() - 2..], [SPEED, 0.0]);
        let step = ship.largest_step();
        let mut last = None;
        ship::replay::replay(&ship, &Recorded::rudder(&rudder), &[0.0, 200.0], step, &mut state, |_, motion| {
            last = Some(*motion);
        });
        let (motion, [u, v]) = (last.expect("a motion"), [state[state.len() - 2], state[state.len() - 1]]);
        assert_eq!((motion.speed, motion.sway), (Some(u.hypot(v)), Some(v)));
        (motion.yaw_rate, u.hypot(v) / SPEED)
    };
    // Steady: r = K δ q^(m_b − m_a).
    let (plain, _) = steered([1.0, 1.0]);
    let (slowed, ratio) = steered([1.0, 2.0]);
    assert_relative_eq!(plain, 0.15 * from_deg(35.0), max_relative = 5e-3);
    assert!(ratio < 0.8);
    assert_relative_eq!(slowed, plain * ratio, max_relative = 5e-3);
}

#[test]
fn states_steps_and_memory_of_the_response_are_passed_on() {
    use ship::effects::{Backlash, SteeringLag};
    // Dead time, play of the rudder, and nothing that asks for speed: the response alone turns in the same way.
    let model = ResponseModel::new(vec![Arc::new(SteeringLag::DeadTime), Arc::new(Backlash)]);
    let response = model.with(vec![0.1, 0.015, 0.01, 1.3, 0.05]);
    let ship = PlanarShip { response: response.clone(), planar: planar() };
    assert_eq!((ship.dimension(), ship.dead_time()), (response.dimension() + 2, 1.3));
    assert!(ship.largest_step() <= response.largest_step());
    let (rudder, times) = (rudder(1.0, 20.0, 16.0, 6, 99.0), [0.0, 30.0, 60.0, 99.0]);
    let headings = |dynamics: &dyn Dynamics| {
        let mut state = vec![0.0; dynamics.dimension()];
        dynamics.approach(0.0, 0.0, &mut state);
        let mut headings = Vec::new();
        ship::replay::replay(dynamics, &Recorded::rudder(&rudder), &times, 0.05, &mut state, |_, motion| {
            headings.push(motion.heading);
        });
        headings
    };
    assert_eq!(headings(&ship), headings(&response));
}

#[test]
fn records_that_tell_nothing_are_refused() {
    let trials = zig_zags(1.0);
    let bare = |trial: &Trial| trial.clone().without(&[&VELOCITIES[..], &POSITIONS[..]].concat());
    let bare: Vec<Trial> = trials.iter().map(bare).collect();
    assert_eq!(fit(&bare, LENGTH), Err(MotionError::NoOutput { records: 3 }));
    assert_eq!(fit(&[], LENGTH), Err(MotionError::NoOutput { records: 0 }));
    for length in [0.0, -7.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(fit(&trials, length), Err(MotionError::NotPositive { quantity: "length", .. })));
    }
    let straight = record("straight", &rudder(1.0, 0.0, 100.0, 1, 100.0), [0.0; 2], NOISE, 9);
    assert!(matches!(fit(&[straight], LENGTH), Err(MotionError::NotExcited { .. })));
    // A record with other rows keeps those without any output from doing harm.
    let mixed = [bare[0].clone(), trials[1].clone(), trials[2].clone()];
    assert_eq!(fit(&mixed, LENGTH).expect("a fit").records.len(), 2);
}

/// A record with one value in a whole channel.
fn replaced(trial: &Trial, channel: Channel, value: f64) -> Trial {
    changed(trial, |own, values| if own == channel { vec![value; values.len()] } else { values.to_vec() })
}

#[test]
fn a_rudder_that_never_moves_leaves_its_coefficients_open() {
    let trial = replaced(&zig_zags(1.0)[1], Channel::Rudder, 0.0);
    let found = fit(&[trial], LENGTH);
    assert!(matches!(found, Err(MotionError::Undetermined { symbol: "X_dd" | "X_dv" | "Y_d" })), "{found:?}");
}

#[test]
fn readings_beyond_all_sense_are_an_error() {
    for (channel, value) in [(Channel::Surge, 1e300), (Channel::Sway, -1e200), (Channel::YawRate, 1e300)] {
        let trial = replaced(&zig_zags(1.0)[1], channel, value);
        assert!(fit(&[trial], LENGTH).is_err(), "{channel:?}");
    }
}

#[test]
fn a_declared_speed_stands_where_no_approach_is_recorded() {
    let declared = Particulars { length: LENGTH, speed: SPEED };
    let late = |trial: &Trial| {
        let cut = |values: &[f64]| values[15..].to_vec();
        let mut channels: std::collections::BTreeMap<_, _> =
            trial.channels().map(|(channel, values)| (channel, cut(values))).collect();
        channels.insert(Channel::Rudder, cut(trial.rudder()));
        let columns = Columns { time: cut(trial.time()), channels, unknown: Vec::new() };
        Trial::new("late", trial.origin().clone(), columns).expect("a record").with_particulars(declared)
    };
    let trials = zig_zags(1.0);
    let found = fit(&trials.iter().map(late).collect::<Vec<_>>(), LENGTH).expect("a fit");
    assert_relative_eq!(found.approach_speed, declared.speed, max_relative = 0.01);
    assert_found(&found, 0.2);
}

#[test]
fn a_record_at_rest_has_no_approach_speed() {
    let trial = &zig_zags(1.0)[0];
    let trial = replaced(trial, Channel::Surge, 0.0);
    assert_eq!(
        fit(std::slice::from_ref(&trial), LENGTH),
        Err(MotionError::NoApproachSpeed { record: "changed".into() })
    );
}

#[test]
fn numbers_that_are_no_ship_are_refused() {
    let known = planar();
    assert_eq!(known.stepped(&[0.0, 0.0, 0.0, -1.0]).coefficients.X_dv, 0.0);
    assert_eq!(known.stepped(&[0.1]).coefficients.X_0, TRUTH[0] + 0.1);
    assert_eq!(known.stepped(&[]), known);
    assert!(matches!(known.scaled_to(7.0, 0.0), Err(MotionError::NotPositive { quantity: "approach speed", .. })));
}
