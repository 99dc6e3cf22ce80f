//! Limits of a run, so that no specification, drawn by chance or slipped from a pen, computes for ever or takes all
//! memory. What a run may take is estimated in [`crate::cost`].

/// Longest time in a specification, s: four months. Beyond it a time of the run is no longer known to a nanosecond.
pub const LONGEST_TIME: f64 = 1e7;

/// Most steps of one run: a minute or two of computing. A zig-zag takes some thousand.
pub const MOST_STEPS: usize = 100_000_000;

/// Most rows of one record, a million periods and the first row: eleven days at one a second, and less than half a
/// gigabyte while it is made.
pub const MOST_ROWS: usize = 1_000_001;

/// Most executes of one run: each leaves three segments of the path of the rudder in memory.
pub const MOST_EXECUTES: usize = 100_000;
