//! One contract for every registered ship, every manoeuvre and every disturbance: a believable record comes out.

use std::sync::Arc;

use kempf_tests::records::zig_zag;
use ship::angle::{from_deg, to_deg};
use ship::ships::{self, ShipModel, kvlcc2, mariner, seiun_like, tanker};
use ship::vessel::abkowitz::Abkowitz;
use ship::vessel::mmg::{BySign, Mmg, MmgParameters, Wake};
use ship::{FirstOrder, Particulars, Polyline, Ship};
use simulate::disturbance::{GaussMarkov, Squall, WaveSpectrum, Wind};
use simulate::{Disturbances, Manoeuvre, Side, SimulatedShip, Simulation, SteeringGear, StreamKey, Truth};
use trial::{Channel, Trial, ZigZag};

const KEY: StreamKey = StreamKey { seed: 11, cell: 2, replicate: 5 };

/// Rudder rate where the ship has none of its own, deg/s.
const USUAL_RATE_DEG_S: f64 = 2.5;

/// Executes every zig-zag has to make.
const EXECUTES: usize = 5;

/// A zig-zag δ = ψ = `angle_deg` of a ship with its own gear, to its fifth execute, in rows of a hundredth of a typical
/// time.
fn own_zig_zag(vessel: SimulatedShip, rate: f64, unit: f64, angle_deg: f64, first: Side) -> Simulation {
    let mut simulation = zig_zag(vessel, angle_deg, angle_deg, rate, 1.0);
    simulation.manoeuvre = simulation.manoeuvre.with_first_side(first).until_execute(EXECUTES);
    simulation.recording.duration = None;
    simulation.recording.sampling_period = 0.05 * unit;
    simulation
}

fn rate_of(ship: &Ship) -> f64 {
    ship.rudder_rate.unwrap_or(from_deg(USUAL_RATE_DEG_S))
}

/// Time the ship needs for its own length, s.
fn unit_of(ship: &Ship) -> f64 {
    ship.particulars.map_or(10.0, |particulars| particulars.length / particulars.speed)
}

fn run(simulation: &Simulation, what: &str) -> (Trial, Truth) {
    let simulated = simulation.run(&KEY).unwrap_or_else(|error| panic!("{what}: {error}"));
    (simulated.trial, Truth::clone(&simulated.truth))
}

fn assert_finite(what: &str, truth: &Truth) {
    let columns = [
        &truth.time,
        &truth.heading,
        &truth.yaw_rate,
        &truth.yaw_acceleration,
        &truth.rudder,
        &truth.disturbance_rudder,
    ];
    for column in columns.into_iter().chain(&truth.speed) {
        assert!(column.iter().all(|x| x.is_finite()), "{what}");
    }
}

#[test]
fn every_ship_reaches_its_executes_in_10_10_and_20_20_to_either_side() {
    for ship in ships::all_ships() {
        for angle_deg in [10.0, 20.0] {
            for first in [Side::Starboard, Side::Port] {
                let what = format!("{} {angle_deg}/{angle_deg} {first:?}", ship.id);
                let simulation =
                    own_zig_zag(SimulatedShip::from_ship(&ship), rate_of(&ship), unit_of(&ship), angle_deg, first);
                let (trial, truth) = run(&simulation, &what);
                assert_finite(&what, &truth);
                assert_eq!(truth.execute_orders.len(), EXECUTES, "{what}");
                for (k, execute) in truth.execute_orders.iter().enumerate() {
                    let side = first.sign() * if k % 2 == 0 { 1.0 } else { -1.0 };
                    let heading = if k == 0 { 0.0 } else { -side * from_deg(angle_deg) };
                    assert_eq!(execute.ordered_rudder, side * from_deg(angle_deg), "{what}");
                    assert!(
                        (execute.heading - heading).abs() < 1e-9,
                        "{what}: execute {k} at {}",
                        to_deg(execute.heading)
                    );
                }
                assert_eq!(trial.particulars(), ship.particulars);
                // What the record shows is what was done.
                let read = ZigZag::from_trial(&trial).unwrap_or_else(|error| panic!("{what}: {error}"));
                assert!(
                    read.nominal_angles.is_some_and(|pair| pair.is_deg(angle_deg, angle_deg)),
                    "{what}: {:?}",
                    read.nominal_angles
                );
                let read = read.initial_turning_time.map(|time| time.value).expect("the record begins with the trial");
                assert!((read / truth.execute_orders[1].time - 1.0).abs() < 0.02, "{what}: t_a {read} s");
            }
        }
    }
}

