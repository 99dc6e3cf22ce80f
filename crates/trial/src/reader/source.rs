//! Logs and channels of files before they become a record: series at separate instants, and the columns made by
//! [`super::assemble`].

use std::ops::RangeInclusive;
use std::path::PathBuf;

use document::Warning;
use estimation::statistics::upper_median;

use crate::channel::Channel;
use crate::clock::Clock;
use crate::plausibility::extremes;
use crate::record::{Columns, RejectedReading};
use crate::sidecar::Sidecar;

/// Maximum change by rounding of the arithmetic, in SI units and radians.
const ROUNDING: f64 = 1e-9;

/// Time series of a channel at separate sampling instants.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// Channel; values are in SI units and radians.
    pub channel: Channel,
    /// Instants, s, on the clock of the file; strictly increasing.
    pub time: Vec<f64>,
    /// Values; NaN for a missing reading. Headings are not unwrapped.
    pub values: Vec<f64>,
    /// Name of the column or instrument; `None` if it is unknown.
    pub source: Option<String>,
}

/// Readings of a log for [`InstrumentLog::inspect`], before the log was joined or completed.
#[derive(Debug, Clone, Default)]
pub(super) enum Readings {
    /// Columns of the log, which contain readings only.
    #[default]
    InColumns,
    /// The columns as read.
    Columns(Columns),
    /// Channels at separate instants, each with the shift (s) from its clock to the clock of the log.
    Series(Vec<(Series, f64)>),
}

/// Log: the columns of one or several files, cleaned and on a common clock.
#[derive(Debug, Clone, Default)]
pub struct InstrumentLog {
    pub(super) path: PathBuf,
    pub(super) columns: Columns,
    /// Clock at time 0; `None` if the files state neither date nor time of day.
    pub clock: Option<Clock>,
    /// SHA-256 of the bytes of the file, hexadecimal; of joined files, the SHA-256 of their two hashes as text.
    pub(super) sha256: String,
    /// Number of rows or lines of the files.
    pub(super) rows: usize,
    pub(super) sidecar: Sidecar,
    /// First and last time of a selected part, s; `None` for the whole log.
    pub(super) part: Option<[f64; 2]>,
    /// Decisions and remarks of the reader.
    pub warnings: Vec<Warning>,
    /// Readings set to missing or reported as doubtful.
    pub(super) rejected: Vec<RejectedReading>,
    /// Names of the columns of channels.
    pub(super) names: Vec<(Channel, String)>,
    /// Readings of every channel.
    pub(super) readings: Readings,
}

/// Statistics of the readings of a channel, in SI units and radians; headings unwrapped.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelReadings {
    /// Channel.
    pub channel: Channel,
    /// Name of the column or instrument; `None` for a derived channel.
    pub source: Option<String>,
    /// Number of readings.
    pub reading_count: usize,
    /// Median interval between readings, s; `None` for fewer than two readings.
    pub median_interval: Option<f64>,
    /// Beginning and length of the maximum gap between readings, s; `None` for fewer than two readings.
    pub longest_gap: Option<[f64; 2]>,
    /// Minimum and maximum reading.
    pub value_range: [f64; 2],
    /// Minimum change between two successive readings, without repetitions; `None` for a constant channel.
    pub smallest_change: Option<f64>,
    /// Number of times that a heading crosses north; `None` for any other channel.
    pub north_crossings: Option<usize>,
}

impl ChannelReadings {
    /// Statistics of a channel; `shift` (s) is added to the times of its clock.
    fn new(channel: Channel, source: Option<String>, time: &[f64], values: &[f64], shift: f64) -> Self {
        let read = time.iter().zip(values).filter(|(_, value)| value.is_finite());
        let read: Vec<(f64, f64)> = read.map(|(t, value)| (*t, *value)).collect();
        let gaps = || read.windows(2).map(|pair| [pair[0].0, pair[1].0 - pair[0].0]);
        let longest = gaps().max_by(|first, second| first[1].total_cmp(&second[1]));
        let changes = read.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).filter(|change| *change > ROUNDING);
        let (low, high) = extremes(read.iter().map(|(_, value)| *value));
        let turns = |value: f64| (value / std::f64::consts::TAU).floor();
        let crossings = || read.windows(2).filter(|pair| turns(pair[0].1) != turns(pair[1].1)).count();
        Self {
            channel,
            source,
            reading_count: read.len(),
            median_interval: upper_median(gaps().map(|[_, length]| length)),
            longest_gap: longest.map(|[begin, length]| [begin + shift, length]),
            value_range: [low, high],
            smallest_change: changes.min_by(f64::total_cmp),
            north_crossings: (channel == Channel::Heading).then(crossings),
        }
    }
}

impl Series {
    /// Series within a part of the log, s, both ends included.
    pub(super) fn within(mut self, part: &RangeInclusive<f64>) -> Self {
        let rows = self.time.partition_point(|t| t < part.start())..self.time.partition_point(|t| t <= part.end());
        for column in [&mut self.time, &mut self.values] {
            column.truncate(rows.end);
            column.drain(..rows.start);
        }
        self
    }
}

impl InstrumentLog {
    /// Statistics of the readings of every channel.
    pub(super) fn readings(&self) -> Vec<ChannelReadings> {
        let columns = match &self.readings {
            Readings::InColumns => &self.columns,
            Readings::Columns(columns) => columns,
            Readings::Series(all) => {
                let all = all.iter().map(|(Series { channel, time, values, source }, shift)| {
                    ChannelReadings::new(*channel, source.clone(), time, values, *shift)
                });
                return all.collect();
            }
        };
        let all = columns.channels.iter().map(|(channel, values)| {
            ChannelReadings::new(*channel, self.column_name(*channel), &columns.time, values, 0.0)
        });
        all.collect()
    }

    /// Name of the column of a channel; `None` for a derived channel and for an instrument.
    pub(super) fn column_name(&self, channel: Channel) -> Option<String> {
        self.names.iter().find(|(named, _)| *named == channel).map(|(_, name)| name.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A damaged file may contain any number.
    #[test]
    fn headings_of_any_size_pass_north_once_a_row() {
        let values = vec![6.2, 6.4, 1e300, -1e300, 1e300];
        let time = (0..values.len()).map(|row| row as f64).collect();
        let columns = Columns { time, channels: [(Channel::Heading, values)].into(), unknown_columns: Vec::new() };
        assert_eq!(InstrumentLog { columns, ..InstrumentLog::default() }.readings()[0].north_crossings, Some(4));
    }
}
