//! The trials that the benches are measured on.

use ship::FirstOrder;
use ship::angle::from_deg;
use simulate::manoeuvre::ZigZagEnd;
use simulate::{Manoeuvre, Recording, Sensors, Simulation, SteeringGear, StreamKey, Vessel};

/// A 10/10 zig-zag of a first-order ship, K = 0.08 1/s, T = 25 s, 2.5 deg/s, heading noise 0.1 deg; `rows` rows half a
/// second apart.
pub fn first_order_zig_zag(rows: usize) -> Simulation {
    let period = 0.5;
    let mut sensors = Sensors::default();
    sensors.heading.noise = from_deg(0.1);
    Simulation {
        gear: SteeringGear::with_rate(from_deg(2.5)),
        recording: Recording { period, duration: Some(period * (rows - 1) as f64), ..Recording::default() },
        sensors,
        ..Simulation::new(
            Vessel::first_order(FirstOrder::from_indices(0.08, 25.0, 0.0)),
            Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0), ZigZagEnd::Record),
        )
    }
}

/// The key of the one trial that is identified.
pub const KEY: StreamKey = StreamKey { seed: 1957, cell: 0, replicate: 0 };
