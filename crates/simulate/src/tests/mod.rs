//! Tests of whole runs: independent numbers, invariances, instruments and failures.

mod failures;
mod instruments;
mod invariance;

use std::sync::Arc;

use ship::angle::from_deg;
use ship::{Dynamics, FirstOrder, Motion, ShipInput};

use crate::{Manoeuvre, SimulatedShip, Simulation, SteeringGear, StreamKey};

/// Training ship of the reference numbers: K = 0.1 1/s, T = 16.3 s.
fn training_ship() -> FirstOrder {
    FirstOrder::from_indices(0.1, 16.3, 0.0)
}

/// Zig-zag (degrees) of the training ship with a rudder rate (deg/s), until the record is full.
pub(crate) fn zig_zag(delta_deg: f64, psi_deg: f64, rate_deg_s: f64, duration: f64) -> Simulation {
    let manoeuvre = Manoeuvre::zig_zag(from_deg(delta_deg), from_deg(psi_deg));
    let mut simulation = Simulation::new(SimulatedShip::from_first_order(training_ship()), manoeuvre);
    simulation.gear = SteeringGear::with_rate(from_deg(rate_deg_s));
    simulation.recording.duration = Some(duration);
    simulation
}

/// Ship of two states, defined by its yaw acceleration, without a closed form.
struct TestShip<F> {
    /// Yaw acceleration, rad/s², from the yaw rate and the input.
    acceleration: F,
    /// Speed, m/s, from the yaw rate.
    speed: fn(f64) -> f64,
    dead_time: f64,
}

impl<F: Fn(f64, &ShipInput) -> f64 + Send + Sync + 'static> TestShip<F> {
    fn simulated(acceleration: F, speed: fn(f64) -> f64, dead_time: f64) -> SimulatedShip {
        SimulatedShip::from_dynamics(Arc::new(Self { acceleration, speed, dead_time }))
    }
}

impl<F: Fn(f64, &ShipInput) -> f64 + Send + Sync> Dynamics for TestShip<F> {
    fn dimension(&self) -> usize {
        2
    }

    fn approach(&self, heading: f64, yaw_rate: f64, state: &mut [f64]) {
        state.copy_from_slice(&[heading, yaw_rate]);
    }

    fn rates(&self, _t: f64, state: &[f64], input: &ShipInput, rate: &mut [f64]) {
        rate.copy_from_slice(&[state[1], (self.acceleration)(state[1], input)]);
    }

    fn motion(&self, _t: f64, state: &[f64], input: &ShipInput) -> Motion {
        let yaw_acceleration = (self.acceleration)(state[1], input);
        let speed = Some((self.speed)(state[1]));
        Motion { heading: state[0], yaw_rate: state[1], yaw_acceleration, speed, sway: None }
    }

    fn dead_time(&self) -> f64 {
        self.dead_time
    }
}

pub(crate) const KEY: StreamKey = StreamKey { seed: 20, cell: 3, replicate: 7 };
