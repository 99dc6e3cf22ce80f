//! Scenario files: one question each, read strictly, resolved completely before anything runs.
//!
//! `wire` is what a file says, `reader` how it is read, [`sweep`] the design, `resolve` the checks, `problem` and `locate`
//! what is wrong and where, [`Scenario`] what the engine accepts. A value of [`Scenario`] has been checked in every cell
//! of the design.

mod effect;
mod locate;
mod problem;
mod reader;
mod resolve;
mod specification;
pub mod sweep;
mod wire;

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use identify::{Estimate, Identifier, IdentifierSettings, IdentifyError};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use ship::FirstOrder;
use simulate::{Purpose, Simulation, StreamKey};
use toml::Table;
use trial::Trial;

use crate::failure::Failure;
pub use effect::keys as effect_keys;
use problem::{KeyPath, Problem};
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
    /// The same cell; its trials carry the name of the scenario.
    fn named(self, scenario: &str) -> Self {
        Self { simulation: Simulation { scenario: scenario.to_owned(), ..self.simulation }, ..self }
    }

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
        let document: Table = text.parse().map_err(|error| not_toml(path, &text, &error))?;
        let fail = |problem: Problem| {
            let span = locate::span(&text, &problem.key, problem.mark);
            Failure::at(path, &text, span, &problem.found, &problem.expected, &problem.advice)
        };
        if document.is_empty() {
            return Err(fail(Problem::name(
                KeyPath::default(),
                "there is nothing in this scenario",
                "expected keys",
                "start from one of the files in scenarios/; the README explains the keys",
            )));
        }
        let wire: ScenarioWire = reader::document(&document).map_err(&fail)?;
        let folder = path.parent().map(PathBuf::from).unwrap_or_default();
        // The document as written has to make sense by itself: a sweep changes it, it does not complete it.
        let base = resolve::cell(&wire, &folder).map_err(&fail)?;
        let axes: Vec<Axis> = wire
            .sweep
            .iter()
            .enumerate()
            .map(|(index, axis)| axis.resolve(index))
            .collect::<Result<_, _>>()
            .map_err(&fail)?;
        let combinations = sweep::product(&axes).map_err(&fail)?;
        check_size(wire.replicates, combinations.len()).map_err(&fail)?;
        let cells: Vec<Cell> = combinations
            .iter()
            .map(|points| swept(&document, points, &base, &folder))
            .map(|cell| cell.map(|cell| cell.named(name)))
            .collect::<Result<_, _>>()
            .map_err(&fail)?;
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

/// Largest number of trials; more is a slip of the pen.
const MOST_TRIALS: u64 = 1_000_000_000;

fn check_size(replicates: u64, cells: usize) -> Result<(), Problem> {
    let key = KeyPath::dotted("replicates");
    if replicates == 0 {
        return Err(Problem::value(
            key,
            "`replicates` is 0, so nothing would be run",
            "expected at least 1",
            "give the number of trials in every cell, or leave the key out for one",
        ));
    }
    if replicates.saturating_mul(cells as u64) > MOST_TRIALS {
        return Err(Problem::value(
            key,
            format!("`replicates` is {replicates}, for a design of size {cells}"),
            format!("expected at most {MOST_TRIALS} trials in all"),
            "use fewer replicates; 200 are enough for a first look",
        ));
    }
    Ok(())
}

/// One cell of the design: the document with the keys of its points changed, resolved like any scenario.
fn swept(document: &Table, points: &[&sweep::Point], base: &Cell, folder: &Path) -> Result<Cell, Problem> {
    let labels: Vec<String> = points.iter().map(|point| point.label.clone()).collect();
    let settings = || points.iter().flat_map(|point| &point.set);
    // The point that sets the key at fault, or one above or below it; else the last point, which may only be one of several.
    let blame = |problem: Problem| {
        let of_key = settings().rfind(|setting| setting.key.meets(&problem.key));
        let setting = of_key.or_else(|| settings().next_back());
        match setting {
            Some(setting) => setting.blamed(problem, (labels.len() > 1).then(|| labels.join(", ")).as_deref()),
            None => problem,
        }
    };
    let mut changed = document.clone();
    for setting in settings() {
        sweep::set(&mut changed, setting).map_err(blame)?;
    }
    let wire: ScenarioWire = reader::document(&changed).map_err(blame)?;
    let resolved = resolve::cell(&wire, folder).map_err(blame)?;
    if resolved.methods.iter().map(|method| &method.label).ne(base.methods.iter().map(|method| &method.label)) {
        return Err(blame(Problem::value(
            KeyPath::dotted("identifier"),
            "the methods are not the same in every cell",
            "expected settings of methods",
            "sweep settings only, and name every method once in an [[identifier]] of its own",
        )));
    }
    let values = points.iter().map(|point| point.value).collect();
    Ok(Cell { labels, values, ..resolved })
}

/// A file that is not TOML, at the place where it stops to be.
fn not_toml(path: &Path, text: &str, error: &toml::de::Error) -> Failure {
    let span = error.span().unwrap_or(0..0);
    let message = match error.message() {
        message if message.starts_with("invalid type: integer") => "this number has too many digits".to_owned(),
        message => message.split_whitespace().collect::<Vec<_>>().join(" "),
    };
    let advice = match path.extension().is_some_and(|extension| extension == "toml") {
        true => "mend the line; a scenario is a TOML file of `key = value` lines under [table] headings",
        false => "give a scenario (a TOML file); a record is identified with `study fit`",
    };
    Failure::at(path, text, span, "this is not valid TOML", &message, advice)
}

/// Largest scenario file accepted, bytes.
const LARGEST_FILE: u64 = 1 << 20;

fn read_text(path: &Path) -> Result<String, Failure> {
    let refuse = |problem: String, advice: &str| Failure::input(format!("{}: {problem}; {advice}", path.display()));
    let advice = "give the path of a scenario (a TOML file)";
    let about = fs::metadata(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => refuse("there is no such file".into(), advice),
        _ => refuse(format!("cannot be read: {error}"), advice),
    })?;
    if about.is_dir() {
        return Err(refuse("this is a folder".into(), advice));
    }
    if about.len() > LARGEST_FILE {
        let problem = format!("this file has {} bytes, a scenario has at most {LARGEST_FILE}", about.len());
        return Err(refuse(problem, "if it is a record, identify it with `study fit`"));
    }
    let bytes = fs::read(path).map_err(|error| refuse(format!("cannot be read: {error}"), "check its rights"))?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count();
        let byte = error.as_bytes()[valid];
        refuse(format!("line {line} holds the byte 0x{byte:02x}, which is not UTF-8 text"), advice)
    })
}

/// Bytes as hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
