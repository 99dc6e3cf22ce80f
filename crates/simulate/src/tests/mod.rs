//! Tests of whole runs: numbers from elsewhere, invariances, instruments and failures.

mod failures;
mod instruments;
mod invariance;

use ship::FirstOrder;
use ship::angle::from_deg;

use crate::manoeuvre::{Manoeuvre, ZigZagEnd};
use crate::{Simulation, SteeringGear, StreamKey, Vessel};

/// The training ship of the reference numbers: K = 0.1 1/s, T = 16.3 s.
fn training_ship() -> FirstOrder {
    FirstOrder::from_indices(0.1, 16.3, 0.0)
}

/// A zig-zag (degrees) of the training ship with a rudder rate (deg/s), until the record is full.
pub(crate) fn zig_zag(delta_deg: f64, psi_deg: f64, rate_deg_s: f64, duration: f64) -> Simulation {
    let manoeuvre = Manoeuvre::zig_zag(from_deg(delta_deg), from_deg(psi_deg), ZigZagEnd::Record);
    let mut simulation = Simulation::new(Vessel::first_order(training_ship()), manoeuvre);
    simulation.gear = SteeringGear::with_rate(from_deg(rate_deg_s));
    simulation.recording.duration = Some(duration);
    simulation
}

pub(crate) const KEY: StreamKey = StreamKey { seed: 20, cell: 3, replicate: 7 };
