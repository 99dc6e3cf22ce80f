//! Invariance of a simulation, or the required change, under solver, step, side, repetition and sources of noise.

use std::sync::Arc;

use approx::assert_abs_diff_eq;
use ship::angle::{from_deg, to_deg};
use ship::{Polyline, ShipInput};

use super::{KEY, TestShip, training_ship, zig_zag};
use crate::disturbance::{GaussMarkov, Gusting, Squall, WaveSpectrum, Wind};
use crate::sensor::{DropOut, Spikes};
use crate::simulated_ship::Solver;
use crate::{
    Manoeuvre, PreparedSimulation, Sensors, Side, SimulatedShip, SimulatedTrial, Simulation, StreamKey, Truth,
};

/// Ship with cubic damping and a dead time of the rudder.
fn cubic(dead_time: f64) -> SimulatedShip {
    let base = training_ship();
    let acceleration = move |r: f64, input: &ShipInput| {
        let steering = input.rudder + input.disturbance_rudder + base.rudder_bias;
        -base.inverse_T * (r + 2000.0 * r * r * r) + base.K_over_T * steering
    };
    TestShip::simulated(acceleration, |r| 7.0 - 1e3 * r * r, dead_time)
}

fn truth(simulation: &Simulation) -> Arc<Truth> {
    simulation.run(&KEY).expect("a run of a stable ship").truth
}

fn assert_same(left: &Truth, right: &Truth, tolerance: f64) {
    assert_eq!(left.execute_orders.len(), right.execute_orders.len());
    for (left, right) in left.execute_orders.iter().zip(&right.execute_orders) {
        assert_abs_diff_eq!(left.time, right.time, epsilon = tolerance);
        assert_abs_diff_eq!(left.yaw_rate, right.yaw_rate, epsilon = tolerance);
    }
    let columns = |truth: &Truth| {
        [&truth.heading, &truth.yaw_rate, &truth.yaw_acceleration, &truth.rudder].map(|column| column.clone())
    };
    for (left, right) in columns(left).iter().zip(columns(right)) {
        assert_eq!(left.len(), right.len());
        for (left, right) in left.iter().zip(right) {
            assert_abs_diff_eq!(*left, right, epsilon = tolerance);
        }
    }
}

/// Manoeuvres of every kind, with disturbances for which the closed form remains valid.
fn variety() -> Vec<Simulation> {
    let mut list = Vec::new();
    for (delta_deg, psi_deg, rate) in [(10.0, 10.0, 2.32), (20.0, 20.0, 3.0), (10.0, 20.0, 2.5), (5.0, 1.0, 4.0)] {
        list.push(zig_zag(delta_deg, psi_deg, rate, 270.0));
    }
    let mut anchored = list[0].clone();
    (anchored.recording.after_execute, anchored.recording.first_row_offset) = (Some(2), Some(1.2));
    anchored.approach.lead_in_time = 7.3;
    anchored.approach.heading = 1.0;
    anchored.gear.dead_time = 0.7;
    anchored.gear.dead_band = from_deg(0.3);
    list.push(anchored.clone());
    anchored.disturbances.moment_drift = from_deg(0.004);
    anchored.disturbances.moment_random_walk = from_deg(0.05);
    anchored.disturbances.gusts = Some(GaussMarkov { sd: from_deg(0.3), correlation_time: 10.0 });
    anchored.disturbances.squall = Some(Squall { start: 90.0, duration: 40.0, edge: 10.0, moment: from_deg(2.0) });
    anchored.helmsman.reaction_time = 0.4;
    list.push(anchored);
    let mut turn = list[0].clone();
    let rudder = from_deg(35.0);
    turn.manoeuvre = Manoeuvre::TurningCircle { rudder, side: Side::Port, duration: None, heading_change: Some(9.0) };
    turn.recording.duration = None;
    list.push(turn.clone());
    turn.manoeuvre = Manoeuvre::PullOut { rudder, side: Side::Starboard, hold: 80.5, duration: 60.0 };
    list.push(turn.clone());
    turn.manoeuvre = Manoeuvre::Williamson { rudder, side: Side::Starboard, duration: 60.0 };
    list.push(turn.clone());
    let recorded = Polyline::new(vec![100.0, 103.0, 120.0, 125.5, 180.0], vec![0.0, 0.2, 0.2, -0.3, 0.1]);
    turn.manoeuvre = Manoeuvre::replay(recorded.expect("increasing times"));
    list.push(turn);
    list
}

