//! What files hold before it is a record: channels, each at its own instants, and the columns that
//! [`super::assemble`] makes of them.

use std::path::PathBuf;

use document::Warning;

use crate::channel::Channel;
use crate::clock::Clock;
use crate::record::{Columns, RejectedReading};
use crate::sidecar::Sidecar;

/// A channel at its own instants.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    /// What it holds, in SI units and radians.
    pub channel: Channel,
    /// Instants, s, on the clock of the file; strictly increasing.
    pub time: Vec<f64>,
    /// Values; NaN where nothing was read. Headings are not unwrapped.
    pub values: Vec<f64>,
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
}
