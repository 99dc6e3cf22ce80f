//! Lateral distance `y` of a formula, in replays of a ship with a bank.

use super::tests::manoeuvres;
use super::*;
use crate::dynamics::{Dynamics, ShipInput};
use crate::number::Tangent;
use crate::replay::{RecordedSignals, replay_states};
use crate::replayable::Replayable;
use crate::response::{Response, ResponseModel};
use crate::signal::Polyline;

const BASE: [f64; 3] = [0.06, 0.006, 0.01];

fn banked(line: &str, constants: Vec<f64>) -> Response {
    let formula = Formula::parse(line).expect("a formula");
    ResponseModel::new(vec![formula]).with_parameters([BASE.to_vec(), constants].concat())
}

/// States of a replay of a zig-zag-like rudder every quarter of a second, from an initial heading, with a falling
/// speed.
fn states(ship: &Response, side: f64, heading: f64, has_speed: bool) -> Vec<[f64; 4]> {
    let rudder = [0.0, 0.2, 0.2, -0.2, -0.2, 0.2, 0.2].map(|angle| side * angle).to_vec();
    let rudder = Polyline::new(vec![0.0, 4.0, 20.0, 28.0, 60.0, 68.0, 100.0], rudder).expect("increasing");
    let speed = Polyline::new(vec![0.0, 100.0], vec![8.0, 6.0]).expect("increasing");
    let recorded = RecordedSignals { speed: has_speed.then_some(&speed), ..RecordedSignals::from_rudder(&rudder) };
    let times: Vec<f64> = (0..=400).map(|row| 0.25 * f64::from(row)).collect();
    let mut state = vec![0.0; 4];
    ship.initialise(heading, 0.0, &recorded.input(0.0, 0.0), &mut state);
    let mut all = Vec::new();
    replay_states(
        ship,
        &recorded,
        &times,
        |_, _| 0.05,
        &mut state,
        |_, state, _| {
            all.push([state[0], state[1], state[2], state[3]]);
        },
    );
    all
}

#[test]
fn the_way_is_the_sum_of_the_speed_aside() {
    let ship = banked("bank = c * y", vec![-3e-4]);
    for has_speed in [true, false] {
        let all = states(&ship, 1.0, 0.7, has_speed);
        let aside = |(row, state): (usize, &[f64; 4])| {
            let speed = if has_speed { 8.0 - 0.02 * 0.25 * row as f64 } else { 1.0 };
            speed * (state[0] - 0.7).sin()
        };
        let aside: Vec<f64> = all.iter().enumerate().map(aside).collect();
        let (mut sum, mut most) = (0.0, 0.0_f64);
        for (pair, state) in aside.windows(2).zip(&all[1..]) {
            sum += 0.125 * (pair[0] + pair[1]);
            most = most.max(sum.abs());
            assert!((state[2] - sum).abs() < 0.01, "{} is not {sum}", state[2]);
        }
        assert!(most > if has_speed { 50.0 } else { 7.0 }, "{most} m");
    }
}

/// Lateral distance under rotation and mirror image: unchanged by a rotation of the record, and of opposite sign in
/// the mirror image.
#[test]
fn only_the_course_at_the_start_matters() {
    let ship = banked("bank = c * y", vec![-3e-4]);
    let mirrored = ship.model().clone().with_parameters(vec![BASE[0], BASE[1], -BASE[2], -3e-4]);
    let (all, turned) = (states(&ship, 1.0, 0.0, true), states(&ship, 1.0, 2.0, true));
    for ((straight, turned), mirrored) in all.iter().zip(turned).zip(states(&mirrored, -1.0, 0.0, true)) {
        assert!((turned[0] - straight[0] - 2.0).abs() < 1e-12 && (turned[2] - straight[2]).abs() < 1e-9);
        assert!((mirrored[0] + straight[0]).abs() < 1e-12 && (mirrored[2] + straight[2]).abs() < 1e-9);
    }
    let mut state = vec![0.3, 0.01, 40.0, 0.1];
    ship.reset_motion(0.5, -0.02, &mut state);
    assert_eq!(state, [0.5, -0.02, 40.0, 0.1]);
    let input = ShipInput { rudder: 0.1, ..ShipInput::default() };
    let mut rate = vec![0.0; 4];
    ship.rates(0.0, &state, &input, &mut rate);
    let moment = -3e-4 * 40.0;
    assert!((rate[1] - (0.06 * 0.02 + 0.006 * (0.11 + moment))).abs() < 1e-15 && rate[2] == (0.4_f64).sin());
}

/// Derivatives by base, constant, first heading and first yaw rate, against finite differences.
#[test]
fn a_way_carries_its_derivatives() {
    let rudder = Polyline::new(vec![0.0, 4.0, 40.0, 50.0, 100.0], vec![0.0, 0.2, 0.2, -0.2, -0.2]).expect("increasing");
    for line in ["bank = c * y", "bank = c * y * psi^2"] {
        let model = banked(line, vec![-3e-3]).model().clone();
        let end = |values: [Tangent; 6]| {
            let ship = model.clone().with_parameters(values[..4].to_vec());
            let mut state = vec![Tangent::default(); 4];
            let recorded = RecordedSignals::from_rudder(&rudder);
            ship.initialise(values[4], values[5], &recorded.input(0.0, Tangent::default()), &mut state);
            replay_states(&ship, &recorded, &[0.0, 100.0], |_, _| 0.25, &mut state, |_, _, _| {});
            state[0]
        };
        let values = [BASE[0], BASE[1], BASE[2], -3e-3, 0.4, 0.003];
        let whole = end(std::array::from_fn(|place| Tangent::variable(values[place], place, 1.0)));
        for place in 0..6 {
            let moved = |by: f64| {
                let mut moved = values;
                moved[place] += by * values[place];
                end(moved.map(Tangent::from)).value
            };
            let slope = (moved(1e-5) - moved(-1e-5)) / (2e-5 * values[place]);
            assert!((whole.derivatives[place] - slope).abs() < 1e-5 * slope.abs().max(0.1), "{line}, {place}: {slope}");
        }
    }
}

/// Unit of the lateral distance: if some records have no speed, the speed of the other records is not used.
#[test]
fn a_way_is_in_one_unit_in_all_records() {
    for (speed, way) in [(None, [1.0, 1.0]), (Some(7.0), [7.0, 0.0])] {
        let formula = Formula::parse("bank = c * y").expect("a formula");
        let CandidateEffect { effect, priors } =
            formula.candidate(&RecordScales { approach_speed: speed, ..manoeuvres() }).expect("any record will do");
        let constants: Vec<f64> = effect.constants().into_iter().map(|(constant, _)| constant).collect();
        assert_eq!(constants, way);
        assert!((priors[0].sd * way[0] / 6e-3 - 1.0).abs() < 0.2, "{priors:?}");
        let ship = ResponseModel::new(vec![effect]).with_parameters([BASE.as_slice(), &[0.0]].concat());
        let [measured, none] = [true, false].map(|has_speed| states(&ship, 1.0, 0.0, has_speed)[400][2]);
        assert_eq!(measured == none, speed.is_none());
    }
}
