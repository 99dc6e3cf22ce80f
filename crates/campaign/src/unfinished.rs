//! The folder `unfinished` inside a result folder: rows as they come, in numbered parts that each appear whole or not
//! at all. Whatever kills a run, the parts stay, and the next run goes on after the last of them. When all trials are
//! done the parts are joined to `rows.parquet`, whose bytes do not depend on where the parts were cut.
//!
//! Beside its rows every part has a description: first and last trial, their number, the SHA-256 of the rows, and
//! times. Only a part that was read and is wrong is thrown away, with those after it, the last one first.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::design::Design;
use crate::disk;
use crate::engine::TrialOutcome;
use crate::files::{MANIFEST, ROWS};
use crate::folder::ResultFolder;
use crate::manifest::Manifest;
use crate::observer::Observer;
use crate::plan::TrialPlan;
use crate::rows::{RowLayout, RowReader, RowWriter, Sequence, StudyRow};
use crate::task::Task;
use crate::timings::{TimingLine, Timings};
use scenario::failure::{Failure, OnPath};
use scenario::hex;

/// Name of the folder.
pub const NAME: &str = "unfinished";

/// File that tells the folder from one of somebody else: the first that is written there, the last that goes.
const MARK: &str = "README";

/// What the mark says.
const MARK_TEXT: &str = "Rows of a study in progress. The command that began it goes on from here;\n\
                         with --restart it begins anew.\n";

/// A part is written when it holds so many rows,
const PART_ROWS: usize = 32_768;
/// or when its first row is so old, so that little is lost to a kill,
const PART_AGE: Duration = Duration::from_millis(250);
/// or, later, when that age is this share of the time of the run, so that long studies have no hosts of small parts.
const PART_SHARE: f64 = 0.01;

/// Largest size of a file of a part, bytes: its rows and the longest of texts.
const LARGEST_PART: u64 = 1 << 30;

/// A study in progress.
pub struct Unfinished<'a> {
    folder: ResultFolder,
    observer: &'a dyn Observer,
    layout: &'a RowLayout,
    /// The design; its cells know which trials are stored.
    pub design: Design,
    /// What ran so far, and on what.
    pub manifest: Manifest,
    parts: u64,
    /// Times so far.
    pub timings: Timings,
}

/// The description of a part.
#[derive(Debug, Serialize, Deserialize)]
struct PartDescription {
    rows_sha256: String,
    timings: Vec<TimingLine>,
}

/// Whether a result folder holds a study in progress. What else may be in its folder `unfinished` is left of one that
/// ended.
pub fn is_in(results: &Path) -> Result<bool, Failure> {
    let manifest = results.join(NAME).join(MANIFEST);
    Ok(is_ours(&results.join(NAME))? && disk::is_there(&manifest).on("look for", &manifest)?)
}

/// Whether a folder is there, and no link, and carries our mark, or nothing at all.
fn is_ours(folder: &Path) -> Result<bool, Failure> {
    if !disk::is_there(folder).on("look for", folder)? || disk::is_link(folder).on("look for", folder)? {
        return Ok(false);
    }
    let mark = folder.join(MARK);
    match disk::read(&mark, LARGEST_PART).on("read", &mark)? {
        Some(text) => Ok(text == MARK_TEXT.as_bytes()),
        None => Ok(foreign(folder)?.is_none()),
    }
}

/// A file in a folder without our mark, apart from a mark that was never finished.
fn foreign(folder: &Path) -> Result<Option<String>, Failure> {
    let names = disk::names(folder).on("list", folder)?;
    Ok(names.into_iter().find(|name| *name != format!("{MARK}.tmp")))
}

/// The manifest of the study in progress in a result folder, if there is one.
pub fn manifest_in(results: &Path) -> Result<Option<Manifest>, Failure> {
    if is_in(results)? { Manifest::read(&results.join(NAME).join(MANIFEST)) } else { Ok(None) }
}

/// Throws away the study in progress in a result folder.
pub fn discard(results: &ResultFolder, observer: &dyn Observer) -> Result<(), Failure> {
    let folder = results.path().join(NAME);
    if is_ours(&folder)? { clear(&folder, observer) } else { Ok(()) }
}

/// Removes what a study wrote into its folder, the manifest first, so that a kill leaves none in progress, and the
/// folder, unless it holds something else.
fn clear(folder: &Path, observer: &dyn Observer) -> Result<(), Failure> {
    remove(&folder.join(MANIFEST))?;
    let names = disk::names(folder).on("list", folder)?;
    let (own, others): (Vec<&String>, Vec<&String>) =
        names.iter().filter(|name| *name != MARK).partition(|name| number_of(name).is_some() || name.ends_with(".tmp"));
    own.iter().rev().try_for_each(|name| remove(&folder.join(name)))?;
    remove(&folder.join(MARK))?;
    if others.is_empty() {
        return disk::remove_folder(folder).on("remove", folder);
    }
    observer.warn(&format!("{} holds files of somebody else, which are left there", folder.display()));
    Ok(())
}

