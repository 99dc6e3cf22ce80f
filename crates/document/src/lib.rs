//! Documents: results exchanged between crates and written to files.
//!
//! | to learn about | read |
//! |---|---|
//! | a number with its uncertainty | [`Quantity`] |
//! | the noise of a record | [`noise`] |
//! | an identified ship in files | [`identified_ship`], [`identified_hull`] |
//! | the document of a fit | [`fit`], [`scales`], [`earlier_trials`] |
//! | the estimate of a method | [`method`] |
//! | the document of a trace | [`trace`] |
//! | display names of effects, records and figures of merit | [`names`] |
//! | ship, date and draughts of a trial | [`TrialParticularsEntry`] |
//! | warnings | [`warning`] |
//! | machine-readable error codes | [`ErrorCode`] |

mod display;
pub mod earlier_trials;
pub mod error;
mod error_code;
pub mod fit;
pub mod identified_hull;
pub mod identified_ship;
mod imo_form;
pub mod method;
pub mod names;
pub mod noise;
mod quantity;
pub mod scales;
pub mod single_records;
pub mod trace;
mod trial_particulars;
pub mod warning;

pub use error::IdentifiedShipError;
pub use error_code::ErrorCode;
pub use identified_hull::{IdentifiedCoefficient, IdentifiedHull, RandomYawMoment};
pub use identified_ship::{IdentifiedEffect, IdentifiedGear, IdentifiedShip, ValidityRange, WeightedStructure};
pub use imo_form::ImoFormEntry;
pub use noise::{HeadingNoise, MomentKind, RandomMoment};
pub use quantity::Quantity;
pub use trial_particulars::TrialParticularsEntry;
pub use warning::{Severity, Warning, WarningCode, WarningSource, Warnings};
