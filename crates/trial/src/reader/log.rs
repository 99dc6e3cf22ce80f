//! A log: what one or several files hold, cleaned and on one clock, before a part of it becomes a record.

use std::io::Read;
use std::path::{Path, PathBuf};

use document::{Code, Warning};
use ship::Particulars;

use super::assemble::{check, columns, complete, once, series, straight_rudder};
use super::error::{Problem, ReadError};
use super::input::{self, Content};
use super::lines::{self, Lines};
use super::messages;
use super::nmea;
use super::rudder;
use super::source::{ChannelReadings, Log, Series};
use super::table;
use crate::channel::Channel;
use crate::cleaning;
use crate::clock::{Clock, DAY};
use crate::encoding::Encoding;
use crate::file::called;
use crate::plausibility;
use crate::record::{Columns, Origin, RejectedReading, Trial, TrialError};
use crate::sidecar::{Sidecar, SidecarError, SidecarProblem};
use crate::sidecar_keys::RudderKeys;

/// A record that was read, and what the reader had to decide or found remarkable.
#[derive(Debug, Clone)]
pub struct ReadRecord {
    /// The record.
    pub trial: Trial,
    /// Those of the record, whose file whoever reads it names.
    pub warnings: Vec<Warning>,
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
        let mut log = Self::of_file(path, sidecar, others.is_empty())?;
        for other in others {
            log.join(other)?;
        }
        if !others.is_empty() {
            check(&log.columns).map_err(|problem| log.fault(problem))?;
            log.complete()?;
        }
        Ok(log)
    }

    /// Reads the log that `input` gives; `path` names it, and `size` (bytes), where known, serves to estimate the rows
    /// of a file that is too long.
    ///
    /// Fails as [`open`](Self::open) does, except for faults of the file system.
    pub fn of_bytes(
        path: &Path,
        input: impl Read,
        size: Option<u64>,
        sidecar: Option<&Sidecar>,
    ) -> Result<Self, ReadError> {
        let content = input::recognise(Box::new(input)).map_err(|problem| ReadError::table(path, problem))?;
        Self::of_content(path, content, size, sidecar.cloned(), true)
    }

    /// `whole` says whether the file has to hold a whole record.
    fn of_file(path: &Path, sidecar: Option<&Path>, whole: bool) -> Result<Self, ReadError> {
        let sidecar = sidecar.map(Sidecar::load).transpose()?;
        let name = called(path);
        let (content, size) = input::open(path).map_err(|problem| ReadError::table(name, problem))?;
        Self::of_content(name, content, size, sidecar, whole)
    }

    fn of_content(
        path: &Path,
        content: Content,
        size: Option<u64>,
        sidecar: Option<Sidecar>,
        whole: bool,
    ) -> Result<Self, ReadError> {
        let sidecar = sidecar.unwrap_or_default();
        let (Content::Table(text) | Content::Sentences(text) | Content::Messages(text, _)) = &content;
        let on_disk = text.on_disk.clone();
        let log = match content {
            Content::Table(text) => table::read(path, text, size, &sidecar, whole)?,
            _ if !sidecar.columns.is_empty() => {
                return Err(sidecar.error(sidecar.columns[0].line, SidecarProblem::NoTable).into());
            }
            Content::Sentences(text) => {
                of_series(path, nmea::read(Lines::new(text.bytes, Encoding::Utf8)), &sidecar, whole)?
            }
            Content::Messages(text, format) => {
                of_series(path, messages::read(Lines::new(text.bytes, Encoding::Utf8), &format), &sidecar, whole)?
            }
        };
        let sha256 = on_disk.map_or(log.sha256, lines::Hash::finish);
        let mut log = Self { path: path.to_path_buf(), sidecar, sha256, ..log };
        if log.readings.is_empty() {
            log.readings = ChannelReadings::of_columns(&log.columns, &log.names);
        }
        if whole {
            log.complete()?;
        }
        Ok(log)
    }

    pub(super) fn fault(&self, problem: impl Into<Problem>) -> ReadError {
        ReadError::table(&self.path, problem.into())
    }

    /// Adds the channels of another file.
    fn join(&mut self, other: &Path) -> Result<(), ReadError> {
        let joined = Self::of_file(other, Sidecar::found_beside(other).as_deref(), false)?;
        let offset = match (&self.clock, &joined.clock) {
            (Some(own), Some(its)) => offset(own, its),
            (None, None) => 0.0,
            (own, _) => {
                let problem = Problem::TwoClocks { other: self.path.clone(), stamped: own.is_some() };
                return Err(ReadError::table(other, problem));
            }
        };
        let of_file = |warning: Warning| warning.code.warning(format!("{}: {}", other.display(), warning.text));
        self.warnings.extend(joined.warnings.into_iter().map(of_file));
        let shifted = |reading: RejectedReading| RejectedReading { time: reading.time + offset, ..reading };
        self.rejected.extend(joined.rejected.into_iter().map(shifted));
        let mut all = series(std::mem::take(&mut self.columns), 0.0);
        all.extend(series(joined.columns, offset));
        let (all, doubled) = once(all);
        self.warnings.extend(doubled.into_iter().map(|channel| {
            let text = format!("the {} is in an earlier file, too, and is taken from there", channel.spoken());
            of_file(Code::Instrument.warning(text))
        }));
        self.columns = columns(all);
        self.names.extend(joined.names);
        let is_new =
            |readings: &ChannelReadings| self.readings.iter().all(|earlier| earlier.channel != readings.channel);
        let further: Vec<ChannelReadings> = joined.readings.into_iter().filter(is_new).collect();
        self.readings.extend(further.into_iter().map(|readings| readings.later(offset)));
        self.sha256 = joined_hash(&self.sha256, &joined.sha256);
        self.rows += joined.rows;
        Ok(())
    }

    /// Adds what was not recorded and can be told, and does with the rudder what the sidecar says.
    ///
    /// Fails where the rudder is moved by more than the length of the log.
    fn complete(&mut self) -> Result<(), ReadError> {
        let RudderKeys { late_s, order_rate_deg_s } = self.sidecar.rudder;
        if let Some(late) = late_s {
            self.columns = rudder::earlier(std::mem::take(&mut self.columns), late);
            if check(&self.columns).is_err() {
                let expected = "less than the log lasts: rudder and heading have no time in common so";
                let problem = SidecarProblem::Value { key: "late-s".into(), found: late.to_string(), expected };
                return Err(SidecarError { file: self.sidecar.file.clone(), line: None, problem }.into());
            }
            let of_rudder = self.rejected.iter_mut().filter(|reading| reading.channel == Channel::Rudder);
            of_rudder.for_each(|reading| reading.time -= late);
            let text = format!("the rudder is taken {late} s earlier than it was read, as the sidecar says");
            self.warnings.push(Code::MovedRudder.warning(text));
        }
        if let Some(rate) = order_rate_deg_s.filter(|rate| rudder::follow_order(&mut self.columns, *rate)) {
            let text = format!("the rudder follows its order at {rate}°/s, as the sidecar says");
            self.warnings.push(Code::MovedRudder.warning(text));
        }
        self.warnings.extend(complete(&mut self.columns));
        self.warnings.extend(straight_rudder(&mut self.columns));
        Ok(())
    }

    /// Time of every row, s.
    pub fn time(&self) -> &[f64] {
        &self.columns.time
    }

    /// Day of the first row, as 2026-11-20; `None` for a log without stamps that hold dates.
    pub fn date(&self) -> Option<String> {
        self.clock?.date_at(*self.time().first()?)
    }

    /// A channel, row by row, where the log has it; SI units and radians.
    pub fn channel(&self, channel: Channel) -> Option<&[f64]> {
        self.columns.channels.get(&channel).map(Vec::as_slice)
    }

    /// Whether a sidecar says which part is to be used.
    pub fn has_declared_part(&self) -> bool {
        let part = self.sidecar.part();
        part.start().is_finite() || part.end().is_finite()
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
    pub fn into_trial(self, ship: Option<Particulars>) -> Result<ReadRecord, ReadError> {
        let date = self.date();
        let Self { path, columns, sha256, rows, mut sidecar, mut warnings, part, mut rejected, names, .. } = self;
        sidecar.conditions.trial.date = sidecar.conditions.trial.date.or(date);
        let (first, last) = (columns.time.first().copied(), columns.time.last().copied());
        rejected.retain(|reading| first <= Some(reading.time) && Some(reading.time) <= last);
        let fault = |problem| ReadError::table(&path, problem);
        let checked = sidecar.is_checked();
        // Two parts of one file are two records.
        let of_part = |[from, until]: [f64; 2]| joined_hash(&sha256, &format!("{from} {until}"));
        let sha256 = part.map(of_part).unwrap_or(sha256);
        let origin = Origin::Measured { file: path.display().to_string(), sha256 };
        let mut trial = Trial::new(input::stem(&path), origin, columns).map_err(|error| {
            fault(match error {
                TrialError::TooShort { needed, found } => Problem::TooShort { needed, found, rows },
                other => Problem::Record(other),
            })
        })?;
        if trial.heading_from_yaw_rate() {
            let text = "there is no heading; it is the integral of the yaw rate, from zero";
            warnings.push(Code::HeadingFromYawRate.warning(text));
        }
        if let Some(particulars) = ship.or(sidecar.conditions.particulars) {
            trial = trial.with_particulars(particulars);
        }
        trial = trial.with_noise(sidecar.noise).with_rejected(rejected).with_conditions(sidecar.conditions);
        if checked {
            warnings.extend(plausibility::readings::check(&trial, &names));
        }
        if checked && plausibility::derivative::is_derivative(&trial) {
            trial = trial.without(&[Channel::YawRate]);
            let text = "the yaw rate is the derivative of the heading, with its noise and jumps: it is no second instrument and is \
                        not counted";
            warnings.push(Code::YawRate.warning(text));
        }
        match plausibility::check(&trial) {
            Ok(found) => warnings.extend(found),
            Err(implausible) if !checked => warnings.push(Code::Implausible.warning(implausible.to_string())),
            Err(implausible) => return Err(fault(implausible.into())),
        }
        Ok(ReadRecord { trial, warnings })
    }
}

