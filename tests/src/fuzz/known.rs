//! Faults that are known and not mended yet. A panic whose place and message hold one of [`SIGNS`] is counted, not failed on;
//! [`FILES`] are regressions that end the process or cannot hold yet. Both are meant to be empty.

/// Target, and a part of `place: message` of the panic.
pub const SIGNS: &[(&str, &str)] = &[];

/// Regression files that are not run, below `tests/fuzz/regressions`, and why.
pub const FILES: &[(&str, &str)] = &[];
