//! Reader of logs: the content of one or several files, cleaned and on a common clock, and the record of a part of it.

use std::io::Read;
use std::path::{Path, PathBuf};

use document::{Warning, WarningCode};
use ship::Particulars;

use super::assemble::{
    add_derived_channels, check_channels, interpolate_rudder, merge_series, split_columns, without_duplicates,
};
use super::error::{ReadError, ReadProblem};
use super::input::{self, FileContent};
use super::lines::{self, Lines};
use super::messages;
use super::nmea;
use super::rudder;
use super::source::{InstrumentLog, Readings, Series};
use super::table;
use crate::channel::Channel;
use crate::cleaning;
use crate::clock::{Clock, SECONDS_PER_DAY};
use crate::encoding::Encoding;
use crate::file::display_path;
use crate::plausibility;
use crate::record::{Columns, RecordOrigin, RejectedReading, Trial, TrialError};
use crate::sidecar::{Sidecar, SidecarError, SidecarProblem};
use crate::sidecar_keys::RudderKeys;

/// Record read from a file, with the warnings of the reader.
#[derive(Debug, Clone)]
pub struct ReadRecord {
    /// Record.
    pub trial: Trial,
    /// Warnings of the record, without the name of its file.
    pub warnings: Vec<Warning>,
}

impl InstrumentLog {
    /// Reads the log at `path`, or from standard input for `-`, with the sidecar at `sidecar`, and joins the
    /// channels of `joined`, each with the sidecar next to it.
    ///
    /// Fails as [`read_with_sidecar`] does, except for the checks of a record, and if two files have no time in common.
    pub fn open(path: &Path, sidecar: Option<&Path>, joined: &[PathBuf]) -> Result<Self, ReadError> {
        if path.to_str().is_some_and(|name| name.ends_with(".trial.toml")) {
            return Err(ReadError::table(path, ReadProblem::IsSidecar));
        }
        let mut log = Self::from_file(path, sidecar, joined.is_empty())?;
        for file in joined {
            log.join(file)?;
        }
        if !joined.is_empty() {
            check_channels(&log.columns).map_err(|problem| log.fault(problem))?;
            log.complete()?;
        }
        Ok(log)
    }

    /// Reads a log from `input`; `path` is its name, and `size` (bytes) gives an estimate of the rows of a file that is
    /// too long.
    ///
    /// Fails as [`open`](Self::open) does, except for faults of the file system.
    pub fn from_reader(
        path: &Path,
        input: impl Read,
        size: Option<u64>,
        sidecar: Option<&Sidecar>,
    ) -> Result<Self, ReadError> {
        let content = input::detect_content(Box::new(input)).map_err(|problem| ReadError::table(path, problem))?;
        Self::from_content(path, content, size, sidecar.cloned(), true)
    }

    /// Reads a file; a `whole` record requires rudder and heading.
    fn from_file(path: &Path, sidecar: Option<&Path>, whole: bool) -> Result<Self, ReadError> {
        let sidecar = sidecar.map(Sidecar::load).transpose()?;
        let name = display_path(path);
        let (content, size) = input::open(path).map_err(|problem| ReadError::table(name, problem))?;
        Self::from_content(name, content, size, sidecar, whole)
    }

    fn from_content(
        path: &Path,
        content: FileContent,
        size: Option<u64>,
        sidecar: Option<Sidecar>,
        whole: bool,
    ) -> Result<Self, ReadError> {
        let sidecar = sidecar.unwrap_or_default();
        let (FileContent::Table(text) | FileContent::Sentences(text) | FileContent::Messages(text, _)) = &content;
        let file_hash = text.file_hash.clone();
        let log = match content {
            FileContent::Table(text) => table::read(path, text, size, &sidecar, whole)?,
            _ if !sidecar.columns.is_empty() => {
                return Err(sidecar.error(sidecar.columns[0].line, SidecarProblem::NoTable).into());
            }
            FileContent::Sentences(text) => {
                of_series(path, nmea::read(Lines::new(text.bytes, Encoding::Utf8)), &sidecar, whole)?
            }
            FileContent::Messages(text, format) => {
                of_series(path, messages::read(Lines::new(text.bytes, Encoding::Utf8), &format), &sidecar, whole)?
            }
        };
        let sha256 = file_hash.map_or(log.sha256, lines::RunningHash::finish);
        let mut log = Self { path: path.to_path_buf(), sidecar, sha256, ..log };
        if whole {
            log.complete()?;
        }
        Ok(log)
    }

