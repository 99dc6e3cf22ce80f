//! A message of a log: stamp, source and readings.

use crate::channel::Channel;

/// Reading: channel, class (lowest for the best quantity of the channel) and value.
pub(super) type RankedReading = (Channel, u8, f64);

/// Line of a log.
pub(super) struct Message<'a> {
    /// Time stamp, as in the log.
    pub stamp: &'a str,
    /// Name of the sender.
    pub source: String,
    /// Readings of the line.
    pub readings: Vec<RankedReading>,
}
