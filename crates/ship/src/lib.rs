//! Ship models: response models of the Nomoto family, the effects that can be added to them, and hulls with three
//! degrees of freedom, which serve as the true ship and match no response model exactly.
//!
//! The crate describes how a ship turns when its rudder moves. Manoeuvres, sensors, records and identification are in
//! other crates.
//!
//! | to learn about | read |
//! |---|---|
//! | the first-order response and its closed form | [`first_order`] |
//! | effects that a first-order response lacks | [`effects`] |
//! | a response model: base plus effects | [`response`] |
//! | the interface of every simulated ship | [`dynamics`] |
//! | integration in time | [`integrate`] and [`replay`] |
//! | dual numbers, which carry derivatives | [`number`] |
//! | hulls with three degrees of freedom | [`vessel`] |
//! | linear sway-yaw equations and their indices | [`linear`] |
//! | parameter sets with their sources | [`ships`] |
//! | numbers in messages | [`short_number`] |
//!
//! All quantities are in SI units and radians. Positive rudder gives positive (starboard) yaw rate. Heading increases
//! clockwise seen from above. `v` is positive to starboard.
#![expect(non_snake_case, reason = "K, T and U are the symbols of the field, Xvv and the like those of the sources")]

pub mod angle;
pub mod dynamics;
pub mod effects;
pub mod first_order;
pub mod integrate;
pub mod linear;
pub mod narrow_band;
pub mod number;
pub mod particulars;
pub mod replay;
pub mod replayable;
pub mod response;
pub mod ships;
pub mod short_number;
pub mod signal;
pub mod vessel;

pub use dynamics::{Dynamics, MeasuredChannels, Motion, RegressorChannel, ShipInput};
pub use effects::EffectReal;
pub use estimation::number::Real;
pub use first_order::FirstOrder;
pub use number::{TANGENT_DERIVATIVES, Tangent};
pub use particulars::Particulars;
pub use replayable::{Replayable, ReplayedShip};
pub use response::{Response, ResponseModel};
pub use ships::Ship;
pub use short_number::ShortNumber;
pub use signal::Polyline;
