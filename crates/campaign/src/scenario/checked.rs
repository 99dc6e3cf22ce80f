//! Checked scenario: reading, resolution and extension.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use identify::Identifier;
use serde::Deserialize;
use sha2::{Digest, Sha256};
use simulate::Assumption;
use toml::Table;
use trial::file::{self, FileError, FileKind};

use crate::failure::Failure;
use crate::scenario::cell::{self, DesignCell};
use crate::scenario::identity::{self, hex_digits};
use crate::scenario::method::{Method, MethodName, Procedure, methods};
use crate::scenario::outside_estimates::OutsideEstimates;
use crate::scenario::part::ScenarioPart;
use crate::scenario::predictions::PredictionSettings;
use crate::scenario::problem::{KeyFault, KeyPath, text_fault};
use crate::scenario::prose::{Presentation, Prose, Published};
use crate::scenario::records::{self, RecordScenarioWire};
use crate::scenario::stop::StopRule;
use crate::scenario::sweep::{self, SweepAxis};
use crate::scenario::wire::ScenarioWire;
use crate::scenario::{checks, locate, name, reader, resolve, resolved};

/// Key of a study of measured records, in place of ship, manoeuvre and instruments.
const RECORDS: &str = "records";

/// Scenario, checked in every cell.
pub struct Scenario {
    /// Stem of the file.
    pub name: String,
    /// Key of every random number.
    pub seed: u64,
    /// Maximum number of trials per cell.
    pub replicates: u64,
    /// Axes of the design.
    pub axes: Vec<SweepAxis>,
    /// Cells of the design; the first axis varies slowest.
    pub cells: Vec<DesignCell>,
    /// Published values of other authors.
    pub published: Published,
    /// Prose and presentation.
    pub prose: Prose,
    /// Keys that are sampled anew in every trial.
    pub drawn_keys: Vec<String>,
    /// Stopping rule of the cells; `None` if every cell has all replicates.
    pub stop: Option<StopRule>,
    /// Manoeuvres predicted from every estimate; `None` without predictions.
    pub predictions: Option<PredictionSettings>,
    /// SHA-256 of the design and of the records it replays; a seed from the command line is not included.
    pub design_sha256: String,
    /// The file as it was read.
    pub text: String,
    /// SHA-256 of the file, hexadecimal.
    pub file_sha256: String,
    /// Keys of `[output]` in a manifest of another version, which are omitted.
    pub unknown_output: Vec<String>,
}

fn table_of(path: &Path, text: &str) -> Result<Table, Failure> {
    text.parse().map_err(|error| not_toml(path, text, &error))
}

/// Part of a manifest from which its scenario is read.
#[derive(Deserialize)]
struct ManifestScenario {
    name: String,
    seed: u64,
    scenario: String,
}

impl Scenario {
    /// Reads and resolves a scenario file, or the scenario of a manifest with the seed of its run.
    ///
    /// Fails with a message that names file, line and key, the value found and what was expected. The name of the study
    /// must be a valid file name ([`name::check_file_name`]).
    pub fn read(path: &Path, seed: Option<u64>) -> Result<Self, Failure> {
        let text = read_text(path)?;
        if let Ok(manifest) = toml::from_str::<ManifestScenario>(&text) {
            name::check_file_name(&manifest.name).map_err(|unfit| {
                let KeyFault { key, mark, problem, expected, advice } =
                    text_fault(KeyPath::from_dotted("name"), &manifest.name, unfit);
                Failure::in_text(path, &text, locate::key_span(&text, &key, mark), &problem, &expected, &advice)
            })?;
            let (text, seed) = (manifest.scenario, Some(seed.unwrap_or(manifest.seed)));
            let mut document = table_of(path, &text)?;
            let unknown_output = Presentation::remove_unknown(&mut document);
            let scenario = Self::from_table(path, &manifest.name, text, &document, seed)?;
            return Ok(Self { unknown_output, ..scenario });
        }
        Self::parse(path, &name::study_name(path)?, text, seed)
    }

    /// Resolves the text of a scenario; messages and relative paths refer to `path`.
    pub fn parse(path: &Path, name: &str, text: String, seed: Option<u64>) -> Result<Self, Failure> {
        let document = table_of(path, &text)?;
        Self::from_table(path, name, text, &document, seed)
    }

    /// Resolves the table of a scenario; a fault is shown at its place in the text. `seed` replaces that of the file.
    fn from_table(path: &Path, name: &str, text: String, document: &Table, seed: Option<u64>) -> Result<Self, Failure> {
        let folder = &folder_of(path);
        let scenario = Self::from_document(document, name, folder).map_err(|fault| {
            let span = locate::key_span(&text, &fault.key, fault.mark);
            Failure::in_text(path, &text, span, &fault.problem, &fault.expected, &fault.advice)
        })?;
        let design = identity::study_design(document);
        let design_sha256 = match document.contains_key(RECORDS) {
            true => records::design_sha256(&design, scenario.cells.iter().filter_map(DesignCell::record_set)),
            false => identity::study_sha256(&design, folder)?,
        };
        let seed = seed.unwrap_or(scenario.seed);
        Ok(Self { seed, design_sha256, file_sha256: hex_digits(&Sha256::digest(text.as_bytes())), text, ..scenario })
    }

