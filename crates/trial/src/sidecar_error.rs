//! Errors of a sidecar, with their line.

use std::ops::Range;
use std::path::PathBuf;

use ship::vessel::prior::ParticularsError;
use thiserror::Error;

use crate::file::FileError;

/// Error of a sidecar, with its file and line.
#[derive(Debug, Error)]
#[error("{}:{} {problem}", file.display(), line.map_or_else(String::new, |line| format!(" line {line}:")))]
pub struct SidecarError {
    /// Path of the sidecar.
    pub file: PathBuf,
    /// Line, from 1; `None` for a problem of the whole file.
    pub line: Option<usize>,
    /// What is wrong.
    pub problem: SidecarProblem,
}

/// Problem of a sidecar.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum SidecarProblem {
    /// The file cannot be read.
    #[error("the sidecar cannot be used: {0}")]
    File(FileError),
    /// Not TOML, or an unknown key or value.
    #[error("{message}")]
    Syntax { message: String },
    /// Unknown quantity of `is`.
    #[error(
        "`is = \"{name}\"` is no known column name; expected quantity_unit such as t_s, heading_deg, heading_rad, \
         rudder_deg, yaw_rate_deg_s, speed_m_s or speed_kn"
    )]
    UnknownQuantity { name: String },
    /// Column with neither index nor name, with both, or with index 0.
    #[error("a [[column]] needs either `index` (from 1) or `name`, but this one has {given}")]
    InvalidColumnReference { given: &'static str },
    /// Column without a description.
    #[error("this [[column]] says nothing; add `is`, `flip = true`, `scale`, `zero` or `ignore = true`")]
    MissingDescription,
    /// `ignore` in addition to other keys.
    #[error("`ignore = true` leaves the column out, so other keys beside it mean nothing; remove one or the other")]
    IgnoredAndUsed,
    /// Formula that cannot be read, or contains no column.
    #[error("`formula`: {problem}")]
    Formula { problem: String },
    /// Name for a table without a header.
    #[error("`name` needs a header, but [table] says `header = false`; use `index`")]
    NameWithoutHeader,
    /// Name that is not in the header.
    #[error("no column is called `{name}`; the header of {} has {}", table.display(), crate::wording::listed(header))]
    NameNotFound { name: String, table: PathBuf, header: Vec<String> },
    /// Columns described in a log of sentences.
    #[error("the file holds sentences or messages (NMEA), which have no columns; remove every [[column]]")]
    NoTable,
    /// Index above the number of columns.
    #[error("there is no column {index}; {} has {columns} columns", table.display())]
    IndexBeyond { index: usize, table: PathBuf, columns: usize },
    /// Two descriptions of a column.
    #[error("the column `{name}` is described twice; keep one [[column]] for it")]
    DescribedTwice { name: String },
    /// Column that keeps its name, which has no meaning.
    #[error("the column name `{name}` is unknown; add `is` to say what the column holds")]
    UnknownColumnName { name: String },
    /// Part that ends before it begins, or with bounds that are not numbers.
    #[error("the part from {from_s} s until {until_s} s is empty; expected numbers with `from-s` below `until-s`")]
    Part { from_s: f64, until_s: f64 },
    /// Length or speed alone, or two speeds.
    #[error("[ship] needs `length-m` and one of `speed-m-s` and `speed-kn`")]
    IncompleteShip,
    /// Implausible particulars.
    #[error("{0}")]
    Particulars(Box<ParticularsError>),
    /// Value outside its range.
    #[error("`{key}` is {value}, expected {expected}")]
    Value { key: String, value: String, expected: &'static str },
}

/// Problem with its range of bytes in the text; `None` for a problem without a place.
pub(crate) type LocatedProblem = (Option<Range<usize>>, SidecarProblem);
