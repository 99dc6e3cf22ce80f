//! Rows of a study: one per trial and method, a failed fit included. `columns` says how a row looks to other programs,
//! [`file`] stores the rows of a block as Parquet and reads them back.
//!
//! Nothing that depends on the clock or the machine is in a row, so a block has the same bytes for the same scenario,
//! seed and program whatever the number of threads, interruptions and shards.

mod columns;
mod file;
mod layout;
mod row;
#[cfg(test)]
mod tests;

pub use columns::{COLUMNS, LOCATED_COLUMNS, OWN_COLUMNS, PREDICT_COLUMNS, RECORD_COLUMNS, RowColumn, TRACE_COLUMNS};
pub use file::{BlockLabel, Damage, decode, encode};
pub use layout::RowLayout;
pub use row::{EffectSize, LocatedMoment, NamedEffect, PredictedFigure, StudyRow, TraceAnswer};