    /// Resolves a document; the caller sets identity and text.
    fn from_document(document: &Table, name: &str, folder: &Path) -> Result<Self, KeyFault> {
        if document.is_empty() {
            return Err(KeyFault::name(
                KeyPath::default(),
                "there is nothing in this scenario",
                "expected keys",
                "start from one of the files in scenarios/; docs/src/reference/scenarios.md explains the keys",
            ));
        }
        if document.contains_key(RECORDS) {
            return Self::from_records(document, name, folder);
        }
        let wire: ScenarioWire = reader::read_document(document)?;
        let prose = Prose {
            question: wire.question.clone(),
            analysis: wire.analysis.clone(),
            finding: wire.finding.clone(),
            output: wire.output.clone(),
        };
        prose.check()?;
        // The document must be valid without sweeps and draws, which change but do not complete it.
        resolve::trial_specification(&wire, name, folder)?;
        let methods = methods(&wire.identifier)?;
        let predictions = wire.predict.as_ref().map(|predict| predict.resolve()).transpose()?;
        wire.stop.as_ref().map_or(Ok(()), |stop| stop.check(&methods))?;
        let axes = sweep::resolve_axes(&wire.sweep)?;
        let combinations = sweep::combine_points(&axes)?;
        checks::check_cell_titles(&axes)?;
        checks::check_study_size(wire.replicates, combinations.len(), methods.len())?;
        checks::check_draws(&wire.draw, &axes)?;
        let of_cells = cell::select_parts(document, &[ScenarioPart::Trial, ScenarioPart::Cell]);
        let cells = combinations.iter().map(|points| cell::simulated_cell(&of_cells, points, &methods, name, folder));
        let cells: Vec<DesignCell> = cells.collect::<Result<_, _>>()?;
        wire.published.check()?;
        let design = Self::from_design(name, prose, axes, cells, &methods)?;
        Ok(Self {
            seed: wire.seed,
            replicates: wire.replicates,
            published: wire.published,
            drawn_keys: wire.draw.iter().map(|draw| draw.key().to_owned()).collect(),
            stop: wire.stop,
            predictions,
            ..design
        })
    }

    /// Resolves a document of measured records.
    fn from_records(document: &Table, name: &str, folder: &Path) -> Result<Self, KeyFault> {
        let wire: RecordScenarioWire = reader::read_document(document)?;
        let RecordScenarioWire { question, analysis, finding, seed, predict, identifier, sweep, output, .. } = wire;
        let prose = Prose { question, analysis, finding, output };
        prose.check()?;
        let methods = methods(&identifier)?;
        let predictions = predict.as_ref().map(|predict| predict.resolve()).transpose()?;
        let axes = sweep::resolve_axes(&sweep)?;
        let combinations = sweep::combine_points(&axes)?;
        checks::check_cell_titles(&axes)?;
        let cells = combinations.iter().map(|points| cell::measured_cell(document, points, &methods, folder));
        let cells: Vec<DesignCell> = cells.collect::<Result<_, _>>()?;
        let counts = cells.iter().filter_map(DesignCell::record_set).map(|set| set.splits.len() as u64);
        let replicates = counts.max().unwrap_or(0);
        // Without any record there is no trial, which is reported in the run.
        checks::check_study_size(replicates.max(1), cells.len(), methods.len())?;
        let design = Self::from_design(name, prose, axes, cells, &methods)?;
        Ok(Self { seed, replicates, predictions, ..design })
    }

    /// Scenario of cells and methods; the caller sets trials, seed, identity, text and optional parts.
    ///
    /// Fails if the presentation names cells, axes or methods that do not exist.
    fn from_design(
        name: &str,
        prose: Prose,
        axes: Vec<SweepAxis>,
        cells: Vec<DesignCell>,
        methods: &[Method],
    ) -> Result<Self, KeyFault> {
        checks::check_detail_titles(&prose.output.detail, &cells)?;
        checks::check_marked_values(&prose.output.marks, &axes)?;
        checks::check_highlight(&prose.output.highlight, methods, &axes, &cells)?;
        Ok(Self {
            name: name.to_owned(),
            seed: 0,
            replicates: 0,
            axes,
            cells,
            published: Published::default(),
            prose,
            drawn_keys: Vec::new(),
            stop: None,
            predictions: None,
            design_sha256: String::new(),
            text: String::new(),
            file_sha256: String::new(),
            unknown_output: Vec::new(),
        })
    }

    /// Maximum number of trials of a cell; for measured records the number of splits.
    pub fn max_cell_trials(&self, cell: usize) -> u64 {
        self.cells[cell].record_set().map_or(self.replicates, |set| set.splits.len() as u64)
    }

    /// Maximum number of trials of all cells.
    pub fn max_trials(&self) -> u64 {
        (0..self.cells.len()).map(|cell| self.max_cell_trials(cell)).sum()
    }