/// Seconds to add to the times of the second clock to have them on the first.
fn offset(own: &Clock, its: &Clock) -> f64 {
    let zone = own.zone.zip(its.zone).map_or(0.0, |(own, its)| 60.0 * f64::from(own - its));
    let seconds = its.second - own.second + zone;
    match own.day.zip(its.day) {
        Some((own, its)) => seconds + DAY * (its - own) as f64,
        // Times of day alone: the nearest.
        None => (seconds + 0.5 * DAY).rem_euclid(DAY) - 0.5 * DAY,
    }
}

/// One hash for two: that of both.
fn joined_hash(one: &str, other: &str) -> String {
    lines::sha256(format!("{one} {other}").as_bytes())
}

/// The log of sentences or messages that were read; `whole` says whether it has to hold a whole record.
fn of_series(
    path: &Path,
    read: Result<(Vec<Series>, Log), Problem>,
    sidecar: &Sidecar,
    whole: bool,
) -> Result<Log, ReadError> {
    let log = read.map(|(series, log)| of_sentences(series, log, sidecar));
    let checked = log.and_then(|log| if whole { check(&log.columns).map(|()| log) } else { Ok(log) });
    checked.map_err(|problem| ReadError::table(path, problem))
}

/// Channels with instants of their own, each cleaned by itself, and of them the part that the sidecar asks for.
fn of_sentences(series: Vec<Series>, mut log: Log, sidecar: &Sidecar) -> Log {
    let cleaned = series.into_iter().map(|Series { channel, time, mut values, source }| {
        if channel == Channel::Heading {
            ship::angle::unwrap_heading(&mut values);
        }
        let mut own = Columns { time, channels: [(channel, values)].into(), unknown: Vec::new() };
        if sidecar.is_checked() {
            log.warnings.extend(rudder::hold(&mut own));
            log.warnings.extend(cleaning::clean(&mut own, &mut log.rejected));
        }
        Series { channel, values: own.channels.remove(&channel).unwrap_or_default(), time: own.time, source }
    });
    let cleaned: Vec<Series> = cleaned.collect();
    log.readings = cleaned.iter().map(|series| ChannelReadings::of(series, sidecar.part())).collect();
    let mut columns = columns(cleaned);
    let keep: Vec<bool> = columns.time.iter().map(|t| sidecar.part().contains(t)).collect();
    columns.retain(&keep);
    Log { columns, ..log }
}

