//! A log: what one or several files hold, cleaned and on one clock, before a part of it becomes a record.

use std::path::{Path, PathBuf};

use super::assemble::{check, columns, complete, once, series, straight_rudder};
use super::error::{Problem, ReadError};
use super::input::{self, Content, Text};
use super::limits::spoken;
use super::lines::Lines;
use super::nmea;
use super::source::{Piece, Series, Source};
use super::table;
use crate::channel::Channel;
use crate::cleaning;
use crate::clock::Clock;
use crate::encoding::Encoding;
use crate::file::called;
use crate::plausibility;
use crate::record::{Columns, Origin, RejectedReading, Trial, TrialError};
use crate::sidecar::{Sidecar, SidecarProblem};
use ship::Particulars;

/// A record that was read, and what the reader had to decide or found remarkable.
#[derive(Debug, Clone)]
pub struct Reading {
    /// The record.
    pub trial: Trial,
    /// One sentence each, without the name of the file.
    pub warnings: Vec<String>,
}

/// What one or several files hold, on one clock.
#[derive(Debug, Clone)]
pub struct Log {
    path: PathBuf,
    columns: Columns,
    clock: Option<Clock>,
    sha256: String,
    rows: usize,
    sidecar: Option<Sidecar>,
    part: Option<[f64; 2]>,
    /// What the reader had to decide or found remarkable, one sentence each.
    pub warnings: Vec<String>,
    marks: Vec<RejectedReading>,
}

impl Log {
    /// Reads the log at `path`, or on standard input for `-`, as the sidecar at `sidecar` describes it, and the
    /// channels of `others` beside it, each as the sidecar beside it describes.
    ///
    /// Fails as [`read_with`] does, but for what makes a record of it, and where two files have no time in common.
    pub fn open(path: &Path, sidecar: Option<&Path>, others: &[PathBuf]) -> Result<Self, ReadError> {
        if path.to_str().is_some_and(|name| name.ends_with(".trial.toml")) {
            return Err(ReadError::table(path, Problem::IsSidecar));
        }
        let sidecar = sidecar.map(Sidecar::load).transpose()?;
        let piece = piece(path, sidecar.as_ref(), others.is_empty())?;
        let mut log = Self::of(called(path), piece, sidecar);
        for other in others {
            log.join(other)?;
        }
        if !others.is_empty() {
            log.settle_joined()?;
        }
        Ok(log)
    }

    /// Reads the log that `input` gives; `path` names it, and `size` (bytes), where known, serves to estimate the rows
    /// of a file that is too long.
    ///
    /// Fails as [`open`](Self::open) does, except for faults of the file system.
    pub fn of_bytes(
        path: &Path,
        input: impl std::io::Read,
        size: Option<u64>,
        sidecar: Option<&Sidecar>,
    ) -> Result<Self, ReadError> {
        let content = input::recognise(Box::new(input)).map_err(|problem| ReadError::table(path, problem))?;
        let piece = of_content(path, content, size, sidecar, true)?;
        Ok(Self::of(path, piece, sidecar.cloned()))
    }

    fn of(path: &Path, piece: Piece, sidecar: Option<Sidecar>) -> Self {
        let Piece { columns, clock, warnings, marks, rows, sha256 } = piece;
        Self { path: path.to_path_buf(), columns, clock, sha256, rows, sidecar, part: None, warnings, marks }
    }

    fn fault(&self, problem: impl Into<Problem>) -> ReadError {
        ReadError::table(&self.path, problem.into())
    }

    /// Adds the channels of another file.
    fn join(&mut self, other: &Path) -> Result<(), ReadError> {
        let sidecar = Sidecar::found_beside(other).map(|beside| Sidecar::load(&beside)).transpose()?;
        let piece = piece(other, sidecar.as_ref(), false)?;
        let offset = match (&self.clock, &piece.clock) {
            (Some(own), Some(its)) => offset(own, its),
            (None, None) => 0.0,
            (own, _) => {
                let problem = Problem::TwoClocks { other: self.path.clone(), stamped: own.is_some() };
                return Err(ReadError::table(other, problem));
            }
        };
        let of_file = |warning: String| format!("{}: {warning}", other.display());
        self.warnings.extend(piece.warnings.into_iter().map(of_file));
        self.marks.extend(piece.marks.into_iter().map(|mark| RejectedReading { time: mark.time + offset, ..mark }));
        let mut all = series(std::mem::take(&mut self.columns), 0.0);
        all.extend(series(piece.columns, offset));
        let (all, doubled) = once(all);
        self.warnings.extend(doubled.into_iter().map(|channel| {
            of_file(format!("the {} is in an earlier file, too, and is taken from there", spoken(channel)))
        }));
        self.columns = columns(all);
        self.sha256 = joined_hash(&self.sha256, &piece.sha256);
        self.rows += piece.rows;
        Ok(())
    }

