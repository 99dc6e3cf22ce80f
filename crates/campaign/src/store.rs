//! The files of a result folder that everything else is made from: rows, design, showcases, times and manifest. The
//! manifest is written last and carries the SHA-256 of the others, and who reads them looks first whether they are
//! still the same.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use scenario::failure::{Failure, OnPath};
use scenario::hex;
use serde::Serialize;
use sha2::{Digest, Sha256};

use crate::design::Design;
use crate::disk;
use crate::files::{DESIGN, MANIFEST, ROWS, SHOWCASES, TIMINGS};
use crate::folder::{ReadLock, ResultFolder, sha256_of};
use crate::manifest::Manifest;
use crate::rows::{RowLayout, RowReader, Sequence, StudyRow};
use crate::showcase::Showcase;
use crate::timings::Timings;
use crate::unfinished;

/// Largest size of a stored text, bytes.
const LARGEST_TEXT: u64 = 1 << 29;

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
    _lock: Option<ReadLock>,
}

impl StoredStudy {
    /// Reads a finished study and keeps others from writing there. Fails as wrong input when the folder holds none.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        // A folder that is not there is not worth a lock.
        expected_in(folder)?;
        let lock = ReadLock::begin(folder)?;
        Ok(Self { _lock: Some(lock), ..Self::of(folder, expected_in(folder)?)? })
    }

    /// Reads a finished study in a folder that is held.
    pub fn held(folder: &ResultFolder) -> Result<Self, Failure> {
        Self::of(folder.path(), expected_in(folder.path())?)
    }

    fn of(folder: &Path, manifest: Manifest) -> Result<Self, Failure> {
        let hash =
            |path: &Path| disk::is_there(path).and_then(|is_there| is_there.then(|| sha256_of(path)).transpose());
        let path = folder.join(ROWS);
        is_unchanged(&path, hash(&path).on("read", &path)?, &manifest)?;
        let text = |name: &str| {
            let path = folder.join(name);
            let bytes = disk::read(&path, LARGEST_TEXT).on("read", &path)?;
            is_unchanged(&path, bytes.as_ref().map(|bytes| hex(&Sha256::digest(bytes))), &manifest)?;
            Ok::<_, Failure>((bytes.unwrap_or_default(), move |problem: String| refused(&path, &problem)))
        };
        let (bytes, refuse) = text(DESIGN)?;
        let design = Design::of_text(&bytes).map_err(refuse)?;
        let (bytes, refuse) = text(SHOWCASES)?;
        let showcases = serde_json::from_slice(&bytes).map_err(|problem| refuse(problem.to_string()))?;
        let (bytes, refuse) = text(TIMINGS)?;
        let timings = Timings::of_text(&bytes, &design).map_err(refuse)?;
        let design = Design { words: manifest.words(), ..design };
        Ok(Self { folder: folder.to_owned(), manifest, design, showcases, timings, _lock: None })
    }

    /// The same study after its words, or what is told of its cells, have changed; they are written where they have.
    pub(crate) fn told_again(self, manifest: Manifest, design: Design, folder: &ResultFolder) -> Result<Self, Failure> {
        let text = described(DESIGN, &design, folder)?;
        let mut sha256 = self.manifest.sha256.clone();
        if sha256.get(DESIGN) != Some(&hex(&Sha256::digest(&text))) {
            sha256.insert(DESIGN.to_owned(), folder.keep(DESIGN, text)?);
        }
        let manifest = Manifest { sha256, ..manifest };
        if manifest != self.manifest {
            manifest.write(folder)?;
        }
        Ok(Self { design: Design { words: manifest.words(), ..design }, manifest, ..self })
    }

    /// Hands every row to `take`, in order. Fails when one is missing or is not of this study.
    pub fn rows(&self, mut take: impl FnMut(StudyRow) -> Result<(), Failure>) -> Result<(), Failure> {
        let path = self.folder.join(ROWS);
        let refuse = |problem: String| refused(&path, &problem);
        let mut sequence = Sequence::new(&self.design);
        RowReader::open(&path, &RowLayout::of(&self.design))?.for_each(|row| {
            sequence.see(&row).map_err(refuse)?;
            take(row)
        })?;
        sequence.finish().map_err(refuse)
    }
}

