//! Simulated sea trials: a record and the corresponding true motion, from a ship and a manoeuvre.
//!
//! A [`Simulation`] is an immutable specification. One call of [`Simulation::run`] with a [`StreamKey`] makes one
//! trial, identical to the last bit in every repetition. The crate is independent of identification.
//!
//! | to learn about | read |
//! |---|---|
//! | the whole specification, and the result | [`simulation`] |
//! | ships, and the use of closed forms | [`simulated_ship`] |
//! | speed and drift of a turn, tracks, turning circles | [`motion`] |
//! | zig-zag, turning circle, pull-out, replay | [`trial::manoeuvre`] |
//! | helmsman | [`helm`] |
//! | rate limit, lag, dead time and dead band of the rudder | [`gear`] |
//! | wind, gusts, squalls, drift, waves | [`disturbance`] |
//! | noise, quantisation, lag, coloured error, spikes, clocks, drop-outs | [`sensor`] |
//! | recorded part of a run | [`recording`] |
//! | random number streams | [`stream`] |
//! | assumptions of left-out settings | [`assumption`] |
//! | cost of a run | [`cost`], [`limits`] |
//! | errors | [`error`] |
//!
//! ```
//! use ship::{FirstOrder, angle::from_deg};
//! use kempf_simulate::{Manoeuvre, SimulatedShip, Simulation, SteeringGear, StreamKey};
//!
//! let ship = SimulatedShip::from_first_order(FirstOrder::from_indices(0.1, 16.3, 0.0));
//! let zig_zag = Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0)).until_execute(5);
//! let mut simulation = Simulation::new(ship, zig_zag);
//! simulation.gear = SteeringGear::with_rate(from_deg(2.32));
//! simulation.sensors.heading_noise = from_deg(0.1);
//! let simulated = simulation.run(&StreamKey { seed: 1, cell: 0, replicate: 0 })?;
//! assert!((simulated.truth.execute_orders[1].time - 24.24).abs() < 0.01);
//! # Ok::<(), kempf_simulate::SimulateError>(())
//! ```
//!
//! The types of a specification are the types of a scenario file, which has degrees, and units in the keys. In memory,
//! time is in seconds from the beginning of the run, and all quantities are in SI units and radians.

mod compass_error;
mod display;
mod manoeuvre;
mod measure;
mod prepared;
mod propagate;
mod root;
mod run;
mod sample;
#[cfg(test)]
mod tests;
mod wave_path;
mod weather;

pub mod assumption;
pub mod cost;
pub mod disturbance;
pub mod error;
pub mod gear;
pub mod helm;
pub mod limits;
pub mod motion;
pub mod recording;
pub mod sensor;
pub mod simulated_ship;
pub mod simulation;
pub mod stream;

pub use assumption::Assumption;
pub use disturbance::Disturbances;
pub use error::{Requirement, SimulateError, SpecificationError};
pub use gear::SteeringGear;
pub use helm::{HelmOrder, Helmsman};
pub use prepared::PreparedSimulation;
pub use recording::Recording;
pub use sensor::Sensors;
pub use simulated_ship::{SimulatedShip, Solver};
pub use simulation::{Approach, SimulatedTrial, Simulation, Truth};
pub use stream::{RngPurpose, StreamKey};
pub use trial::{Manoeuvre, Side};
