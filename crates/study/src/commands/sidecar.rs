//! `study sidecar`: a first description of a table for a person to check.

use std::path::Path;

use serde_json::json;
use trial::file::STDIN;
use trial::{Sidecar, reader};

use crate::options::{Common, Format};
use crate::screen;
use crate::views::document;
use scenario::failure::{Failure, OnPath};

/// Writes the description beside the table; that of a table on standard input to standard output.
///
/// Fails when the table cannot be read, and when it has a description.
pub fn run(log: &Path, common: &Common) -> Result<(), Failure> {
    if log == Path::new(STDIN) {
        // There is nothing beside which it could be put.
        return tell(&reader::describe(log).map_err(Failure::input)?, None, common);
    }
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
    std::fs::write(&path, &text).on("write", &path)?;
    tell(&text, Some((&path, log)), common)
}

/// Tells where the description is; itself where it is in no file or a program reads.
fn tell(text: &str, written: Option<(&Path, &Path)>, common: &Common) -> Result<(), Failure> {
    match (common.format, written) {
        _ if common.quiet => Ok(()),
        (Format::Json, _) => {
            let described: toml::Table = text.parse().map_err(Failure::work)?;
            let file = written.map(|(path, _)| path.display().to_string());
            document::say("sidecar/1", json!({ "file": file, "sidecar": described }))
        }
        (_, None) => screen::say(text.trim_end()),
        (_, Some((path, log))) => {
            screen::say(&format!("{}: check every line, then run `study fit {}`", path.display(), log.display()))
        }
    }
}
