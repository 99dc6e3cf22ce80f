//! A table from its first line to a record.

use std::io::Read;
use std::path::Path;

use super::error::{Problem, ReadError};
use super::layout::Layout;
use super::limits::{RECORD, is_comment, no_rows};
use super::lines::Lines;
use super::rows::Rows;
use crate::cells::{Cell, Separator, cell, recognise, unquoted};
use crate::encoding::Encoding;
use crate::file;
use crate::hygiene;
use crate::plausibility;
use crate::record::{Columns, Origin, Trial, TrialError};
use crate::sidecar::{Quantity, Sidecar};
use crate::words::shortened;

/// A record that was read, and what the reader had to decide or found remarkable.
#[derive(Debug, Clone)]
pub struct Reading {
    /// The record.
    pub trial: Trial,
    /// One sentence each, without the name of the file.
    pub warnings: Vec<String>,
}

/// Reads the trial at `path`, with the sidecar beside it where there is one.
///
/// Fails as [`read_with`] does.
pub fn read(path: &Path) -> Result<Reading, ReadError> {
    let beside = Sidecar::beside(path);
    let sidecar = if beside.is_file() { Some(beside) } else { None };
    read_with(path, sidecar.as_deref())
}

/// Reads the trial at `path` as the sidecar at `sidecar` describes it; `None` reads it by its header alone.
///
/// Fails with [`ReadError`] when the file is not there, larger than [`RECORD`] or no table, when a needed column is
/// absent, a cell is no number, time does not increase, fewer than [`Trial::FEWEST_ROWS`] or more than
/// [`super::MAX_ROWS`] rows are usable, the sidecar is at fault, or the record contradicts itself ([`plausibility`]).
pub fn read_with(path: &Path, sidecar: Option<&Path>) -> Result<Reading, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    if path.to_str().is_some_and(|name| name.ends_with(".trial.toml")) {
        return Err(fault(Problem::IsSidecar));
    }
    let sidecar = sidecar.map(Sidecar::load).transpose()?;
    let file = file::open(path, RECORD).map_err(|error| fault(error.into()))?;
    let size = file.size();
    read_bytes(path, file, size, sidecar.as_ref())
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
) -> Result<Reading, ReadError> {
    let fault = |problem| ReadError::table(path, problem);
    let mut lines = Lines::new(input, sidecar.map_or(Encoding::Utf8, |sidecar| sidecar.encoding));
    let Start { header, first_row, separator, line } = start(&mut lines, sidecar).map_err(fault)?;
    let layout = Layout::new(header, line, path, sidecar)?;
    let mut rows = Rows::new(&layout, separator, sidecar);
    if let Some(text) = first_row {
        rows.add(&text, lines.number()).map_err(fault)?;
    }
    loop {
        // The number is taken after the line is read, and the line borrows the source: hence the detour over `number`.
        let number = lines.number() + 1;
        let consumed = lines.consumed();
        match lines.next_line().map_err(fault)? {
            Some(text) => rows.add(text, number).map_err(fault)?,
            None => break,
        }
        if rows.kept() > rows.limit() {
            return Err(fault(rows.too_many(consumed, size)));
        }
    }
    let sha256 = lines.sha256();
    let (mut columns, mut warnings) = rows.finish(line).map_err(fault)?;
    let checked = sidecar.is_none_or(|sidecar| sidecar.plausibility);
    if checked {
        warnings.extend(hygiene::mend(&mut columns.columns));
    }
    let name = path.file_stem().map_or_else(|| "record".to_owned(), |stem| stem.to_string_lossy().into_owned());
    let origin = Origin::Measured { file: path.display().to_string(), sha256 };
    let trial = record(name, origin, columns.columns, columns.rows).map_err(fault)?;
    if trial.heading_from_yaw_rate() {
        warnings.push("there is no heading; it is the integral of the yaw rate, from zero".to_owned());
    }
    let trial = match sidecar {
        Some(sidecar) => {
            let trial = trial.with_noise(sidecar.noise);
            match sidecar.particulars {
                Some(particulars) => trial.with_particulars(particulars),
                None => trial,
            }
        }
        None => trial,
    };
    match plausibility::check(&trial) {
        Ok(found) => warnings.extend(found),
        Err(implausible) if !checked => warnings.push(implausible.to_string()),
        Err(implausible) => return Err(fault(implausible.into())),
    }
    Ok(Reading { trial, warnings })
}

