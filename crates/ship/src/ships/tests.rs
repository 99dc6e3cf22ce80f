//! Test suite over every ship, and numbers of single ships against an independent computation.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use approx::assert_relative_eq;

use super::*;
use crate::dynamics::{Motion, ShipInput};
use crate::linear::PrimeSwayYawMatrices;
use crate::replay::{RecordedSignals, replay};
use crate::signal::Polyline;
use crate::vessel::mmg::{BySign, Mmg};
use crate::vessel::{Hull, state};

fn every_finite(state: &[f64]) -> bool {
    state.iter().all(|x| x.is_finite())
}

/// State and motion after `duration` seconds from the approach on, with the rudder put over to `delta_deg` at
/// 2.32 deg/s.
fn held_rudder(dynamics: &dyn Dynamics, delta_deg: f64, duration: f64, largest_step: f64) -> (Vec<f64>, Motion) {
    let ramp = (delta_deg.abs() / 2.32).max(0.1);
    let rudder = Polyline::new(vec![0.0, ramp], vec![0.0, delta_deg.to_radians()]).expect("a ramp");
    let mut state = vec![0.0; dynamics.dimension()];
    dynamics.approach(0.0, 0.0, &mut state);
    let mut end = Motion::default();
    replay(
        dynamics,
        &RecordedSignals::from_rudder(&rudder),
        &[0.0, duration],
        largest_step,
        &mut state,
        |_, motion| end = *motion,
    );
    (state, end)
}

fn turning_rate_deg(ship: &Ship, delta_deg: f64) -> f64 {
    let dynamics = ship.dynamics();
    held_rudder(dynamics.as_ref(), delta_deg, 3000.0, dynamics.largest_step()).1.yaw_rate.to_degrees()
}

// --- every ship ----------------------------------------------------------------------------------------------------

#[test]
fn identifiers_are_unique_and_found() {
    let ids: BTreeSet<_> = all_ships().iter().map(|ship| ship.id.clone()).collect();
    assert_eq!(ids.len(), all_ships().len());
    for id in ids {
        assert_eq!(find_ship(&id).expect("listed").id, id);
    }
    assert!(find_ship("titanic").is_none());
}

#[test]
fn particulars_and_steering_gear_are_positive() {
    for ship in all_ships() {
        let particulars = ship.particulars.map(|p| [p.length, p.speed]);
        for value in particulars.iter().flatten().chain(&ship.rudder_rate).chain(&ship.largest_rudder) {
            assert!(value.is_finite() && *value > 0.0, "{}: {value}", ship.id);
        }
        assert!(ship.largest_rudder.is_none_or(|delta| delta < 0.5 * PI), "{}", ship.id);
        assert!(!ship.name.is_empty() && !ship.source.is_empty());
    }
}

#[test]
fn a_straight_approach_stays_finite_and_a_rudder_turns_to_its_own_side() {
    for ship in all_ships() {
        let dynamics = ship.dynamics();
        let (state, motion) = held_rudder(dynamics.as_ref(), 0.0, 600.0, dynamics.largest_step());
        assert!(every_finite(&state), "{}", ship.id);
        assert!(motion.speed.is_none_or(|speed| speed > 0.0), "{}", ship.id);
        for delta_deg in [35.0, 10.0, -10.0, -35.0] {
            let (state, motion) = held_rudder(dynamics.as_ref(), delta_deg, 600.0, dynamics.largest_step());
            assert!(every_finite(&state), "{} at {delta_deg}°", ship.id);
            assert!(motion.yaw_rate * delta_deg > 0.0, "{} at {delta_deg}°: r = {}", ship.id, motion.yaw_rate);
            if let (Some(kept), Some(approach)) = (motion.speed, ship.particulars) {
                assert!(kept > approach.speed / 4.0, "{} at {delta_deg}° slows to {kept} m/s", ship.id);
            }
        }
    }
}

