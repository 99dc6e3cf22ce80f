//! Scenario files: one question each, read strictly, resolved completely before anything runs.
//!
//! `wire` is what a file says, [`sweep`] the design, `resolve` the checks, [`Scenario`] what the engine accepts. A
//! value of [`Scenario`] has been checked in every cell of the design.

mod locate;
mod resolve;
pub mod sweep;
mod wire;

use std::fs;
use std::path::{Path, PathBuf};

use identify::{Estimate, Identifier, IdentifierSettings, IdentifyError};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use ship::FirstOrder;
use simulate::{Purpose, Simulation, StreamKey};
use trial::Trial;

use crate::failure::Failure;
use sweep::Axis;
use wire::ScenarioWire;

/// A method as a scenario names it.
pub struct Method {
    /// Label in tables and figures; unique in the scenario.
    pub label: String,
    /// Id of the method.
    pub id: &'static str,
    /// Its settings.
    pub settings: IdentifierSettings,
    /// The method with its settings.
    pub identifier: Box<dyn Identifier>,
}

/// What a method is called, and which it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MethodName {
    /// Label in tables and figures.
    pub label: String,
    /// Id of the method.
    pub id: String,
}

impl Method {
    /// Identifies one trial; a method that draws at random draws from the stream of this trial.
    pub fn identify(&self, trial: &Trial, key: &StreamKey) -> Result<Estimate, IdentifyError> {
        let own = self.identifier.with_seed(key.rng(Purpose::Method).random());
        own.as_ref().unwrap_or(&self.identifier).identify(std::slice::from_ref(trial))
    }
}

/// One cell of the design: everything but chance is fixed.
pub struct Cell {
    /// Labels of its points, one an axis.
    pub labels: Vec<String>,
    /// Values of its points, where an axis is a number.
    pub values: Vec<Option<f64>>,
    /// How a trial is made.
    pub simulation: Simulation,
    /// The truth, where the ship is exactly first order.
    pub truth: Option<FirstOrder>,
    /// The methods, all on the same trial.
    pub methods: Vec<Method>,
}

impl Cell {
    /// Labels of the points joined, or nothing when there is no axis.
    pub fn title(&self) -> String {
        self.labels.join(", ")
    }
}

/// Values of other authors, shown beside the results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Published {
    /// K, 1/s.
    pub k_per_s: Option<f64>,
    /// T, s.
    pub t_s: Option<f64>,
}

/// A scenario that has been checked in every cell.
pub struct Scenario {
    /// Stem of the file.
    pub name: String,
    /// The question it answers.
    pub question: String,
    /// What was seen, in prose.
    pub analysis: String,
    /// Key of every random draw.
    pub seed: u64,
    /// Trials per cell.
    pub replicates: u64,
    /// Axes of the design.
    pub axes: Vec<Axis>,
    /// Cells of the design, the first axis slowest.
    pub cells: Vec<Cell>,
    /// Values of other authors.
    pub published: Published,
    /// Whether the first replicate of every cell is shown in detail.
    pub showcase: bool,
    /// The file as it was read.
    pub text: String,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
}

impl Scenario {
    /// Reads and resolves a file.
    ///
    /// Fails with a message that names the file, the line and the key, what was found and what was expected.
    pub fn read(path: &Path, seed: Option<u64>) -> Result<Self, Failure> {
        let text = read_text(path)?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        Self::parse(path, &name, text, seed)
    }

