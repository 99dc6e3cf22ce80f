//! Trials at sea in a computer: a vessel in, a record and the truth behind it out.
//!
//! A [`Simulation`] is a specification: nothing in it changes while it runs. One call of [`Simulation::run`] with a
//! [`StreamKey`] makes one trial, bit for bit the same every time it is called. The crate knows nothing of
//! identification, and nothing that identifies can reach this crate.
//!
//! | to learn about | read |
//! |---|---|
//! | the whole specification, and the result | [`simulation`] |
//! | what can be steered, and when its closed form is used | [`vessel`] |
//! | speed and drift of a turn, tracks, turning circles | [`motion`] |
//! | zig-zag, turning circle, pull-out, replay | [`trial::manoeuvre`] |
//! | who reads the compass and turns the wheel | [`helm`] |
//! | rate limit, lag, dead time and dead band of the rudder | [`gear`] |
//! | wind, gusts, squalls, drift, waves | [`disturbance`] |
//! | noise, quantisation, lag, coloured error, spikes, clocks, drop-outs | [`sensor`] |
//! | which part of the run is recorded | [`recording`] |
//! | where random numbers come from | [`stream`] |
//! | what is taken for granted | [`assumption`] |
//! | what a run may cost | [`cost`], [`limits`] |
//! | what can go wrong | [`error`] |
//!
//! ```
//! use ship::{FirstOrder, angle::from_deg};
//! use kempf_simulate::{Manoeuvre, Simulation, SteeringGear, StreamKey, Vessel};
//!
//! let vessel = Vessel::first_order(FirstOrder::from_indices(0.1, 16.3, 0.0));
//! let zig_zag = Manoeuvre::zig_zag(from_deg(10.0), from_deg(10.0)).until_execute(5);
//! let mut simulation = Simulation::new(vessel, zig_zag);
//! simulation.gear = SteeringGear::with_rate(from_deg(2.32));
//! simulation.sensors.heading_noise = from_deg(0.1);
//! let simulated = simulation.run(&StreamKey { seed: 1, cell: 0, replicate: 0 })?;
//! assert!((simulated.truth.executes[1].time - 24.24).abs() < 0.01);
//! # Ok::<(), kempf_simulate::SimulateError>(())
//! ```
//!
//! A setting is declared once: the types of a specification are those that a scenario file holds, with degrees and
//! units in its keys. In the program time is in seconds from the beginning of the run, everything else in SI units and
//! radians.

mod display;
mod manoeuvre;
mod measure;
mod propagate;
mod root;
mod run;
mod sample;
#[cfg(test)]
mod tests;
mod wander;
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
pub mod simulation;
pub mod stream;
pub mod vessel;

pub use assumption::Assumption;
pub use disturbance::Disturbances;
pub use error::{Expected, SimulateError, SpecificationError};
pub use gear::SteeringGear;
pub use helm::{HelmOrder, Helmsman};
pub use recording::Recording;
pub use sensor::Sensors;
pub use simulation::{BeforeExecute, PreparedSimulation, Simulated, Simulation, Truth};
pub use stream::{Purpose, StreamKey};
pub use trial::{Manoeuvre, Side};
pub use vessel::{Solver, Vessel};
