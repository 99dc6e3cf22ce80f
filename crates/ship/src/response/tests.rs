use super::*;
use crate::Tangent;
use crate::dynamics::MeasuredChannels;
use crate::effects;
use crate::first_order::{FirstOrderTransition, YawState};
use crate::replay::{RecordedSignals, replay, replay_states};
use crate::signal::Polyline;
use approx::assert_relative_eq;

const BASE_VALUES: [f64; 3] = [1.0 / 16.3, 0.1 / 16.3, 0.01];

/// Zig-zag-like rudder: ramps of 2.5 deg/s between ±10 deg.
fn rudder(sign: f64) -> Polyline {
    let d = sign * crate::angle::from_deg(10.0);
    let time = vec![0.0, 4.0, 20.0, 28.0, 60.0, 68.0, 100.0];
    Polyline::new(time, vec![0.0, d, d, -d, -d, d, d]).expect("increasing times")
}

fn heading_at_end(response: &Response, rudder: &Polyline, side: f64) -> f64 {
    let times: Vec<f64> = (0..=100).map(f64::from).collect();
    let mut state = vec![0.0; response.dimension()];
    response.approach(0.0, 0.0, &mut state);
    let speed = Polyline::new(vec![0.0, 100.0], vec![1.0, 0.7]).expect("increasing times");
    let (sway, wind, from) = (Polyline::constant(0.2 * side), Polyline::constant(3.0), Polyline::constant(0.8 * side));
    let propeller = Polyline::constant(1.2);
    let recorded = RecordedSignals {
        rudder,
        speed: Some(&speed),
        sway: Some(&sway),
        wind_speed: Some(&wind),
        wind_from: Some(&from),
        propeller_rate: Some(&propeller),
    };
    let mut last = f64::NAN;
    replay(response, &recorded, &times, response.largest_step(), &mut state, |_, motion| last = motion.heading);
    last
}

fn with_effect(effect: Arc<dyn Effect>, value: impl Fn(&Parameter) -> f64, side: f64) -> Response {
    let mut parameters = BASE_VALUES.to_vec();
    parameters[2] *= side;
    parameters.extend(effect.parameters().iter().map(|p| if p.is_odd { side * value(p) } else { value(p) }));
    ResponseModel::new(vec![effect]).with_parameters(parameters)
}

#[test]
fn the_base_is_the_closed_form() {
    let response = ResponseModel::first_order().with_parameters(BASE_VALUES.to_vec());
    let signal = rudder(1.0);
    let mut state = YawState::default();
    for k in 0..signal.times().len() - 1 {
        let h = signal.times()[k + 1] - signal.times()[k];
        let slope = (signal.values()[k + 1] - signal.values()[k]) / h;
        let b = BASE_VALUES[1];
        state = FirstOrderTransition::new(BASE_VALUES[0], h).advance(
            state,
            b * (signal.values()[k] + BASE_VALUES[2]),
            b * slope,
        );
    }
    assert_relative_eq!(heading_at_end(&response, &signal, 1.0), state.heading, max_relative = 1e-9);
}

#[test]
fn a_neutral_effect_is_no_effect() {
    let base = heading_at_end(&ResponseModel::first_order().with_parameters(BASE_VALUES.to_vec()), &rudder(1.0), 1.0);
    for effect in effects::all_effects() {
        let model = with_effect(effect.clone(), |p| p.neutral, 1.0);
        let heading = heading_at_end(&model, &rudder(1.0), 1.0);
        assert!((heading - base).abs() < 1e-8, "{} ({}): {heading} is not {base}", effect.id(), effect.form());
    }
}

#[test]
fn every_effect_acts_is_finite_and_keeps_its_mirror_symmetry() {
    let base = heading_at_end(&ResponseModel::first_order().with_parameters(BASE_VALUES.to_vec()), &rudder(1.0), 1.0);
    for effect in effects::all_effects() {
        let starboard = heading_at_end(&with_effect(effect.clone(), |p| p.typical, 1.0), &rudder(1.0), 1.0);
        let port = heading_at_end(&with_effect(effect.clone(), |p| p.typical, -1.0), &rudder(-1.0), -1.0);
        let name = format!("{} ({})", effect.id(), effect.form());
        assert!(starboard.is_finite(), "{name}");
        assert_relative_eq!(starboard, -port, max_relative = 1e-12);
        let deterministic =
            effect.random_heading(&effect.parameters().iter().map(|p| p.typical).collect::<Vec<_>>()).is_none();
        assert_eq!((starboard - base).abs() > 1e-6, deterministic, "{name} moves the heading by {}", starboard - base);
    }
}