/// The same hull with the coefficients of both sides equal.
fn evened(mut parameters: MmgParameters) -> MmgParameters {
    let even = |by_sign: BySign| BySign { positive: by_sign.mean(), negative: by_sign.mean() };
    parameters.rudder.gammaR = even(parameters.rudder.gammaR);
    if let Wake::Exponential { C2, .. } = &mut parameters.propeller.wake {
        *C2 = even(*C2);
    }
    parameters
}

fn has_sides(ship: &Ship) -> bool {
    matches!(ship.model, ShipModel::Hull(_)) && ship.id != "s175"
}

/// Response ships and S175 have no side; other hulls are evened first: the propeller force of the Mariner and the
/// tanker, wake and flow straightening of the MMG hulls differ by side.
#[test]
fn a_ship_without_built_in_asymmetry_is_its_own_mirror() {
    let mut vessels: Vec<(String, SimulatedShip, f64, f64)> = ships::all_ships()
        .iter()
        .filter(|ship| !has_sides(ship))
        .map(|ship| (ship.id.to_string(), SimulatedShip::from_ship(ship), rate_of(ship), unit_of(ship)))
        .collect();
    let mut derivatives = mariner::DERIVATIVES;
    for side in [&mut derivatives.Y, &mut derivatives.N] {
        (side.zero, side.zero_u, side.zero_uu) = (0.0, 0.0, 0.0);
    }
    let particulars = Particulars { length: 160.93, speed: 7.7175 };
    let cargo_ship = SimulatedShip::from_dynamics(Arc::new(Abkowitz::new(particulars, derivatives)));
    vessels.push(("mariner, evened".into(), cargo_ship, from_deg(5.0), 20.9));
    let tanker = SimulatedShip::from_dynamics(Arc::new(tanker::hull_model().without_thrust_asymmetry()));
    vessels.push(("tanker, evened".into(), tanker, from_deg(2.33), 37.0));
    for (name, parameters, speed, rate_deg, unit) in [
        ("kvlcc2, evened", kvlcc2::FULL_SCALE, 7.97, 2.32, 40.1),
        ("kvlcc2-l7, evened", kvlcc2::MODEL_L7, 1.179, 15.68, 5.9),
        ("seiun-like, evened", seiun_like::PARAMETERS, 8.59, 2.5, 12.2),
    ] {
        let hull = Mmg::at_speed(evened(parameters), speed).expect("the evened set balances");
        vessels.push((name.into(), SimulatedShip::from_dynamics(Arc::new(hull)), from_deg(rate_deg), unit));
    }
    assert_eq!(vessels.len(), ships::all_ships().len(), "every ship has its turn");
    for (what, vessel, rate, unit) in vessels {
        for angle_deg in [10.0, 20.0] {
            let [starboard, port] = [Side::Starboard, Side::Port]
                .map(|side| run(&own_zig_zag(vessel.clone(), rate, unit, angle_deg, side), &what).1);
            assert_eq!(starboard.time, port.time, "{what}");
            let apart = starboard.heading.iter().zip(&port.heading).map(|(right, left)| (right + left).abs());
            let apart = to_deg(apart.fold(0.0, f64::max));
            assert!(apart < 1e-9, "{what} {angle_deg}/{angle_deg}: {apart} deg");
        }
    }
}

