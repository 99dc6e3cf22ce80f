//! Limits of a run, so that no random or mistyped specification runs without end or exhausts the memory. The cost of a
//! run is estimated in [`crate::cost`].

/// Maximum time in a specification, s: four months. The resolution of f64 is 2 ns at this time.
pub const MAX_TIME_S: f64 = 1e7;

/// Maximum number of steps of one run: a minute or two of computing. A zig-zag has some thousand steps.
pub const MAX_STEPS: usize = 100_000_000;

/// Maximum number of rows of one record, a million periods and the first row: eleven days at one row a second, and less
/// than half a gigabyte of memory.
pub const MAX_ROWS: usize = 1_000_001;

/// Maximum number of executes of one run; each adds three segments of the rudder path to the memory.
pub const MAX_EXECUTES: usize = 100_000;
