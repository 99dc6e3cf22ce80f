//! Entry of a log, shared by the results of several commands.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use trial::InstrumentLog;

/// Entry of a log.
#[derive(Serialize, JsonSchema)]
pub struct LogEntry {
    /// The file as it was named.
    pub file: String,
    /// Number of rows: instants with a reading of heading, rudder or yaw rate.
    pub rows: usize,
    /// Duration, s.
    pub duration_s: f64,
    /// Date of the first row, if the clock has dates.
    pub date: Option<String>,
}

impl LogEntry {
    /// Entry of the log of a file.
    pub fn from_log(file: &Path, log: &InstrumentLog) -> Self {
        let time = log.time();
        let ends = time.first().zip(time.last());
        Self {
            file: file.display().to_string(),
            rows: time.len(),
            duration_s: ends.map_or(0.0, |(first, last)| last - first),
            date: log.date(),
        }
    }
}
