//! What files hold before it is a record: channels, each at its own instants, and the columns that
//! [`super::assemble`] makes of them.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use document::Warning;
use estimation::statistics::upper_median;

use crate::channel::Channel;
use crate::clock::Clock;
use crate::plausibility::extremes;
use crate::record::{Columns, RejectedReading};
use crate::sidecar::Sidecar;

/// Changes below this are rounding of the arithmetic, in SI units and radians.
const ROUNDING: f64 = 1e-9;

/// A channel at its own instants.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// What it holds, in SI units and radians.
    pub channel: Channel,
    /// Instants, s, on the clock of the file; strictly increasing.
    pub time: Vec<f64>,
    /// Values; NaN where nothing was read. Headings are not unwrapped.
    pub values: Vec<f64>,
    /// The column or instrument that gives it, where that has a name.
    pub source: Option<String>,
}

/// What one or several files hold, cleaned and on one clock.
#[derive(Debug, Clone, Default)]
pub struct Log {
    pub(super) path: PathBuf,
    pub(super) columns: Columns,
    /// What the clock shows at time 0, where the files have stamps.
    pub clock: Option<Clock>,
    /// SHA-256 of the bytes, hexadecimal.
    pub(super) sha256: String,
    /// Rows or lines of the files.
    pub(super) rows: usize,
    pub(super) sidecar: Sidecar,
    pub(super) part: Option<[f64; 2]>,
    /// What the reader had to decide or found remarkable.
    pub warnings: Vec<Warning>,
    /// Readings taken as missing or told as doubtful.
    pub(super) rejected: Vec<RejectedReading>,
    /// The columns that channels come from.
    pub(super) names: Vec<(Channel, String)>,
    /// What was read of every channel.
    pub(super) readings: Vec<ChannelReadings>,
}

/// What was read of a channel, in SI units and radians; a heading unwrapped.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelReadings {
    /// The channel.
    pub channel: Channel,
    /// The column or instrument it comes from; nothing where it was made of others.
    pub source: Option<String>,
    /// How many there are.
    pub count: usize,
    /// Median time from one to the next, s.
    pub interval: Option<f64>,
    /// Begin of the longest way from one to the next, and its length, s.
    pub longest: Option<[f64; 2]>,
    /// The smallest and the largest.
    pub range: [f64; 2],
    /// The smallest change from one to the next.
    pub step: Option<f64>,
    /// How often a heading crosses north.
    pub wraps: Option<usize>,
}

impl ChannelReadings {
    /// Of a series, within a part of the log.
    pub(super) fn of(Series { channel, time, values, source }: &Series, part: RangeInclusive<f64>) -> Self {
        let read = time.iter().zip(values).filter(|(t, value)| value.is_finite() && part.contains(t));
        let read: Vec<(f64, f64)> = read.map(|(t, value)| (*t, *value)).collect();
        let ways = || read.windows(2).map(|pair| [pair[0].0, pair[1].0 - pair[0].0]);
        let changes = read.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).filter(|change| *change > ROUNDING);
        let (low, high) = extremes(read.iter().map(|(_, value)| *value));
        let turns = |value: f64| (value / std::f64::consts::TAU).floor();
        let crossings = || read.windows(2).filter(|pair| turns(pair[0].1) != turns(pair[1].1)).count();
        Self {
            channel: *channel,
            source: source.clone(),
            count: read.len(),
            interval: upper_median(ways().map(|[_, way]| way)),
            longest: ways().max_by(|first, second| first[1].total_cmp(&second[1])),
            range: [low, high],
            step: changes.min_by(f64::total_cmp),
            wraps: (*channel == Channel::Heading).then(crossings),
        }
    }

    /// Of the columns of a table with their names.
    pub(super) fn of_columns(columns: &Columns, names: &[(Channel, String)]) -> Vec<Self> {
        let of = |(channel, values): (&Channel, &Vec<f64>)| {
            let source = names.iter().find(|(named, _)| named == channel).map(|(_, name)| name.clone());
            let series = Series { channel: *channel, time: columns.time.clone(), values: values.clone(), source };
            Self::of(&series, f64::NEG_INFINITY..=f64::INFINITY)
        };
        columns.channels.iter().map(of).collect()
    }

    /// The same on a clock that shows so many seconds more.
    pub(super) fn later(self, offset: f64) -> Self {
        Self { longest: self.longest.map(|[begin, way]| [begin + offset, way]), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A damaged file may hold any number.
    #[test]
    fn headings_of_any_size_pass_north_once_a_row() {
        let values = vec![6.2, 6.4, 1e300, -1e300, 1e300];
        let time = (0..values.len()).map(|row| row as f64).collect();
        let series = Series { channel: Channel::Heading, time, values, source: None };
        assert_eq!(ChannelReadings::of(&series, 0.0..=9.0).wraps, Some(4));
    }
}
