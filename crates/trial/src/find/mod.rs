//! Finds the manoeuvres inside a long log: zig-zags, turning circles, pull-outs, spirals and straight pieces, each with
//! the part of the log that is to be analysed. It reads no characteristics off them (see [`crate::zigzag`]), identifies
//! nothing and mends nothing.
//!
//! A log is first cut into stretches where the rudder rests (`rest`); every manoeuvre is a pattern of such stretches
//! that the heading answers (`zigzags`, `spirals`, `turns`), and what lies between them may be straight (`straights`).
//! Where a part begins and ends is decided last, and in one place (`bounds`).
//!
//! No time is fixed in seconds: a model and a tanker differ by a factor of fifty. Scales come from the holds of each
//! manoeuvre. Positive rudder turns the ship to starboard; in a log with the other sign no ship answers its rudder, and
//! nothing but straight pieces is found.

mod bounds;
mod course;
mod quality;
mod rest;
mod spirals;
mod straights;
#[cfg(test)]
mod tests;
mod turns;
mod zigzags;

use ship::angle::to_deg;

use crate::zigzag::holds::conventional_deg;
use course::Course;
use rest::{Rest, Stretch};

pub use quality::{Approach, Quality};

/// The channels that a search looks at, row by row, in SI units and radians.
///
/// All have the length of `time`. Time increases strictly; its spacing may be uneven and have gaps.
#[derive(Debug, Clone, Copy)]
pub struct Log<'a> {
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

impl Log<'_> {
    /// Whether the channels are as documented: a search in anything else finds nothing.
    fn is_sound(&self) -> bool {
        let rows = self.time.len();
        self.rudder.len() == rows
            && self.heading.len() == rows
            && self.time.iter().all(|t| t.is_finite())
            && self.time.windows(2).all(|pair| pair[0] < pair[1])
            && self.rudder.iter().all(|delta| delta.is_finite())
    }
}

/// What a ship did.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// A zig-zag; angles as executed.
    ZigZag {
        /// Rudder laid, rad: median over the holds to each side, and the mean of both sides.
        rudder: f64,
        /// Change of heading from the base course at which the rudder was reversed, rad: median over the executes.
        heading: f64,
    },
    /// A turn of half a circle or more with the rudder held.
    TurningCircle {
        /// Rudder held, rad, positive to starboard.
        rudder: f64,
        /// Change of heading under that rudder, rad, positive to starboard.
        turned: f64,
    },
    /// Rudder amidships after a turn.
    PullOut {
        /// Rudder of the turn before, rad, positive to starboard.
        rudder: f64,
    },
    /// A Dieudonné spiral: the rudder goes from side to side in steps and is held at each until the turn is steady.
    Spiral {
        /// Largest rudder angle, rad.
        largest: f64,
        /// Number of holds.
        steps: usize,
    },
    /// The ship keeps her course, by herself or under an autopilot.
    Straight,
}

impl Kind {
    /// A name for lists, with conventional angles: "zig-zag 10/10", "turning circle 35 to starboard", "pull-out",
    /// "spiral", "straight".
    pub fn name(&self) -> String {
        match *self {
            Self::ZigZag { rudder, heading } => {
                format!("zig-zag {}/{}", conventional(rudder, 0.08, 0.08), conventional(heading, 0.05, 0.25))
            }
            Self::TurningCircle { rudder, .. } => {
                let side = if rudder < 0.0 { "port" } else { "starboard" };
                format!("turning circle {} to {side}", conventional(rudder, 0.08, 0.08))
            }
            Self::PullOut { .. } => String::from("pull-out"),
            Self::Spiral { .. } => String::from("spiral"),
            Self::Straight => String::from("straight"),
        }
    }
}

/// The conventional angle near a measured one, for a name; see [`conventional_deg`].
fn conventional(angle: f64, below: f64, above: f64) -> String {
    let degrees = to_deg(angle.abs());
    conventional_deg(degrees, below, above, 0.0).map_or_else(|| format!("{degrees:.1}"), |angle| format!("{angle:.0}"))
}

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

/// The manoeuvres of a log in order of time; they do not overlap.
///
/// Empty where nothing is recognised, and for a log that is not as [`Log`] says. Time and memory grow in proportion to
/// the rows.
pub fn manoeuvres(log: &Log) -> Vec<Manoeuvre> {
    if !log.is_sound() {
        return Vec::new();
    }
    let course = Course::of(log);
    let rest = Rest::of(log.time, log.rudder);
    let record = Record { log, rest: &rest, course: &course };
    let mut found = spirals::spirals(&record);
    let free = rest.merged.iter().copied().filter(|stretch| !overlaps(&found, stretch)).collect::<Vec<_>>();
    found.extend(zigzags::zigzags(&record, &free));
    found.sort_by_key(|pattern| pattern.holds[0].first);
    let free = rest.merged.iter().copied().filter(|stretch| !overlaps(&found, stretch)).collect::<Vec<_>>();
    found.extend(turns::turns(&record, &free));
    found.sort_by_key(|pattern| pattern.holds[0].first);
    let mut list = bounds::bounded(&record, &found);
    straights::add(&record, &found, &mut list);
    list
}

/// A log with what is derived from it once.
#[derive(Clone, Copy)]
struct Record<'a> {
    log: &'a Log<'a>,
    rest: &'a Rest,
    course: &'a Course,
}

/// A manoeuvre before its part is bounded.
#[derive(Debug, Clone)]
struct Pattern {
    kind: Kind,
    /// Where the rudder was held; never empty.
    holds: Vec<Stretch>,
    /// Longest approach that belongs to it, s; also its time scale.
    scale: f64,
    /// Change of heading that is large for it, rad.
    swing: f64,
}

impl Pattern {
    fn first(&self) -> usize {
        self.holds[0].first
    }

    fn last(&self) -> usize {
        self.holds[self.holds.len() - 1].last
    }
}

/// Whether a stretch shares rows with one of the patterns, which are in order of time and apart.
fn overlaps(found: &[Pattern], stretch: &Stretch) -> bool {
    let next = found.partition_point(|pattern| pattern.last() < stretch.first);
    found.get(next).is_some_and(|pattern| pattern.first() <= stretch.last)
}
