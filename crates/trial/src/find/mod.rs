//! Detection of manoeuvres in a long log: zig-zags, turning circles, pull-outs, spirals and straight pieces, each with
//! its part of the log. Characteristics of a zig-zag are computed in [`crate::zigzag`].
//!
//! The log is first cut into holds of the rudder (`rudder`). A manoeuvre is a pattern of holds to which the heading
//! responds (`zigzags`, `spirals`, `turns`); the pieces between may be straight (`straights`). The bounds of every part
//! follow last (`bounds`).
//!
//! No time limit is fixed in seconds, because a model and a tanker differ by a factor of fifty: scales come from the
//! holds of each manoeuvre. Positive rudder turns the ship to starboard; in a log with the opposite sign only straight
//! pieces are detected.
//!
//! Source of the manoeuvres: ITTC 7.5-04-02-01, Full Scale Manoeuvring Trials.

mod bounds;
mod detection;
mod headings;
mod pattern;
mod rudder;
mod spirals;
mod straights;
#[cfg(test)]
mod tests;
mod turns;
mod zigzags;

use headings::HeadingReadings;
use pattern::{Pattern, PreparedLog};
use rudder::{Hold, RudderHolds};

pub use detection::{ApproachState, DetectedManoeuvre, RecordingQuality};
pub use pattern::LogSignals;

/// Manoeuvres of a log in order of time, without overlap.
///
/// Empty if no manoeuvre is recognised, and for a log that violates the rules of [`LogSignals`]. Time and memory grow
/// in proportion to the rows.
pub fn detect_manoeuvres(log: &LogSignals) -> Vec<DetectedManoeuvre> {
    if !log.is_sound() {
        return Vec::new();
    }
    let headings = HeadingReadings::from_columns(log.time, log.heading);
    let rudder = RudderHolds::from_signal(log.time, log.rudder);
    let record = PreparedLog { log, rudder: &rudder, headings: &headings };
    let mut patterns = spirals::spirals(&record);
    let free = rudder.merged.iter().copied().filter(|hold| !overlaps(&patterns, hold)).collect::<Vec<_>>();
    patterns.extend(zigzags::zigzags(&record, &free));
    patterns.sort_by_key(|pattern| pattern.holds[0].first_row);
    let free = rudder.merged.iter().copied().filter(|hold| !overlaps(&patterns, hold)).collect::<Vec<_>>();
    // A pull-out begins at the end of its turn; another manoeuvre may lie between.
    let turns = turns::turns(&record, &free).into_iter().filter(|turn| !overlaps(&patterns, &turn.holds[0]));
    patterns.extend(turns.collect::<Vec<_>>());
    patterns.sort_by_key(|pattern| pattern.holds[0].first_row);
    let mut list = bounds::with_bounds(&record, &patterns);
    straights::add_straight_runs(&record, &patterns, &mut list);
    list
}

/// `true` if a hold shares rows with a pattern; the patterns are in order of time and do not overlap.
fn overlaps(patterns: &[Pattern], hold: &Hold) -> bool {
    let next = patterns.partition_point(|pattern| pattern.last() < hold.first_row);
    patterns.get(next).is_some_and(|pattern| pattern.first() <= hold.last_row)
}
