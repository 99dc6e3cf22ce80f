//! `manifest.toml`: everything required to repeat a study, and the machine of the run.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::disk;
use crate::failure::{Failure, OnPath};
use crate::files::{DESIGN_FILE, MANIFEST_FILE};
use crate::folder::ResultFolder;
use crate::scenario::hex_digits;
use crate::scenario::{Prose, Scenario, identity};

/// Manifest of a study, the same for any shards in the folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub struct Manifest {
    /// Name of the scenario.
    pub name: String,
    /// Seed of the run.
    pub seed: u64,
    /// SHA-256 of the scenario text.
    pub scenario_sha256: String,
    /// SHA-256 of the design: the scenario without its prose, and the files it reads.
    pub design_sha256: String,
    /// Version of the program.
    pub version: String,
    /// Last git revision in which the source of the program changed; `null` unless built in a repository.
    pub git_revision: Option<String>,
    /// `true` if the source had uncommitted changes.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub git_dirty: bool,
    /// Machine of the run. No row depends on it.
    pub machine: Machine,
    /// Assumptions of the scenario with an influence on its result, one sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
    /// Versions of the crates that determine the numbers.
    pub crates: Vec<String>,
    /// SHA-256 of the files written on completion, by name; empty until then.
    #[serde(default)]
    pub sha256: BTreeMap<String, String>,
    /// The scenario file as it was read.
    pub scenario: String,
}

/// Machine of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub struct Machine {
    /// Operating system and processor family.
    pub target: String,
    /// Threads used.
    pub threads: usize,
    /// Wall time of trials and identification, s.
    pub wall_time_s: f64,
}

/// Version and revision of the program, such as "0.3.0 (revision 1a2b3c4d5e)"; ", changed" marks uncommitted source.
pub fn version() -> String {
    let number = env!("CARGO_PKG_VERSION");
    let Some(revision) = option_env!("KEMPF_GIT_REVISION") else { return number.to_owned() };
    let changed = if option_env!("KEMPF_GIT_DIRTY").is_some() { ", changed" } else { "" };
    format!("{number} (revision {}{changed})", &revision[..10])
}

/// Maximum size of a manifest, bytes: a scenario and a few lines.
const MAX_MANIFEST_BYTES: u64 = 1 << 22;

/// First line of the file.
const REPEAT: &str = "# `study manifest.toml --out DIR` runs this study again.\n";

impl Manifest {
    /// Manifest of a scenario before its run.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            name: scenario.name.clone(),
            seed: scenario.seed,
            scenario_sha256: scenario.file_sha256.clone(),
            design_sha256: scenario.design_sha256.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            git_revision: option_env!("KEMPF_GIT_REVISION").map(str::to_owned),
            git_dirty: option_env!("KEMPF_GIT_DIRTY").is_some(),
            machine: Machine {
                target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
                threads: rayon::current_num_threads(),
                wall_time_s: 0.0,
            },
            assumptions: scenario.influential_defaults().into_iter().map(|(_, sentence)| sentence).collect(),
            crates: env!("KEMPF_NUMERIC_CRATES").split_terminator(',').map(str::to_owned).collect(),
            sha256: BTreeMap::new(),
            scenario: scenario.text.clone(),
        }
    }

    /// Label of the program and its numerical crates, which every block states as its origin.
    pub fn program_label(&self) -> String {
        let revision = self.git_revision.as_deref().map_or_else(String::new, |revision| format!(" {revision}"));
        let changed = if self.git_dirty { " (changed)" } else { "" };
        let crates = hex_digits(&Sha256::digest(self.crates.join(",")));
        format!("kempf {}{revision}{changed} with crates {}", self.version, &crates[..8])
    }

    /// Manifest with program and machine of `other`.
    pub(crate) fn with_program_and_machine(self, other: &Self) -> Self {
        let Self { version, git_revision, git_dirty, crates, machine, .. } = other.clone();
        Self { version, git_revision, git_dirty, crates, machine, ..self }
    }

    /// `true` if the study is finished: design, showcases and timings are stored next to its rows.
    pub fn is_finished(&self) -> bool {
        self.sha256.contains_key(DESIGN_FILE)
    }

    /// Differences in design and seed, one sentence each; empty if both manifests describe the same rows.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let mut differences = Vec::new();
        if self.design_sha256 != other.design_sha256 {
            let design = |manifest: &Self| manifest.scenario.parse().ok().as_ref().map(identity::study_design);
            let designs = design(self).zip(design(other));
            let changes = designs.map_or_else(Vec::new, |(there, here)| identity::document_differences(&there, &here));
            match changes.is_empty() {
                true => differences.push(
                    "a replayed record, a table of answers or a method of the calling program has changed".to_owned(),
                ),
                false => differences.extend(changes),
            }
        }
        if self.seed != other.seed {
            differences.push(format!("seed: {} there, {} here", self.seed, other.seed));
        }
        differences
    }

    /// Prose and presentation of the scenario.
    pub fn prose(&self) -> Prose {
        Prose::from_scenario_text(&self.scenario)
    }

    /// Writes the manifest into a folder, with the wall time rounded to 1 ms.
    pub fn write(&self, folder: &ResultFolder) -> Result<(), Failure> {
        let rounded = Machine { wall_time_s: (self.machine.wall_time_s * 1e3).round() / 1e3, ..self.machine.clone() };
        let text =
            toml::to_string(&Self { machine: rounded, ..self.clone() }).on("describe the run in", folder.path())?;
        folder.write_synced(MANIFEST_FILE, REPEAT.to_owned() + &text)
    }

    /// Manifest at a path; `None` without a file. Fails for any other content.
    pub fn read(path: &Path) -> Result<Option<Self>, Failure> {
        let refuse = |problem: &str| Failure::in_file(path, format!("{problem}; expected the manifest of a study"));
        let Some(bytes) = disk::read(path, MAX_MANIFEST_BYTES).on("read", path)? else { return Ok(None) };
        let text = String::from_utf8(bytes).map_err(|_| refuse("it is not UTF-8 text"))?;
        toml::from_str(&text).map(Some).map_err(|error| refuse(error.message()))
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_crate_that_decides_the_numbers_has_its_version() {
        let crates = env!("KEMPF_NUMERIC_CRATES");
        for name in ["nalgebra", "rand", "rand_distr", "realfft", "statrs"] {
            assert!(crates.split(',').any(|version| version.starts_with(&format!("{name} "))), "{name}: {crates}");
        }
    }
}
