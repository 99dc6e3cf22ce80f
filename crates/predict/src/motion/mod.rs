//! Speed and drift of a turning ship: what a yaw response lacks before a track can be drawn from it.
//!
//! A response model says how a ship turns. Where it goes depends on how much speed it loses and how far it slips
//! sideways, and records of zig-zag trials and turning circles tell both. This module fits two equations in surge and
//! sway to such records, joins them with a yaw response to a ship that can be steered, draws tracks, and reads the
//! figures of a turning circle off them. It identifies no yaw response and simulates no manoeuvre.
//!
//! | to learn about | read |
//! |---|---|
//! | the equations and their coefficients | [`PlanarCoefficients`] |
//! | coefficients with length, speed and covariance | [`Planar`] |
//! | fitting them to records | [`fit()`] |
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
mod error;
mod fit;
mod planar;
mod planar_ship;
mod record;
mod search;
#[cfg(test)]
mod tests;

pub use circle::{TurningCircleFigures, track, turning_circle};
pub use coefficients::{COEFFICIENTS, PlanarCoefficients, SYMBOLS};
pub use current::{Current, current};
pub use error::MotionError;
pub use fit::fit;
pub use planar::{MotionRecordFit, Planar, Residual};
pub use planar_ship::PlanarShip;
pub use record::MotionOutput;
