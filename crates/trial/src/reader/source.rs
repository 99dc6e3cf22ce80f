//! What one file holds before it is a record: channels, each at its own instants. Every format is read into this, and
//! [`super::assemble`] makes a record of it.

use crate::channel::Channel;
use crate::clock::Clock;
use crate::record::{Columns, RejectedReading};

/// A channel at its own instants.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Series {
    /// What it holds, in SI units and radians.
    pub channel: Channel,
    /// What the file calls it, for messages.
    pub name: String,
    /// Instants, s, on the clock of the file; strictly increasing.
    pub time: Vec<f64>,
    /// Values; NaN where nothing was read. Headings are not unwrapped.
    pub values: Vec<f64>,
}

/// What a log of sentences holds.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    /// One for each channel.
    pub series: Vec<Series>,
    /// What the clock shows at time 0, where the file has one.
    pub clock: Option<Clock>,
    /// What was decided or found remarkable on the way, one sentence each.
    pub warnings: Vec<String>,
    /// Lines of the file.
    pub lines: usize,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// What one file holds.
pub(super) struct Piece {
    pub columns: Columns,
    pub clock: Option<Clock>,
    pub warnings: Vec<String>,
    /// Readings taken as missing or told as doubtful.
    pub marks: Vec<RejectedReading>,
    /// Rows or lines of the file.
    pub rows: usize,
    pub sha256: String,
}
