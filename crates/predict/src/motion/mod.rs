//! Speed and drift of a turning ship: what a yaw response lacks before a track can be drawn from it.
//!
//! A response model says how a ship turns. Where it goes depends on how much speed it loses and how far it slips
//! sideways, and records of zig-zag trials and turning circles tell both. This crate fits two equations in surge and
//! sway to such records, joins them with a yaw response to a ship that can be steered, draws tracks, and reads the
//! figures of a turning circle off them. Where a record has drift the yaw equation can be fitted beside them: a hull of
//! three degrees of freedom. It identifies no yaw response and simulates no manoeuvre.
//!
//! | to learn about | read |
//! |---|---|
//! | the equations and their coefficients | [`PlanarCoefficients`] |
//! | coefficients with length, speed and covariance | [`Planar`] |
//! | fitting them to records | [`fit()`] |
//! | a yaw response with speed and drift | [`PlanarShip`] |
//! | the yaw equation and its coefficients | [`Yaw`] |
//! | surge, sway and yaw fitted to records | [`fit_hull`] |
//! | a hull of three degrees of freedom | [`IdentifiedHull`] |
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
mod hull;
mod hull_fit;
mod moment;
mod planar;
mod planar_ship;
mod record;
mod search;
#[cfg(test)]
mod tests;
mod windows;
mod yaw;

pub use circle::{TurningCircleFigures, track, turning_circle};
pub use coefficients::{COEFFICIENTS, PlanarCoefficients, SYMBOLS};
pub use current::{Current, current};
pub use error::MotionError;
pub use fit::fit;
pub use hull::{HULL_COEFFICIENTS, HullRecord, IdentifiedHull, RandomYawMoment, Spread};
pub use hull_fit::fit_hull;
pub use planar::{MotionRecordFit, Planar, Residual};
pub use planar_ship::PlanarShip;
pub use record::MotionOutput;
pub use yaw::{YAW_COEFFICIENTS, YAW_SYMBOLS, Yaw};
