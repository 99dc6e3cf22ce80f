//! Rows of a study: one per trial and method, a failed fit included. `columns` says how a row looks to other programs,
//! [`file`] stores rows as Parquet and reads them back a few at a time, [`Sequence`] says whether all are there.
//!
//! Nothing that depends on the clock or the machine is in a row, so a file has the same bytes for the same scenario and
//! seed whatever the number of threads, interruptions and shards.

mod columns;
mod file;
mod layout;
mod row;
mod sequence;
#[cfg(test)]
mod tests;

pub use columns::{COLUMNS, OWN_COLUMNS, PREDICT_COLUMNS, RowColumn, TRACE_COLUMNS};
pub use file::{RowReader, RowWriter};
pub use layout::RowLayout;
pub use row::{NamedEffect, PredictedFigure, StudyRow, TraceAnswer};
pub use sequence::Sequence;