    /// Readings of every channel before other files are joined, each with its shift (s) to the clock of this log.
    fn take_readings(&mut self) -> Vec<(Series, f64)> {
        if let Readings::Series(series) = std::mem::take(&mut self.readings) {
            return series;
        }
        let named = |read: Series| (Series { source: self.column_name(read.channel), ..read }, 0.0);
        split_columns(self.columns.clone(), 0.0).into_iter().map(named).collect()
    }

    pub(super) fn fault(&self, problem: impl Into<ReadProblem>) -> ReadError {
        ReadError::table(&self.path, problem.into())
    }

    /// Adds the channels of another file.
    fn join(&mut self, file: &Path) -> Result<(), ReadError> {
        let mut joined = Self::from_file(file, Sidecar::existing_beside(file).as_deref(), false)?;
        let offset = match (&self.clock, &joined.clock) {
            (Some(first), Some(second)) => offset(first, second),
            (None, None) => 0.0,
            (clock, _) => {
                let problem = ReadProblem::TwoClocks { first: self.path.clone(), stamped: clock.is_some() };
                return Err(ReadError::table(file, problem));
            }
        };
        let with_file = |warning: Warning| warning.code.warning(format!("{}: {}", file.display(), warning.text));
        let mut readings = self.take_readings();
        for (series, _) in joined.take_readings() {
            if readings.iter().all(|(earlier, _)| earlier.channel != series.channel) {
                readings.push((series, offset));
            }
        }
        self.readings = Readings::Series(readings);
        self.warnings.extend(joined.warnings.into_iter().map(with_file));
        let shifted = |reading: RejectedReading| RejectedReading { time: reading.time + offset, ..reading };
        self.rejected.extend(joined.rejected.into_iter().map(shifted));
        let mut all = split_columns(std::mem::take(&mut self.columns), 0.0);
        all.extend(split_columns(joined.columns, offset));
        let (all, dropped) = without_duplicates(all);
        self.warnings.extend(dropped.into_iter().map(|channel| {
            let text = format!("the {} is also in an earlier file, from which it is taken", channel.label());
            with_file(WarningCode::Instrument.warning(text))
        }));
        self.columns = merge_series(&all);
        self.names.extend(joined.names);
        self.sha256 = joined_hash(&self.sha256, &joined.sha256);
        self.rows += joined.rows;
        Ok(())
    }

    /// Adds derived channels, fills the rudder, and applies the keys of [rudder] in the sidecar.
    ///
    /// Fails if the rudder is moved by more than the length of the log.
    fn complete(&mut self) -> Result<(), ReadError> {
        if matches!(self.readings, Readings::InColumns) && !self.is_complete() {
            self.readings = Readings::Columns(self.columns.clone());
        }
        let RudderKeys { late_s, order_rate_deg_s } = self.sidecar.rudder;
        if let Some(late) = late_s {
            self.columns = rudder::with_earlier_rudder(std::mem::take(&mut self.columns), late);
            if check_channels(&self.columns).is_err() {
                let expected = "less than the length of the log: rudder and heading would have no time in common";
                let problem = SidecarProblem::Value { key: "late-s".into(), value: late.to_string(), expected };
                return Err(SidecarError { file: self.sidecar.file.clone(), line: None, problem }.into());
            }
            let rejected = self.rejected.iter_mut().filter(|reading| reading.channel == Channel::Rudder);
            rejected.for_each(|reading| reading.time -= late);
            let text = format!("the rudder is taken {late} s earlier than it was read, as the sidecar declares");
            self.warnings.push(WarningCode::MovedRudder.warning(text));
        }
        if let Some(rate) = order_rate_deg_s.filter(|rate| rudder::follow_order(&mut self.columns, *rate)) {
            let text = format!("the rudder follows its order at {rate}°/s, as the sidecar declares");
            self.warnings.push(WarningCode::MovedRudder.warning(text));
        }
        self.warnings.extend(add_derived_channels(&mut self.columns));
        self.warnings.extend(interpolate_rudder(&mut self.columns));
        Ok(())
    }

    /// `true` for columns unchanged by completion.
    fn is_complete(&self) -> bool {
        let RudderKeys { late_s, order_rate_deg_s } = self.sidecar.rudder;
        let has = |channel: Channel| self.columns.channels.contains_key(&channel);
        let has_speed = has(Channel::Speed) || !has(Channel::Surge) || !has(Channel::Sway);
        let has_rudder = self.channel(Channel::Rudder).is_some_and(|rudder| rudder.iter().all(|x| x.is_finite()));
        has_speed && has_rudder && late_s.or(order_rate_deg_s).is_none()
    }