    /// Checks that files which belong together make a record.
    fn settle_joined(&mut self) -> Result<(), ReadError> {
        check(&self.columns).map_err(|problem| self.fault(problem))?;
        self.warnings.extend(complete(&mut self.columns));
        self.warnings.extend(straight_rudder(&mut self.columns));
        Ok(())
    }

    /// What the clock shows at time 0, where the files have stamps.
    pub fn clock(&self) -> Option<Clock> {
        self.clock
    }

    /// Time of every row, s.
    pub fn time(&self) -> &[f64] {
        &self.columns.time
    }

    /// A channel, row by row, where the log has it; SI units and radians.
    pub fn channel(&self, channel: Channel) -> Option<&[f64]> {
        self.columns.channels.get(&channel).map(Vec::as_slice)
    }

    /// Whether a sidecar says which part is to be used.
    pub fn has_declared_part(&self) -> bool {
        self.sidecar.as_ref().is_some_and(|sidecar| sidecar.from.is_finite() || sidecar.until.is_finite())
    }

    /// The part from one time to another, s, both included. Fails where it holds no row.
    pub fn part(mut self, from: f64, until: f64) -> Result<Self, ReadError> {
        let time = &self.columns.time;
        let rows = time.partition_point(|&t| t < from)..time.partition_point(|&t| t <= until);
        if rows.is_empty() {
            let ends = |place: Option<&f64>| place.copied().unwrap_or(f64::NAN);
            let (first_s, last_s) = (ends(time.first()), ends(time.last()));
            return Err(self.fault(Problem::EmptyPart { from_s: from, until_s: until, first_s, last_s }));
        }
        if rows.len() < time.len() {
            self.part = Some([time[rows.start], time[rows.end - 1]]);
            let cut = |values: &mut Vec<f64>| {
                values.truncate(rows.end);
                values.drain(..rows.start);
            };
            cut(&mut self.columns.time);
            self.columns.channels.values_mut().for_each(cut);
            self.columns.unknown.iter_mut().for_each(|(_, values)| cut(values));
            self.columns.channels.retain(|_, values| values.iter().any(|value| value.is_finite()));
        }
        Ok(self)
    }

    /// The record that the log holds; `ship` goes before what a sidecar declares.
    ///
    /// Fails when it has too few rows, or contradicts itself ([`plausibility`]).
    pub fn into_trial(self, ship: Option<Particulars>) -> Result<Reading, ReadError> {
        let Self { path, columns, sha256, rows, sidecar, mut warnings, part, mut marks, .. } = self;
        let (first, last) = (columns.time.first().copied(), columns.time.last().copied());
        marks.retain(|mark| first <= Some(mark.time) && Some(mark.time) <= last);
        let fault = |problem| ReadError::table(&path, problem);
        let checked = sidecar.as_ref().is_none_or(|sidecar| sidecar.plausibility);
        let name = input::stem(&path);
        // Two parts of one file are two records.
        let sha256 =
            part.map_or_else(|| sha256.clone(), |[from, until]| joined_hash(&sha256, &format!("{from} {until}")));
        let origin = Origin::Measured { file: path.display().to_string(), sha256 };
        let trial = Trial::new(name, origin, columns).map_err(|error| {
            fault(match error {
                TrialError::TooShort { needed, found } => Problem::TooShort { needed, found, rows },
                other => Problem::Record(other),
            })
        })?;
        if trial.heading_from_yaw_rate() {
            warnings.push("there is no heading; it is the integral of the yaw rate, from zero".to_owned());
        }
        let noise = sidecar.as_ref().map(|sidecar| sidecar.noise).unwrap_or_default();
        let trial = match ship.or_else(|| sidecar.as_ref().and_then(|sidecar| sidecar.particulars)) {
            Some(particulars) => trial.with_noise(noise).with_particulars(particulars),
            None => trial.with_noise(noise),
        };
        let conditions = sidecar.as_ref().map(|sidecar| sidecar.conditions.clone()).unwrap_or_default();
        let trial = trial.with_rejected(marks).with_conditions(conditions);
        match plausibility::check(&trial) {
            Ok(found) => warnings.extend(found),
            Err(implausible) if !checked => warnings.push(implausible.to_string()),
            Err(implausible) => return Err(fault(implausible.into())),
        }
        Ok(Reading { trial, warnings })
    }
}

