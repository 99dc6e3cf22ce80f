//! Motion of a turning ship over ground.
//!
//! A response model describes the yaw of a ship; the track also depends on speed loss and drift. This module combines
//! equations of surge and sway with a yaw response into a ship for scenarios, integrates tracks, and computes the
//! characteristics of a turning circle. Speed and drift of records are identified by a hull ([`ship::vessel`]).
//!
//! | to learn about | read |
//! |---|---|
//! | the equations and their coefficients | [`PlanarCoefficients`] |
//! | coefficients with length and speed | [`PlanarModel`] |
//! | a yaw response with speed and drift | [`PlanarShip`] |
//! | the track over ground | [`dead_reckoning`] |
//! | advance, transfer, tactical diameter | [`turning_circle`] |
//! | current from two rounds | [`estimate_current`] |
//!
//! Propeller revolutions are constant, as trial procedures require; engine manoeuvres are not modelled. Water is deep
//! and at rest apart from a uniform current, which only shifts positions.

mod circle;
mod coefficients;
mod current;
mod planar;
mod planar_ship;
#[cfg(test)]
mod tests;

pub use circle::{TurningCircleCharacteristics, dead_reckoning, turning_circle};
pub use coefficients::{COEFFICIENT_COUNT, COEFFICIENT_SYMBOLS, PlanarCoefficients};
pub use current::{Current, estimate_current};
pub use planar::{MotionError, PlanarModel};
pub use planar_ship::PlanarShip;
