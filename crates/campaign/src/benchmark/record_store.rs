//! Where measured records are: files are known by name and checksum, wherever they lie below some folders. Nothing of
//! where they lie goes into a result.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use trial::Trial;
use trial::reader::{RECORD, read_bytes};

use crate::benchmark::definition::{Definition, RecordFile, SetSource};
use crate::disk;
use crate::failure::Failure;
use crate::scenario::hex;

/// Folders below one another that are searched: a link that leads back is not followed, and nobody has as many.
const DEEPEST: usize = 32;

/// The files below some folders that a definition knows by name.
#[derive(Debug, Default)]
pub struct RecordStore {
    places: BTreeMap<String, Vec<PathBuf>>,
}

/// A file that was used.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UsedFile {
    /// Its name, without its place.
    pub name: String,
    /// Its SHA-256, hexadecimal.
    pub sha256: String,
}

impl RecordStore {
    /// Looks through folders for the files that a definition names, in the order of the folders and of names.
    ///
    /// Fails when a folder cannot be listed; one below it that cannot be listed is passed by.
    pub fn search(folders: &[PathBuf], definition: &Definition) -> Result<Self, Failure> {
        let copies = definition.sets.iter().flat_map(|set| match &set.source {
            SetSource::Measured { copies, .. } => copies.as_slice(),
            SetSource::Simulated { .. } => &[],
        });
        let wanted = copies.flatten().map(|copy| copy.file.as_str()).collect();
        let mut store = Self::default();
        for folder in folders {
            let names = disk::names(folder).map_err(|error| {
                let advice = "give the folder of the measured records with --data, or in KEMPF_DATA";
                Failure::about(folder, format!("{error}; {advice}"))
            })?;
            store.look_through(folder, names, &wanted, 0);
        }
        Ok(store)
    }

    fn look_through(&mut self, folder: &Path, names: Vec<String>, wanted: &BTreeSet<&str>, depth: usize) {
        for name in names {
            let path = folder.join(&name);
            let is_folder = fs::symlink_metadata(&path).is_ok_and(|about| about.is_dir());
            match is_folder {
                true if depth < DEEPEST => {
                    if let Ok(names) = disk::names(&path) {
                        self.look_through(&path, names, wanted, depth + 1);
                    }
                }
                false if wanted.contains(name.as_str()) => self.places.entry(name).or_default().push(path),
                _ => {}
            }
        }
    }

    /// The record in the first of some files that is there as it should be, and which file that is. Fails with the
    /// reason in words.
    pub fn take(&self, copies: &[RecordFile]) -> Result<(Trial, UsedFile), String> {
        let mut others = Vec::new();
        for copy in copies {
            for path in self.places.get(&copy.file).into_iter().flatten() {
                let bytes = match disk::read(path, RECORD.largest) {
                    Ok(Some(bytes)) => bytes,
                    Ok(None) => continue,
                    Err(error) => {
                        others.push(format!("{} cannot be read: {error}", copy.file));
                        continue;
                    }
                };
                let sha256 = hex(&Sha256::digest(&bytes));
                if sha256 == copy.sha256 {
                    let size = Some(bytes.len() as u64);
                    let read = read_bytes(Path::new(&copy.file), Cursor::new(bytes), size, copy.sidecar.as_ref());
                    let file = UsedFile { name: copy.file.clone(), sha256 };
                    return Ok((read.map_err(|error| error.to_string())?.trial, file));
                }
                let [begin, expected] = [&sha256[..12], &copy.sha256[..12]];
                others.push(format!(
                    "{} is another file: its SHA-256 begins with {begin}, expected {expected}",
                    copy.file
                ));
            }
        }
        if others.is_empty() {
            let names: Vec<&str> = copies.iter().map(|copy| copy.file.as_str()).collect();
            return Err(format!("no file {}", names.join(" or ")));
        }
        others.dedup();
        Err(others.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RECORD_TEXT: &str = "t_s,heading_deg,rudder_deg\n0,0,0\n1,0,10\n2,1,10\n3,2,10\n4,4,-10\n5,5,-10\n6,5,-10\n\
                               7,4,-10\n8,2,-10\n9,0,10\n10,-2,10\n11,-3,10\n";

    fn copy(file: &str, text: &str) -> RecordFile {
        RecordFile { file: file.into(), sha256: hex(&Sha256::digest(text)), sidecar: None }
    }

    fn store(folder: &Path) -> RecordStore {
        let mut store = RecordStore::default();
        store.look_through(folder, disk::names(folder).expect("a folder"), &BTreeSet::from(["a.csv", "b.csv"]), 0);
        store
    }

    #[test]
    fn a_record_is_known_by_its_checksum_wherever_it_lies() {
        let desk = tempfile::tempdir().expect("a folder");
        fs::create_dir_all(desk.path().join("x/y")).expect("folders");
        // Another file of the same name comes first; the right one is there twice.
        fs::write(desk.path().join("a.csv"), "another").expect("written");
        fs::write(desk.path().join("x/a.csv"), RECORD_TEXT).expect("written");
        fs::write(desk.path().join("x/y/a.csv"), RECORD_TEXT).expect("written");
        let found = store(desk.path()).take(&[copy("b.csv", RECORD_TEXT), copy("a.csv", RECORD_TEXT)]);
        let (trial, file) = found.expect("it is there");
        assert_eq!((file.name.as_str(), trial.len()), ("a.csv", 12));
    }

    #[test]
    fn what_is_absent_or_another_file_is_told_without_its_place() {
        let desk = tempfile::tempdir().expect("a folder");
        let absent = store(desk.path()).take(&[copy("a.csv", RECORD_TEXT), copy("b.csv", "")]).expect_err("absent");
        assert_eq!(absent, "no file a.csv or b.csv");
        fs::write(desk.path().join("a.csv"), format!("{RECORD_TEXT} ")).expect("written");
        let another = store(desk.path()).take(&[copy("a.csv", RECORD_TEXT)]).expect_err("another file");
        assert!(another.starts_with("a.csv is another file: its SHA-256 begins with "), "{another}");
        assert!(!another.contains(&*desk.path().to_string_lossy()), "{another}");
    }

    /// A file with the right checksum that is no record says so.
    #[test]
    fn what_cannot_be_read_is_told() {
        let desk = tempfile::tempdir().expect("a folder");
        fs::write(desk.path().join("a.csv"), "no,record\n1,2\n").expect("written");
        let error = store(desk.path()).take(&[copy("a.csv", "no,record\n1,2\n")]).expect_err("no record");
        assert!(error.starts_with("a.csv"), "{error}");
    }
}
