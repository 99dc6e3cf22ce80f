//! Documents: the results that cross between crates and into files.
//!
//! | to learn about | read |
//! |---|---|
//! | a number with its error | [`Quantity`] |
//! | the noise of a record | [`noise`] |
//! | an identified ship, as files hold it | [`identified_ship`], [`stored_hull`] |
//! | what a fit says | [`fit`], [`scales`], [`earlier_trials`] |
//! | the answer of a method | [`method`] |
//! | what a trace says | [`trace`] |
//! | what people call effects, records and figures of merit | [`names`] |
//! | ship, day and draughts of a trial | [`TrialParticularsEntry`] |
//! | what a reader should know beside the numbers | [`warning`] |
//! | what an error is about, for programs | [`ErrorCode`] |

pub mod earlier_trials;
pub mod error;
mod error_code;
pub mod fit;
mod form;
pub mod identified_ship;
pub mod method;
pub mod names;
pub mod noise;
mod quantity;
pub mod scales;
mod shown;
pub mod single_records;
pub mod stored_hull;
pub mod trace;
mod trial_particulars;
pub mod warning;

pub use error::IdentifiedShipError;
pub use error_code::ErrorCode;
pub use form::ImoFormEntry;
pub use identified_ship::{IdentifiedShip, KnownGear, StoredEffect, ValidityRange, WeightedStructure};
pub use noise::{HeadingNoise, Moment, RandomMoment};
pub use quantity::Quantity;
pub use stored_hull::{RandomYawMoment, StoredCoefficient, StoredHull};
pub use trial_particulars::TrialParticularsEntry;
pub use warning::{Code, Severity, Source, Warning, Warnings};
