//! The folder `unfinished` inside a result folder: rows as they come, in numbered parts that each appear whole or not at
//! all. Whatever kills a run, the parts stay, and the next run goes on after the last of them. When all trials are done the
//! parts are joined to `rows.parquet`, whose bytes do not depend on where the parts were cut.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::engine::Outcome;
use crate::failure::{Failure, OnPath};
use crate::manifest::Manifest;
use crate::plan::{Plan, Task};
use crate::rows::{Layout, Reader, Row, Writer};
use crate::screen;
use crate::store::Design;
use crate::timings::Timings;

/// Name of the folder.
pub const NAME: &str = "unfinished";

const MANIFEST: &str = "manifest.toml";
const LOCK: &str = "lock";

/// A part is written when it holds so many rows,
const PART_ROWS: usize = 32_768;
/// or when its first row is so old, so that little is lost to a kill,
const PART_AGE: Duration = Duration::from_millis(250);
/// or, later, when that age is this share of the time of the run, so that long studies have no hosts of small parts.
const PART_SHARE: f64 = 0.01;

/// A study in progress. Nobody else can work in the folder while this lives.
pub struct Unfinished<'a> {
    folder: PathBuf,
    design: &'a Design,
    layout: &'a Layout,
    manifest: Manifest,
    parts: u64,
    timings: Timings,
    _lock: File,
}

/// Whether a result folder holds a study in progress. What else may be in its folder `unfinished` is left of one that ended.
pub fn is_in(results: &Path) -> bool {
    results.join(NAME).join(MANIFEST).exists()
}

/// Throws away the study in progress in a result folder. Fails when a run is at work there.
pub fn discard(results: &Path) -> Result<(), Failure> {
    let folder = results.join(NAME);
    if folder.exists() {
        drop(lock(results)?);
        fs::remove_dir_all(&folder).on("remove", &folder)?;
    }
    Ok(())
}

/// Keeps other runs out of a result folder while the file lives. Fails when one is at work there.
fn lock(results: &Path) -> Result<File, Failure> {
    let path = results.join(NAME).join(LOCK);
    let lock = File::create(&path).on("create", &path)?;
    lock.try_lock().map_err(|error| match error {
        fs::TryLockError::WouldBlock => Failure::work(format!(
            "another study is running in {}; wait for it, or give another folder with --out",
            results.display()
        )),
        fs::TryLockError::Error(error) => Failure::work(format!("failed to lock {}: {error}", path.display())),
    })?;
    Ok(lock)
}

impl<'a> Unfinished<'a> {
    /// The manifest of the study in progress in a result folder, if there is one.
    pub fn manifest_in(results: &Path) -> Result<Option<Manifest>, Failure> {
        if is_in(results) { Manifest::read(&results.join(NAME).join(MANIFEST)).map(Some) } else { Ok(None) }
    }

    /// Begins a study, or goes on with the one in the folder, which the caller has found to be the same.
    ///
    /// Fails when another run is at work in the folder.
    pub fn open(results: &Path, manifest: Manifest, design: &'a Design, layout: &'a Layout) -> Result<Self, Failure> {
        let folder = results.join(NAME);
        fs::create_dir_all(&folder).on("make the folder", &folder)?;
        let lock = lock(results)?;
        let known = Self::manifest_in(results)?;
        let machine = known.as_ref().unwrap_or(&manifest).machine.clone();
        let manifest = Manifest { machine, ..manifest };
        let this = Self {
            folder,
            design,
            layout,
            manifest,
            parts: 0,
            timings: Timings::new(design.methods.len()),
            _lock: lock,
        };
        if known.is_none() {
            this.remove_parts_from(0)?;
        }
        this.write_manifest()?;
        Ok(this)
    }

    fn remove_parts_from(&self, first: u64) -> Result<(), Failure> {
        let mut part = first;
        while self.rows_of(part).exists() {
            fs::remove_file(self.rows_of(part)).on("remove", &self.rows_of(part))?;
            part += 1;
        }
        Ok(())
    }

    fn rows_of(&self, part: u64) -> PathBuf {
        self.folder.join(format!("{part:08}.parquet"))
    }

    fn timings_of(&self, part: u64) -> PathBuf {
        self.folder.join(format!("{part:08}.csv"))
    }

