//! The names of the files of a result folder that everything else is made from.

/// Folder of the rows, a file a block.
pub const ROWS: &str = "rows";
/// Folder of what simulation and methods took, a file a block.
pub const BLOCK_TIMINGS: &str = "timings";
/// How long simulation and methods took.
pub const TIMINGS: &str = "timings.csv";
/// What runs, and on what: written first, and again when the study is finished.
pub const MANIFEST: &str = "manifest.toml";
/// The design: axes, methods, cells.
pub const DESIGN: &str = "cells.json";
/// The first trial of every cell in detail.
pub const SHOWCASES: &str = "showcase.json";
/// Rows in one file, as versions before 0.3 stored them.
pub const ROWS_OF_OLD: &str = "rows.parquet";
