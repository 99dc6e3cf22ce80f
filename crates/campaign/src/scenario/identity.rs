//! Identity of a study: its design, that is the document without prose and presentation. Equal designs give equal rows;
//! differences are reported by key.

use std::path::Path;
use std::{io, iter};

use sha2::{Digest, Sha256};
use toml::{Table, Value};
use trial::Sidecar;
use trial::file::{self, FileError};
use trial::reader::RECORD_FILE;

use crate::failure::{Failure, OnPath};
use crate::scenario::part::ScenarioPart;

/// Design of a document: its keys without prose and presentation.
pub fn study_design(document: &Table) -> Table {
    document
        .iter()
        .filter(|(key, _)| ScenarioPart::from_key(key) != ScenarioPart::Prose)
        .map(|(key, value)| (key.clone(), value.clone()))
        .collect()
}

/// SHA-256 of a design and of the records it replays, each with its sidecar, if any.
///
/// Fails if an existing record cannot be read to its end.
pub fn study_sha256(design: &Table, folder: &Path) -> Result<String, Failure> {
    let mut digest = Sha256::new_with_prefix(design.to_string());
    let mut tables = vec![design];
    while let Some(table) = tables.pop() {
        for (key, value) in table {
            match value {
                Value::Table(inner) => tables.push(inner),
                Value::String(name) if key == "file" => {
                    let record = folder.join(name);
                    let sidecar = Sidecar::existing_beside(&record);
                    for path in iter::once(record).chain(sidecar) {
                        match file::open(&path, RECORD_FILE) {
                            Ok(mut file) => drop(io::copy(&mut file, &mut digest).on("read", &path)?),
                            // Refused by another check, or overridden in every cell.
                            Err(FileError::NotFound | FileError::Folder | FileError::NotAFile) => {}
                            Err(error) => return Err(error).on("read", &path),
                        }
                    }
                }
                Value::Array(items) => tables.extend(items.iter().filter_map(Value::as_table)),
                _ => {}
            }
        }
    }
    Ok(hex_digits(&digest.finalize()))
}

/// Bytes as hexadecimal digits.
pub fn hex_digits(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Maximum length of a value in a message, characters.
const MAX_VALUE_CHARACTERS: usize = 60;

fn shortened(value: Option<&Value>) -> String {
    let text = value.map_or_else(|| "nothing".to_owned(), Value::to_string);
    match text.char_indices().nth(MAX_VALUE_CHARACTERS) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// Differences between two documents, one sentence per dotted key with both values; list entries count from 0.
pub fn document_differences(there: &Table, here: &Table) -> Vec<String> {
    differences_below("", there, here)
}

fn differences_below(path: &str, there: &Table, here: &Table) -> Vec<String> {
    let only = here.keys().filter(|name| !there.contains_key(*name));
    let differences_of = |name: &String| differences_at(&format!("{path}{name}"), there.get(name), here.get(name));
    there.keys().chain(only).flat_map(differences_of).collect()
}

fn differences_at(key: &str, there: Option<&Value>, here: Option<&Value>) -> Vec<String> {
    match (there, here) {
        (Some(Value::Table(there)), Some(Value::Table(here))) => differences_below(&format!("{key}."), there, here),
        (Some(Value::Array(there)), Some(Value::Array(here))) => {
            let entry = |index: usize| differences_at(&format!("{key}.{index}"), there.get(index), here.get(index));
            (0..there.len().max(here.len())).flat_map(entry).collect()
        }
        (Some(there), Some(here)) if is_same(there, here) => Vec::new(),
        _ => vec![format!("`{key}`: {} there, {} here", shortened(there), shortened(here))],
    }
}

/// `true` for equal values; 1 equals 1.0.
fn is_same(there: &Value, here: &Value) -> bool {
    let number = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64));
    match (number(there), number(here)) {
        (Some(there), Some(here)) => there.to_bits() == here.to_bits(),
        _ => there == here,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn document(text: &str) -> Table {
        text.parse().expect("well formed")
    }

    #[test]
    fn differences_name_keys_and_both_values() {
        let there =
            document("seed = 1\nsensor.heading-noise-deg = 0.1\nidentifier = [{ method.srivc = {} }]\n[ship.yukun]");
        let here =
            document("seed = 1.0\nsensor.heading-noise-deg = 0.2\nidentifier = []\nstop.figure = 20\n[ship.yukun]");
        assert_eq!(
            document_differences(&there, &here),
            [
                "`identifier.0`: { method = { srivc = {} } } there, nothing here",
                "`sensor.heading-noise-deg`: 0.1 there, 0.2 here",
                "`stop`: nothing there, { figure = 20 } here"
            ]
        );
        assert!(document_differences(&there, &there).is_empty());
    }

    #[test]
    fn prose_and_presentation_are_not_part_of_a_design() {
        let bare = document("seed = 1\n[ship.yukun]");
        let described = document(
            "# Why?\nquestion = \"?\"\nanalysis = \"!\"\nseed    = 1\n[ship.yukun]\n[output]\nshowcase = true",
        );
        assert_eq!(study_design(&bare), study_design(&described));
    }
}
