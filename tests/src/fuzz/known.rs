//! Faults that are known and not mended yet. A panic whose `place | message` holds one of [`SIGNS`] is counted and not failed on;
//! [`FILES`] are regressions that end the process. Both are meant to be empty.

/// Target, and a part of `place | message` of the panic.
pub const SIGNS: &[(&str, &str)] = &[
    // A piece of a record between gaps that gives no equations.
    ("record", "crates/identify/src/robust.rs"),
    // Escapes in quoted words of a sidecar.
    ("sidecar", "control character"),
    // Labels with escapes and NUL.
    ("scenario", "a label that no table can carry"),
    ("manifest", "a label that no table can carry"),
    ("manifest", "a name that leads out of results/"),
    // Damaged pages.
    ("rows", "/parquet-"),
    // Designs that do not fit together, or not to the rows.
    ("cells", "crates/study/src/"),
    ("cells", "labels of a cell and axes"),
    ("cells", "values of a cell and axes"),
    ("cells", "control character"),
];

/// Regression files that are not run, as `TARGET/NAME`, and why.
pub const FILES: &[(&str, &str)] = &[
    ("scenario/long-dotted-sweep.toml", "the stack overflows"),
    ("scenario/long-dotted-draw.toml", "the stack overflows"),
];
