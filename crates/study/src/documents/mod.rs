//! Documents of the commands: types of JSON files and tables that are not in the crate `document`, and functions that
//! read and write all of them. Pages and figures are made from documents. `--format json` writes the text of the file
//! to standard output.

pub mod answers;
pub mod columns;
pub mod curves;
pub mod draws;
pub mod error;
pub mod find;
pub mod fit_curves;
pub mod fit_each;
pub mod inspect;
pub mod log;
pub mod missing_moment;
pub mod prior;
pub mod truth;

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use campaign::disk;
use campaign::failure::{Failure, OnPath};
use campaign::files::MANIFEST_FILE;
use campaign::folder::ResultFolder;
use document::ErrorCode;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use trial::Trial;

use crate::records::file_and_hash;
use crate::screen;
use answers::{CommandAnswer, Versioned};

/// Name of the file with a fit.
pub const FIT_FILE: &str = "fit.json";

/// Name of the file with a trace.
pub const TRACE_FILE: &str = "trace.json";

/// Name of the file with a prediction.
pub const PREDICT_FILE: &str = "predict.json";

/// Name of the file with a benchmark.
pub const BENCH_FILE: &str = "bench.json";

/// Name of the file with the curves of the figures of a fit or a prediction.
pub const CURVES_FILE: &str = "curves.json";

/// Indented JSON of a document. Fails if it cannot be written as JSON.
pub fn to_json(document: &impl Serialize) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(document).map(|text| text + "\n")
}

/// The folder `place`, if the command that writes the file `document` may use it. Fails if it holds results of another
/// command, whose page would be lost.
pub fn folder_for(document: &str, place: &Path) -> Result<PathBuf, Failure> {
    let documents = [FIT_FILE, TRACE_FILE, PREDICT_FILE, BENCH_FILE, MANIFEST_FILE].into_iter();
    match documents.filter(|name| *name != document).map(|name| place.join(name)).find(|path| path.is_file()) {
        Some(path) => Err(Failure::input(format!(
            "{} is the result of another command; give another folder with --out",
            path.display()
        ))),
        None => Ok(place.to_owned()),
    }
}

/// The folder `place`, as from [`folder_for`], for the result of some records. Fails also if it holds results of other
/// records. Records are the same if the file name is equal (the content may have been corrected) or if the content is
/// equal.
pub fn folder_for_records(document: &str, place: &Path, trials: &[Trial]) -> Result<PathBuf, Failure> {
    let place = folder_for(document, place)?;
    let path = place.join(document);
    let earlier = path.is_file().then(|| read_text(&path)).transpose()?;
    let earlier = earlier.map(|text| serde_json::from_str(&text).unwrap_or(Value::Null));
    let Some(records) = earlier.map(|earlier| records_of(&earlier)).filter(|records| !records.is_empty()) else {
        return Ok(place);
    };
    let is_same = |trial: &Trial| {
        let (file, sha256) = file_and_hash(trial);
        records.iter().any(|(file_then, hash)| file_then == file || hash == sha256)
    };
    if records.len() == trials.len() && trials.iter().all(is_same) {
        return Ok(place);
    }
    let files: Vec<String> = records.into_iter().map(|(file, _)| file).collect();
    Err(Failure::input(format!(
        "{} is the result of {}, not of {}; give another folder with --out",
        path.display(),
        few(&files),
        few(&trials.iter().map(|trial| file_and_hash(trial).0.to_owned()).collect::<Vec<_>>())
    )))
}

/// Path and SHA-256 of every fitted record of an earlier document.
fn records_of(document: &Value) -> Vec<(String, String)> {
    let list = document["trials"].as_array().or_else(|| document["records"].as_array());
    let fitted = list.into_iter().flatten().filter(|record| record["held_out"] != true);
    let text = |value: &Value| value.as_str().map(str::to_owned);
    fitted.filter_map(|record| Some((text(&record["file"])?, text(&record["sha256"])?))).collect()
}

/// The first of some files and the number of further files, such as `a.csv and 3 more`.
fn few(files: &[String]) -> String {
    match files {
        [only] => only.clone(),
        several => {
            format!("{} and {} more", several.first().map_or("", String::as_str), several.len().saturating_sub(1))
        }
    }
}

/// Writes the document of a command to a folder and returns its text. Fails if the file cannot be written.
pub fn write_document(folder: &ResultFolder, name: &str, document: &impl Serialize) -> Result<String, Failure> {
    let text = to_json(document).on("describe", &folder.path().join(name))?;
    folder.write_synced(name, &text).map(|_| text)
}

/// Writes the document of a command and the curves of its figures to a folder; returns the text of the document. Fails
/// if a file cannot be written.
pub fn write_with_curves(
    folder: &ResultFolder,
    name: &str,
    document: &impl Serialize,
    curves: &impl Serialize,
) -> Result<String, Failure> {
    let text = write_document(folder, name, document)?;
    folder.write(CURVES_FILE, serde_json::to_string(curves).on("describe", &folder.path().join(CURVES_FILE))?)?;
    Ok(text)
}

/// Document that a command wrote, and its text.
///
/// Fails if the file cannot be read, or if it was not written by this program.
pub fn read_json<T: DeserializeOwned>(path: &Path, command: &str) -> Result<(T, String), Failure> {
    let text = read_text(path)?;
    let document = serde_json::from_str(&text).map_err(|error| unread(path, error, command))?;
    Ok((document, text))
}

/// Document of this schema that a command wrote, and its text.
///
/// Fails as [`read_json`] does, or if the document has another version.
pub fn read_document<T: DeserializeOwned>(path: &Path, schema: &str) -> Result<(T, String), Failure> {
    #[derive(serde::Deserialize)]
    struct Stated {
        schema: String,
    }
    let command = schema.split('/').next().unwrap_or_default();
    let (stated, text): (Stated, String) = read_json(path, command)?;
    if stated.schema != schema {
        let mismatch = format!("schema = {:?}, expected {schema:?}", stated.schema);
        let problem = format!("{mismatch}; make it again with `study {command}`");
        return Err(Failure::in_file(path, problem).with_code(ErrorCode::Document));
    }
    let document = serde_json::from_str(&text).map_err(|error| unread(path, error, command))?;
    Ok((document, text))
}

/// Failure for a document that this program did not write.
fn unread(path: &Path, error: serde_json::Error, command: &str) -> Failure {
    let problem = format!("{error}; make it again with `study {command}`");
    Failure::in_file(path, problem).with_code(ErrorCode::Document)
}

/// Maximum size of a document or a table of curves, bytes.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// Text of a file that a command wrote. Fails if it is missing, too large or not a file.
fn read_text(path: &Path) -> Result<String, Failure> {
    let bytes = disk::read(path, MAX_FILE_BYTES).and_then(|bytes| bytes.ok_or_else(|| ErrorKind::NotFound.into()));
    String::from_utf8(bytes.on("read", path)?).on("read", path)
}

/// Text of a document without a file, with its schema version first.
///
/// Fails if it cannot be written as JSON.
pub fn answer_text<A: CommandAnswer>(body: &A) -> Result<String, Failure> {
    to_json(&Versioned { schema: A::SCHEMA, body }).map_err(Failure::execution)
}

/// Writes a document to standard output.
///
/// Fails as [`answer_text`] and [`screen::print_lines`] do.
pub fn print_document(body: &impl CommandAnswer) -> Result<(), Failure> {
    screen::print_unescaped(&answer_text(body)?)
}
