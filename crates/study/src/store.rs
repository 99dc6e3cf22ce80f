//! The files of a result folder that everything else is made from: rows, design, showcases and manifest.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::engine::CellFacts;
use crate::failure::{Failure, OnPath};
use crate::manifest::Manifest;
use crate::rows::{self, Row};
use crate::scenario::MethodName;
use crate::showcase::Showcase;

const ROWS: &str = "rows.parquet";
const DESIGN: &str = "cells.json";
const SHOWCASES: &str = "showcase.json";
const MANIFEST: &str = "manifest.toml";

/// What tables and figures need of a scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Design {
    /// The question.
    pub question: String,
    /// What was seen.
    pub analysis: String,
    /// Names of the axes.
    pub axes: Vec<String>,
    /// The methods.
    pub methods: Vec<MethodName>,
    /// The cells, in their order.
    pub cells: Vec<CellFacts>,
}

/// A finished study.
#[derive(Debug, Clone, PartialEq)]
pub struct Stored {
    /// What ran, and on what.
    pub manifest: Manifest,
    /// The rows.
    pub rows: Vec<Row>,
    /// The design.
    pub design: Design,
    /// The first trial of every cell in detail, where it was asked for.
    pub showcases: Vec<Showcase>,
}

impl Stored {
    /// Writes everything to a folder, the manifest last: a folder with a manifest is whole.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        rows::write(&folder.join(ROWS), &self.rows)?;
        write_json(&folder.join(DESIGN), &self.design)?;
        write_json(&folder.join(SHOWCASES), &self.showcases)?;
        self.manifest.write(&folder.join(MANIFEST))
    }

    /// Reads a finished study. Fails as wrong input when the folder holds none.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        Ok(Self {
            manifest: Manifest::read(&folder.join(MANIFEST))?,
            rows: rows::read(&folder.join(ROWS))?,
            design: read_json(&folder.join(DESIGN))?,
            showcases: read_json(&folder.join(SHOWCASES))?,
        })
    }
}

fn write_json<T: Serialize>(path: &Path, value: &T) -> Result<(), Failure> {
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
