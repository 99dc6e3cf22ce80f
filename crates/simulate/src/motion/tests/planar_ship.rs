//! Yaw response combined with speed and drift.

use std::sync::Arc;

use approx::assert_relative_eq;
use ship::angle::from_deg;
use ship::effects::SpeedLoss;
use ship::replay::RecordedSignals;
use ship::{Dynamics, Polyline, ResponseModel};

use crate::motion::{COEFFICIENT_COUNT, PlanarCoefficients, PlanarModel, PlanarShip};

const LENGTH: f64 = 7.0;
const SPEED: f64 = 1.2;
const TRUTH: [f64; COEFFICIENT_COUNT] = [0.066, 1.5, 0.11, 0.2, 0.36, 2.5, 0.42, 0.14];

fn planar() -> PlanarModel {
    PlanarModel::new(PlanarCoefficients::clamped_from_array(TRUTH), LENGTH, SPEED).expect("a ship")
}

/// Rudder signal: successive angles from 3 s on, each held for `hold` s, with 15°/s between them.
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

/// Turn of many circles: it ends in a steady state, and the speed never exceeds the approach speed by more than 2 %,
/// for any rudder angle.
#[test]
fn no_rudder_makes_the_ship_faster() {
    for rate in [0.005, 0.02, 0.05] {
        for angle in [-0.6, -0.2, 0.0, 0.2, 0.6] {
            let ([mut u, mut v], mut last) = ([SPEED, 0.0], [f64::NAN; 2]);
            for _ in 0..20_000 {
                last = planar().rates(u, v, rate, angle);
                (u, v) = (u + 0.1 * last[0], v + 0.1 * last[1]);
                assert!(u.hypot(v) <= 1.02 * SPEED, "r {rate} rudder {angle}");
            }
            assert!(last[0].abs() < 1e-9 && u > 0.0, "{last:?}");
        }
    }
}

#[test]
fn a_response_sees_the_speed_of_its_ship() {
    let rudder = rudder(1.0, 35.0, 400.0, 1, 200.0);
    let model = ResponseModel::new(vec![Arc::new(SpeedLoss::Measured { approach_speed: SPEED })]);
    let steered = |exponents: [f64; 2]| {
        let response = model.clone().with_parameters(vec![0.1, 0.015, 0.0, exponents[0], exponents[1]]);
        let ship = PlanarShip { response, planar: planar() };
        let mut state = vec![f64::NAN; ship.dimension()];
        ship.approach(0.0, 0.0, &mut state);
        assert_eq!(state[state.len() - 2..], [SPEED, 0.0]);
        let step = ship.largest_step();
        let mut last = None;
        ship::replay::replay(
            &ship,
            &RecordedSignals::from_rudder(&rudder),
            &[0.0, 200.0],
            step,
            &mut state,
            |_, motion| {
                last = Some(*motion);
            },
        );
        let (motion, [u, v]) = (last.expect("a motion"), [state[state.len() - 2], state[state.len() - 1]]);
        assert_eq!((motion.speed, motion.sway), (Some(u.hypot(v)), Some(v)));
        (motion.yaw_rate, u.hypot(v) / SPEED)
    };
    // Steady turn: r = K δ q^(m_b − m_a).
    let (plain, _) = steered([1.0, 1.0]);
    let (slowed, ratio) = steered([1.0, 2.0]);
    assert_relative_eq!(plain, 0.15 * from_deg(35.0), max_relative = 5e-3);
    assert!(ratio < 0.8);
    assert_relative_eq!(slowed, plain * ratio, max_relative = 5e-3);
}

#[test]
fn states_steps_and_memory_of_the_response_are_passed_on() {
    use ship::effects::{Backlash, SteeringLag};
    // With dead time and play of the rudder but no effect that requires the speed, the response alone turns
    // identically.
    let model = ResponseModel::new(vec![Arc::new(SteeringLag::DeadTime), Arc::new(Backlash)]);
    let response = model.with_parameters(vec![0.1, 0.015, 0.01, 1.3, 0.05]);
    let ship = PlanarShip { response: response.clone(), planar: planar() };
    assert_eq!((ship.dimension(), ship.dead_time()), (response.dimension() + 2, 1.3));
    assert!(ship.largest_step() <= response.largest_step());
    let (rudder, times) = (rudder(1.0, 20.0, 16.0, 6, 99.0), [0.0, 30.0, 60.0, 99.0]);
    let headings = |dynamics: &dyn Dynamics| {
        let mut state = vec![0.0; dynamics.dimension()];
        dynamics.approach(0.0, 0.0, &mut state);
        let mut headings = Vec::new();
        ship::replay::replay(
            dynamics,
            &RecordedSignals::from_rudder(&rudder),
            &times,
            0.05,
            &mut state,
            |_, motion| {
                headings.push(motion.heading);
            },
        );
        headings
    };
    assert_eq!(headings(&ship), headings(&response));
}

#[test]
fn numbers_that_are_no_ship_are_refused() {
    let coefficients = PlanarCoefficients::clamped_from_array(TRUTH);
    for (length, speed) in [(0.0, SPEED), (LENGTH, 0.0), (f64::NAN, SPEED), (LENGTH, f64::INFINITY)] {
        assert!(PlanarModel::new(coefficients, length, speed).is_err(), "{length} {speed}");
    }
    assert_eq!(PlanarCoefficients::clamped_from_array([-1.0; COEFFICIENT_COUNT]).X_dv, 0.0);
}
