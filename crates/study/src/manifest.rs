//! `manifest.toml`: what is needed to run a study again, beside what it ran on.

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::failure::{Failure, OnPath};
use crate::scenario::Scenario;

/// The manifest of a finished study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Manifest {
    /// Name of the scenario.
    pub name: String,
    /// Seed that was used.
    pub seed: u64,
    /// SHA-256 of the scenario text.
    pub scenario_sha256: String,
    /// Version of the program.
    pub version: String,
    /// Git revision of the program's source, where git can tell.
    pub git_revision: Option<String>,
    /// What it ran on. Nothing in the rows depends on this.
    pub machine: Machine,
    /// Versions of the crates that decide the numbers.
    pub crates: Vec<String>,
    /// The scenario file as it was read.
    pub scenario: String,
}

/// What a study ran on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub struct Machine {
    /// Operating system and processor family.
    pub target: String,
    /// Threads used.
    pub threads: usize,
    /// Wall time of trials and identification, s.
    pub wall_time_s: f64,
}

/// The lock file the program was built with.
const LOCK: &str = include_str!("../../../Cargo.lock");

/// Crates whose version is part of a result's identity.
const NUMERIC: [&str; 5] = ["nalgebra", "rand", "rand_distr", "realfft", "statrs"];

impl Manifest {
    /// The manifest of a scenario that has just run.
    pub fn new(scenario: &Scenario, wall_time: Duration) -> Self {
        Self {
            name: scenario.name.clone(),
            seed: scenario.seed,
            scenario_sha256: scenario.sha256.clone(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            git_revision: git_revision(),
            machine: Machine {
                target: format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS),
                threads: rayon::current_num_threads(),
                wall_time_s: (wall_time.as_secs_f64() * 1e3).round() / 1e3,
            },
            crates: NUMERIC.iter().flat_map(|name| locked(name)).collect(),
            scenario: scenario.text.clone(),
        }
    }

    /// Writes the manifest.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        let text = toml::to_string(self).on("describe the run in", path)?;
        std::fs::write(path, text).on("write", path)
    }

    /// Reads the manifest of a finished study.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let refuse = |problem: String| {
            Failure::input(format!("{}: {problem}; expected the folder of a finished study", path.display()))
        };
        let text = std::fs::read_to_string(path).map_err(|error| refuse(error.to_string()))?;
        toml::from_str(&text).map_err(|error: toml::de::Error| refuse(error.message().to_owned()))
    }
}

/// "name version" of a crate, once for every version in the lock file.
fn locked(name: &str) -> Vec<String> {
    let wanted = format!("name = \"{name}\"");
    let lines: Vec<&str> = LOCK.lines().collect();
    lines
        .windows(2)
        .filter(|pair| pair[0] == wanted)
        .filter_map(|pair| pair[1].strip_prefix("version = "))
        .map(|version| format!("{name} {}", version.trim_matches('"')))
        .collect()
}

/// Revision of the folder the program was built in; `None` where there is no git or no repository any more.
fn git_revision() -> Option<String> {
    let output = Command::new("git")
        .args(["-C", env!("CARGO_MANIFEST_DIR"), "rev-parse", "HEAD"])
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_numeric_crate_is_in_the_lock_file() {
        for name in NUMERIC {
            assert!(!locked(name).is_empty(), "{name}");
        }
    }
}
