//! Finds the manoeuvres inside a long log: zig-zags, turning circles, pull-outs, spirals and straight pieces, each with
//! the part of the log that is to be analysed. It reads no characteristics off them (see [`crate::zigzag`]), identifies
//! nothing and cleans nothing.
//!
//! A log is first cut into holds, where the rudder rests (`rest`); every manoeuvre is a pattern of such holds
//! that the heading answers (`zigzags`, `spirals`, `turns`), and what lies between them may be straight (`straights`).
//! Where a part begins and ends is decided last, and in one place (`bounds`).
//!
//! No time is fixed in seconds: a model and a tanker differ by a factor of fifty. Scales come from the holds of each
//! manoeuvre. Positive rudder turns the ship to starboard; in a log with the other sign no ship answers its rudder, and
//! nothing but straight pieces is found.

mod bounds;
mod course;
mod found;
mod pattern;
mod rest;
mod spirals;
mod straights;
#[cfg(test)]
mod tests;
mod turns;
mod zigzags;

use course::Course;
use pattern::{Pattern, Prepared};
use rest::{Hold, Rest};

pub use found::{Approach, FoundManoeuvre, Quality};
pub use pattern::Signals;

/// The manoeuvres of a log in order of time; they do not overlap.
///
/// Empty where nothing is recognised, and for a log that is not as [`Signals`] says. Time and memory grow in
/// proportion to the rows.
pub fn manoeuvres(log: &Signals) -> Vec<FoundManoeuvre> {
    if !log.is_sound() {
        return Vec::new();
    }
    let course = Course::of(log.time, log.heading);
    let rest = Rest::of(log.time, log.rudder);
    let record = Prepared { log, rest: &rest, course: &course };
    let mut found = spirals::spirals(&record);
    let free = rest.merged.iter().copied().filter(|hold| !overlaps(&found, hold)).collect::<Vec<_>>();
    found.extend(zigzags::zigzags(&record, &free));
    found.sort_by_key(|pattern| pattern.holds[0].first);
    let free = rest.merged.iter().copied().filter(|hold| !overlaps(&found, hold)).collect::<Vec<_>>();
    // A pull-out begins where its turn ends, and something else may lie between.
    let turns = turns::turns(&record, &free).into_iter().filter(|turn| !overlaps(&found, &turn.holds[0]));
    found.extend(turns.collect::<Vec<_>>());
    found.sort_by_key(|pattern| pattern.holds[0].first);
    let mut list = bounds::bounded(&record, &found);
    straights::add(&record, &found, &mut list);
    list
}

/// Whether a hold shares rows with one of the patterns, which are in order of time and apart.
fn overlaps(found: &[Pattern], hold: &Hold) -> bool {
    let next = found.partition_point(|pattern| pattern.last() < hold.first);
    found.get(next).is_some_and(|pattern| pattern.first() <= hold.last)
}
