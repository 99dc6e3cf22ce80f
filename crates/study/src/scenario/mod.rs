//! Scenario files: one question each, read strictly, resolved completely before anything runs.
//!
//! `wire` is what a file says, `reader` how it is read, [`sweep`] the design, `resolve` the checks, `problem` and `locate`
//! what is wrong and where, [`Scenario`] what the engine accepts. A value of [`Scenario`] has been checked in every cell
//! of the design.

mod draw;
mod effect;
pub mod identity;
mod limits;
mod locate;
mod part;
mod problem;
mod reader;
mod resolve;
mod specification;
mod stop;
pub mod sweep;
mod wire;
mod words;

use std::borrow::Cow;
use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};

use identify::{Estimate, Identifier, IdentifierSettings, IdentifyError};
use rand::RngExt;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use simulate::{Purpose, StreamKey};
use toml::{Table, Value};
use trial::Trial;
use trial::file::{self, FileError, Kind};
use trial::reader::RECORD;

use crate::failure::{Failure, OnPath};
use crate::manifest::Manifest;
use crate::name::{self, LONGEST_NAME};
use draw::{Draw, DrawWire};
pub use effect::keys as effect_keys;
use part::Part;
use problem::{KeyPath, Problem, of_text, suggestion};
use reader::Gaps;
pub use resolve::{HULL, Specification};
pub use stop::{Index, StopFigure, StopRule};
use sweep::Axis;
use wire::{PublishedWire, ScenarioWire};
pub use words::Words;

/// A method as a scenario names it.
pub struct Method {
    /// Label in tables and figures; unique in the scenario.
    pub label: String,
    /// Id of the method.
    pub id: &'static str,
    /// What it does.
    pub means: Means,
}

/// What a method does with a trial.
pub enum Means {
    /// Identifies a first-order response.
    Identify {
        /// Settings of the method.
        settings: IdentifierSettings,
        /// The method with its settings.
        identifier: Box<dyn Identifier>,
    },
    /// Traces what a first-order response lacks.
    Trace(::trace::Settings),
}

/// Id of a trace among the methods.
pub const TRACE: &str = "trace";

/// What a method is called, and which it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MethodName {
    /// Label in tables and figures.
    pub label: String,
    /// Id of the method.
    pub id: String,
}

/// Identifies one trial; a method that draws at random draws from the stream of this trial.
pub fn identify(identifier: &dyn Identifier, trial: &Trial, key: &StreamKey) -> Result<Estimate, IdentifyError> {
    let own = identifier.with_seed(key.rng(Purpose::Method).random());
    own.as_deref().unwrap_or(identifier).identify(std::slice::from_ref(trial))
}

/// One cell of the design: everything but chance is fixed.
pub struct Cell {
    /// Labels of its points, one an axis.
    pub labels: Vec<String>,
    /// Values of its points, where an axis is a number.
    pub values: Vec<Option<f64>>,
    /// The methods, all on the same trial.
    pub methods: Vec<Method>,
    /// How a trial is made; drawn values are in the middle of their distributions.
    specification: Specification,
    /// How a trial with drawn values is made.
    drawn: Option<Drawn>,
}

/// What a trial with drawn values is made from.
struct Drawn {
    draws: Vec<Draw>,
    /// The document of the cell, as far as it says how a trial is made, with every drawn value in the middle.
    document: Table,
    /// Where the drawn values stand in it.
    gaps: Gaps,
    folder: PathBuf,
}

/// How one trial is made.
pub struct Specimen<'a> {
    /// The specification, whole.
    pub specification: Cow<'a, Specification>,
    /// Drawn values in the units of their keys, in the order of [`Scenario::draws`].
    pub drawn: Vec<f64>,
}

/// Drawn values that make no trial.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(String);

impl Cell {
    /// The same cell; its trials carry the name of the scenario.
    fn named(mut self, scenario: &str) -> Self {
        self.specification.name(scenario);
        self
    }

