//! A log with what is derived from it once, and the patterns that are looked for in it.

use crate::course::Course;
use crate::kind::Kind;
use crate::log::Log;
use crate::rest::{Rest, Stretch};

/// A log with what is derived from it once.
#[derive(Clone, Copy)]
pub(crate) struct Record<'a> {
    pub log: &'a Log<'a>,
    pub rest: &'a Rest,
    pub course: &'a Course,
}

/// A manoeuvre before its part is bounded.
#[derive(Debug, Clone)]
pub(crate) struct Pattern {
    pub kind: Kind,
    /// Where the rudder was held; never empty.
    pub holds: Vec<Stretch>,
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