fn record(name: String, origin: Origin, columns: Columns, rows: usize) -> Result<Trial, Problem> {
    Trial::new(name, origin, columns).map_err(|error| match error {
        TrialError::TooShort { needed, found } => Problem::TooShort { needed, found, rows },
        other => Problem::Record(other),
    })
}

/// The begin of a table: its names, and the first row where that had to be read to find them.
struct Start {
    header: Vec<String>,
    first_row: Option<String>,
    separator: Separator,
    line: usize,
}

/// Reads up to the header, or to the first row where there is none, and recognises the separator.
fn start<R: Read>(lines: &mut Lines<R>, sidecar: Option<&Sidecar>) -> Result<Start, Problem> {
    for _ in 0..sidecar.map_or(0, |sidecar| sidecar.skip_lines) {
        if !lines.skip()? {
            return Err(if lines.number() == 0 { Problem::Empty } else { no_rows(lines.number()) });
        }
    }
    let mut comment: Option<(String, usize)> = None;
    let first = loop {
        let number = lines.number() + 1;
        match lines.next_line()? {
            None if number == 1 => return Err(Problem::Empty),
            None => return Err(no_rows(number - 1)),
            Some(text) if is_comment(text) => comment = Some((text.trim_start_matches([' ', '#']).to_owned(), number)),
            Some(text) if text.trim().is_empty() => {}
            Some(text) => break text.to_owned(),
        }
    };
    let line = lines.number();
    let declared = sidecar.and_then(|sidecar| sidecar.separator);
    let numbers = |separator: Separator| {
        move |cells: &[&str]| {
            let numeric = |text: &&&str| !matches!(cell(text, separator), Cell::Text);
            if cells.iter().filter(numeric).count() == cells.len() { cells.len() } else { 0 }
        }
    };
    let best_numbers = || {
        let count = |separator: Separator| numbers(separator)(&cells(&first, separator));
        // The earlier separator wins a tie, so the search runs from the last.
        Separator::ALL
            .into_iter()
            .rev()
            .max_by_key(|&separator| count(separator))
            .filter(|&separator| count(separator) > 0)
    };
    if sidecar.is_some_and(|sidecar| !sidecar.header) {
        let separator = declared.or_else(best_numbers).unwrap_or(Separator::Blank);
        let header = (1..=cells(&first, separator).len()).map(|place| format!("column_{place}")).collect();
        return Ok(Start { header, first_row: Some(first), separator, line });
    }
    let known = |cells: &[&str]| cells.iter().filter(|name| is_known(name, sidecar)).count();
    if let Some(separator) = best_numbers() {
        // Rows from the first line on. Some programs write the names into the comment above.
        let separator = declared.unwrap_or(separator);
        if let Some((names, line)) = comment {
            let header = cells(&names, declared.unwrap_or_else(|| recognise(&names, known)));
            if known(&header) >= 2 {
                let header = header.into_iter().map(unquoted).collect();
                return Ok(Start { header, first_row: Some(first), separator, line });
            }
        }
        return Err(Problem::NoHeader { line, found: shortened(&first) });
    }
    let separator = declared.unwrap_or_else(|| recognise(&first, known));
    let header = cells(&first, separator).into_iter().map(unquoted).collect();
    Ok(Start { header, first_row: None, separator, line })
}

/// Whether a name in a header means something: to the contract or to the sidecar.
fn is_known(name: &str, sidecar: Option<&Sidecar>) -> bool {
    let described = |sidecar: &Sidecar| {
        sidecar
            .columns
            .iter()
            .any(|column| matches!(&column.which, crate::sidecar::Which::Name(found) if found == name))
    };
    Quantity::of(name).is_some() || sidecar.is_some_and(described)
}

fn cells(line: &str, separator: Separator) -> Vec<&str> {
    let mut ranges = Vec::new();
    separator.split(line, &mut ranges);
    ranges.into_iter().map(|range| &line[range]).collect()
}