/// Accelerations at standstill, in drift and astern: they stay finite, because a search may visit any state.
#[test]
fn rates_are_finite_wherever_the_state_is() {
    for ship in all_ships() {
        let dynamics = ship.dynamics();
        let mut straight = vec![0.0; dynamics.dimension()];
        dynamics.approach(1.0, 0.0, &mut straight);
        let mut rate = straight.clone();
        for delta_deg in [-35.0_f64, 0.0, 35.0] {
            let input = ShipInput { rudder: delta_deg.to_radians(), disturbance_rudder: 0.02, ..ShipInput::default() };
            for yaw_rate in [-0.05, 0.0, 0.05] {
                for share in [-0.5, 0.0, 1e-9, 0.05, 0.5, 1.0, 1.5] {
                    for sway in [-1.0, 0.0, 1.0] {
                        let mut state = straight.clone();
                        state[state::YAW_RATE] = yaw_rate;
                        if matches!(ship.model, ShipModel::Hull(_)) {
                            state[state::SURGE] *= share;
                            state[state::SWAY] = sway * share;
                        }
                        dynamics.rates(0.0, &state, &input, &mut rate);
                        assert!(every_finite(&rate), "{} at {state:?}, {delta_deg}°: {rate:?}", ship.id);
                        let seen = dynamics.motion(0.0, &state, &input);
                        assert_eq!(seen.yaw_acceleration, rate[state::YAW_RATE], "{}", ship.id);
                    }
                }
            }
        }
    }
}

/// Disturbance as equivalent rudder: at the first instant it gives the yaw acceleration of its moment, with the sign of
/// the rudder. (A rudder also causes a sway force, so for a hull only the larger part of its acceleration remains.)
#[test]
fn a_disturbance_acts_like_the_rudder_it_is_equivalent_to() {
    for ship in all_ships() {
        let dynamics = ship.dynamics();
        let mut state = vec![0.0; dynamics.dimension()];
        dynamics.approach(0.0, 0.0, &mut state);
        let angle = 0.01;
        let acceleration = |input: ShipInput| dynamics.motion(0.0, &state, &input).yaw_acceleration;
        let still = acceleration(ShipInput::default());
        let by_rudder = acceleration(ShipInput { rudder: angle, ..ShipInput::default() }) - still;
        let by_disturbance = acceleration(ShipInput { disturbance_rudder: angle, ..ShipInput::default() }) - still;
        match ship.model {
            ShipModel::Hull(_) => {
                let share = by_disturbance / by_rudder;
                assert!((0.8..1.25).contains(&share), "{}: {share}", ship.id);
            }
            // T3 is a direct path from the rudder, not from the disturbance, to the yaw acceleration.
            ShipModel::Response(_) => assert!(by_disturbance >= 0.0 && by_rudder > 0.0, "{}", ship.id),
        }
    }
}

/// Heading, rad, after five reversals of a 20° rudder, four ship lengths apart: inflow angles change sign many times.
fn heading_after_reversals(dynamics: &dyn Dynamics, unit: f64, largest_step: f64) -> f64 {
    let mut corners = (vec![0.0], vec![0.0]);
    for k in 0..6 {
        let (start, side) = (4.0 * unit * f64::from(k), if k % 2 == 0 { 20f64 } else { -20.0 });
        corners.0.extend([start + unit, start + 3.9 * unit]);
        corners.1.extend([side.to_radians(); 2]);
    }
    let rudder = Polyline::new(corners.0, corners.1).expect("increasing times");
    let mut state = vec![0.0; dynamics.dimension()];
    dynamics.approach(0.0, 0.0, &mut state);
    let mut heading = 0.0;
    let times = [0.0, 24.0 * unit];
    replay(dynamics, &RecordedSignals::from_rudder(&rudder), &times, largest_step, &mut state, |_, motion| {
        heading = motion.heading
    });
    heading
}

/// Change of the final heading with an eighth of the maximum step: less than 0.0001°.
#[test]
fn the_largest_step_is_small_enough() {
    for ship in all_ships() {
        let dynamics = ship.dynamics();
        let unit = ship.particulars.map_or(10.0, |p| p.length / p.speed);
        let step = dynamics.largest_step();
        let coarse = heading_after_reversals(dynamics.as_ref(), unit, step);
        let fine = heading_after_reversals(dynamics.as_ref(), unit, 0.125 * step);
        let difference = (coarse - fine).to_degrees();
        assert!(difference.abs() < 1e-4, "{}: {difference}° with {step} s", ship.id);
    }
}