#[test]
fn closed_form_and_runge_kutta_agree_to_1e_9() {
    for simulation in variety() {
        let exact = truth(&simulation);
        let integrated = truth(&Simulation { solver: Solver::RungeKutta(0.1), ..simulation });
        assert_same(&exact, &integrated, 1e-9);
    }
}

#[test]
fn port_first_is_the_exact_mirror() {
    for ship in [SimulatedShip::from_first_order(training_ship()), cubic(0.4)] {
        let mut starboard = zig_zag(15.0, 10.0, 2.5, 300.0);
        starboard.ship = ship;
        starboard.gear.lag = 0.5;
        starboard.sensors = spoilt();
        let mut port = starboard.clone();
        port.manoeuvre = port.manoeuvre.with_first_side(Side::Port);
        let (starboard, port) = (starboard.run(&KEY).expect("a zig-zag"), port.run(&KEY).expect("a zig-zag"));
        // Instrument errors are independent of the side.
        let errors = |simulated: &SimulatedTrial| {
            let headings = simulated.trial.heading().iter().zip(&simulated.truth.heading);
            headings.map(|(psi, truth)| psi - truth).collect::<Vec<f64>>()
        };
        let (mut headings, mut spikes) = (0, 0);
        for (right, left) in errors(&starboard).into_iter().zip(errors(&port)) {
            assert_eq!(right.is_nan(), left.is_nan());
            if right.is_finite() {
                assert_abs_diff_eq!(right, left, epsilon = 1e-13);
                (headings, spikes) = (headings + 1, spikes + usize::from(right.abs() > from_deg(3.0)));
            }
        }
        assert!(headings == 151 && (5..40).contains(&spikes), "{headings} {spikes}");
        let (starboard, port) = (starboard.truth, port.truth);
        for (right, left) in starboard.heading.iter().zip(&port.heading) {
            assert_eq!(*right, -left);
        }
        for (right, left) in starboard.execute_orders.iter().zip(&port.execute_orders) {
            assert_eq!((right.time, right.ordered_rudder), (left.time, -left.ordered_rudder));
        }
    }
}

#[test]
fn runge_kutta_is_of_order_four_and_events_with_it() {
    let with = |step| {
        let mut simulation = zig_zag(20.0, 20.0, 2.32, 200.0);
        simulation.ship = cubic(0.6);
        // Rows are coarser than the step; otherwise the rows would determine the step.
        simulation.recording.sampling_period = 20.0;
        truth(&Simulation { solver: Solver::RungeKutta(step), ..simulation })
    };
    let exact = with(0.02);
    let error = |step| {
        let rough = with(step);
        // The first crossing: later crossings also contain the steps shortened at earlier events.
        let event = (rough.execute_orders[1].time - exact.execute_orders[1].time).abs();
        let heading = (rough.heading[10] - exact.heading[10]).abs();
        (event, heading)
    };
    // Half of the step gives a sixteenth of the error.
    for step in [0.5, 0.25] {
        let (coarse, fine) = (error(step), error(0.5 * step));
        assert!((14.0..18.0).contains(&(coarse.0 / fine.0)), "events {coarse:?} {fine:?}");
        assert!((14.0..20.0).contains(&(coarse.1 / fine.1)), "heading {coarse:?} {fine:?}");
    }
}

#[test]
fn events_do_not_depend_on_step_or_sampling() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 280.0);
    let exact = truth(&simulation);
    simulation.recording.sampling_period = 0.37;
    let other = truth(&simulation);
    for (left, right) in exact.execute_orders.iter().zip(&other.execute_orders) {
        assert_abs_diff_eq!(left.time, right.time, epsilon = 1e-11);
        assert_abs_diff_eq!(to_deg(left.heading.abs()), if left.time > 0.0 { 10.0 } else { 0.0 }, epsilon = 1e-11);
    }
    simulation.ship = cubic(0.0);
    let [coarse, fine] = [0.1, 0.03].map(|step| {
        let solver = Solver::RungeKutta(step);
        truth(&Simulation { solver, ..simulation.clone() })
    });
    for (left, right) in coarse.execute_orders.iter().zip(&fine.execute_orders) {
        assert_abs_diff_eq!(left.time, right.time, epsilon = 1e-7);
    }
}