/// The hulls that are not even really are not: port-first differs from starboard-first.
#[test]
fn a_built_in_asymmetry_is_seen() {
    for ship in ships::all_ships().iter().filter(|ship| has_sides(ship)) {
        let overshoot = |side| {
            let (_, truth) =
                run(&own_zig_zag(SimulatedShip::from_ship(ship), rate_of(ship), unit_of(ship), 10.0, side), &ship.id);
            truth.execute_orders[1].time
        };
        let (starboard, port) = (overshoot(Side::Starboard), overshoot(Side::Port));
        assert!((starboard / port - 1.0).abs() > 1e-3, "{}: {starboard} s and {port} s", ship.id);
    }
}

fn training_ship(manoeuvre: Manoeuvre) -> Simulation {
    let particulars = Particulars { length: 105.0, speed: 8.59 };
    let vessel =
        SimulatedShip::from_first_order(FirstOrder::from_indices(0.1, 16.3, 0.0)).with_particulars(particulars);
    let mut simulation = Simulation::new(vessel, manoeuvre);
    simulation.gear = SteeringGear::with_rate(from_deg(2.5));
    simulation
}

#[test]
fn every_manoeuvre_leaves_a_record() {
    let rudder = from_deg(15.0);
    let signal = Polyline::new(vec![0.0, 20.0, 30.0, 90.0], vec![0.0, 0.2, -0.2, 0.1]).expect("increasing times");
    let zig_zag = Manoeuvre::zig_zag(rudder, from_deg(10.0));
    let turn = Manoeuvre::turning_circle(rudder).with_first_side(Side::Port);
    let to_heading =
        Manoeuvre::TurningCircle { rudder, side: Side::Port, duration: None, heading_change: Some(from_deg(540.0)) };
    let manoeuvres = [
        ("zig-zag by executes", zig_zag.clone().until_execute(4), None),
        ("zig-zag by duration", zig_zag.lasting(200.0), Some(200.0)),
        ("turning circle by duration", turn.lasting(300.0), Some(300.0)),
        ("turning circle by heading", to_heading, None),
        ("pull-out", Manoeuvre::PullOut { rudder, side: Side::Starboard, hold: 100.0, duration: 80.0 }, Some(180.0)),
        ("replay", Manoeuvre::replay(signal), Some(90.0)),
    ];
    for (what, manoeuvre, duration) in manoeuvres {
        let (trial, truth) = run(&training_ship(manoeuvre), what);
        assert_finite(what, &truth);
        assert!(trial.len() > 60, "{what}: {} rows", trial.len());
        assert!(duration.is_none_or(|duration| trial.duration() == duration), "{what}: {} s", trial.duration());
        assert!(trial.rudder().iter().any(|delta| delta.abs() > 0.1), "{what}");
    }
}

/// A disturbance by name, and how it is switched on.
type Disturbance = (&'static str, fn(&mut Disturbances));

#[test]
fn every_disturbance_moves_the_ship() {
    let disturbances: [Disturbance; 6] = [
        ("wind", |d| d.wind = Some(Wind { moment: 0.02, from_direction: 1.0, speed: Some(10.0), gusting: None })),
        ("gusts", |d| d.gusts = Some(GaussMarkov { sd: 0.02, correlation_time: 10.0 })),
        ("drift", |d| d.moment_drift = 1e-4),
        ("squall", |d| d.squall = Some(Squall { start: 50.0, duration: 60.0, edge: 10.0, moment: 0.03 })),
        ("random walk", |d| d.moment_random_walk = 1e-3),
        ("waves", |d| d.waves = Some(WaveSpectrum { sd: 0.007, frequency: 0.6, damping: 0.1 })),
    ];
    let manoeuvre = Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0)).lasting(270.0);
    let (calm, _) = run(&training_ship(manoeuvre.clone()), "calm");
    for (what, set) in disturbances {
        let mut simulation = training_ship(manoeuvre.clone());
        set(&mut simulation.disturbances);
        let (trial, truth) = run(&simulation, what);
        assert_finite(what, &truth);
        assert_ne!(trial.heading(), calm.heading(), "{what}");
        assert_eq!(trial.channel(Channel::WindRelativeSpeed).is_some(), what == "wind");
    }
}