fn remove(path: &Path) -> Result<(), Failure> {
    disk::remove_if_there(path).on("remove", path)
}

/// The number of a part in the name of one of its files.
fn number_of(name: &str) -> Option<u64> {
    let stem = name.strip_suffix(".parquet").or_else(|| name.strip_suffix(".json"))?;
    (stem.len() >= 8 && stem.bytes().all(|byte| byte.is_ascii_digit())).then(|| stem.parse().ok()).flatten()
}

fn rows_of(part: u64) -> String {
    format!("{part:08}.parquet")
}

fn about(part: u64) -> String {
    format!("{part:08}.json")
}

impl<'a> Unfinished<'a> {
    /// Begins a study, or goes on with the one in the folder, which the caller has found to be the same.
    ///
    /// Fails when the place of its folder is taken by something else.
    pub fn open(
        results: &ResultFolder,
        manifest: Manifest,
        design: &Design,
        layout: &'a RowLayout,
        observer: &'a dyn Observer,
    ) -> Result<Self, Failure> {
        let folder = results.inside(NAME)?;
        let path = folder.path();
        if !is_ours(path)? {
            let name = foreign(path)?.unwrap_or_default();
            return Err(Failure::input(format!(
                "{} holds {name}, and was not made by this program; move it away, or give another folder with --out",
                path.display()
            )));
        }
        let known = manifest_in(results.path())?;
        if known.is_none() {
            let names = disk::names(path).on("list", path)?;
            if let Some(part) = names.iter().find(|name| number_of(name).is_some()) {
                return Err(Failure::input(format!(
                    "{} holds rows of a study ({part}) without {MANIFEST}, so nobody knows of which one; put the manifest \
                     back, give another folder with --out, or --restart to discard the rows",
                    path.display()
                )));
            }
            clear(path, observer)?;
            results.inside(NAME)?.keep(MARK, MARK_TEXT)?;
        }
        let machine = known.as_ref().unwrap_or(&manifest).machine.clone();
        let this = Self {
            folder,
            observer,
            design: design.clone(),
            layout,
            manifest: Manifest { machine, ..manifest },
            parts: 0,
            timings: Timings::default(),
        };
        this.manifest.write(&this.folder)?;
        Ok(this)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Reads what is stored, shows every row to the plan and to `check`, and moves the plan behind it. A part that is
    /// wrong is thrown away with all after it: their trials are run again.
    ///
    /// Fails when a part cannot be read; then nothing is thrown away.
    pub fn resume(
        &mut self,
        plan: &mut TrialPlan,
        mut check: impl FnMut(StudyRow) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let names = disk::names(self.folder.path()).on("list", self.folder.path())?;
        let stored: Vec<u64> =
            names.iter().filter(|name| name.ends_with(".parquet")).filter_map(|name| number_of(name)).collect();
        let mut wrong = None;
        for &number in &stored {
            // Seen by a copy, since a part may turn out to be wrong at its end.
            let mut ahead = plan.clone();
            let read = match number == self.parts {
                true => self.read(number, |trial| follows(&mut ahead, trial))?,
                false => Err(format!("{} is missing", self.path(&rows_of(self.parts)).display())),
            };
            let (rows, timings) = match read {
                Ok(read) => read,
                Err(problem) => {
                    wrong = Some(problem);
                    break;
                }
            };
            self.note(&rows);
            rows.into_iter().try_for_each(&mut check)?;
            self.timings.join(&timings);
            self.parts += 1;
            *plan = ahead;
        }
        let Some(problem) = wrong else { return Ok(()) };
        let lost = &stored[self.parts as usize..];
        self.observer.warn(&format!(
            "{problem}; it is removed with what comes after it, {} in all, and their trials are run again",
            if lost.len() == 1 { "1 part".to_owned() } else { format!("{} parts", lost.len()) }
        ));
        for &number in lost.iter().rev() {
            remove(&self.path(&rows_of(number)))?;
            remove(&self.path(&about(number)))?;
        }
        Ok(())
    }

    /// Rows and times of a part, every trial shown to `see`. The inner failure is a part that was read and is wrong.
    fn read(
        &self,
        part: u64,
        see: impl FnMut(&[StudyRow]) -> Result<(), String>,
    ) -> Result<Result<(Vec<StudyRow>, Timings), String>, Failure> {
        let (rows, about) = (self.path(&rows_of(part)), self.path(&about(part)));
        let read = |path: &Path| {
            let advice = "nothing is removed, and the same command tries again";
            let refuse = |error| Failure::work(format!("failed to read {}: {error}; {advice}", path.display()));
            disk::read(path, LARGEST_PART).map_err(refuse)
        };
        let (bytes, description) = (read(&rows)?, read(&about)?);
        let whole = || {
            let (bytes, description) = bytes.zip(description).ok_or("it is missing, or its description")?;
            self.decode(&rows, bytes, &description, see)
        };
        Ok(whole().map_err(|problem: String| format!("{}: {problem}", rows.display())))
    }

    fn decode(
        &self,
        path: &Path,
        bytes: Vec<u8>,
        description: &[u8],
        see: impl FnMut(&[StudyRow]) -> Result<(), String>,
    ) -> Result<(Vec<StudyRow>, Timings), String> {
        let about: PartDescription = serde_json::from_slice(description).map_err(|error| error.to_string())?;
        if hex(&Sha256::digest(&bytes)) != about.rows_sha256 {
            return Err("it is damaged, its SHA-256 is another".to_owned());
        }
        let mut rows = Vec::new();
        let keep = |row| {
            rows.push(row);
            Ok(())
        };
        let reader = RowReader::of_bytes(bytes, path, self.layout);
        reader.and_then(|reader| reader.for_each(keep)).map_err(|failure| failure.message)?;
        let methods = self.design.methods.len();
        if !rows.len().is_multiple_of(methods) {
            return Err("its last trial is not whole".to_owned());
        }
        rows.chunks(methods).try_for_each(see)?;
        Ok((rows, Timings::of_lines(about.timings, &self.design)))
    }

    /// Takes note of trials that are stored.
    fn note(&mut self, rows: &[StudyRow]) {
        for trial in rows.chunks(self.design.methods.len()) {
            let Task { cell, replicate } = task(trial);
            let trials = &mut self.design.cells[cell].trials;
            let start = if trials.is_empty() { replicate } else { trials.start };
            *trials = start..replicate + 1;
        }
    }

    /// Stores trials as they come until there are no more.
    pub fn store(&mut self, outcomes: impl IntoIterator<Item = Vec<TrialOutcome>>) -> Result<(), Failure> {
        let before = self.manifest.machine.wall_time_s;
        let start = Instant::now();
        let mut waiting: Vec<StudyRow> = Vec::new();
        let mut timings = Timings::default();
        let mut oldest = Instant::now();
        for outcomes in outcomes {
            if waiting.is_empty() {
                oldest = Instant::now();
            }
            for outcome in outcomes {
                waiting.extend(outcome.rows);
                timings.add(&outcome.timing);
            }
            if waiting.len() >= PART_ROWS || oldest.elapsed() >= PART_AGE.max(start.elapsed().mul_f64(PART_SHARE)) {
                self.manifest.machine.wall_time_s = before + start.elapsed().as_secs_f64();
                self.write_part(&mut waiting, &mut timings)?;
            }
        }
        self.manifest.machine.wall_time_s = before + start.elapsed().as_secs_f64();
        if waiting.is_empty() { self.manifest.write(&self.folder) } else { self.write_part(&mut waiting, &mut timings) }
    }

    /// Writes a part; its description first, so that a part with rows has one.
    fn write_part(&mut self, rows: &mut Vec<StudyRow>, timings: &mut Timings) -> Result<(), Failure> {
        self.note(rows);
        let mut writer = RowWriter::create(&self.folder, &rows_of(self.parts), self.layout)?;
        writer.push(rows.drain(..))?;
        let (file, rows_sha256) = writer.finish()?;
        let part = PartDescription { rows_sha256, timings: timings.lines(&self.design).collect() };
        let name = about(self.parts);
        self.folder.keep(&name, serde_json::to_string(&part).on("describe", &self.path(&name))?)?;
        file.put()?;
        self.folder.sync()?;
        self.parts += 1;
        self.timings.join(&std::mem::take(timings));
        self.manifest.write(&self.folder)
    }

    /// Joins the parts to the rows of a finished study; returns their SHA-256.
    pub fn join(&self, results: &ResultFolder) -> Result<String, Failure> {
        let mut writer = RowWriter::create(results, ROWS, self.layout)?;
        let mut sequence = Sequence::new(&self.design);
        let changed =
            |problem: String| Failure::work(format!("{problem}; it changed while the study ran, run it again"));
        for part in 0..self.parts {
            let see = |trial: &[StudyRow]| trial.iter().try_for_each(|row| sequence.see(row));
            let (rows, _) = self.read(part, see)?.map_err(changed)?;
            writer.push(rows)?;
        }
        sequence.finish().map_err(changed)?;
        let (file, sha256) = writer.finish()?;
        file.put()?;
        results.sync()?;
        Ok(sha256)
    }

    /// Removes the folder, once everything in it is elsewhere.
    pub fn remove(self) -> Result<(), Failure> {
        clear(self.folder.path(), self.observer)
    }
}

/// The trial that rows belong to.
fn task(trial: &[StudyRow]) -> Task {
    Task { cell: trial[0].cell as usize, replicate: trial[0].replicate }
}

/// Moves a plan behind a trial. Fails when that is not the next one, whole.
fn follows(plan: &mut TrialPlan, trial: &[StudyRow]) -> Result<(), String> {
    let expected = plan.next(1).pop();
    let is_row =
        |(method, row): (usize, &StudyRow)| row.method == method && task(std::slice::from_ref(row)) == task(trial);
    if expected != Some(task(trial)) || !trial.iter().enumerate().all(is_row) {
        return Err("these are not the next trials of this study".to_owned());
    }
    trial.iter().for_each(|row| plan.saw(row));
    Ok(())
}
