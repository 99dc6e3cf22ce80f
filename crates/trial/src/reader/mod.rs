//! Reader of measured trials: a table, text or binary, with a sidecar if its columns require a description, becomes a
//! [`Trial`](crate::Trial), or a single error with its place and a remedy. Every decision of the reader is a warning.
//!
//! A table has one row per line below a header of `quantity_unit` names (see [`crate::channel`]), separated by commas,
//! semicolons, tabs or blanks. Lines that start with `#` and empty lines are skipped; a commented header is used if
//! the rows have none. Headings may wrap; cells may be empty. Rows without time are omitted. A missing rudder angle is
//! interpolated between its neighbours; rows in a gap of the rudder are omitted. Rows without a heading are kept. A
//! missing speed is √(u² + v²) of surge and sway. Sentinels of loggers, impossible rudder angles, repeated values and a
//! frozen heading are omitted and reported, unless a sidecar has `plausibility = false`. A sidecar describes tables
//! with other names ([`crate::sidecar`]).

mod assemble;
mod choice;
mod code;
mod columnar;
mod counts;
mod description;
mod error;
mod head;
mod input;
mod inspection;
mod instants;
mod layout;
mod limits;
mod lines;
mod log;
mod messages;
mod nmea;
mod position;
mod rows;
mod rudder;
mod source;
mod table;
#[cfg(test)]
mod tests;
mod units;

pub use description::draft_sidecar;
pub use error::{ReadError, ReadProblem};
pub use inspection::{ChannelInspection, ChannelRelation};
pub use limits::{MAX_CELLS, MAX_ROWS, RECORD_FILE};
pub use lines::MAX_LINE_BYTES;
pub use log::{ReadRecord, read, read_from_reader, read_with_sidecar};

pub use source::{ChannelReadings, InstrumentLog};

pub use crate::cells::Separator;
pub use crate::encoding::Encoding;
