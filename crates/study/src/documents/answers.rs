//! What commands without a file of their own answer to other programs, as `--format json` writes it.

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
    /// What it holds.
    #[serde(flatten)]
    pub body: T,
}

/// What can be named.
#[derive(Serialize, JsonSchema)]
pub struct ListAnswer {
    /// What is listed.
    pub what: String,
    /// The lines of the list, each by the heads of its columns.
    pub entries: Vec<Value>,
}

/// Scenarios that were resolved.
#[derive(Serialize, JsonSchema)]
pub struct CheckAnswer {
    /// Those that are right.
    pub scenarios: Vec<CheckedScenario>,
    /// How many are wrong.
    pub wrong: usize,
}

/// A scenario that is right.
#[derive(Serialize, JsonSchema)]
pub struct CheckedScenario {
    /// The file as it was named.
    pub file: String,
    /// Its name.
    pub name: String,
    /// What it asks.
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
    /// What it leaves to be assumed and can decide what it finds.
    pub assumptions: Vec<String>,
    /// The scenario with nothing left out, where it was asked for.
    #[schemars(with = "Option<Map<String, Value>>")]
    pub resolved: Option<toml::Table>,
}

/// A finished study.
#[derive(Serialize, JsonSchema)]
pub struct StudyAnswer<'a> {
    /// Where it is.
    pub folder: String,
    /// What ran.
    pub manifest: &'a Manifest,
    /// A line for every cell and method, by the heads of the columns of `summary.csv`.
    pub summary: Vec<Value>,
    /// How many answers failed, and why.
    pub failures: Vec<String>,
}

/// A part of a study.
#[derive(Serialize, JsonSchema)]
pub struct ShardAnswer<'a> {
    /// Where it is.
    pub folder: String,
    /// What ran.
    pub manifest: &'a Manifest,
}

/// Simulated records.
#[derive(Serialize, JsonSchema)]
pub struct SimulateAnswer {
    /// How many there are.
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

/// What a shell reads.
#[derive(Serialize, JsonSchema)]
pub struct CompletionsAnswer {
    /// The shell.
    pub shell: String,
    /// What it reads.
    pub script: String,
}

/// A first description of a table.
#[derive(Serialize, JsonSchema)]
pub struct SidecarAnswer {
    /// The file; none where it was not written.
    pub file: Option<String>,
    /// What it says.
    #[schemars(with = "Map<String, Value>")]
    pub sidecar: toml::Table,
}

/// The machine.
#[derive(Serialize, JsonSchema)]
pub struct DoctorAnswer {
    /// What was found, by what was looked for.
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
