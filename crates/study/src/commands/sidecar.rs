//! `study sidecar`: a first description of a table for a person to check.

use std::path::Path;

use trial::{Sidecar, reader};

use crate::options::Common;
use crate::screen;
use scenario::failure::{Failure, OnPath};

/// Writes the description beside the table.
///
/// Fails when the table cannot be read, and when it has a description.
pub fn run(log: &Path, common: &Common) -> Result<(), Failure> {
    let path = match &common.out {
        Some(folder) => folder.join(Sidecar::beside(log).file_name().unwrap_or_default()),
        None => Sidecar::beside(log),
    };
    if path.exists() {
        return Err(Failure::input(format!(
            "{}: this description is there already; remove it, or write another one elsewhere with `--out DIR`",
            path.display()
        )));
    }
    let text = reader::describe(log).map_err(Failure::input)?;
    if let Some(folder) = &common.out {
        std::fs::create_dir_all(folder).on("make", folder)?;
    }
    std::fs::write(&path, text).on("write", &path)?;
    if !common.quiet {
        screen::say(&format!("{}: check every line, then run `study fit {}`", path.display(), log.display()))?;
    }
    Ok(())
}
