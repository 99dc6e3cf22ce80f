//! The result of a benchmark, as it is stored in `bench.json`. Nothing in it depends on clock, machine or threads.

use serde::{Deserialize, Serialize};

use crate::benchmark::board::{Board, boards};
use crate::benchmark::cases::BenchCase;
use crate::benchmark::definition::{Definition, Identity, RecordSet, SetRecord, SetSource};
use crate::benchmark::method::BenchMethod;
use crate::benchmark::naming::{self, NamingLine};
use crate::benchmark::overall::{OverallRanking, overall};
use crate::benchmark::record_store::UsedFile;
use crate::benchmark::wire::words;
use crate::statistics::distinct;

/// Version of the file.
pub const SCHEMA: &str = "bench/1";

/// The whole result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BenchDocument {
    /// Version of the file.
    pub schema: String,
    /// What was run.
    pub definition: Identity,
    /// Version of the program.
    pub program: String,
    /// The method that others are compared with.
    pub reference: String,
    /// All methods, in order.
    pub methods: Vec<String>,
    /// One line on each.
    pub summaries: Vec<String>,
    /// The sets.
    pub sets: Vec<Present>,
    /// Records that were not there or could not be used.
    pub skipped: Vec<Skipped>,
    /// Leaderboards.
    pub boards: Vec<Board>,
    /// What was said of missing effects.
    pub naming: Vec<NamingLine>,
    /// The ranking over all predictions.
    pub overall: Option<OverallRanking>,
    /// Every question with every answer.
    pub cases: Vec<BenchCase>,
}

/// A set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Present {
    /// What it is called.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Where to download it, its licence, and what to cite; none of a simulated set.
    pub source: Option<[String; 3]>,
    /// Number of simulated trials, or 1 of a measured set that is there.
    pub trials: usize,
    /// Its records.
    pub records: Vec<PresentRecord>,
}

/// A record of a set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PresentRecord {
    /// What it is called.
    pub name: String,
    /// What the ship was asked to do.
    pub manoeuvre: String,
    /// The file that was used; none of a simulated record, and of one that was skipped.
    pub file: Option<UsedFile>,
}

/// A record that was not used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Skipped {
    /// Name of the set.
    pub set: String,
    /// Name of the record.
    pub record: String,
    /// Why.
    pub reason: String,
}

impl Present {
    /// A set with the files of its records that were found, in order, or no files where it is simulated.
    pub(super) fn of(set: &RecordSet, files: Vec<Option<UsedFile>>, trials: usize) -> Self {
        let source = match &set.source {
            SetSource::Measured { origin, .. } => Some(origin.clone()),
            SetSource::Simulated { .. } => None,
        };
        let files = files.into_iter().chain(std::iter::repeat(None));
        let record = |(SetRecord { name, manoeuvre }, file): (&SetRecord, Option<UsedFile>)| PresentRecord {
            name: name.clone(),
            manoeuvre: words(manoeuvre),
            file,
        };
        let records = set.records.iter().zip(files).map(record).collect();
        Self { name: set.name.clone(), title: set.title.clone(), source, trials, records }
    }
}

impl BenchDocument {
    /// The result of some cases.
    pub(super) fn of(
        definition: &Definition,
        methods: &[BenchMethod],
        sets: Vec<Present>,
        skipped: Vec<Skipped>,
        cases: Vec<BenchCase>,
    ) -> Self {
        let Definition { identity, reference, .. } = definition;
        let labels: Vec<String> = methods.iter().map(|method| method.label().to_owned()).collect();
        Self {
            schema: SCHEMA.to_owned(),
            definition: identity.clone(),
            program: env!("CARGO_PKG_VERSION").to_owned(),
            reference: reference.clone(),
            boards: boards(&cases, &labels, reference),
            naming: naming::lines(&cases, &labels),
            overall: overall(&cases, &labels),
            methods: labels,
            summaries: methods.iter().map(|method| method.summary().to_owned()).collect(),
            sets,
            skipped,
            cases,
        }
    }

    /// The fields of records, in order.
    pub fn fields(&self) -> Vec<&str> {
        distinct(self.boards.iter().map(|board| board.field.as_str()))
    }

    /// The same as JSON: everything indented, and a line for every case.
    ///
    /// Fails where a number is none that JSON knows, which stored ones are not.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        let head = serde_json::to_string_pretty(&Self { cases: Vec::new(), ..self.clone() })?;
        let lines: Vec<String> = self.cases.iter().map(serde_json::to_string).collect::<Result<_, _>>()?;
        let head = head.strip_suffix("\"cases\": []\n}").unwrap_or(&head);
        Ok(format!("{head}\"cases\": [\n    {}\n  ]\n}}\n", lines.join(",\n    ")))
    }
}