#[test]
fn effects_without_their_channel_are_silent() {
    for effect in effects::all_effects().iter().filter(|effect| effect.needs().is_some()) {
        let response = with_effect(effect.clone(), |p| p.typical, 1.0);
        let mut state = vec![0.0; response.dimension()];
        response.approach(0.0, 0.01, &mut state);
        let mut rate = state.clone();
        response.rates(
            0.0,
            &state,
            &ShipInput { rudder: 0.1, measured: MeasuredChannels::default(), ..ShipInput::default() },
            &mut rate,
        );
        assert_relative_eq!(rate[1], -BASE_VALUES[0] * 0.01 + BASE_VALUES[1] * 0.11, max_relative = 1e-12);
    }
}

#[test]
fn an_effect_acts_where_it_says() {
    let measured = MeasuredChannels {
        speed: Some(0.8),
        sway: Some(0.2),
        wind_speed: Some(3.0),
        wind_from: Some(0.8),
        propeller_rate: Some(1.2),
    };
    let now = OperatingPoint {
        t: 95.0,
        heading: 0.3,
        yaw_rate: 0.01,
        rudder: 0.2,
        inverse_T: 0.06,
        K_over_T: 0.006,
        measured: &measured,
    };
    for effect in effects::all_effects() {
        let p: Vec<f64> = effect.parameters().iter().map(|p| p.typical).collect();
        let z = vec![0.15; effect.states()];
        let acts = f64::effect_equations(effect.as_ref());
        let acted_on = EffectTarget {
            transforms_rudder: acts.rudder(&p, &z, 0.2) != 0.2,
            scales_response: acts.base_factors(&p, &z, &now) != BaseFactors::unity(),
            adds_moment: acts.yaw_acceleration(&p, &z, &now) != 0.0,
        };
        assert_eq!(acted_on, effect.acts_on(), "{} ({})", effect.id(), effect.form());
    }
}

/// Replay in dual numbers: values of the plain replay, and derivatives by finite differences.
#[test]
fn a_replay_carries_its_derivatives() {
    let signal = rudder(1.0);
    let times: Vec<f64> = (0..=100).map(f64::from).collect();
    let end = |model: &ResponseModel, values: &[Tangent]| {
        let response = model.clone().with_parameters(values.to_vec());
        let recorded = RecordedSignals::from_rudder(&signal);
        let mut state = vec![Tangent::default(); response.dimension()];
        let zero = Tangent::default();
        response.initialise(zero, zero, &recorded.input(0.0, response.dead_time()), &mut state);
        replay_states(&response, &recorded, &times, |_, _| 0.25, &mut state, |_, _, _| {});
        state[0]
    };
    for effect in effects::all_effects().into_iter().filter(|effect| effect.needs().is_none()) {
        let mut values = BASE_VALUES.to_vec();
        values.extend(effect.parameters().iter().map(|p| p.typical));
        let model = ResponseModel::new(vec![Arc::clone(&effect)]);
        let constant = |values: &[f64]| values.iter().map(|&x| Tangent::from(x)).collect::<Vec<_>>();
        for k in 0..values.len() {
            let name = format!("{} ({}), {k}", effect.id(), effect.form());
            let mut seeded = constant(&values);
            seeded[k] = Tangent::variable(values[k], 1, 1.0);
            let dual = end(&model, &seeded);
            assert_eq!(dual.value, end(&model, &constant(&values)).value, "{name}");
            let h = 1e-5 * values[k];
            let moved = |by: f64| {
                let mut moved = values.clone();
                moved[k] += by;
                end(&model, &constant(&moved)).value
            };
            let slope = (moved(h) - moved(-h)) / (2.0 * h);
            assert_relative_eq!(dual.derivatives[1], slope, max_relative = 2e-5, epsilon = 1e-7);
        }
    }
}