    /// Whether one of its methods is a trace.
    pub fn traces(&self) -> bool {
        self.methods.iter().any(|method| matches!(method.means, Means::Trace(_)))
    }

    /// Effects a first-order base lacks in its trials.
    pub fn missing(&self) -> Vec<String> {
        self.specification.missing.clone()
    }

    /// Labels of the points joined, or nothing when there is no axis.
    pub fn title(&self) -> String {
        self.labels.join(", ")
    }

    /// Whether all its trials have one specification.
    pub fn is_fixed(&self) -> bool {
        self.drawn.is_none()
    }

    /// How the trial of `key` is made.
    ///
    /// Fails when drawn values make no trial, which only a distribution without ends can do.
    pub fn specimen(&self, key: &StreamKey) -> Result<Specimen<'_>, Refusal> {
        let Some(drawn) = &self.drawn else {
            return Ok(Specimen { specification: Cow::Borrowed(&self.specification), drawn: Vec::new() });
        };
        let values: Vec<f64> = drawn.draws.iter().map(|draw| draw.value(key)).collect();
        let mut specification = drawn.specification(&values).map_err(|problem| Refusal(problem.found))?;
        specification.name(&self.specification.simulation.scenario);
        Ok(Specimen { specification: Cow::Owned(specification), drawn: values })
    }
}

impl Drawn {
    /// Draws for a cell, each tried in the middle and at the ends of its range, and the specification in the middle of all;
    /// `None` where nothing is drawn.
    ///
    /// Fails with the draw at fault and what is wrong with the trial.
    fn new(draws: &[Draw], document: &Table, folder: &Path) -> Result<Option<(Self, Specification)>, (usize, Problem)> {
        if draws.is_empty() {
            return Ok(None);
        }
        let blamed = |index: usize, problem: Problem| {
            let of_key = draws.iter().position(|draw| draw.key.meets(&problem.key));
            (of_key.unwrap_or(index), problem)
        };
        let middle: Vec<f64> = draws.iter().map(Draw::middle).collect();
        let mut document = only(document, &[Part::Trial]);
        for (draw, &value) in draws.iter().zip(&middle) {
            sweep::set(&mut document, &draw.key, Value::Float(value)).map_err(|problem| blamed(0, problem))?;
        }
        let gaps = Gaps::new(draws.iter().map(|draw| &draw.key));
        let drawn = Self { draws: draws.to_vec(), document, gaps, folder: folder.to_owned() };
        let specification = drawn.specification(&middle).map_err(|problem| blamed(0, problem))?;
        for (index, draw) in draws.iter().enumerate() {
            for value in draw.ends() {
                let mut values = middle.clone();
                values[index] = value;
                drawn.specification(&values).map_err(|problem| blamed(index, problem))?;
            }
        }
        Ok(Some((drawn, specification)))
    }

    /// The specification with these values; what they do not touch is as it is in the middle.
    fn specification(&self, values: &[f64]) -> Result<Specification, Problem> {
        let values: Vec<Value> = values.iter().copied().map(Value::Float).collect();
        resolve::specification(&reader::filled(&self.document, &self.gaps, &values)?, &self.folder)
    }
}

/// Some parts of a document, and empty ones where a document needs more.
fn only(document: &Table, parts: &[Part]) -> Table {
    let empty = [
        ("question", Value::String(String::new())),
        ("seed", Value::Integer(0)),
        ("identifier", Value::Array(Vec::new())),
    ];
    let mut some: Table = empty.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    let kept = document.iter().filter(|(key, _)| parts.contains(&Part::of(key)));
    some.extend(kept.map(|(key, value)| (key.clone(), value.clone())));
    some
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
    /// What it says about itself.
    pub words: Words,
    /// Whether the first replicate of every cell is shown in detail.
    pub showcase: bool,
    /// Keys that are drawn anew in every trial.
    pub draws: Vec<String>,
    /// When a cell has had enough trials.
    pub stop: Option<StopRule>,
    /// SHA-256 of all that decides the rows, the seed of the command line apart, and of the files it reads.
    pub design_sha256: String,
    /// The file as it was read.
    pub text: String,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
}

