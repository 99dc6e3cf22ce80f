//! `study sidecar`: a first description of a table, to be checked by a person.

use std::path::{Path, PathBuf};

use campaign::disk;
use campaign::folder::ResultFolder;
use clap::Args;
use trial::file::STDIN_PATH;
use trial::{Sidecar, reader};

use super::reply;
use crate::documents::answers::SidecarAnswer;
use crate::options::CommonOptions;
use campaign::failure::{Failure, OnPath};

/// Arguments of `study sidecar`.
#[derive(Debug, Clone, Args)]
pub struct SidecarRequest {
    /// The table
    #[arg(value_name = "LOG")]
    pub log: PathBuf,
}

/// Writes the description next to the table; for a table on standard input, to standard output.
///
/// Fails if the table cannot be read, or if it already has a description.
pub fn run(SidecarRequest { log }: &SidecarRequest, common: &CommonOptions) -> Result<(), Failure> {
    if log == Path::new(STDIN_PATH) {
        // Standard input has no folder for the description.
        return tell(&reader::draft_sidecar(log).map_err(Failure::input)?, None, common);
    }
    let path = match &common.out {
        Some(folder) => folder.join(Sidecar::path_beside(log).file_name().unwrap_or_default()),
        None => Sidecar::path_beside(log),
    };
    if disk::path_exists(&path).on("look for", &path)? {
        return Err(Failure::in_file(
            &path,
            "this description is there already; remove it, or write another one elsewhere with `--out DIR`",
        ));
    }
    let text = reader::draft_sidecar(log).map_err(Failure::input)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    ResultFolder::make(path.parent().unwrap_or(Path::new("")))?.write(&name, &text)?;
    tell(&text, Some((&path, log)), common)
}

/// Prints the path of the description; prints the description itself if it is in no file or JSON is requested.
fn tell(text: &str, written: Option<(&Path, &Path)>, common: &CommonOptions) -> Result<(), Failure> {
    let described: toml::Table = text.parse().map_err(Failure::execution)?;
    let file = written.map(|(path, _)| path.display().to_string());
    let line = match written {
        None => text.trim_end().to_owned(),
        Some((path, log)) => {
            let is_found = path == Sidecar::path_beside(log);
            let columns = if is_found { String::new() } else { format!(" --columns {}", path.display()) };
            format!("{}: check every line, then run `study fit {}{columns}`", path.display(), log.display())
        }
    };
    reply(common, &SidecarAnswer { file, sidecar: described }, &line)
}
