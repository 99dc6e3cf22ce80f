//! Input of a search: the channels of a log, the quantities derived from them, and the patterns of holds.

use super::headings::HeadingReadings;
use super::rudder::{Hold, RudderHolds};
use crate::manoeuvre::Manoeuvre;

/// Channels of a log to be searched for manoeuvres, row by row, in SI units and radians.
///
/// All channels have the length of `time`. Time increases strictly; its spacing may be uneven and have gaps.
#[derive(Debug, Clone, Copy)]
pub struct LogSignals<'a> {
    /// Time, s.
    pub time: &'a [f64],
    /// Rudder angle or order, rad; finite in every row.
    pub rudder: &'a [f64],
    /// Heading, rad, unwrapped; NaN if missing.
    pub heading: &'a [f64],
    /// Speed, m/s; `None` if it was not recorded.
    pub speed: Option<&'a [f64]>,
    /// Revolutions of the propeller, in any unit; `None` if they were not recorded.
    pub propeller_rate: Option<&'a [f64]>,
}

impl LogSignals<'_> {
    /// `true` if time, rudder and heading are as documented; otherwise no manoeuvre is detected.
    pub(crate) fn is_sound(&self) -> bool {
        let rows = self.time.len();
        self.rudder.len() == rows
            && self.heading.len() == rows
            && self.time.iter().all(|t| t.is_finite())
            && self.time.windows(2).all(|pair| pair[0] < pair[1])
            && self.rudder.iter().all(|delta| delta.is_finite())
    }
}

/// Log prepared for the search: its channels, the holds of its rudder and its headings.
#[derive(Clone, Copy)]
pub(crate) struct PreparedLog<'a> {
    pub log: &'a LogSignals<'a>,
    pub rudder: &'a RudderHolds,
    pub headings: &'a HeadingReadings,
}

/// Detected manoeuvre, before the start and end of its part of the log are determined.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    pub manoeuvre: Manoeuvre,
    /// Holds of the rudder; never empty.
    pub holds: Vec<Hold>,
    /// Time scale, s; also the maximum length of the approach.
    pub scale: f64,
    /// Characteristic change of heading, rad.
    pub swing: f64,
}

impl Pattern {
    /// First row of the first hold.
    pub fn first(&self) -> usize {
        self.holds[0].first_row
    }

    /// Last row of the last hold.
    pub fn last(&self) -> usize {
        self.holds[self.holds.len() - 1].last_row
    }
}
