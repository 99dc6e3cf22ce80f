//! The files of a result folder that everything else is made from: rows, design, showcases, times and manifest.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::failure::{Failure, OnPath};
use crate::manifest::Manifest;
use crate::rows::{Layout, Reader, Row};
use crate::scenario::MethodName;
use crate::showcase::Showcase;
use crate::timings::Timings;
use crate::unfinished;

/// Rows, one per trial and method.
pub const ROWS: &str = "rows.parquet";
/// How long simulation and methods took.
pub const TIMINGS: &str = "timings.csv";
/// What ran, and on what; written last.
pub const MANIFEST: &str = "manifest.toml";
const DESIGN: &str = "cells.json";
const SHOWCASES: &str = "showcase.json";

/// What tables and figures need of a scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// The question.
    pub question: String,
    /// What was seen.
    pub analysis: String,
    /// The answer in one sentence.
    pub finding: String,
    /// Stem of the figure that stands for the study.
    pub figure: Option<String>,
    /// Cells whose errors are shown one by one.
    pub detail: Vec<usize>,
    /// Names of the axes.
    pub axes: Vec<String>,
    /// The methods.
    pub methods: Vec<MethodName>,
    /// Keys that are drawn anew in every trial.
    pub draws: Vec<String>,
    /// The cells, in their order.
    pub cells: Vec<CellFacts>,
}

/// What is known of a cell without its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellFacts {
    /// Labels of its points, one an axis.
    pub labels: Vec<String>,
    /// Values of its points, where an axis is a number.
    pub values: Vec<Option<f64>>,
    /// Identifiers of the effects that a first-order base lacks in its trials.
    #[serde(default)]
    pub missing: Vec<String>,
    /// Cramér–Rao covariance of the relative errors of K and T, in squared per cent; `None` where every trial has a bound
    /// of its own, and where there is none.
    pub bound_percent2: Option<[[f64; 2]; 2]>,
}

/// A finished study: everything but its rows, which are read a few at a time.
pub struct Stored {
    folder: PathBuf,
    /// What ran, and on what.
    pub manifest: Manifest,
    /// The design.
    pub design: Design,
    /// The first trial of every cell in detail, where it was asked for.
    pub showcases: Vec<Showcase>,
    /// How long the methods took.
    pub timings: Timings,
}

impl Stored {
    /// Reads a finished study. Fails as wrong input when the folder holds none.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        let Some(manifest) = manifest_of_rows(folder)? else {
            let problem = match unfinished::is_in(folder) {
                true => "the study in it is not finished; run it again to go on",
                false => "there are no rows in it; expected the folder of a finished study",
            };
            return Err(Failure::input(format!("{}: {problem}", folder.display())));
        };
        let design = read_design(folder)?;
        Ok(Self {
            folder: folder.to_owned(),
            manifest,
            showcases: read_json(&folder.join(SHOWCASES))?,
            timings: Timings::read(&folder.join(TIMINGS), &design)?,
            design,
        })
    }

    /// Hands every row to `take`, in order.
    pub fn rows(&self, take: impl FnMut(Row) -> Result<(), Failure>) -> Result<(), Failure> {
        Reader::open(&self.folder.join(ROWS), &Layout::of(&self.design))?.for_each(take)
    }
}

/// The manifest of the finished rows in a folder; `None` when there are none. A folder that holds what was published
/// without its rows is not a finished study.
pub fn manifest_of_rows(folder: &Path) -> Result<Option<Manifest>, Failure> {
    let whole = folder.join(ROWS).exists() && folder.join(MANIFEST).exists() && !unfinished::is_in(folder);
    if whole { Manifest::read(&folder.join(MANIFEST)).map(Some) } else { Ok(None) }
}

/// Writes the design.
pub fn write_design(folder: &Path, design: &Design) -> Result<(), Failure> {
    write_json(&folder.join(DESIGN), design)
}

/// Reads the design.
pub fn read_design(folder: &Path) -> Result<Design, Failure> {
    read_json(&folder.join(DESIGN))
}

/// Writes the showcases.
pub fn write_showcases(folder: &Path, showcases: &[Showcase]) -> Result<(), Failure> {
    write_json(&folder.join(SHOWCASES), showcases)
}

/// Reads the showcases.
pub fn read_showcases(folder: &Path) -> Result<Vec<Showcase>, Failure> {
    read_json(&folder.join(SHOWCASES))
}

fn write_json<T: Serialize + ?Sized>(path: &Path, value: &T) -> Result<(), Failure> {
    let text = serde_json::to_string(value).on("describe", path)?;
    fs::write(path, text + "\n").on("write", path)
}

fn read_json<T: for<'de> Deserialize<'de>>(path: &Path) -> Result<T, Failure> {
    let refuse = |problem: String| {
        Failure::input(format!("{}: {problem}; expected the folder of a finished study", path.display()))
    };
    let text = fs::read_to_string(path).map_err(|error| refuse(error.to_string()))?;
    serde_json::from_str(&text).map_err(|error| refuse(error.to_string()))
}
