//! Primary files of a result folder: rows, design, showcases, timings and manifest. The manifest contains the SHA-256
//! of the files written on completion; each block of rows contains its hash.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::block_store::{self, TrialBlockStore};
use crate::design::Design;
use crate::disk;
use crate::failure::{Failure, OnPath};
use crate::files::{DESIGN_FILE, LEGACY_ROWS_FILE, MANIFEST_FILE, SHOWCASES_FILE, TIMINGS_FILE};
use crate::folder::ResultFolder;
use crate::manifest::Manifest;
use crate::rows::StudyRow;
use crate::scenario::hex_digits;
use crate::showcase::Showcase;
use crate::timings::Timings;

/// Maximum size of a stored text, bytes.
const MAX_TEXT_BYTES: u64 = 1 << 29;

/// Finished study without its rows, which are read block by block.
pub struct StoredStudy {
    folder: PathBuf,
    /// Program, machine and scenario.
    pub manifest: Manifest,
    /// Design.
    pub design: Design,
    /// Showcases of the cells, if requested.
    pub showcases: Vec<Showcase>,
    /// Durations of the methods.
    pub timings: Timings,
}

impl StoredStudy {
    /// Finished study of a folder. Fails without one, and if one of its files was changed.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        let manifest = required_manifest(folder)?;
        if !manifest.is_finished() {
            return Err(Failure::in_file(folder, "the study in it is not finished; run it again to go on"));
        }
        Self::from_manifest(folder, manifest)
    }

    /// Study from the files that a manifest lists, verified by their SHA-256.
    pub(crate) fn from_manifest(folder: &Path, manifest: Manifest) -> Result<Self, Failure> {
        let text = |name: &str| {
            let path = folder.join(name);
            let bytes = disk::read(&path, MAX_TEXT_BYTES).on("read", &path)?;
            let sha256 = bytes.as_ref().map(|bytes| hex_digits(&Sha256::digest(bytes)));
            match sha256 {
                None => Err(refused(&path, "it is missing")),
                Some(sha256) if Some(&sha256) == manifest.sha256.get(name) => {
                    Ok((bytes.unwrap_or_default(), move |problem: String| refused(&path, &problem)))
                }
                Some(_) => Err(refused(&path, "it was changed: its SHA-256 is not the one in the manifest")),
            }
        };
        let (bytes, refuse) = text(DESIGN_FILE)?;
        let design = Design::from_json(&bytes).map_err(refuse)?;
        let (bytes, refuse) = text(SHOWCASES_FILE)?;
        let showcases = serde_json::from_slice(&bytes).map_err(|problem| refuse(problem.to_string()))?;
        let (bytes, refuse) = text(TIMINGS_FILE)?;
        let timings = Timings::from_csv(&bytes, &design).map_err(refuse)?;
        let design = Design { prose: manifest.prose(), ..design };
        Ok(Self { folder: folder.to_owned(), manifest, design, showcases, timings })
    }

    /// Study with renewed prose and cell facts; changed files are written.
    pub(crate) fn with_descriptions(
        self,
        manifest: Manifest,
        design: Design,
        folder: &ResultFolder,
    ) -> Result<Self, Failure> {
        let mut sha256 = self.manifest.sha256.clone();
        write(DESIGN_FILE, &described(DESIGN_FILE, &design, folder)?, folder, &mut sha256)?;
        let manifest = Manifest { sha256, ..manifest };
        if manifest != self.manifest {
            manifest.write(folder)?;
        }
        Ok(Self { design: Design { prose: manifest.prose(), ..design }, manifest, ..self })
    }

    /// Passes every row to `take`, in order. Fails if a row is missing or belongs to another study.
    pub fn for_each_row(&self, take: impl FnMut(StudyRow) -> Result<(), Failure>) -> Result<(), Failure> {
        TrialBlockStore::new(&self.folder, &self.manifest, &self.design).for_each_row(take)
    }
}

/// Failure of a file that differs from the file written by the study.
fn refused(path: &Path, problem: &str) -> Failure {
    Failure::in_file(
        path,
        format!(
            "{problem}; expected the file that the finished study wrote; restore it, or run the study again; complete \
                 blocks are kept"
        ),
    )
}

/// Manifest of a folder with rows; `None` without rows, as in a folder published without them, or without a manifest.
///
/// Fails for rows in the single file of earlier versions.
pub fn manifest_of_rows(folder: &Path) -> Result<Option<Manifest>, Failure> {
    let old = folder.join(LEGACY_ROWS_FILE);
    if disk::path_exists(&old).on("look for", &old)? {
        return Err(Failure::in_file(
            &old,
            "these rows were stored by an earlier version of this program; remove the folder, or give another with --out, \
             and run the study again",
        ));
    }
    if block_store::has_blocks(folder)? { Manifest::read(&folder.join(MANIFEST_FILE)) } else { Ok(None) }
}

/// Manifest of a folder that must contain rows.
pub fn required_manifest(folder: &Path) -> Result<Manifest, Failure> {
    manifest_of_rows(folder)?.ok_or_else(|| {
        let problem = match folder.exists() {
            false => "there is no such folder",
            true => {
                "there are no rows in it; expected the folder of a finished study, fit, trace, prediction or benchmark"
            }
        };
        Failure::in_file(folder, problem)
    })
}

/// JSON text of a file of the result folder, with a line end.
fn described(name: &str, content: &impl Serialize, folder: &ResultFolder) -> Result<Vec<u8>, Failure> {
    let text = serde_json::to_string(content).on("describe", &folder.path().join(name))?;
    Ok((text + "\n").into_bytes())
}

/// Writes a file unless its SHA-256 is unchanged, and stores the SHA-256.
fn write(name: &str, text: &[u8], folder: &ResultFolder, sha256: &mut BTreeMap<String, String>) -> Result<(), Failure> {
    let digest = hex_digits(&Sha256::digest(text));
    if sha256.insert(name.to_owned(), digest.clone()) == Some(digest) {
        Ok(())
    } else {
        folder.write_synced(name, text)
    }
}

/// Completes a folder with all rows: writes design, showcases, timings, and the manifest last. Returns the study
/// as written.
pub(crate) fn finish(
    folder: &ResultFolder,
    manifest: Manifest,
    design: Design,
    showcases: Vec<Showcase>,
    timings: &Timings,
) -> Result<StoredStudy, Failure> {
    let mut sha256 = BTreeMap::new();
    write(DESIGN_FILE, &described(DESIGN_FILE, &design, folder)?, folder, &mut sha256)?;
    write(SHOWCASES_FILE, &described(SHOWCASES_FILE, &showcases, folder)?, folder, &mut sha256)?;
    let times = timings.to_csv(&design)?;
    write(TIMINGS_FILE, &times, folder, &mut sha256)?;
    let manifest = Manifest { sha256, ..manifest };
    // Written last, since it makes the folder a finished study.
    manifest.write(folder)?;
    // Timings as written, rounded to the nanosecond.
    let timings = Timings::from_csv(&times, &design).map_err(Failure::execution)?;
    let design = Design { prose: manifest.prose(), ..design };
    Ok(StoredStudy { folder: folder.path().to_owned(), manifest, design, showcases, timings })
}
