//! The manoeuvres of logs for other programs.

use std::path::Path;

use document::Warning;
use schemars::JsonSchema;
use serde::Serialize;
use ship::angle::to_deg;
use trial::Log;
use trial::find::FoundManoeuvre;

use super::answers::CommandAnswer;
use super::log::LogEntry;

/// The manoeuvres of some logs.
#[derive(Serialize, JsonSchema)]
pub struct FindAnswer {
    /// The logs in the order they were named.
    pub logs: Vec<SearchedLog>,
    /// Warnings of the reader, the worst first.
    pub warnings: Vec<Warning>,
}

impl CommandAnswer for FindAnswer {
    const SCHEMA: &'static str = "find/1";
}

/// A log with its manoeuvres.
#[derive(Serialize, JsonSchema)]
pub struct SearchedLog {
    /// The log.
    #[serde(flatten)]
    pub log: LogEntry,
    /// Its manoeuvres in order of time.
    pub manoeuvres: Vec<ManoeuvreEntry>,
}

/// A manoeuvre inside a log.
#[derive(Serialize, JsonSchema)]
pub struct ManoeuvreEntry {
    /// Its number, as `--trial` takes it.
    pub trial: usize,
    /// What it is, such as `zig-zag 10/10`.
    pub kind: String,
    /// Its begin, s.
    pub from_s: f64,
    /// Its end, s.
    pub until_s: f64,
    /// What the clock shows at both.
    pub clock: Option<[String; 2]>,
    /// How often the rudder is put over.
    pub executes: usize,
    /// Rudder angle, deg.
    pub rudder_deg: Option<f64>,
    /// Heading angle at which it is put over, deg.
    pub heading_deg: Option<f64>,
    /// What is odd about it.
    pub remarks: Vec<String>,
}

impl SearchedLog {
    /// A log with what was found in it.
    pub fn of(file: &Path, log: &Log, found: &[FoundManoeuvre]) -> Self {
        let clock = |time: f64| log.clock.map(|clock| clock.at(time).to_string());
        let manoeuvre = |(trial, one): (usize, &FoundManoeuvre)| {
            let [rudder_deg, heading_deg] = one.angles().map(|angle| angle.map(to_deg));
            ManoeuvreEntry {
                trial,
                kind: one.name(),
                from_s: one.from,
                until_s: one.until,
                clock: clock(one.from).zip(clock(one.until)).map(|(from, until)| [from, until]),
                executes: one.executes,
                rudder_deg,
                heading_deg,
                remarks: one.quality.remarks(),
            }
        };
        Self { log: LogEntry::of(file, log), manoeuvres: (1..).zip(found).map(manoeuvre).collect() }
    }
}
