//! What a search gives: a manoeuvre with the part of the log that is to be analysed.

use super::kind::Kind;
use super::quality::Quality;

/// A manoeuvre inside a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Manoeuvre {
    /// What it is.
    pub kind: Kind,
    /// First row of the part to analyse, s: the first execute, or before it where the approach was steady.
    pub from: f64,
    /// Last row of that part, s: the rudder is still held in it, and the propeller turns.
    pub until: f64,
    /// Time of the first row in which the rudder moves for this manoeuvre, s; of a straight piece its first row.
    pub start: f64,
    /// Number of executes: a turn has one, a straight piece none.
    pub executes: usize,
    /// How good the log is there.
    pub quality: Quality,
}