    fn write_manifest(&self) -> Result<(), Failure> {
        let path = self.folder.join(MANIFEST);
        let unfinished = path.with_extension("tmp");
        self.manifest.write(&unfinished)?;
        fs::rename(&unfinished, &path).on("write", &path)
    }

    /// Reads what is stored, shows every row to the plan and to `check`, and moves the plan behind it. A part that cannot be
    /// read is thrown away with all after it: their trials are run again.
    pub fn resume(
        &mut self,
        plan: &mut Plan,
        mut check: impl FnMut(Row) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut last: Option<Task> = None;
        while self.rows_of(self.parts).exists() {
            let part = self.parts;
            let stored = self
                .part(part, plan, last)
                .and_then(|rows| Timings::read(&self.timings_of(part), self.design).map(|timings| (rows, timings)));
            let (rows, timings) = match stored {
                Ok(stored) => stored,
                Err(failure) => {
                    screen::warn(&format!("warning: {}; its trials are run again", failure.message));
                    break;
                }
            };
            for row in rows {
                plan.saw(&row);
                last = Some(Task { cell: row.cell as usize, replicate: row.replicate });
                check(row)?;
            }
            self.timings.join(&timings);
            self.parts += 1;
        }
        self.remove_parts_from(self.parts)?;
        if let Some(last) = last {
            plan.resume_after(last);
        }
        Ok(())
    }

    /// Rows of a part; fails unless they are whole trials of the plan that come after `last`.
    fn part(&self, part: u64, plan: &Plan, last: Option<Task>) -> Result<Vec<Row>, Failure> {
        let path = self.rows_of(part);
        let mut rows = Vec::new();
        Reader::open(&path, self.layout)?.for_each(|row| {
            rows.push(row);
            Ok(())
        })?;
        let foreign = || Failure::input(format!("{}: these are not the next trials of this study", path.display()));
        let mut before = last;
        let trials = rows.chunks(self.design.methods.len());
        for trial in trials {
            let task = Task { cell: trial[0].cell as usize, replicate: trial[0].replicate };
            let whole = trial.len() == self.design.methods.len()
                && trial.iter().enumerate().all(|(method, row)| {
                    row.method == method && row.cell == trial[0].cell && row.replicate == trial[0].replicate
                });
            if !whole || !plan.holds(task) || before.is_some_and(|before| task <= before) {
                return Err(foreign());
            }
            before = Some(task);
        }
        Ok(rows)
    }

    /// Stores trials as they come until there are no more.
    pub fn store(&mut self, outcomes: impl IntoIterator<Item = Vec<Outcome>>) -> Result<(), Failure> {
        let before = self.manifest.machine.wall_time_s;
        let start = Instant::now();
        let mut waiting: Vec<Row> = Vec::new();
        let mut timings = Timings::new(self.design.methods.len());
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
        if waiting.is_empty() { self.write_manifest() } else { self.write_part(&mut waiting, &mut timings) }
    }

    /// Writes a part; its times first, so that a part with rows has them.
    fn write_part(&mut self, rows: &mut Vec<Row>, timings: &mut Timings) -> Result<(), Failure> {
        timings.write(&self.timings_of(self.parts), self.design)?;
        let mut writer = Writer::create(&self.rows_of(self.parts), self.layout)?;
        writer.push(rows.drain(..))?;
        writer.finish()?;
        self.parts += 1;
        self.timings.join(timings);
        *timings = Timings::new(self.design.methods.len());
        self.write_manifest()
    }

    /// Joins the parts to one file of rows.
    pub fn join(&self, rows: &Path) -> Result<(), Failure> {
        let mut writer = Writer::create(rows, self.layout)?;
        for part in 0..self.parts {
            Reader::open(&self.rows_of(part), self.layout)?.for_each(|row| writer.push([row]))?;
        }
        writer.finish()
    }

    /// What ran so far, and on what.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Times so far.
    pub fn timings(&self) -> &Timings {
        &self.timings
    }

    /// Removes the folder, once everything in it is elsewhere; the manifest first, so that a kill leaves a finished study.
    pub fn remove(self) -> Result<(), Failure> {
        let manifest = self.folder.join(MANIFEST);
        fs::remove_file(&manifest).on("remove", &manifest)?;
        fs::remove_dir_all(&self.folder).on("remove", &self.folder)
    }
}
