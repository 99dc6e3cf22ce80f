//! All errors of a simulation, with their numbers.

use ship::FirstOrder;
use ship::angle::from_deg;
use trial::TrialError;

use super::{KEY, zig_zag};
use crate::disturbance::GaussMarkov;
use crate::limits::{MAX_EXECUTES, MAX_ROWS, MAX_TIME_S};
use crate::sensor::Spikes;
use crate::{Manoeuvre, Requirement, SimulateError, SimulatedShip, Simulation, Solver};

fn failure(simulation: &Simulation) -> SimulateError {
    simulation.run(&KEY).expect_err("this must fail")
}

fn refused(change: impl FnOnce(&mut Simulation)) -> (&'static str, Requirement) {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
    change(&mut simulation);
    match failure(&simulation) {
        SimulateError::Specification(error) => (error.key, error.expected),
        other => panic!("expected a refusal, found {other}"),
    }
}

#[test]
fn a_specification_that_makes_no_sense_is_refused_by_name() {
    assert_eq!(refused(|s| s.solver = Solver::RungeKutta(1e-300)).0, "solver.step");
    assert_eq!(refused(|s| s.sensors.heading_lag = 1e-300).0, "sensor.heading-lag-s");
    assert_eq!(refused(|s| s.helmsman.reads_display_every = Some(1e-300)).0, "helmsman.reads-display-every-s");
    let wander =
        |sd, correlation_time| refused(|s| s.sensors.heading_wander = Some(GaussMarkov { sd, correlation_time }));
    assert_eq!(wander(-0.1, 10.0), ("sensor.heading-wander.sd-deg", Requirement::NotNegative));
    assert_eq!(wander(0.1, 0.0), ("sensor.heading-wander.correlation-s", Requirement::Positive));
    assert_eq!(wander(0.1, 1e9), ("sensor.heading-wander.correlation-s", Requirement::AtMost(MAX_TIME_S)));
    let spikes = |probability, size| refused(|s| s.sensors.heading_spikes = Some(Spikes { probability, size }));
    assert_eq!(spikes(-0.1, 0.1), ("sensor.heading-spikes.probability", Requirement::Between(0.0, 1.0)));
    assert_eq!(spikes(0.1, 0.0), ("sensor.heading-spikes.size-deg", Requirement::Positive));
    assert_eq!(spikes(0.1, 4.0), ("sensor.heading-spikes.size-deg", Requirement::AtMost(180.0)));
    let rows = Requirement::Between(1.0, MAX_ROWS as f64);
    assert_eq!(refused(|s| s.sensors.heading_every_rows = Some(0)), ("sensor.heading-every-rows", rows));
}

#[test]
fn a_message_says_what_was_found_and_what_was_expected() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
    simulation.recording.sampling_period = 0.0;
    let message = failure(&simulation).to_string();
    assert_eq!(message, "recording.sampling-s is 0, expected a finite number above 0");
}

#[test]
fn an_unstable_ship_that_runs_away_is_an_error() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 4000.0);
    simulation.ship =
        SimulatedShip::from_first_order(FirstOrder { inverse_T: -0.05, K_over_T: 6e-3, rudder_bias: 0.0 });
    simulation.manoeuvre = Manoeuvre::turning_circle(0.1).lasting(4000.0);
    match failure(&simulation) {
        SimulateError::Diverged { time, .. } => assert!(time > 100.0 && time < 400.0, "{time}"),
        other => panic!("expected divergence, found {other}"),
    }
}

#[test]
fn a_heading_that_is_never_reached_is_an_error() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 3000.0);
    // A bias larger than the port rudder: the ship turns to starboard only.
    simulation.ship = SimulatedShip::from_first_order(FirstOrder::from_indices(0.1, 16.3, from_deg(10.2)));
    simulation.longest_wait = 500.0;
    match failure(&simulation) {
        SimulateError::NeverReached { execute, waited, .. } => assert_eq!((execute, waited), (2, 500.0)),
        other => panic!("expected to wait in vain, found {other}"),
    }
}

#[test]
fn a_record_that_starts_at_no_execute_is_an_error() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 100.0);
    let angle = from_deg(10.0);
    simulation.recording.after_execute = Some(5);
    simulation.manoeuvre = Manoeuvre::zig_zag(angle, angle).lasting(60.0);
    assert!(matches!(failure(&simulation), SimulateError::NoSuchExecute { execute: 5, .. }));
    simulation.manoeuvre = Manoeuvre::zig_zag(angle, angle).until_execute(3);
    let SimulateError::Specification(refused) = failure(&simulation) else { panic!("known before it is run") };
    assert_eq!((refused.key, refused.expected), ("recording.after-execute", Requirement::Execute(3)));
}

/// Costs that no estimate includes: a helmsman who reverses the rudder at every small heading change, and a record that
/// only the last execute ends.
#[test]
fn a_run_that_takes_too_much_is_given_up() {
    let mut simulation = zig_zag(10.0, 1e-290, f64::INFINITY, 100.0);
    let given_up = |simulation: &Simulation| match failure(simulation) {
        SimulateError::TooLong { quantity, limit, .. } => (quantity, limit),
        other => panic!("expected to be given up, found {other}"),
    };
    assert_eq!(given_up(&simulation), ("executes", MAX_EXECUTES));
    simulation.manoeuvre = Manoeuvre::zig_zag(0.1, 0.4).until_execute(12);
    (simulation.recording.duration, simulation.recording.sampling_period) = (None, 1e-3);
    assert_eq!(given_up(&simulation), ("rows", MAX_ROWS));
}

#[test]
fn a_record_with_too_few_rows_is_an_error() {
    let mut simulation = zig_zag(10.0, 10.0, 2.5, 3.0);
    assert!(matches!(failure(&simulation), SimulateError::Record(_)));
    // Enough rows, but a heading only in every fiftieth.
    simulation = zig_zag(10.0, 10.0, 2.5, 300.0);
    simulation.sensors.heading_every_rows = Some(50);
    assert_eq!(failure(&simulation), SimulateError::Record(TrialError::TooShort { needed: 8, rows: 7 }));
}
