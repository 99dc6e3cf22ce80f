//! The result of a benchmark, as it is stored in `bench.json`. Nothing in it depends on clock, machine or threads.

use serde::{Deserialize, Serialize};

use crate::benchmark::board::{Board, boards};
use crate::benchmark::cases::Case;
use crate::benchmark::definition::{Definition, Set, Source};
use crate::benchmark::naming::{self, NamingLine};
use crate::benchmark::overall::{Overall, overall};
use crate::benchmark::shelf::UsedFile;

/// Version of the file.
pub const SCHEMA: &str = "bench/1";

/// The whole result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Results {
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
    pub overall: Option<Overall>,
    /// Every question with every answer.
    pub cases: Vec<Case>,
}

/// Which definition was run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Identity {
    /// What it is called.
    pub name: String,
    /// What it says about itself.
    pub about: String,
    /// SHA-256 of it and of all files it names.
    pub sha256: String,
    /// Seed in place of those of the scenarios.
    pub seed: Option<u64>,
}

/// A set.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
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
    pub(crate) fn of(set: &Set, files: Vec<Option<UsedFile>>, trials: usize) -> Self {
        let source = match &set.source {
            Source::Measured { download, licence, cite, .. } => Some([download.clone(), licence.clone(), cite.clone()]),
            Source::Simulated { .. } => None,
        };
        let files = files.into_iter().chain(std::iter::repeat(None));
        let record = |(member, file): (&crate::benchmark::definition::Member, Option<UsedFile>)| PresentRecord {
            name: member.name.clone(),
            manoeuvre: member.deed.words(),
            file,
        };
        Self {
            name: set.name.clone(),
            title: set.title.clone(),
            source,
            trials,
            records: set.records.iter().zip(files).map(record).collect(),
        }
    }
}

/// The result of some cases.
pub(crate) fn of(
    definition: &Definition,
    [methods, summaries]: [Vec<String>; 2],
    sets: Vec<Present>,
    skipped: Vec<Skipped>,
    cases: Vec<Case>,
) -> Results {
    Results {
        schema: SCHEMA.to_owned(),
        definition: Identity {
            name: definition.name.clone(),
            about: definition.about.clone(),
            sha256: definition.sha256.clone(),
            seed: definition.seed,
        },
        program: env!("CARGO_PKG_VERSION").to_owned(),
        reference: definition.reference.clone(),
        boards: boards(&cases, &methods, &definition.reference),
        naming: naming::lines(&cases, &methods),
        overall: overall(&cases, &methods),
        methods,
        summaries,
        sets,
        skipped,
        cases,
    }
}

impl Results {
    /// The fields of records, in order.
    pub fn fields(&self) -> Vec<&str> {
        let mut fields: Vec<&str> = Vec::new();
        for board in &self.boards {
            if !fields.contains(&board.field.as_str()) {
                fields.push(&board.field);
            }
        }
        fields
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
