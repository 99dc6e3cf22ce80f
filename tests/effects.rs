//! One contract for every effect, with the simulator in the loop: a zig-zag is steered with the effect in the ship.

use std::collections::BTreeSet;
use std::sync::Arc;

use kempf_tests::records::zig_zag;
use ship::angle::{from_deg, to_deg};
use ship::effects::{self, Effect, Parameter};
use ship::{Particulars, Response, ResponseModel};
use simulate::{SimulatedShip, SimulatedTrial, StreamKey};

/// The identifiers that were published: files of users name them. A new effect needs no line here.
const IDS: &str = "second_order nonlinear_damping wind_moment speed_loss steering_lag rudder_saturation \
                   rudder_deadband port_starboard_asymmetry moment_drift transient_disturbance wave_yaw \
                   sway_coupling_measured";

/// K = 0.1 1/s, T = 16.3 s, δ_r = 0.5 deg.
fn base() -> Vec<f64> {
    vec![1.0 / 16.3, 0.1 / 16.3, from_deg(0.5)]
}

fn with_effect(effect: &Arc<dyn Effect>, value: fn(&Parameter) -> f64) -> Response {
    let mut parameters = base();
    parameters.extend(effect.parameters().iter().map(value));
    ResponseModel::new(vec![Arc::clone(effect)]).with_parameters(parameters)
}

/// A 10/10 zig-zag of 300 s.
fn steer(response: Response) -> SimulatedTrial {
    let vessel = SimulatedShip::from_response(response).with_particulars(Particulars { length: 105.0, speed: 8.6 });
    zig_zag(vessel, 10.0, 10.0, from_deg(2.5), 300.0)
        .run(&StreamKey { seed: 7, cell: 0, replicate: 0 })
        .expect("a zig-zag with a typical effect comes to its end")
}

fn name(effect: &Arc<dyn Effect>) -> String {
    format!("{} ({})", effect.id(), effect.form())
}

/// Maximum distance of two headings, deg.
fn apart_deg(left: &[f64], right: &[f64]) -> f64 {
    assert_eq!(left.len(), right.len());
    left.iter().zip(right).map(|(left, right)| to_deg((left - right).abs())).fold(0.0, f64::max)
}

#[test]
fn the_identifiers_users_rely_on_are_all_there() {
    let found: BTreeSet<&str> = effects::all_effects().iter().map(|effect| effect.id()).collect();
    let gone: Vec<&str> = IDS.split(' ').filter(|id| !found.contains(id)).collect();
    assert!(gone.is_empty(), "files of users name {gone:?}");
    let forms: BTreeSet<String> = effects::all_effects().iter().map(name).collect();
    assert_eq!(forms.len(), effects::all_effects().len(), "no form twice");
    assert!(effects::all_effects().iter().all(|effect| effect.equation().contains('=')));
}

#[test]
fn neutral_and_typical_values_lie_within_the_bounds() {
    for effect in effects::all_effects() {
        assert!(!effect.parameters().is_empty());
        for p in effect.parameters() {
            let what = format!("{}: {}", name(&effect), p.symbol);
            assert!(p.lowest < p.highest, "{what}");
            assert!((p.lowest..=p.highest).contains(&p.neutral), "{what} neutral");
            assert!((p.lowest..=p.highest).contains(&p.typical), "{what} typical");
            // The mirror image of a value that changes sign has to be allowed as well.
            assert!(!p.is_odd || (p.neutral == 0.0 && p.lowest == -p.highest), "{what} is odd");
            assert!(!p.symbol.is_empty() && !p.unit.is_empty());
            assert!(!p.key.is_empty() && p.key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'), "{what} key");
        }
        let moved = effect.parameters().iter().any(|p| p.typical != p.neutral);
        assert!(moved, "{}: typical is not absent", name(&effect));
    }
}

#[test]
fn a_typical_effect_keeps_a_zig_zag_finite_and_is_seen_unless_it_needs_a_channel() {
    let plain = steer(ResponseModel::first_order().with_parameters(base()));
    for effect in effects::all_effects() {
        let simulated = steer(with_effect(&effect, |p| p.typical));
        let truth = &simulated.truth;
        let columns = [&truth.heading, &truth.yaw_rate, &truth.yaw_acceleration, &truth.rudder];
        assert!(columns.iter().all(|column| column.iter().all(|x| x.is_finite())), "{}", name(&effect));
        assert!(truth.execute_orders.len() >= 4, "{}: {} executes", name(&effect), truth.execute_orders.len());
        let seen = apart_deg(simulated.trial.heading(), plain.trial.heading());
        // Forms that need a measured channel have nothing to act on: the simulator measures with its own instruments
        // only.
        assert_eq!(seen > 0.01, effect.needs().is_none(), "{}: moved by {seen} deg", name(&effect));
    }
}

#[test]
fn values_at_the_bounds_do_not_break_the_equations() {
    for effect in effects::all_effects() {
        for value in [|p: &Parameter| p.lowest, |p: &Parameter| p.highest] {
            let response = with_effect(&effect, value);
            let dynamics: &dyn ship::Dynamics = &response;
            let mut state = vec![0.0; dynamics.dimension()];
            dynamics.approach(0.1, 0.01, &mut state);
            let mut rate = state.clone();
            let input = ship::ShipInput { rudder: from_deg(10.0), ..ship::ShipInput::default() };
            dynamics.rates(0.0, &state, &input, &mut rate);
            assert!(rate.iter().all(|x| x.is_finite()), "{}: {rate:?}", name(&effect));
            assert!(dynamics.largest_step() > 0.0 && dynamics.dead_time().is_finite());
        }
    }
}