/// A file that is not what a study wrote, and what to do.
fn refused(path: &Path, problem: &str) -> Failure {
    Failure::about(
        path,
        format!(
            "{problem}; expected what a finished study wrote; put the file back, or run the study again with --restart"
        ),
    )
}

/// Compares the SHA-256 of a file, none where the file is missing, with what the manifest says of it.
fn is_unchanged(path: &Path, found: Option<String>, manifest: &Manifest) -> Result<(), Failure> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(written) = manifest.sha256.get(&*name) else {
        return Err(Failure::about(
            &path.with_file_name(MANIFEST),
            format!(
                "it has no SHA-256 of {name}, as an earlier version of this program wrote it; run the study again with \
             --restart"
            ),
        ));
    };
    match found {
        None => Err(refused(path, "it is missing")),
        Some(found) if found == *written => Ok(()),
        Some(_) => Err(refused(path, "it was changed: its SHA-256 is not the one in the manifest")),
    }
}

/// The manifest of the finished rows in a folder; `None` when there are none. A folder that holds what was published
/// without its rows is not a finished study.
pub fn manifest_of_rows(folder: &Path) -> Result<Option<Manifest>, Failure> {
    let is_there = |name: &str| disk::is_there(&folder.join(name)).on("look for", &folder.join(name));
    if unfinished::is_in(folder)? || !is_there(ROWS)? { Ok(None) } else { Manifest::read(&folder.join(MANIFEST)) }
}

/// Fails unless a folder holds a finished study.
pub fn is_finished(folder: &Path) -> Result<(), Failure> {
    expected_in(folder).map(drop)
}

/// The same where there have to be rows.
fn expected_in(folder: &Path) -> Result<Manifest, Failure> {
    manifest_of_rows(folder)?.ok_or_else(|| {
        let problem = match unfinished::is_in(folder) {
            Ok(true) => "the study in it is not finished; run it again to go on",
            _ if !folder.exists() => "there is no such folder",
            _ => {
                "there are no rows in it; expected the folder of a finished study, fit, trace, prediction or benchmark"
            }
        };
        Failure::about(folder, problem)
    })
}

/// The text of a file of this name.
fn described(name: &str, what: &impl Serialize, folder: &ResultFolder) -> Result<String, Failure> {
    Ok(serde_json::to_string(what).on("describe", &folder.path().join(name))? + "\n")
}

/// Makes a folder that holds rows with this SHA-256 a finished study: design, showcases, times, and the manifest last.
/// What is returned is what was written, and need not be read again.
pub fn finish(
    folder: &ResultFolder,
    manifest: &Manifest,
    rows_sha256: String,
    design: Design,
    showcases: Vec<Showcase>,
    timings: &Timings,
) -> Result<StoredStudy, Failure> {
    let mut sha256 = BTreeMap::from([(ROWS.to_owned(), rows_sha256)]);
    sha256.insert(DESIGN.to_owned(), folder.keep(DESIGN, described(DESIGN, &design, folder)?)?);
    sha256.insert(SHOWCASES.to_owned(), folder.keep(SHOWCASES, described(SHOWCASES, &showcases, folder)?)?);
    let times = timings.to_text(&design)?;
    sha256.insert(TIMINGS.to_owned(), folder.keep(TIMINGS, &times)?);
    let manifest = Manifest { sha256, ..manifest.clone() };
    // Last, since it makes the folder a finished study.
    manifest.write(folder)?;
    // As they are written: to the nanosecond.
    let timings = Timings::of_text(&times, &design).map_err(Failure::work)?;
    let design = Design { words: manifest.words(), ..design };
    Ok(StoredStudy { folder: folder.path().to_owned(), manifest, design, showcases, timings, _lock: None })
}