    /// Scenario with the methods of these labels, or all for an empty list; `None` if no method is left.
    pub fn restricted_to_methods(mut self, labels: &[String]) -> Option<Self> {
        if !labels.is_empty() {
            for cell in &mut self.cells {
                cell.methods.retain(|method| labels.contains(&method.label));
            }
            self.design_sha256 =
                hex_digits(&Sha256::digest(format!("{} of {}", self.design_sha256, labels.join(", "))));
        }
        (!self.cells[0].methods.is_empty()).then_some(self)
    }

    /// Scenario with a method of the caller appended to its own methods, on the same trials.
    ///
    /// Fails for an invalid label, and for one already in use.
    pub fn with_identifier(self, label: &str, identifier: Arc<dyn Identifier>) -> Result<Self, Failure> {
        let id = identifier.id();
        self.with(label, Procedure::Identify { settings: None, identifier }, id)
    }

    /// Scenario with a further method: the estimates of an outside estimator.
    ///
    /// Fails for an invalid label, and for one already in use.
    pub fn with_outside_estimates(self, label: &str, answers: OutsideEstimates) -> Result<Self, Failure> {
        let content = format!("answers {}", answers.source_sha256());
        self.with(label, Procedure::OutsideEstimates(Arc::new(answers)), &content)
    }

    /// Scenario with a further method; `identity_text` enters the SHA-256 of the design.
    fn with(mut self, label: &str, procedure: Procedure, identity_text: &str) -> Result<Self, Failure> {
        name::check_label(label).map_err(|unfit| {
            Failure::input(format!("a method is called {}; {unfit}", name::quoted_beginning(label)))
        })?;
        if self.method_labels().any(|other| other == label) {
            return Err(Failure::input(format!("two methods are called {label:?}; give this one a label of its own")));
        }
        self.design_sha256 = hex_digits(&Sha256::digest(format!("{} {label} {identity_text}", self.design_sha256)));
        for cell in &mut self.cells {
            cell.methods.push(Method { label: label.to_owned(), procedure: procedure.clone() });
        }
        Ok(self)
    }

    /// Scenario as TOML with all defaults written out and marked; for measured records, the text as it was read.
    pub fn resolved(&self) -> String {
        let document: Table = self.text.parse().expect("it has been read");
        if document.contains_key(RECORDS) {
            return self.text.clone();
        }
        resolved::scenario_toml(&document, &self.cells[0].methods).expect("it has been resolved")
    }

    /// Assumptions that can influence the result, most harmful first, each with a sentence without full stop.
    pub fn influential_defaults(&self) -> Vec<(Assumption, String)> {
        let described = |assumption: Assumption| {
            let cells = self.cells.iter().filter(|cell| cell.assumes(assumption)).count();
            let sentence = assumption.sentence();
            match cells {
                0 => None,
                all if all == self.cells.len() => Some((assumption, sentence.to_owned())),
                some => Some((assumption, format!("in {some} of {} cells {sentence}", self.cells.len()))),
            }
        };
        Assumption::ALL.into_iter().filter_map(described).collect()
    }

    /// Labels and ids of the methods, in the order of the scenario.
    pub fn method_names(&self) -> Vec<MethodName> {
        self.cells[0]
            .methods
            .iter()
            .map(|method| MethodName { label: method.label.clone(), id: method.procedure.id().to_owned() })
            .collect()
    }

    /// Labels of the methods, in the order of the scenario.
    pub fn method_labels(&self) -> impl Iterator<Item = &str> {
        self.cells[0].methods.iter().map(|method| method.label.as_str())
    }
}

/// Failure of a text that is not TOML, at the faulty place.
fn not_toml(path: &Path, text: &str, error: &toml::de::Error) -> Failure {
    let span = error.span().unwrap_or(0..0);
    let message = match error.message() {
        message if message.starts_with("invalid type: integer") => "this number has too many digits".to_owned(),
        message => message.split_whitespace().collect::<Vec<_>>().join(" "),
    };
    let advice = match path.extension().is_some_and(|extension| extension == "toml") {
        true => "correct the line; a scenario is a TOML file of `key = value` lines under [table] headings",
        false => "give a scenario (a TOML file); a record is identified with `study fit`",
    };
    Failure::in_text(path, text, span, "this is not valid TOML", &message, advice)
}

/// Folder to which relative paths of a scenario refer.
fn folder_of(path: &Path) -> PathBuf {
    path.parent().map(PathBuf::from).unwrap_or_default()
}

/// Name and maximum size of a scenario, alone or in a manifest; the longest published one has a hundredth of this size.
const SCENARIO: FileKind = FileKind { name: "a scenario", max_bytes: 1 << 20 };

fn read_text(path: &Path) -> Result<String, Failure> {
    file::read_text(path, SCENARIO).map_err(|error| {
        let advice = match error {
            FileError::TooLarge { .. } => "a record is identified with `study fit`",
            _ => "expected the path of a scenario (a TOML file)",
        };
        Failure::input(format!("{}: {error}; {advice}", path.display()))
    })
}