// --- single ships --------------------------------------------------------------------------------------------------

/// Linear equations of a hull against central differences of its accelerations on the straight approach.
#[test]
fn linear_equations_are_the_slopes_of_the_hull() {
    let mut tanker = kvlcc2::FULL_SCALE;
    tanker.rudder.gammaR = BySign { positive: 0.5, negative: 0.5 };
    let tanker = Mmg::at_speed(tanker, 8.0).expect("balances");
    let cargo_ship = mariner::hull_model();
    let hulls: [(&dyn Hull, PrimeSwayYawMatrices); 2] =
        [(&tanker, tanker.linearised()), (&cargo_ship, cargo_ship.linearised())];
    for (hull, PrimeSwayYawMatrices { M, N, b }) in hulls {
        let Particulars { length: L, speed: U } = hull.particulars();
        let at = |v: f64, r: f64, rudder: f64| {
            let velocity = [U, v * U, r * U / L];
            let [_, sway, yaw] = hull.acceleration(velocity, &ShipInput { rudder, ..ShipInput::default() });
            [sway * L / (U * U), yaw * L * L / (U * U)]
        };
        let e = 1e-5;
        let slope = |v: f64, r: f64, d: f64| {
            let (plus, minus) = (at(v * e, r * e, d * e), at(-v * e, -r * e, -d * e));
            [(plus[0] - minus[0]) / (2.0 * e), (plus[1] - minus[1]) / (2.0 * e)]
        };
        for ([dv, dr], expected) in [
            (slope(1.0, 0.0, 0.0), [-N[0][0], -N[1][0]]),
            (slope(0.0, 1.0, 0.0), [-N[0][1], -N[1][1]]),
            (slope(0.0, 0.0, 1.0), b),
        ] {
            assert_relative_eq!(M[0][0] * dv + M[0][1] * dr, expected[0], max_relative = 1e-5);
            assert_relative_eq!(M[1][0] * dv + M[1][1] * dr, expected[1], max_relative = 1e-5);
        }
    }
}

/// Revolutions and speed of an independent implementation, in pairs; tolerance: one unit of the last digit (a knot of
/// 0.5144 m/s instead of 1852 m an hour changes the fourth digit).
#[test]
fn revolutions_and_speed_of_the_straight_approach_agree() {
    for (parameters, speed_kn, revolutions) in
        [(kvlcc2::FULL_SCALE, 15.5, 1.778), (seiun_like::PARAMETERS, 16.7, 2.438)]
    {
        let by_speed = Mmg::at_speed(parameters, speed_kn * KNOT).expect("balances");
        assert_relative_eq!(by_speed.revolutions(), revolutions, epsilon = 1e-3);
        let (state, motion) = held_rudder(&by_speed, 0.0, 600.0, 0.1);
        assert_relative_eq!(motion.speed.expect("a hull has a speed"), speed_kn * KNOT, max_relative = 1e-10);
        assert_relative_eq!(state[state::NORTH], 600.0 * speed_kn * KNOT, max_relative = 1e-10);
    }
}

/// n₃ in deg/s: 0.5 · 30 = 3.1 + 0.4 · 3.1³ to two digits.
#[test]
fn zeefakkel_turns_at_3_degrees_a_second() {
    assert_relative_eq!(turning_rate_deg(&amerongen::zeefakkel(), 30.0), 3.1, epsilon = 0.05);
}

#[test]
fn the_first_order_ship_of_the_paper_is_exactly_that() {
    let truth = yukun::ship().first_order().expect("exactly first order");
    assert_relative_eq!(truth.K(), 0.1, max_relative = 1e-12);
    assert_relative_eq!(truth.T(), 16.3, max_relative = 1e-12);
    let first_order_ships = all_ships().iter().filter(|ship| ship.first_order().is_some()).count();
    assert_eq!(first_order_ships, 1);
}
