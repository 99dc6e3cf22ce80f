//! The way of a turning ship over ground.
//!
//! A response model says how a ship turns. Where it goes depends on how much speed it loses and how far it slips
//! sideways. This module joins two equations in surge and sway with a yaw response to a ship that a scenario can steer,
//! draws tracks, and reads the figures of a turning circle off them. What records tell of speed and drift is a hull.
//!
//! | to learn about | read |
//! |---|---|
//! | the equations and their coefficients | [`PlanarCoefficients`] |
//! | coefficients with length and speed | [`Planar`] |
//! | a yaw response with speed and drift | [`PlanarShip`] |
//! | the path over ground | [`track`] |
//! | advance, transfer, tactical diameter | [`turning_circle`] |
//! | a current that two rounds show | [`current`](current()) |
//!
//! Propeller revolutions are constant, as they are in trials that keep to the rules; a ship that is slowed down by its
//! engine is not described. Water is deep and at rest apart from a uniform current that only moves positions.

mod circle;
mod coefficients;
mod current;
mod planar;
mod planar_ship;
#[cfg(test)]
mod tests;

pub use circle::{TurningCircleFigures, track, turning_circle};
pub use coefficients::{COEFFICIENTS, PlanarCoefficients, SYMBOLS};
pub use current::{Current, current};
pub use planar::{MotionError, Planar};
pub use planar_ship::PlanarShip;
