//! The studies of the benchmark and their sidecars, embedded in the program.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::folder::ResultFolder;

/// Folder of the scenarios, and folder of the sidecars that one of them names.
const FOLDERS: [&str; 2] = ["bench", "measured"];

macro_rules! files {
    ($folder:literal: $($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../../../../scenarios/", $folder, "/", $name)))),+]
    };
}

/// Scenarios, in the order of the leaderboards.
const SCENARIOS: &[(&str, &str)] = files!["bench": "measured.toml", "first-order.toml", "hulls.toml", "missing.toml"];

/// Sidecars of the measured records.
const SIDECARS: &[(&str, &str)] = files![
    "measured":
    "kvlcc2_hsva.trial.toml",
    "kvlcc2_marin.trial.toml",
    "turning_oct14_14_29_49.trial.toml",
    "turning_oct14_15_06_53.trial.toml",
    "turning_sep14_13_51_45.trial.toml",
    "zigzag_13_04_24.trial.toml",
    "zigzag_13_14_21.trial.toml",
    "zigzag_13_42_53.trial.toml",
    "zigzag_13_57_45.trial.toml",
    "zigzag_14_10_05.trial.toml",
];

/// Writes the scenarios and sidecars into a folder; returns the paths of the scenarios, in their order.
pub fn unpack(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let folder = ResultFolder::make(folder)?;
    for (name, files) in FOLDERS.iter().zip([SCENARIOS, SIDECARS]) {
        let folder = folder.subfolder(name)?;
        files.iter().try_for_each(|(name, text)| folder.write(name, text))?;
    }
    Ok(SCENARIOS.iter().map(|(name, _)| folder.path().join(FOLDERS[0]).join(name)).collect())
}