/// Away from the edges of a squall the steps of the base suffice: the error of the heading is that of the base.
#[test]
fn small_steps_are_taken_where_motion_is_fast() {
    let signal = rudder(1.0);
    let times: Vec<f64> = (0..=200).map(|k| 0.5 * f64::from(k)).collect();
    let error = |response: &Response| {
        let headings = |step: &dyn Fn(f64, f64) -> f64| {
            let mut state = vec![0.0; response.dimension()];
            let mut headings = Vec::new();
            let recorded = RecordedSignals::from_rudder(&signal);
            replay_states(response, &recorded, &times, step, &mut state, |_, state, _| headings.push(state[0]));
            headings
        };
        let pace = response.time_constants();
        let coarse = headings(&|from, to| pace.shortest(from, to) / 4.0);
        coarse.iter().zip(headings(&|_, _| 1e-3)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    };
    let base = error(&ResponseModel::first_order().with_parameters(BASE_VALUES.to_vec()));
    let values = [BASE_VALUES.as_slice(), &[0.05, 47.3, 1.5]].concat();
    let squall =
        error(&ResponseModel::new(vec![Arc::new(effects::TransientDisturbance::Passing)]).with_parameters(values));
    assert!(squall < 1.5 * base, "{squall:e} rad, {base:e} rad without the squall");
}

/// Predicates of an effect against its equations: rotation of the record changes only effects of the heading, a later
/// start only effects of time, and the constants are the constants of the equations.
#[test]
fn an_effect_is_what_it_says() {
    for effect in effects::all_effects().into_iter().filter(|effect| !effect.is_random() && effect.needs().is_none()) {
        let name = format!("{} ({})", effect.id(), effect.form());
        let response = with_effect(effect.clone(), |p| p.typical, 1.0);
        let turning = |response: &Response, heading: f64, from: f64| {
            let signal = Polyline::new(vec![from, from + 20.0, from + 60.0], vec![0.0, 0.2, -0.1]).expect("increasing");
            let times: Vec<f64> = (0..=100).map(|k| from + f64::from(k)).collect();
            let mut state = vec![0.0; response.dimension()];
            response.approach(heading, 0.0, &mut state);
            replay(response, &RecordedSignals::from_rudder(&signal), &times, 0.1, &mut state, |_, _| {});
            state[0] - heading
        };
        assert_eq!(
            (turning(&response, 0.0, 0.0) - turning(&response, 1.0, 0.0)).abs() > 1e-9,
            effect.is_heading_dependent(),
            "{name}"
        );
        assert_eq!(
            (turning(&response, 0.0, 0.0) - turning(&response, 0.0, 500.0)).abs() > 1e-6,
            effect.is_time_dependent(),
            "{name}"
        );
        let constants: Vec<f64> = effect.constants().iter().map(|(constant, _)| constant + 1.5).collect();
        let other = effects::find_effect(effect.id(), effect.form(), &constants).expect("all are known");
        let other = turning(&with_effect(other, |p| p.typical, 1.0), 0.0, 0.0);
        assert_eq!((turning(&response, 0.0, 0.0) - other).abs() > 1e-9, !constants.is_empty(), "{name}");
    }
}

/// Steady state and slow roots of a second-order response: r∞ = K (δ + δ_r) and the characteristic polynomial.
#[test]
fn second_order_has_the_declared_transfer_function() {
    let (gain, t1, t2, t3, delta) = (0.1, 20.0, 2.5, 6.2, 0.2);
    let response = ResponseModel::new(vec![Arc::new(effects::SecondOrder)]).with_parameters(vec![
        1.0 / t1,
        gain / t1,
        0.0,
        t2,
        t3,
    ]);
    let mut state = vec![0.0; 3];
    response.approach(0.0, 0.0, &mut state);
    let signal = Polyline::constant(delta);
    let times = [0.0, 1.0, 5.0, 20.0, 60.0];
    replay(&response, &RecordedSignals::from_rudder(&signal), &times, 0.01, &mut state, |k, motion| {
        // Step response of K (1 + T₃ s)/((1 + T₁ s)(1 + T₂ s)) by partial fractions.
        let t = times[k];
        let exact =
            gain * delta * (1.0 - (t1 - t3) / (t1 - t2) * (-t / t1).exp() - (t3 - t2) / (t1 - t2) * (-t / t2).exp());
        if k > 0 {
            assert_relative_eq!(motion.yaw_rate, exact, max_relative = 1e-8);
        }
    });
}