    /// Resolves the text of a scenario; `path` is where messages and relative files refer to.
    pub fn parse(path: &Path, name: &str, text: String, seed: Option<u64>) -> Result<Self, Failure> {
        let wire: ScenarioWire = toml::from_str(&text).map_err(|error| {
            Failure::at(path, &text, error.span().unwrap_or(0..0), error.message(), "see the README for the keys of a scenario")
        })?;
        let folder = path.parent().map(PathBuf::from).unwrap_or_default();
        let fail = |key: &str, problem: &str, advice: &str| {
            Failure::at(path, &text, locate::span(&text, key), problem, advice)
        };
        let axes = wire
            .sweep
            .iter()
            .enumerate()
            .map(|(index, axis)| axis.resolve(index))
            .collect::<Result<Vec<Axis>, _>>()
            .map_err(|error| fail(&error.key, &error.problem, "mend this axis"))?;
        let combinations = sweep::product(&axes).map_err(|error| fail(&error.key, &error.problem, "use fewer points"))?;
        // The document as written has to make sense by itself: a sweep changes it, it does not complete it.
        let base = resolve::cell(&wire, &folder).map_err(|error| fail(&error.key, &error.problem, &error.advice))?;
        let document: toml::Table = text.parse().map_err(|error: toml::de::Error| fail("", error.message(), "mend the file"))?;
        let mut cells = Vec::with_capacity(combinations.len());
        for combination in &combinations {
            let mut changed = document.clone();
            for point in combination {
                for (key, value) in &point.set {
                    sweep::set(&mut changed, key, value.clone())
                        .map_err(|problem| fail("sweep", &format!("sweep of `{key}`: {problem}"), "mend the key"))?;
                }
            }
            let labels: Vec<String> = combination.iter().map(|point| point.label.clone()).collect();
            let place = || labels.join(", ");
            let wire = ScenarioWire::deserialize(changed)
                .map_err(|error| fail("sweep", &format!("in cell {}: {}", place(), error.message()), "mend the swept key or value"))?;
            let resolved = resolve::cell(&wire, &folder).map_err(|error| {
                fail("sweep", &format!("in cell {}: `{}`: {}", place(), error.key, error.problem), &error.advice)
            })?;
            let values = combination.iter().map(|point| point.value).collect();
            cells.push(Cell { labels, values, ..resolved });
        }
        if cells.iter().any(|cell| cell.methods.iter().map(|method| &method.label).ne(base.methods.iter().map(|method| &method.label))) {
            return Err(fail("sweep", "a sweep may change the settings of methods, not which methods there are", "sweep settings only"));
        }
        if wire.replicates == 0 {
            return Err(fail("replicates", "0 replicates: nothing would be run", "at least 1"));
        }
        let sha256 = hex(&Sha256::digest(text.as_bytes()));
        Ok(Self {
            name: name.to_owned(),
            question: wire.question,
            analysis: wire.analysis,
            seed: seed.unwrap_or(wire.seed),
            replicates: wire.replicates,
            axes,
            cells,
            published: Published { k_per_s: wire.published.K_per_s, t_s: wire.published.T_s },
            showcase: wire.output.showcase,
            text,
            sha256,
        })
    }

    /// Labels and ids of the methods, in the order of the scenario.
    pub fn method_names(&self) -> Vec<MethodName> {
        self.cells[0]
            .methods
            .iter()
            .map(|method| MethodName { label: method.label.clone(), id: method.id.to_owned() })
            .collect()
    }

    /// Labels of the methods, in the order of the scenario.
    pub fn labels(&self) -> impl Iterator<Item = &str> {
        self.cells[0].methods.iter().map(|method| method.label.as_str())
    }
}

/// Largest scenario file accepted, bytes.
const LARGEST_FILE: u64 = 1 << 20;

fn read_text(path: &Path) -> Result<String, Failure> {
    let refuse = |problem: String| Failure::input(format!("{}: {problem}", path.display()));
    let about = fs::metadata(path).map_err(|error| refuse(format!("{error}; give the path of a scenario file (TOML)")))?;
    if about.is_dir() {
        return Err(refuse("is a folder; give the path of a scenario file (TOML)".into()));
    }
    if about.len() > LARGEST_FILE {
        return Err(refuse(format!("has {} bytes, a scenario has at most {LARGEST_FILE}; is this a record? try `study fit`", about.len())));
    }
    let bytes = fs::read(path).map_err(|error| refuse(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| {
        refuse(format!("byte {} is not UTF-8 text; a scenario is a TOML text file", error.utf8_error().valid_up_to()))
    })
}

/// Bytes as hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
