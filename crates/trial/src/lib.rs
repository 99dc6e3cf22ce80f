//! One manoeuvring trial as a time series, simulated or measured: the only input of an identification method.
//!
//! | to learn about | read |
//! |---|---|
//! | the record itself | [`record`] |
//! | names of columns and their units | [`channel`], [`names`] |
//! | noise parameters of a record | [`noise_model`] |
//! | opening of files, with their maximum sizes | [`mod@file`] |
//! | decoders that may panic | [`decoder`] |
//! | angles in files | [`degrees`] |
//! | stamps of date and time | [`clock`] |
//! | declared particulars and conditions | [`conditions`] |
//! | reading CSV and other tables | [`reader`] and [`sidecar`] |
//! | writing CSV | [`writer`] |
//! | plausibility checks of a record | [`plausibility`] |
//! | zig-zag characteristics (ITTC) | [`zigzag`] |
//! | manoeuvres and their rudder orders | [`manoeuvre`] |
//! | manoeuvres inside a long log | [`find`] |
//! | IMO criteria | [`imo`] |
//! | records of similar ships of different size and speed | [`scale`] |

mod cells;
pub mod channel;
mod cleaning;
pub mod clock;
pub mod conditions;
#[cfg(feature = "parquet")]
pub mod decoder;
pub mod degrees;
mod encoding;
pub mod file;
pub mod find;
pub mod imo;
pub mod manoeuvre;
pub mod names;
pub mod noise_model;
pub mod plausibility;
pub mod reader;
pub mod record;
pub mod scale;
pub mod sidecar;
mod sidecar_error;
mod sidecar_keys;
#[cfg(test)]
mod testing;
mod trial_particulars;
mod wording;
pub mod writer;
pub mod zigzag;

pub use channel::Channel;
pub use conditions::{DeclaredConditions, DeclaredWeather, Loading};
pub use document::Quantity;
pub use file::FileError;
pub use manoeuvre::Manoeuvre;
pub use reader::{InstrumentLog, ReadError, ReadRecord, read, read_with_sidecar};
pub use record::wind::relative_wind;
pub use record::{Columns, RecordOrigin, RejectedReading, RudderCorner, SensorNoise, Trial, TrialError};
pub use scale::{ScaleError, ShipScales};
pub use sidecar::{Sidecar, SidecarError};
pub use trial_particulars::TrialParticulars;
pub use writer::write_csv;
pub use zigzag::{Side, ZigZag, ZigZagError};
