//! The files of a result folder that everything else is made from: rows, design, showcases, times and manifest. The
//! manifest carries the SHA-256 of those that are made when all rows are there; a block of rows carries its own.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::blocks::{self, BlockStore};
use crate::design::Design;
use crate::disk;
use crate::failure::{Failure, OnPath};
use crate::files::{DESIGN, MANIFEST, ROWS_OF_OLD, SHOWCASES, TIMINGS};
use crate::folder::ResultFolder;
use crate::manifest::Manifest;
use crate::rows::StudyRow;
use crate::scenario::hex;
use crate::showcase::Showcase;
use crate::timings::Timings;

/// Largest size of a stored text, bytes.
const MAX_TEXT_BYTES: u64 = 1 << 29;

/// A finished study: everything but its rows, which are read a few at a time.
pub struct StoredStudy {
    folder: PathBuf,
    /// What ran, and on what.
    pub manifest: Manifest,
    /// The design.
    pub design: Design,
    /// The first trial of every cell in detail, where it was asked for.
    pub showcases: Vec<Showcase>,
    /// How long the methods took.
    pub timings: Timings,
}

impl StoredStudy {
    /// Reads a finished study. Fails as wrong input when the folder holds none.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        let manifest = expected_in(folder)?;
        if !manifest.is_finished() {
            return Err(Failure::about(folder, "the study in it is not finished; run it again to go on"));
        }
        Self::of(folder, manifest)
    }

    /// Reads what a manifest tells of.
    pub(crate) fn of(folder: &Path, manifest: Manifest) -> Result<Self, Failure> {
        let text = |name: &str| {
            let path = folder.join(name);
            let bytes = disk::read(&path, MAX_TEXT_BYTES).on("read", &path)?;
            let found = bytes.as_ref().map(|bytes| hex(&Sha256::digest(bytes)));
            match found {
                None => Err(refused(&path, "it is missing")),
                Some(found) if Some(&found) == manifest.sha256.get(name) => {
                    Ok((bytes.unwrap_or_default(), move |problem: String| refused(&path, &problem)))
                }
                Some(_) => Err(refused(&path, "it was changed: its SHA-256 is not the one in the manifest")),
            }
        };
        let (bytes, refuse) = text(DESIGN)?;
        let design = Design::of_text(&bytes).map_err(refuse)?;
        let (bytes, refuse) = text(SHOWCASES)?;
        let showcases = serde_json::from_slice(&bytes).map_err(|problem| refuse(problem.to_string()))?;
        let (bytes, refuse) = text(TIMINGS)?;
        let timings = Timings::of_text(&bytes, &design).map_err(refuse)?;
        let design = Design { words: manifest.words(), ..design };
        Ok(Self { folder: folder.to_owned(), manifest, design, showcases, timings })
    }

    /// The same study after its words, or what is told of its cells, have changed; they are written where they have.
    pub(crate) fn told_again(self, manifest: Manifest, design: Design, folder: &ResultFolder) -> Result<Self, Failure> {
        let mut sha256 = self.manifest.sha256.clone();
        write(DESIGN, &described(DESIGN, &design, folder)?, folder, &mut sha256)?;
        let manifest = Manifest { sha256, ..manifest };
        if manifest != self.manifest {
            manifest.write(folder)?;
        }
        Ok(Self { design: Design { words: manifest.words(), ..design }, manifest, ..self })
    }

    /// Hands every row to `take`, in order. Fails when one is missing or is not of this study.
    pub fn rows(&self, take: impl FnMut(StudyRow) -> Result<(), Failure>) -> Result<(), Failure> {
        BlockStore::new(&self.folder, &self.manifest, &self.design).rows(take)
    }
}

/// A file that is not what a study wrote, and what to do.
fn refused(path: &Path, problem: &str) -> Failure {
    Failure::about(
        path,
        format!(
            "{problem}; expected what a finished study wrote; put the file back, or run the study again: what is whole \
                 is not computed again"
        ),
    )
}

/// The manifest of a folder with rows; `None` where there are none. A folder that holds what was published without its
/// rows has none.
///
/// Fails where the rows are those of a version that stored them in one file.
pub fn manifest_of_rows(folder: &Path) -> Result<Option<Manifest>, Failure> {
    let old = folder.join(ROWS_OF_OLD);
    if disk::is_there(&old).on("look for", &old)? {
        return Err(Failure::about(
            &old,
            "these rows were stored by an earlier version of this program; remove the folder, or give another with --out, \
             and run the study again",
        ));
    }
    if blocks::is_in(folder)? { Manifest::read(&folder.join(MANIFEST)) } else { Ok(None) }
}

/// The same where there have to be rows.
pub fn expected_in(folder: &Path) -> Result<Manifest, Failure> {
    manifest_of_rows(folder)?.ok_or_else(|| {
        let problem = match folder.exists() {
            false => "there is no such folder",
            true => {
                "there are no rows in it; expected the folder of a finished study, fit, trace, prediction or benchmark"
            }
        };
        Failure::about(folder, problem)
    })
}

/// The text of a file of this name.
fn described(name: &str, what: &impl Serialize, folder: &ResultFolder) -> Result<Vec<u8>, Failure> {
    let text = serde_json::to_string(what).on("describe", &folder.path().join(name))?;
    Ok((text + "\n").into_bytes())
}

/// Writes a file unless it is there with this text, and notes its SHA-256.
fn write(name: &str, text: &[u8], folder: &ResultFolder, sha256: &mut BTreeMap<String, String>) -> Result<(), Failure> {
    let own = hex(&Sha256::digest(text));
    if sha256.insert(name.to_owned(), own.clone()) == Some(own) { Ok(()) } else { folder.keep(name, text) }
}

/// Makes a folder that holds all rows a finished study: design, showcases, times, and the manifest last. What is
/// returned is what was written, and need not be read again.
pub(crate) fn finish(
    folder: &ResultFolder,
    manifest: Manifest,
    design: Design,
    showcases: Vec<Showcase>,
    timings: &Timings,
) -> Result<StoredStudy, Failure> {
    let mut sha256 = BTreeMap::new();
    write(DESIGN, &described(DESIGN, &design, folder)?, folder, &mut sha256)?;
    write(SHOWCASES, &described(SHOWCASES, &showcases, folder)?, folder, &mut sha256)?;
    let times = timings.to_text(&design)?;
    write(TIMINGS, &times, folder, &mut sha256)?;
    let manifest = Manifest { sha256, ..manifest };
    // Last, since it makes the folder a finished study.
    manifest.write(folder)?;
    // As they are written: to the nanosecond.
    let timings = Timings::of_text(&times, &design).map_err(Failure::work)?;
    let design = Design { words: manifest.words(), ..design };
    Ok(StoredStudy { folder: folder.path().to_owned(), manifest, design, showcases, timings })
}
