//! Trials on which the benchmarks are measured.

use std::sync::Arc;

use ship::angle::from_deg;
use ship::effects::{Effect, listed_effect};
use ship::{FirstOrder, Response, ResponseModel};
use simulate::{Manoeuvre, Recording, Sensors, SimulatedShip, Simulation, SteeringGear, StreamKey};
use trial::Trial;

/// K of the ship, 1/s.
pub const K: f64 = 0.08;

/// T of the ship, s.
pub const T: f64 = 25.0;

/// Time between rows, s.
pub const PERIOD: f64 = 0.5;

/// Number of rows of the record on which methods are compared: 600 s.
pub const ROWS: usize = 1201;

/// Key of the trial that is identified.
pub const KEY: StreamKey = StreamKey { seed: 1957, cell: 0, replicate: 0 };

/// 10/10 zig-zag of a first-order ship with K = 0.08 1/s and T = 25 s; rudder 2.5 deg/s, heading noise 0.1 deg, gyro
/// noise 0.02 deg/s; `rows` rows half a second apart.
pub fn first_order_zig_zag(rows: usize) -> Simulation {
    let sensors = Sensors { heading_noise: from_deg(0.1), yaw_rate_noise: Some(from_deg(0.02)), ..Sensors::default() };
    Simulation {
        gear: SteeringGear::with_rate(from_deg(2.5)),
        recording: Recording {
            sampling_period: PERIOD,
            duration: Some(PERIOD * (rows - 1) as f64),
            ..Recording::default()
        },
        sensors,
        ..Simulation::new(
            SimulatedShip::from_first_order(FirstOrder::from_indices(K, T, 0.0)),
            Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0)),
        )
    }
}

/// 10/10 zig-zag as in [`first_order_zig_zag`], of a ship with K = 0.1 1/s, T = 16.3 s and cubic damping.
pub fn damped_zig_zag(rows: usize) -> Simulation {
    let effect: Arc<dyn Effect> = listed_effect("nonlinear_damping", "r³");
    let ship: Response = ResponseModel::new(vec![effect]).with_parameters(vec![1.0 / 16.3, 0.1 / 16.3, 0.0, 80.0]);
    Simulation { ship: SimulatedShip::from_response(ship), ..first_order_zig_zag(rows) }
}

/// Record of a trial.
///
/// # Panics
/// If the trial cannot be made; the trials of this module do not fail.
pub fn record(simulation: &Simulation) -> Trial {
    simulation.run(&KEY).expect("a regular trial").trial
}