#[test]
fn a_late_rudder_is_the_same_motion_with_a_late_gear() {
    let mut late_ship = zig_zag(10.0, 10.0, 2.5, 200.0);
    late_ship.ship = cubic(1.3);
    let mut late_gear = late_ship.clone();
    late_gear.ship = cubic(0.0);
    late_gear.gear.dead_time = 1.3;
    let (ship, gear) = (truth(&late_ship), truth(&late_gear));
    for (left, right) in ship.heading.iter().zip(&gear.heading) {
        assert_abs_diff_eq!(*left, *right, epsilon = 1e-9);
    }
    assert!(ship.rudder.iter().zip(&gear.rudder).any(|(left, right)| (left - right).abs() > 0.01));
}

#[test]
fn the_record_starts_after_the_execute_and_has_its_rows() {
    let mut simulation = zig_zag(10.0, 20.0, 2.5, 270.0);
    (simulation.recording.after_execute, simulation.recording.first_row_offset) = (Some(2), Some(1.2));
    let simulated = simulation.run(&KEY).expect("a zig-zag");
    assert_eq!(simulated.trial.len(), 271);
    assert_abs_diff_eq!(simulated.trial.time()[0], 36.31 + 1.2, epsilon = 0.01);
    assert_eq!(simulated.trial.heading(), simulated.truth.heading);
    assert_eq!(simulated.trial.rudder(), simulated.truth.rudder);
    // +10 deg minus 1.2 s at 2.5 deg/s.
    assert_abs_diff_eq!(to_deg(simulated.trial.rudder()[0]), 7.0, epsilon = 1e-9);
    assert_eq!(simulated.truth.speed, None);
    assert!(simulated.trial.noise().heading_sd.is_none());
}

#[test]
fn zig_zag_ends_at_its_execute_or_its_duration() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 1.0);
    simulation.recording.duration = None;
    simulation.approach.lead_in_time = 10.0;
    let angle = from_deg(10.0);
    simulation.manoeuvre = Manoeuvre::zig_zag(angle, angle).until_execute(4);
    let by_executes = truth(&simulation);
    assert_eq!(by_executes.execute_orders.len(), 4);
    assert_eq!(by_executes.time.last().copied(), Some(147.0));
    simulation.manoeuvre = Manoeuvre::zig_zag(angle, angle).lasting(200.0);
    let by_duration = truth(&simulation);
    assert_eq!(by_duration.time.last().copied(), Some(210.0));
    assert_eq!(by_duration.execute_orders[0].time, 10.0);
    assert_eq!(by_duration.heading[10], 0.0);
}

#[test]
fn a_turning_circle_ends_at_its_heading_and_a_pull_out_comes_to_rest() {
    let list = variety();
    let turn = truth(&list[6]);
    let last = turn.heading[turn.heading.len() - 1];
    assert!(last > -9.0 && last < -9.0 + 0.07, "{last}");
    let pull_out = truth(&list[7]);
    assert_eq!(pull_out.execute_orders.len(), 2);
    assert_eq!(pull_out.execute_orders[1].time, 80.5);
    assert_eq!(pull_out.execute_orders[1].ordered_rudder, 0.0);
    // 60 s are 3.7 time constants, minus the time of the rudder motion.
    let last = pull_out.yaw_rate.len() - 1;
    assert!(pull_out.yaw_rate[last] < 0.1 * pull_out.yaw_rate[80]);
}

/// Compass with all random errors.
fn spoilt() -> Sensors {
    Sensors {
        heading_noise: from_deg(0.2),
        heading_wander: Some(GaussMarkov { sd: from_deg(0.3), correlation_time: 10.0 }),
        heading_spikes: Some(Spikes { probability: 0.1, size: from_deg(5.0) }),
        heading_every_rows: Some(2),
        ..Sensors::default()
    }
}

/// Simulation with all random inputs at once.
fn noisy() -> Simulation {
    let mut simulation = variety().swap_remove(5);
    simulation.disturbances.wind = Some(Wind {
        moment: from_deg(1.0),
        from_direction: 1.0,
        speed: Some(12.0),
        gusting: Some(Gusting { sd: 0.2, correlation_time: 8.0 }),
    });
    simulation.disturbances.waves = Some(WaveSpectrum { sd: from_deg(0.3), frequency: 0.7, damping: 0.1 });
    simulation.sensors = Sensors { heading_quantum: from_deg(0.1), ..spoilt() };
    simulation.sensors.yaw_rate_noise = Some(1e-3);
    simulation.sensors.rudder_noise = from_deg(0.2);
    simulation.sensors.sampling_jitter = 0.1;
    simulation.sensors.drop_out.probability = 0.05;
    simulation.helmsman.reads_display_every = Some(1.0);
    simulation
}

