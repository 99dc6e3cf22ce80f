//! A message of a log: stamp, source and readings.

use crate::channel::Channel;

/// Reading: channel, class (lowest for the best quantity of the channel), and value in SI units, with an angle in
/// degrees or radians as in the log.
pub(super) type RankedReading = (Channel, u8, f64);

/// Message: a line of a log with its stamp.
pub(super) struct Message<'a> {
    /// Time stamp, as in the log.
    pub stamp: &'a str,
    /// Name of the sender.
    pub source: String,
    /// Readings of the line.
    pub readings: Vec<RankedReading>,
}
