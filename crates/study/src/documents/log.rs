//! A log as the answers of several commands name it.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use trial::Log;

/// A log.
#[derive(Serialize, JsonSchema)]
pub struct LogEntry {
    /// The file as it was named.
    pub file: String,
    /// Number of rows: instants at which heading, rudder or yaw rate was read.
    pub rows: usize,
    /// Length, s.
    pub duration_s: f64,
    /// Its first day, where it has a clock with dates.
    pub date: Option<String>,
}

impl LogEntry {
    /// The log of a file.
    pub fn of(file: &Path, log: &Log) -> Self {
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
