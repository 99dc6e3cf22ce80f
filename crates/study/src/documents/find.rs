//! Manoeuvres of logs for other programs.

use std::path::Path;

use document::Warning;
use schemars::JsonSchema;
use serde::Serialize;
use ship::angle::to_deg;
use trial::InstrumentLog;
use trial::find::DetectedManoeuvre;

use super::answers::CommandAnswer;
use super::log::LogEntry;

/// Manoeuvres of some logs.
#[derive(Serialize, JsonSchema)]
pub struct FindAnswer {
    /// The logs in the order in which they were given.
    pub logs: Vec<SearchedLog>,
    /// Warnings of the reader, the worst first.
    pub warnings: Vec<Warning>,
}

impl CommandAnswer for FindAnswer {
    const SCHEMA: &'static str = "find/1";
}

/// Log with its manoeuvres.
#[derive(Serialize, JsonSchema)]
pub struct SearchedLog {
    /// The log.
    #[serde(flatten)]
    pub log: LogEntry,
    /// Manoeuvres in order of time.
    pub manoeuvres: Vec<ManoeuvreEntry>,
}

/// Manoeuvre inside a log.
#[derive(Serialize, JsonSchema)]
pub struct ManoeuvreEntry {
    /// Number of the manoeuvre, as in `--trial`.
    pub trial: usize,
    /// Name, such as `zig-zag 10/10`.
    pub kind: String,
    /// Beginning, s.
    pub from_s: f64,
    /// End, s.
    pub until_s: f64,
    /// Clock readings at beginning and end.
    pub clock: Option<[String; 2]>,
    /// Number of executes.
    pub executes: usize,
    /// Rudder angle, deg.
    pub rudder_deg: Option<f64>,
    /// Heading angle at which the rudder is put over, deg.
    pub heading_deg: Option<f64>,
    /// Remarks on the quality of the manoeuvre.
    pub remarks: Vec<String>,
}

impl SearchedLog {
    /// Entry of a log with its manoeuvres.
    pub fn from_log(file: &Path, log: &InstrumentLog, manoeuvres: &[DetectedManoeuvre]) -> Self {
        let clock = |time: f64| log.clock.map(|clock| clock.time_of_day_at(time).to_string());
        let manoeuvre = |(trial, manoeuvre): (usize, &DetectedManoeuvre)| {
            let [rudder_deg, heading_deg] = manoeuvre.angles().map(|angle| angle.map(to_deg));
            ManoeuvreEntry {
                trial,
                kind: manoeuvre.name(),
                from_s: manoeuvre.start_time,
                until_s: manoeuvre.end_time,
                clock: clock(manoeuvre.start_time).zip(clock(manoeuvre.end_time)).map(|(from, until)| [from, until]),
                executes: manoeuvre.execute_count,
                rudder_deg,
                heading_deg,
                remarks: manoeuvre.quality.remarks(),
            }
        };
        Self { log: LogEntry::from_log(file, log), manoeuvres: (1..).zip(manoeuvres).map(manoeuvre).collect() }
    }
}
