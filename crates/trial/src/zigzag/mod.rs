//! Zig-zag characteristics of a record after ITTC 7.5-04-02-01 (2017): executes, initial turning time, overshoots, time
//! to check yaw, reach, period and yaw rates, each with its uncertainty from the noise of the record. The criteria are
//! in [`crate::imo`], the points for characteristic-point identification in [`points`].
//!
//! Executes come from the rudder (`holds`, `executes`): the rudder is laid to alternate sides, and an execute is the
//! instant at which the line through its ramp meets the level before. Headings come from local cubic fits (`heading`),
//! so that an overshoot is the extremum of a smooth curve and not the maximum of many noisy samples.

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
    BaseCourse, BaseCourseSource, Execute, MAX_APPROACH_RATE_SHARE, NominalAngles, Overshoot, Side, ZigZag, ZigZagError,
};
pub use heading::noise_sd;
