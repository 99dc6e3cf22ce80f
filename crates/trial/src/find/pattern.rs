//! A log with what is derived from it once, and the patterns that are looked for in it.

use super::course::Course;
use super::kind::Kind;
use super::rest::{Hold, Rest};
use super::signals::Signals;

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
    pub kind: Kind,
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