#[test]
fn the_same_key_gives_the_same_bits() {
    let simulation = noisy();
    let bits = |key: &StreamKey| {
        let simulated = simulation.run(key).expect("a noisy zig-zag");
        let trial = simulated.trial;
        let channels = trial.channels().flat_map(|(_, values)| values.iter().map(|x| x.to_bits()));
        channels.chain(trial.rudder().iter().map(|x| x.to_bits())).collect::<Vec<u64>>()
    };
    assert_eq!(bits(&KEY), bits(&KEY));
    for other in [StreamKey { seed: 21, ..KEY }, StreamKey { cell: 4, ..KEY }, StreamKey { replicate: 8, ..KEY }] {
        assert_ne!(bits(&KEY), bits(&other));
    }
}

/// Rows without events between them are computed at once; with a heading that is late by a microsecond, every row is
/// searched. The instants of the helm differ by rounding.
#[test]
fn going_on_without_looking_changes_nothing() {
    for (case, simulation) in variety().into_iter().enumerate() {
        let mut watched = simulation.clone();
        watched.sensors.heading_delay = 1e-6;
        assert_same(&truth(&simulation), &truth(&watched), 1e-10);
        assert_eq!(truth(&simulation).time.len(), truth(&watched).time.len(), "case {case}");
    }
}

/// Quantities kept for all keys must not depend on the random numbers of one key: every random input, alone and
/// together.
#[test]
fn a_prepared_simulation_gives_the_same_bits() {
    let shaken: [fn(&mut Simulation); 11] = [
        |_| {},
        |simulation| simulation.sensors = Sensors { sampling_jitter: 0.0, heading_delay: 0.0, ..noisy().sensors },
        |simulation| simulation.sensors.sampling_jitter = 0.1,
        |simulation| simulation.sensors.heading_delay = 0.4,
        |simulation| simulation.disturbances.waves = noisy().disturbances.waves,
        |simulation| simulation.disturbances = noisy().disturbances,
        |simulation| simulation.helmsman.reads_display_every = Some(1.0),
        |simulation| simulation.sensors = spoilt(),
        |simulation| {
            simulation.sensors = Sensors { heading_noise: 0.0, ..spoilt() };
            simulation.helmsman.reads_display_every = Some(1.0);
        },
        |simulation| {
            simulation.sensors.drop_out = DropOut { probability: 0.1, whole_row: true, ..DropOut::default() };
            simulation.ship = cubic(0.4);
        },
        |simulation| *simulation = noisy(),
    ];
    for (case, shake) in shaken.into_iter().enumerate() {
        let mut simulation = zig_zag(10.0, 10.0, 2.32, 270.0);
        simulation.sensors.heading_noise = from_deg(0.2);
        shake(&mut simulation);
        let prepared = PreparedSimulation::new(simulation.clone()).expect("a zig-zag");
        for replicate in 0..3 {
            let key = StreamKey { replicate, ..KEY };
            let (direct, prepared) = (simulation.run(&key).expect("a zig-zag"), prepared.run(&key).expect("a zig-zag"));
            let columns = |simulated: &SimulatedTrial| {
                let trial = &simulated.trial;
                let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<u64>>();
                let channels = trial.channels().map(|(channel, values)| (channel, bits(values)));
                (bits(trial.time()), bits(trial.rudder()), channels.collect::<Vec<_>>())
            };
            assert_eq!(columns(&direct), columns(&prepared), "case {case}");
            assert_eq!(direct.truth, prepared.truth, "case {case}");
            assert_eq!(direct.trial.name(), prepared.trial.name());
        }
    }
}

#[test]
fn a_new_source_of_noise_leaves_the_others_as_they_were() {
    let mut few = zig_zag(10.0, 10.0, 2.5, 100.0);
    few.sensors.heading_noise = from_deg(0.3);
    let mut many = few.clone();
    many.sensors.rudder_noise = from_deg(0.2);
    many.sensors.yaw_rate_noise = Some(1e-3);
    many.sensors.drop_out.probability = 0.1;
    many.sensors.heading_spikes = Some(Spikes { probability: 0.1, size: 1.0 });
    many.sensors.heading_every_rows = Some(2);
    let (few, many) = (few.run(&KEY).expect("a zig-zag").trial, many.run(&KEY).expect("a zig-zag").trial);
    let mut kept = 0;
    for (left, right) in few.heading().iter().zip(many.heading()).filter(|(_, right)| right.is_finite()) {
        if (left - right).abs() < 0.9 {
            assert_eq!(left, right);
            kept += 1;
        }
    }
    assert!(kept > 30 && kept < 51);
    assert_ne!(few.rudder(), many.rudder());
}