    /// Time of every row, s.
    pub fn time(&self) -> &[f64] {
        &self.columns.time
    }

    /// Day of the first row, as 2026-11-20; `None` for a log without dates in its stamps.
    pub fn date(&self) -> Option<String> {
        self.clock?.date_at(*self.time().first()?)
    }

    /// Channel, row by row, in SI units and radians; `None` if it is absent.
    pub fn channel(&self, channel: Channel) -> Option<&[f64]> {
        self.columns.channels.get(&channel).map(Vec::as_slice)
    }

    /// `true` if the sidecar declares a part.
    pub fn has_declared_interval(&self) -> bool {
        let part = self.sidecar.used_interval();
        part.start().is_finite() || part.end().is_finite()
    }

    /// Part between two times, s, both included. Fails if it contains no row.
    pub fn into_interval(mut self, from: f64, until: f64) -> Result<Self, ReadError> {
        let time = &self.columns.time;
        let rows = time.partition_point(|&t| t < from)..time.partition_point(|&t| t <= until);
        if rows.is_empty() {
            let ends = |time: Option<&f64>| time.copied().unwrap_or(f64::NAN);
            let (first_s, last_s) = (ends(time.first()), ends(time.last()));
            return Err(self.fault(ReadProblem::EmptyPart { from_s: from, until_s: until, first_s, last_s }));
        }
        if rows.len() < time.len() {
            self.part = Some([time[rows.start], time[rows.end - 1]]);
            let cut = |values: &mut Vec<f64>| {
                values.truncate(rows.end);
                values.drain(..rows.start);
            };
            cut(&mut self.columns.time);
            self.columns.channels.values_mut().for_each(cut);
            self.columns.unknown_columns.iter_mut().for_each(|(_, values)| cut(values));
            self.columns.channels.retain(|_, values| values.iter().any(|value| value.is_finite()));
        }
        Ok(self)
    }

    /// Record of the log; `ship` overrides the particulars of the sidecar.
    ///
    /// Fails if the log has too few rows, or is implausible ([`plausibility`]).
    pub fn into_trial(self, ship: Option<Particulars>) -> Result<ReadRecord, ReadError> {
        let date = self.date();
        let Self { path, columns, sha256, rows, mut sidecar, mut warnings, part, mut rejected, names, .. } = self;
        sidecar.conditions.trial.date = sidecar.conditions.trial.date.or(date);
        let (first, last) = (columns.time.first().copied(), columns.time.last().copied());
        rejected.retain(|reading| first <= Some(reading.time) && Some(reading.time) <= last);
        let fault = |problem| ReadError::table(&path, problem);
        let checked = sidecar.is_checked();
        // Two parts of the same file are two records.
        let part_hash = |[from, until]: [f64; 2]| joined_hash(&sha256, &format!("{from} {until}"));
        let sha256 = part.map(part_hash).unwrap_or(sha256);
        let origin = RecordOrigin::Measured { file: path.display().to_string(), sha256 };
        let mut trial = Trial::new(input::stem(&path), origin, columns).map_err(|error| {
            fault(match error {
                TrialError::TooShort { needed, rows: usable } => ReadProblem::TooShort { needed, usable, rows },
                error => ReadProblem::Record(error),
            })
        })?;
        if trial.is_heading_integrated() {
            let text = "there is no heading; the integral of the yaw rate, from zero, is used instead";
            warnings.push(WarningCode::HeadingFromYawRate.warning(text));
        }
        if let Some(particulars) = ship.or(sidecar.conditions.particulars) {
            trial = trial.with_particulars(particulars);
        }
        trial = trial.with_noise(sidecar.noise).with_rejected(rejected).with_conditions(sidecar.conditions);
        if checked {
            warnings.extend(plausibility::readings::reading_warnings(&trial, &names));
        }
        if checked && plausibility::derivative::is_derivative(&trial) {
            trial = trial.without_channels(&[Channel::YawRate]);
            let text = "the yaw rate is the derivative of the heading, with its noise and jumps: it is not a second \
                        instrument and is not used";
            warnings.push(WarningCode::YawRate.warning(text));
        }
        match plausibility::check_plausibility(&trial) {
            Ok(doubts) => warnings.extend(doubts),
            Err(implausible) if !checked => warnings.push(WarningCode::Implausible.warning(implausible.to_string())),
            Err(implausible) => return Err(fault(implausible.into())),
        }
        Ok(ReadRecord { trial, warnings })
    }
}

