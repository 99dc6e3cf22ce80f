//! What a search looks at, a log with what is derived from it once, and the patterns that are looked for in it.

use super::course::Course;
use super::rest::{Hold, Rest};
use crate::manoeuvre::Manoeuvre;

/// The channels that a search looks at, row by row, in SI units and radians.
///
/// All have the length of `time`. Time increases strictly; its spacing may be uneven and have gaps.
#[derive(Debug, Clone, Copy)]
pub struct Signals<'a> {
    /// Time, s.
    pub time: &'a [f64],
    /// Rudder angle or order, rad; finite in every row.
    pub rudder: &'a [f64],
    /// Heading, rad, unwrapped; NaN where it was not read.
    pub heading: &'a [f64],
    /// Speed, m/s.
    pub speed: Option<&'a [f64]>,
    /// Revolutions of the propeller, any unit.
    pub propeller: Option<&'a [f64]>,
}

impl Signals<'_> {
    /// Whether the channels are as documented: a search in anything else finds nothing.
    pub(crate) fn is_sound(&self) -> bool {
        let rows = self.time.len();
        self.rudder.len() == rows
            && self.heading.len() == rows
            && self.time.iter().all(|t| t.is_finite())
            && self.time.windows(2).all(|pair| pair[0] < pair[1])
            && self.rudder.iter().all(|delta| delta.is_finite())
    }
}

/// A log with what is derived from it once.
#[derive(Clone, Copy)]
pub(crate) struct Prepared<'a> {
    pub log: &'a Signals<'a>,
    pub rest: &'a Rest,
    pub course: &'a Course,
}

/// A manoeuvre before its part is bounded.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    pub manoeuvre: Manoeuvre,
    /// Where the rudder was held; never empty.
    pub holds: Vec<Hold>,
    /// Longest approach that belongs to it, s; also its time scale.
    pub scale: f64,
    /// Change of heading that is large for it, rad.
    pub swing: f64,
}

impl Pattern {
    pub fn first(&self) -> usize {
        self.holds[0].first
    }

    pub fn last(&self) -> usize {
        self.holds[self.holds.len() - 1].last
    }
}
