//! JSON output of commands that write no JSON document to a file, as `--format json` prints it.

use std::collections::BTreeMap;

use campaign::manifest::Manifest;
use campaign::scenario::MethodName;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

/// JSON document of a command that writes it to no file.
pub trait CommandAnswer: Serialize + JsonSchema {
    /// Name and version of the document, such as `list/1`.
    const SCHEMA: &'static str;
}

/// Document preceded by its version.
#[derive(Serialize, JsonSchema)]
pub struct Versioned<T> {
    /// Name and version of the document.
    pub schema: &'static str,
    /// Body of the document.
    #[serde(flatten)]
    pub body: T,
}

/// A list of `study list`.
#[derive(Serialize, JsonSchema)]
pub struct ListAnswer {
    /// Name of the list.
    pub what: String,
    /// Rows of the list, each an object keyed by the column heads.
    pub entries: Vec<Value>,
}

/// Result of `study check`.
#[derive(Serialize, JsonSchema)]
pub struct CheckAnswer {
    /// Valid scenarios.
    pub scenarios: Vec<CheckedScenario>,
    /// Number of invalid scenarios.
    pub wrong: usize,
}

/// A valid scenario.
#[derive(Serialize, JsonSchema)]
pub struct CheckedScenario {
    /// File, as the user named it.
    pub file: String,
    /// Name of the scenario.
    pub name: String,
    /// Question of the scenario.
    pub question: String,
    /// Seed of a run.
    pub seed: u64,
    /// SHA-256 of all settings that determine the rows.
    pub design_sha256: String,
    /// Number of trials of a cell.
    pub replicates: u64,
    /// Labels of every cell.
    pub cells: Vec<Vec<String>>,
    /// Methods of the scenario.
    pub methods: Vec<MethodName>,
    /// Assumptions for values left open that can affect the result.
    pub assumptions: Vec<String>,
    /// The scenario with all defaults, if requested.
    #[schemars(with = "Option<Map<String, Value>>")]
    pub resolved: Option<toml::Table>,
}

/// Result of a finished study.
#[derive(Serialize, JsonSchema)]
pub struct StudyAnswer<'a> {
    /// Path of the folder.
    pub folder: String,
    /// Manifest of the run.
    pub manifest: &'a Manifest,
    /// One object for every cell and method, keyed by the column heads of `summary.csv`.
    pub summary: Vec<Value>,
    /// Failed identifications with their reasons.
    pub failures: Vec<String>,
}

/// Result of a part of a study.
#[derive(Serialize, JsonSchema)]
pub struct ShardAnswer<'a> {
    /// Path of the folder.
    pub folder: String,
    /// Manifest of the run.
    pub manifest: &'a Manifest,
}

/// Result of `study simulate`.
#[derive(Serialize, JsonSchema)]
pub struct SimulateAnswer {
    /// Number of records.
    pub records: u64,
    /// The first file of every trial.
    pub files: Vec<String>,
}

/// Result of `study man`.
#[derive(Serialize, JsonSchema)]
pub struct ManAnswer {
    /// Paths of the pages.
    pub files: Vec<String>,
}

/// Result of `study completions`.
#[derive(Serialize, JsonSchema)]
pub struct CompletionsAnswer {
    /// Name of the shell.
    pub shell: String,
    /// Text of the script.
    pub script: String,
}

/// A first description of a table.
#[derive(Serialize, JsonSchema)]
pub struct SidecarAnswer {
    /// Path of the file; `null` if it was not written.
    pub file: Option<String>,
    /// Keys and values of the description.
    #[schemars(with = "Map<String, Value>")]
    pub sidecar: toml::Table,
}

/// Properties of the machine.
#[derive(Serialize, JsonSchema)]
pub struct DoctorAnswer {
    /// Results of the checks, by name.
    #[serde(flatten)]
    pub checks: BTreeMap<String, String>,
}

macro_rules! answers {
    ($($name:ty: $schema:literal),* $(,)?) => {
        $(impl CommandAnswer for $name {
            const SCHEMA: &'static str = $schema;
        })*
    };
}

answers! {
    ListAnswer: "list/1",
    CheckAnswer: "check/1",
    StudyAnswer<'_>: "study/1",
    ShardAnswer<'_>: "shard/1",
    SimulateAnswer: "simulate/1",
    ManAnswer: "man/1",
    CompletionsAnswer: "completions/1",
    SidecarAnswer: "sidecar/1",
    DoctorAnswer: "doctor/1",
}
