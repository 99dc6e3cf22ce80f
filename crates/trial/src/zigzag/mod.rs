//! Zig-zag characteristics of one record after ITTC 7.5-04-02-01: executes, initial turning time, overshoots, time to
//! check yaw, reach, period, yaw rates, each with the uncertainty that the noise of the record gives it. Works from the
//! record alone, simulated or measured. It compares with no criterion (see [`crate::imo`]) and identifies nothing; the
//! points a characteristic-point identification needs are in [`points`].
//!
//! Executes come from the rudder (`holds`, `executes`): a rudder is laid to alternate sides and the moment it starts to
//! move is where the line through its ramp leaves the level before. Everything about the heading comes from local cubic
//! fits (`heading`), so that an overshoot is the extremum of a smooth curve and not the largest of many noisy samples.

mod characteristics;
pub mod executes;
mod findings;
mod heading;
pub mod holds;
mod local;
pub mod points;
#[cfg(test)]
mod tests;

pub(crate) use executes::quantum;
pub use findings::{
    BaseCourse, BaseCourseSource, Execute, Overshoot, Pair, STRAIGHT_APPROACH, Side, ZigZag, ZigZagError,
};
pub use heading::noise_sd;
