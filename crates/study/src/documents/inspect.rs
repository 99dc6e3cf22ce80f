//! Result of `study inspect`: the channels of a log.

use std::path::Path;

use document::{Warning, names};
use schemars::JsonSchema;
use serde::Serialize;
use trial::reader::ChannelInspection;
use trial::{Channel, InstrumentLog};

use super::answers::CommandAnswer;
use super::log::LogEntry;

/// Minimum time between two readings that counts as a gap, in median intervals.
const MIN_GAP: f64 = 1.5;

/// Result for one log.
#[derive(Serialize, JsonSchema)]
pub struct InspectAnswer {
    /// File, number of rows, duration and date of the log.
    #[serde(flatten)]
    pub log: LogEntry,
    /// Channels of the log.
    pub channels: Vec<ChannelEntry>,
    /// Warnings of the reader, the worst first.
    pub warnings: Vec<Warning>,
}

impl CommandAnswer for InspectAnswer {
    const SCHEMA: &'static str = "inspect/1";
}

/// Channel of a log.
#[derive(Serialize, JsonSchema)]
pub struct ChannelEntry {
    /// Name, such as `yaw rate`.
    pub channel: String,
    /// Column or instrument that is the source; `null` if the channel was computed from others.
    pub source: Option<String>,
    /// Number of readings.
    pub readings: usize,
    /// Median time from one reading to the next.
    pub interval_s: Option<f64>,
    /// Maximum time from one reading to the next, if it exceeds one and a half times the median.
    pub longest_gap_s: Option<f64>,
    /// Beginning of the longest gap.
    pub longest_gap_from_s: Option<f64>,
    /// Unit of `lowest`, `highest` and `step`.
    pub unit: String,
    /// Minimum reading; a heading is continued past north.
    pub lowest: f64,
    /// Maximum reading.
    pub highest: f64,
    /// Minimum change from one reading to the next.
    pub step: Option<f64>,
    /// Number of times a heading crosses north.
    pub wraps: Option<usize>,
    /// Side to which positive values turn the ship, `starboard` or `port`; `null` if it cannot be determined.
    pub turns_to: Option<String>,
    /// Reference channel of the comparison.
    pub reference: Option<String>,
    /// Factor from this channel to the reference: negative if its sign is reversed.
    pub scale: Option<f64>,
    /// Lag of this channel behind the reference.
    pub lag_s: Option<f64>,
}

impl From<&ChannelInspection> for ChannelEntry {
    fn from(ChannelInspection { readings, to_starboard, relation }: &ChannelInspection) -> Self {
        let unit = readings.channel.written_unit();
        let shown = |value: f64| value / unit.si_factor();
        let side = |to_starboard: bool| if to_starboard { "starboard" } else { "port" };
        let spoken = |channel: Channel| names::with_blanks(channel.label());
        let gap =
            readings.longest_gap.filter(|[_, way]| readings.median_interval.is_none_or(|usual| *way > MIN_GAP * usual));
        Self {
            channel: spoken(readings.channel),
            source: readings.source.clone(),
            readings: readings.reading_count,
            interval_s: readings.median_interval,
            longest_gap_s: gap.map(|[_, way]| way),
            longest_gap_from_s: gap.map(|[begin, _]| begin),
            unit: unit.id().to_owned(),
            lowest: shown(readings.value_range[0]),
            highest: shown(readings.value_range[1]),
            step: readings.smallest_change.map(shown),
            wraps: readings.north_crossings,
            turns_to: to_starboard.map(|to_starboard| side(to_starboard).to_owned()),
            reference: relation.map(|relation| spoken(relation.reference)),
            scale: relation.map(|relation| relation.factor_to_reference),
            lag_s: relation.and_then(|relation| relation.lag_behind_reference),
        }
    }
}

impl InspectAnswer {
    /// Entry of a log with its warnings.
    pub fn from_log(file: &Path, log: &InstrumentLog, warnings: Vec<Warning>) -> Self {
        Self {
            log: LogEntry::from_log(file, log),
            channels: log.inspect().iter().map(ChannelEntry::from).collect(),
            warnings,
        }
    }
}