/// Offset of the second clock from the first, s.
fn offset(first: &Clock, second: &Clock) -> f64 {
    let zone =
        first.utc_offset_min.zip(second.utc_offset_min).map_or(0.0, |(first, second)| 60.0 * f64::from(first - second));
    let seconds = second.second - first.second + zone;
    match first.day.zip(second.day) {
        Some((first, second)) => seconds + SECONDS_PER_DAY * (second - first) as f64,
        // Times of day without a date: the nearest difference.
        None => (seconds + 0.5 * SECONDS_PER_DAY).rem_euclid(SECONDS_PER_DAY) - 0.5 * SECONDS_PER_DAY,
    }
}

/// SHA-256 of two texts with a blank between them, hexadecimal.
fn joined_hash(first: &str, second: &str) -> String {
    lines::sha256(format!("{first} {second}").as_bytes())
}

/// Log of sentences or messages; a `whole` record requires rudder and heading.
fn of_series(
    path: &Path,
    read: Result<(Vec<Series>, InstrumentLog), ReadProblem>,
    sidecar: &Sidecar,
    whole: bool,
) -> Result<InstrumentLog, ReadError> {
    let log = read.map(|(series, log)| of_sentences(series, log, sidecar));
    let checked = log.and_then(|log| if whole { check_channels(&log.columns).map(|()| log) } else { Ok(log) });
    checked.map_err(|problem| ReadError::table(path, problem))
}

/// Log of channels at separate instants, each cleaned separately, in the part declared by the sidecar.
fn of_sentences(series: Vec<Series>, mut log: InstrumentLog, sidecar: &Sidecar) -> InstrumentLog {
    let cleaned = series.into_iter().map(|Series { channel, time, mut values, source }| {
        if channel == Channel::Heading {
            ship::angle::unwrap_heading(&mut values);
        }
        let mut single = Columns { time, channels: [(channel, values)].into(), unknown_columns: Vec::new() };
        if sidecar.is_checked() {
            log.warnings.extend(rudder::repeat_held_rudder(&mut single));
            log.warnings.extend(cleaning::clean(&mut single, &mut log.rejected));
        }
        Series { channel, values: single.channels.remove(&channel).unwrap_or_default(), time: single.time, source }
    });
    let cleaned: Vec<Series> = cleaned.collect();
    let (mut columns, part) = (merge_series(&cleaned), sidecar.used_interval());
    let keep: Vec<bool> = columns.time.iter().map(|t| part.contains(t)).collect();
    columns.retain(&keep);
    log.readings = Readings::Series(cleaned.into_iter().map(|series| (series.within(&part), 0.0)).collect());
    InstrumentLog { columns, ..log }
}

/// Reads the trial at `path`, with the sidecar next to it, if any.
///
/// Fails as [`read_with_sidecar`] does.
pub fn read(path: &Path) -> Result<ReadRecord, ReadError> {
    read_with_sidecar(path, Sidecar::existing_beside(path).as_deref())
}

/// Reads the trial at `path` with the sidecar at `sidecar`; `None` uses the header only.
///
/// Fails with [`ReadError`] if the file is absent, larger than [`super::RECORD_FILE`] or of an unknown format, if a
/// required channel is absent, a cell is not a number, time does not increase, fewer than [`Trial::MIN_ROWS`]
/// or more than [`super::MAX_ROWS`] rows are usable, the sidecar is invalid, or the record is implausible
/// ([`plausibility`]).
pub fn read_with_sidecar(path: &Path, sidecar: Option<&Path>) -> Result<ReadRecord, ReadError> {
    InstrumentLog::open(path, sidecar, &[])?.into_trial(None)
}

/// Reads a trial from `input`; `path` is its name, and `size` (bytes) gives an estimate of the rows of a file that is
/// too long.
///
/// Fails as [`read_with_sidecar`] does, except for faults of the file system.
pub fn read_from_reader(
    path: &Path,
    input: impl Read,
    size: Option<u64>,
    sidecar: Option<&Sidecar>,
) -> Result<ReadRecord, ReadError> {
    InstrumentLog::from_reader(path, input, size, sidecar)?.into_trial(None)
}
