//! A message: when, by whom, and what it says.

use crate::channel::Channel;

/// A reading: its quantity, how good a quantity of its kind it is (the lower, the better), its value.
pub(super) type RankedReading = (Channel, u8, f64);

/// One line of a log.
pub(super) struct Message<'a> {
    /// When it was sent, as it stands there.
    pub stamp: &'a str,
    /// Who sent it.
    pub source: String,
    /// What it says.
    pub readings: Vec<RankedReading>,
}