/// Reads the trial at `path`, with the sidecar beside it where there is one.
///
/// Fails as [`read_with`] does.
pub fn read(path: &Path) -> Result<ReadRecord, ReadError> {
    read_with(path, Sidecar::found_beside(path).as_deref())
}

/// Reads the trial at `path` as the sidecar at `sidecar` describes it; `None` reads it by its header alone.
///
/// Fails with [`ReadError`] when the file is not there, larger than [`RECORD`](super::RECORD) or of no known format,
/// when a needed channel is absent, a cell is no number, time does not increase, fewer than [`Trial::FEWEST_ROWS`] or
/// more than [`super::MAX_ROWS`] rows are usable, the sidecar is at fault, or the record contradicts itself
/// ([`plausibility`]).
pub fn read_with(path: &Path, sidecar: Option<&Path>) -> Result<ReadRecord, ReadError> {
    Log::open(path, sidecar, &[])?.into_trial(None)
}

/// Reads a trial from `input`; `path` names it, and `size` (bytes), where known, serves to estimate the rows of a file
/// that is too long.
///
/// Fails as [`read_with`] does, except for faults of the file system.
pub fn read_bytes(
    path: &Path,
    input: impl Read,
    size: Option<u64>,
    sidecar: Option<&Sidecar>,
) -> Result<ReadRecord, ReadError> {
    Log::of_bytes(path, input, size, sidecar)?.into_trial(None)
}
