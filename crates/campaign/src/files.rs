//! Names of the primary files of a result folder, from which all tables and plots are made.

/// Name of the folder of the rows, one file per block.
pub const ROWS_FOLDER: &str = "rows";
/// Name of the folder of the timings, one file per block.
pub const TIMINGS_FOLDER: &str = "timings";
/// File of the durations of simulation and methods.
pub const TIMINGS_FILE: &str = "timings.csv";
/// Manifest: program, machine and scenario; written first, and again at the end of the study.
pub const MANIFEST_FILE: &str = "manifest.toml";
/// File of the design.
pub const DESIGN_FILE: &str = "cells.json";
/// File with the first trial of every cell in detail.
pub const SHOWCASES_FILE: &str = "showcase.json";
/// Rows in one file, as versions before 0.3 stored them.
pub const LEGACY_ROWS_FILE: &str = "rows.parquet";
