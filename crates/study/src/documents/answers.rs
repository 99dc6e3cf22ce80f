//! Answers of commands that write no file, as `--format json` prints them.

use std::collections::BTreeMap;

use campaign::manifest::Manifest;
use campaign::scenario::MethodName;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

/// A document without a file of its own.
pub trait CommandAnswer: Serialize + JsonSchema {
    /// Its name and version, such as `list/1`.
    const SCHEMA: &'static str;
}

/// An answer with its version before it.
#[derive(Serialize, JsonSchema)]
pub struct Versioned<T> {
    /// Name and version of the document.
    pub schema: &'static str,
    /// The answer.
    #[serde(flatten)]
    pub body: T,
}

/// A list.
#[derive(Serialize, JsonSchema)]
pub struct ListAnswer {
    /// Name of the list.
    pub what: String,
    /// The lines of the list, each by the heads of its columns.
    pub entries: Vec<Value>,
}

/// Scenarios that were resolved.
#[derive(Serialize, JsonSchema)]
pub struct CheckAnswer {
    /// Valid scenarios.
    pub scenarios: Vec<CheckedScenario>,
    /// Number of invalid scenarios.
    pub wrong: usize,
}

/// A scenario that is right.
#[derive(Serialize, JsonSchema)]
pub struct CheckedScenario {
    /// The file as it was named.
    pub file: String,
    /// Its name.
    pub name: String,
    /// Question of the scenario.
    pub question: String,
    /// The seed of a run.
    pub seed: u64,
    /// SHA-256 of all that decides the rows.
    pub design_sha256: String,
    /// Trials of a cell.
    pub replicates: u64,
    /// Labels of every cell.
    pub cells: Vec<Vec<String>>,
    /// The methods.
    pub methods: Vec<MethodName>,
    /// Assumptions for values left open that can affect the result.
    pub assumptions: Vec<String>,
    /// The scenario with nothing left out, where it was requested.
    #[schemars(with = "Option<Map<String, Value>>")]
    pub resolved: Option<toml::Table>,
}

/// A finished study.
#[derive(Serialize, JsonSchema)]
pub struct StudyAnswer<'a> {
    /// Where it is.
    pub folder: String,
    /// Manifest of the run.
    pub manifest: &'a Manifest,
    /// A line for every cell and method, by the heads of the columns of `summary.csv`.
    pub summary: Vec<Value>,
    /// Failed answers with their reasons.
    pub failures: Vec<String>,
}

/// A part of a study.
#[derive(Serialize, JsonSchema)]
pub struct ShardAnswer<'a> {
    /// Where it is.
    pub folder: String,
    /// Manifest of the run.
    pub manifest: &'a Manifest,
}

/// Simulated records.
#[derive(Serialize, JsonSchema)]
pub struct SimulateAnswer {
    /// Number of records.
    pub records: u64,
    /// The first of every trial.
    pub files: Vec<String>,
}

/// Manual pages.
#[derive(Serialize, JsonSchema)]
pub struct ManAnswer {
    /// The pages.
    pub files: Vec<String>,
}

/// A completion script.
#[derive(Serialize, JsonSchema)]
pub struct CompletionsAnswer {
    /// The shell.
    pub shell: String,
    /// The script.
    pub script: String,
}

/// A first description of a table.
#[derive(Serialize, JsonSchema)]
pub struct SidecarAnswer {
    /// The file; none if it was not written.
    pub file: Option<String>,
    /// Keys and values of the description.
    #[schemars(with = "Map<String, Value>")]
    pub sidecar: toml::Table,
}

/// The machine.
#[derive(Serialize, JsonSchema)]
pub struct DoctorAnswer {
    /// Results of the checks, by their names.
    #[serde(flatten)]
    pub found: BTreeMap<String, String>,
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
