//! `bench.json`, the result of a benchmark. It depends on neither clock, machine nor number of threads.

use serde::{Deserialize, Serialize};

use crate::benchmark::board::{Leaderboard, leaderboards};
use crate::benchmark::cases::{BenchCase, BenchSet, BenchTask, SkippedRecord};
use crate::benchmark::naming::{self, NamingLine};
use crate::benchmark::overall::{OverallRanking, overall_ranking};
use crate::benchmark::study_cases;
use crate::rows::StudyRow;
use crate::scenario::Scenario;
use crate::statistics::distinct;

/// Version of the file.
pub const SCHEMA: &str = "bench/2";

/// Result of a benchmark.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BenchDocument {
    /// Version of the file.
    pub schema: String,
    /// Studies of the benchmark.
    pub studies: Vec<StudyFacts>,
    /// Version of the program.
    pub program: String,
    /// Reference method: the first one.
    pub reference: String,
    /// All methods, in order.
    pub methods: Vec<String>,
    /// One-line summary of each method.
    pub summaries: Vec<String>,
    /// Sets of trials, each with its records.
    pub sets: Vec<BenchSet>,
    /// Absent records, and trials with a failed simulation.
    pub skipped: Vec<SkippedRecord>,
    /// Leaderboards.
    pub boards: Vec<Leaderboard>,
    /// Counts of correct and wrong effect names.
    pub naming: Vec<NamingLine>,
    /// Ranking over all predictions.
    pub overall: Option<OverallRanking>,
    /// Cases with their results.
    pub cases: Vec<BenchCase>,
}

/// Study of the benchmark.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyFacts {
    /// Name of the scenario.
    pub name: String,
    /// Question of the study.
    pub question: String,
    /// Description of the records.
    pub analysis: String,
    /// SHA-256 of the design and of the measured records that are present.
    pub design_sha256: String,
    /// Key of every random number.
    pub seed: u64,
}

impl BenchDocument {
    /// Result of studies with all their rows, in order; `tasks` selects tasks, all of them if it is empty.
    pub fn from_studies(studies: &[(Scenario, Vec<StudyRow>)], tasks: &[BenchTask]) -> Self {
        let facts = |(scenario, _): &(Scenario, Vec<StudyRow>)| StudyFacts {
            name: scenario.name.clone(),
            question: scenario.prose.question.clone(),
            analysis: scenario.prose.analysis.clone(),
            design_sha256: scenario.design_sha256.clone(),
            seed: scenario.seed,
        };
        let methods = distinct(studies.iter().flat_map(|(scenario, _)| {
            let methods = &scenario.cells[0].methods;
            methods.iter().map(|method| (method.label.clone(), method.procedure.summary().to_owned()))
        }));
        let (labels, summaries): (Vec<String>, Vec<String>) = methods.into_iter().unzip();
        let (mut cases, mut sets, mut skipped) = (Vec::new(), Vec::new(), Vec::new());
        for study in studies.iter().map(|(scenario, rows)| study_cases::cases(scenario, rows)) {
            cases.extend(study.cases.into_iter().filter(|case| tasks.is_empty() || tasks.contains(&case.task)));
            sets.extend(study.sets);
            skipped.extend(study.skipped);
        }
        // Sorted by task; within a task in the order of the studies.
        cases.sort_by_key(|case| case.task);
        let reference = labels.first().cloned().unwrap_or_default();
        Self {
            schema: SCHEMA.to_owned(),
            studies: studies.iter().map(facts).collect(),
            program: env!("CARGO_PKG_VERSION").to_owned(),
            boards: leaderboards(&cases, &labels, &reference),
            naming: naming::naming_lines(&cases, &labels),
            overall: overall_ranking(&cases, &labels),
            reference,
            methods: labels,
            summaries,
            sets,
            skipped,
            cases,
        }
    }

    /// Names of the studies that have a leaderboard, in order.
    pub fn study_names(&self) -> Vec<&str> {
        distinct(self.boards.iter().map(|board| board.study.as_str()))
    }

    /// JSON text: indented, with one line per case.
    ///
    /// Fails if serialisation fails. Stored numbers are finite; JSON has no others.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        let head = serde_json::to_string_pretty(&Self { cases: Vec::new(), ..self.clone() })?;
        let lines: Vec<String> = self.cases.iter().map(serde_json::to_string).collect::<Result<_, _>>()?;
        let head = head.strip_suffix("\"cases\": []\n}").unwrap_or(&head);
        Ok(format!("{head}\"cases\": [\n    {}\n  ]\n}}\n", lines.join(",\n    ")))
    }
}