impl Scenario {
    /// Reads and resolves a file; of a manifest the scenario in it, with the seed it was run with.
    ///
    /// Fails with a message that names the file, the line and the key, what was found and what was expected. The name of
    /// the study, which its folder is called by, has to be one ([`name::file`]).
    pub fn read(path: &Path, seed: Option<u64>) -> Result<Self, Failure> {
        let text = read_text(path)?;
        if let Some(manifest) = Manifest::of_text(&text) {
            name::file(&manifest.name).map_err(|unfit| {
                let Problem { key, mark, found, expected, advice } =
                    of_text(KeyPath::dotted("name"), &manifest.name, unfit);
                Failure::at(path, &text, locate::span(&text, &key, mark), &found, &expected, &advice)
            })?;
            return Self::parse(path, &manifest.name, manifest.scenario, Some(seed.unwrap_or(manifest.seed)));
        }
        Self::parse(path, &name::of_file(path)?, text, seed)
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
        for (key, text) in [("question", &wire.question), ("analysis", &wire.analysis), ("finding", &wire.finding)] {
            name::prose(text).map_err(|unfit| fail(of_text(KeyPath::dotted(key), text, unfit)))?;
        }
        if let Some(stem) = &wire.output.figure {
            name::file(stem).map_err(|unfit| fail(of_text(KeyPath::dotted("output.figure"), stem, unfit)))?;
        }
        // The document as written has to make sense by itself: sweeps and draws change it, they do not complete it.
        resolve::specification(&wire, &folder).map_err(&fail)?;
        let methods = resolve::methods(&wire.identifier).map_err(&fail)?;
        let stop = wire.stop.as_ref().map(|stop| stop.resolve(&methods)).transpose().map_err(&fail)?;
        let axes: Vec<Axis> = wire
            .sweep
            .iter()
            .enumerate()
            .map(|(index, axis)| axis.resolve(index))
            .collect::<Result<_, _>>()
            .map_err(&fail)?;
        let combinations = sweep::product(&axes).map_err(&fail)?;
        check_titles(&axes).map_err(&fail)?;
        check_size(wire.replicates, combinations.len(), methods.len()).map_err(&fail)?;
        check_draws(&wire.draw, &axes).map_err(&fail)?;
        let of_cells = only(&document, &[Part::Trial, Part::Cell]);
        let cells: Vec<Cell> = combinations
            .iter()
            .map(|points| swept(&of_cells, points, &methods, &folder))
            .map(|cell| cell.map(|cell| cell.named(name)))
            .collect::<Result<_, _>>()
            .map_err(&fail)?;
        check_detail(&wire.output.detail, &cells).map_err(&fail)?;
        Ok(Self {
            name: name.to_owned(),
            seed: seed.unwrap_or(wire.seed),
            replicates: wire.replicates,
            draws: wire.draw.iter().map(|draw| draw.key().to_owned()).collect(),
            axes,
            cells,
            published: published(&wire.published).map_err(&fail)?,
            showcase: wire.output.showcase,
            words: Words {
                question: wire.question,
                analysis: wire.analysis,
                finding: wire.finding,
                figure: wire.output.figure,
                detail: wire.output.detail,
            },
            stop,
            design_sha256: sha256_of(&identity::design_of(&document), &folder)?,
            sha256: hex(&Sha256::digest(text.as_bytes())),
            text,
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

/// Values of other authors; fails where one is no number.
fn published(wire: &PublishedWire) -> Result<Published, Problem> {
    let finite = |name: &str, value: Option<f64>| match value {
        Some(value) if !value.is_finite() => {
            let key = KeyPath::dotted("published").child(name);
            let found = format!("`{key}` is {value}");
            Err(Problem::value(key, found, "expected a finite number", "give the number, or leave the key out"))
        }
        _ => Ok(value),
    };
    Ok(Published { k_per_s: finite("K-per-s", wire.K_per_s)?, t_s: finite("T-s", wire.T_s)? })
}

/// Largest number of trials; more is a slip of the pen.
const MOST_TRIALS: u64 = 1_000_000_000;

fn check_size(replicates: u64, cells: usize, methods: usize) -> Result<(), Problem> {
    let key = KeyPath::dotted("replicates");
    if replicates == 0 {
        return Err(Problem::value(
            key,
            "`replicates` is 0, so nothing would be run",
            "expected at least 1",
            "give the number of trials in every cell, or leave the key out for one",
        ));
    }
    if cells * methods > limits::MOST_METHODS_OF_CELLS {
        return Err(Problem::name(
            KeyPath::dotted("sweep"),
            format!("the sweeps make {cells} cells, each with {methods} methods"),
            format!("expected at most {} methods of cells in all", limits::MOST_METHODS_OF_CELLS),
            "use fewer points or fewer methods, or make several scenarios of this one",
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

/// Files are named after cells, so their labels are not too long together.
fn check_titles(axes: &[Axis]) -> Result<(), Problem> {
    let longest = |axis: &Axis| axis.points.iter().map(|point| point.label.chars().count()).max().unwrap_or(0);
    let found = axes.iter().map(|axis| longest(axis) + ", ".len()).sum::<usize>();
    if found <= LONGEST_NAME {
        return Ok(());
    }
    Err(Problem::name(
        KeyPath::dotted("sweep"),
        format!("the labels of a cell have up to {found} characters together"),
        format!("expected at most {LONGEST_NAME}"),
        "shorten the longest labels, or sweep along fewer axes",
    ))
}

/// Draws and sweeps change different keys, and no key twice.
fn check_draws(draws: &[DrawWire], axes: &[Axis]) -> Result<(), Problem> {
    limits::entries("draw", draws.len(), limits::MOST_DRAWS)?;
    for (index, draw) in draws.iter().enumerate() {
        let own = KeyPath::dotted(draw.key());
        let place = KeyPath::dotted("draw").child(index).child("key");
        let by_draw = draws[..index].iter().any(|other| KeyPath::dotted(other.key()).meets(&own));
        let by_sweep =
            axes.iter().flat_map(|axis| &axis.points).flat_map(|point| &point.set).any(|set| set.key.meets(&own));
        if by_draw || by_sweep {
            return Err(Problem::value(
                place,
                format!("`{own}` is drawn, and {} changes it too", if by_draw { "another draw" } else { "a sweep" }),
                "expected a key that nothing else changes",
                "remove one of them; a sweep can change the numbers of a draw, for instance `draw.0.normal.sd`",
            ));
        }
    }
    Ok(())
}

/// Every title is that of a cell.
fn check_detail(titles: &[String], cells: &[Cell]) -> Result<(), Problem> {
    let known: Vec<String> = cells.iter().map(Cell::title).filter(|title| !title.is_empty()).collect();
    let places: HashSet<&str> = known.iter().map(String::as_str).collect();
    let Some((index, title)) = titles.iter().enumerate().find(|(_, title)| !places.contains(title.as_str())) else {
        return Ok(());
    };
    let advice = match &known[..known.len().min(20)] {
        [] => "leave the key out: a study without a sweep shows its only cell".to_owned(),
        shown => suggestion(title, shown),
    };
    Err(Problem::value(
        KeyPath::dotted("output.detail").child(index),
        format!("no cell is called {title:?}"),
        "expected labels of points, joined by commas",
        advice,
    ))
}

/// SHA-256 of a design and of the records it replays.
///
/// Fails when such a record is there and cannot be read to its end.
fn sha256_of(design: &Table, folder: &Path) -> Result<String, Failure> {
    let mut digest = Sha256::new_with_prefix(design.to_string());
    let mut tables = vec![design];
    while let Some(table) = tables.pop() {
        for (key, value) in table {
            match value {
                Value::Table(inner) => tables.push(inner),
                Value::String(name) if key == "file" => {
                    let path = folder.join(name);
                    match file::open(&path, RECORD) {
                        Ok(mut record) => drop(io::copy(&mut record, &mut digest).on("read", &path)?),
                        // It has been refused, or belongs to a point that is never resolved with it.
                        Err(FileError::NotFound | FileError::Folder | FileError::NoFile) => {}
                        Err(error) => return Err(error).on("read", &path),
                    }
                }
                Value::Array(items) => tables.extend(items.iter().filter_map(Value::as_table)),
                _ => {}
            }
        }
    }
    Ok(hex(&digest.finalize()))
}

/// One cell of the design: what the document says of trials and methods, with the keys of its points changed, resolved like
/// any scenario.
fn swept(document: &Table, points: &[&sweep::Point], base: &[Method], folder: &Path) -> Result<Cell, Problem> {
    let labels: Vec<String> = points.iter().map(|point| point.label.clone()).collect();
    let settings = || points.iter().flat_map(|point| &point.set);
    let cell = (labels.len() > 1).then(|| labels.join(", "));
    // The point that sets the key at fault, or one above or below it; else the last point, which may only be one of several.
    let blame = |problem: Problem| {
        let of_key = settings().rfind(|setting| setting.key.meets(&problem.key));
        match of_key.or_else(|| settings().next_back()) {
            Some(setting) => setting.blamed(problem, cell.as_deref()),
            None => problem,
        }
    };
    let mut changed = document.clone();
    for setting in settings() {
        sweep::set(&mut changed, &setting.key, setting.value.clone()).map_err(blame)?;
    }
    let wire: ScenarioWire = reader::document(&changed).map_err(blame)?;
    let specification = resolve::specification(&wire, folder).map_err(blame)?;
    let methods = resolve::methods(&wire.identifier).map_err(blame)?;
    if methods.iter().map(|method| &method.label).ne(base.iter().map(|method| &method.label)) {
        return Err(blame(Problem::value(
            KeyPath::dotted("identifier"),
            "the methods are not the same in every cell",
            "expected settings of methods",
            "sweep settings only, and name every method once in an [[identifier]] of its own",
        )));
    }
    limits::entries("draw", wire.draw.len(), limits::MOST_DRAWS).map_err(blame)?;
    let draws: Vec<Draw> = wire
        .draw
        .iter()
        .enumerate()
        .map(|(index, draw)| draw.resolve(index))
        .collect::<Result<_, _>>()
        .map_err(|problem| if points.is_empty() { problem } else { blame(problem) })?;
    let drawn =
        Drawn::new(&draws, &changed, folder).map_err(|(draw, problem)| draws[draw].blamed(problem, cell.as_deref()))?;
    let (drawn, specification) = match drawn {
        Some((drawn, specification)) => (Some(drawn), specification),
        None => (None, specification),
    };
    let values = points.iter().map(|point| point.value).collect();
    Ok(Cell { labels, values, methods, specification, drawn })
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

/// A scenario, alone or in a manifest; the longest published one has a hundredth of this.
const SCENARIO: Kind = Kind { name: "a scenario", largest: 1 << 20 };

fn read_text(path: &Path) -> Result<String, Failure> {
    file::read_text(path, SCENARIO).map_err(|error| {
        let advice = match error {
            FileError::TooLarge { .. } => "a record is identified with `study fit`",
            _ => "expected the path of a scenario (a TOML file)",
        };
        Failure::input(format!("{}: {error}; {advice}", path.display()))
    })
}

/// Bytes as hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
