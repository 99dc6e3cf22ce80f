//! The names of the files of a result folder that everything else is made from.

/// Rows, one per trial and method.
pub const ROWS: &str = "rows.parquet";
/// How long simulation and methods took.
pub const TIMINGS: &str = "timings.csv";
/// What ran, and on what; written last.
pub const MANIFEST: &str = "manifest.toml";
/// The design: axes, methods, cells.
pub const DESIGN: &str = "cells.json";
/// Folder with the scripts that the study starts.
pub const SOURCES: &str = "sources";
/// The first trial of every cell in detail.
pub const SHOWCASES: &str = "showcase.json";
