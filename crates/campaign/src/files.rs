//! Names of the primary files of a result folder, from which all tables and plots are made.

/// Folder of the rows, one file per block.
pub const ROWS: &str = "rows";
/// Folder of the timings, one file per block.
pub const BLOCK_TIMINGS: &str = "timings";
/// File of the durations of simulation and methods.
pub const TIMINGS: &str = "timings.csv";
/// Manifest: program, machine and scenario; written first, and again at the end of the study.
pub const MANIFEST: &str = "manifest.toml";
/// File of the design.
pub const DESIGN: &str = "cells.json";
/// File with the first trial of every cell in detail.
pub const SHOWCASES: &str = "showcase.json";
/// Rows in one file, as versions before 0.3 stored them.
pub const LEGACY_ROWS: &str = "rows.parquet";