/// Seconds to add to the times of the second clock to have them on the first.
fn offset(own: &Clock, its: &Clock) -> f64 {
    let zone = match (own.zone, its.zone) {
        (Some(own), Some(its)) => 60.0 * f64::from(own - its),
        _ => 0.0,
    };
    let seconds = its.second - own.second + zone;
    let half = 0.5 * crate::clock::DAY;
    match (own.day, its.day) {
        (Some(own), Some(its)) => seconds + crate::clock::DAY * (its - own) as f64,
        // Times of day alone: the nearest.
        _ => (seconds + half).rem_euclid(crate::clock::DAY) - half,
    }
}

/// One hash for two: that of both.
fn joined_hash(one: &str, other: &str) -> String {
    super::lines::sha256(format!("{one} {other}").as_bytes())
}

fn piece(path: &Path, sidecar: Option<&Sidecar>, whole: bool) -> Result<Piece, ReadError> {
    let name = called(path);
    let (content, size) = input::open(path).map_err(|problem| ReadError::table(name, problem))?;
    of_content(name, content, size, sidecar, whole)
}

fn of_content(
    path: &Path,
    content: Content,
    size: Option<u64>,
    sidecar: Option<&Sidecar>,
    whole: bool,
) -> Result<Piece, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    let checked = sidecar.is_none_or(|sidecar| sidecar.plausibility);
    let (Content::Table(text) | Content::Sentences(text)) = &content;
    let on_disk = text.on_disk.clone();
    let mut piece = match content {
        Content::Table(text) => table::read(path, text, size, sidecar, whole)?,
        Content::Sentences(Text { bytes: input, .. }) => {
            if let Some(sidecar) = sidecar.filter(|sidecar| !sidecar.columns.is_empty()) {
                return Err(sidecar.error(sidecar.columns[0].line, SidecarProblem::NoTable).into());
            }
            let source = nmea::read(Vec::new(), Lines::new(input, Encoding::Utf8)).map_err(fault)?;
            let mut piece = of_source(source, checked);
            if let Some(sidecar) = sidecar {
                piece.columns = kept_part(piece.columns, sidecar);
            }
            if whole {
                check(&piece.columns).map_err(fault)?;
            }
            piece
        }
    };
    if let Some(hash) = on_disk {
        piece.sha256 = hash.finish();
    }
    if whole {
        piece.warnings.extend(complete(&mut piece.columns));
        piece.warnings.extend(straight_rudder(&mut piece.columns));
    }
    Ok(piece)
}

/// Channels with instants of their own, each cleaned by itself.
fn of_source(source: Source, checked: bool) -> Piece {
    let Source { series, clock, mut warnings, lines, sha256 } = source;
    let mut marks = Vec::new();
    let cleaned = series.into_iter().map(|one| {
        let Series { channel, name, time, mut values } = one;
        if channel == Channel::Heading {
            ship::angle::unwrap_heading(&mut values);
        }
        let mut own = Columns { time, channels: [(channel, values)].into(), unknown: Vec::new() };
        if checked {
            warnings.extend(cleaning::clean(&mut own, &mut marks));
        }
        let values = own.channels.remove(&channel).unwrap_or_default();
        Series { channel, name, time: own.time, values }
    });
    let columns = columns(cleaned.collect());
    Piece { columns, clock, warnings, marks, rows: lines, sha256 }
}

/// The part of a log that its sidecar asks for.
fn kept_part(mut columns: Columns, sidecar: &Sidecar) -> Columns {
    let keep: Vec<bool> = columns.time.iter().map(|&t| (sidecar.from..=sidecar.until).contains(&t)).collect();
    columns.retain(&keep);
    columns
}

/// Reads the trial at `path`, with the sidecar beside it where there is one.
///
/// Fails as [`read_with`] does.
pub fn read(path: &Path) -> Result<Reading, ReadError> {
    read_with(path, Sidecar::found_beside(path).as_deref())
}

/// Reads the trial at `path` as the sidecar at `sidecar` describes it; `None` reads it by its header alone.
///
/// Fails with [`ReadError`] when the file is not there, larger than [`RECORD`](super::RECORD) or of no known format,
/// when a needed channel is absent, a cell is no number, time does not increase, fewer than [`Trial::FEWEST_ROWS`] or
/// more than [`super::MAX_ROWS`] rows are usable, the sidecar is at fault, or the record contradicts itself
/// ([`plausibility`]).
pub fn read_with(path: &Path, sidecar: Option<&Path>) -> Result<Reading, ReadError> {
    Log::open(path, sidecar, &[])?.into_trial(None)
}

/// Reads a trial from `input`; `path` names it, and `size` (bytes), where known, serves to estimate the rows of a file
/// that is too long.
///
/// Fails as [`read_with`] does, except for faults of the file system.
pub fn read_bytes(
    path: &Path,
    input: impl std::io::Read,
    size: Option<u64>,
    sidecar: Option<&Sidecar>,
) -> Result<Reading, ReadError> {
    Log::of_bytes(path, input, size, sidecar)?.into_trial(None)
}
