//! Rows of a study: one per trial and method, failed fits included. `columns` defines the columns, [`file`] stores the
//! rows of a block as Parquet and reads them back.
//!
//! No value of a row depends on the clock or the machine, so a block has the same bytes for the same scenario, seed and
//! program, for any number of threads, interruptions and shards.

mod columns;
mod file;
mod layout;
mod row;
#[cfg(test)]
mod tests;

pub use columns::{
    BASE_COLUMNS, COMMON_COLUMNS, LOCATED_COLUMNS, PREDICT_COLUMNS, RECORD_COLUMNS, RowColumn, TRACE_COLUMNS,
};
pub use file::{BlockFileError, BlockLabel, decode, encode};
pub use layout::RowLayout;
pub use row::{EffectParameterValue, LocatedMoment, NamedEffect, PredictedCharacteristic, StudyRow, TraceRow};
