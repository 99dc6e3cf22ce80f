//! What is wrong with a sidecar, and where.

use std::ops::Range;
use std::path::PathBuf;

use ship::vessel::prior::ParticularsError;
use thiserror::Error;

use crate::file::FileError;

/// What is wrong with a sidecar, and where.
#[derive(Debug, Error)]
#[error("{}:{} {problem}", file.display(), line.map_or_else(String::new, |line| format!(" line {line}:")))]
pub struct SidecarError {
    /// The sidecar.
    pub file: PathBuf,
    /// Line, from 1, where one is known.
    pub line: Option<usize>,
    /// What is wrong there.
    pub problem: SidecarProblem,
}

/// What is wrong with a sidecar.
#[derive(Debug, Error)]
#[expect(missing_docs, reason = "the message of a variant says what its fields are")]
pub enum SidecarProblem {
    /// The file cannot be read.
    #[error("the sidecar cannot be used: {0}")]
    File(FileError),
    /// Not TOML, or a key or value that is not known.
    #[error("{message}")]
    Syntax { message: String },
    /// `is` names no quantity.
    #[error(
        "`is = \"{found}\"` is no known column name; expected quantity_unit such as t_s, heading_deg, heading_rad, rudder_deg, \
         yaw_rate_deg_s, speed_m_s or speed_kn"
    )]
    UnknownQuantity { found: String },
    /// A column that is not pointed at, or twice.
    #[error("a [[column]] needs either `index` (from 1) or `name`, and this one has {found}")]
    Which { found: &'static str },
    /// A column that says nothing.
    #[error("this [[column]] says nothing; add `is`, `flip = true`, `scale`, `zero` or `ignore = true`")]
    Idle,
    /// `ignore` beside other keys.
    #[error("`ignore = true` leaves the column out, so other keys beside it mean nothing; remove one or the other")]
    IgnoredAndUsed,
    /// A formula that cannot be read, or names no column.
    #[error("`formula`: {problem}")]
    Formula { problem: String },
    /// A name, but the table has no header.
    #[error("`name` needs a header and [table] says `header = false`; use `index`")]
    NameWithoutHeader,
    /// The name is not in the header.
    #[error("no column is called `{name}`; the header of {} has {}", table.display(), crate::words::listed(found))]
    NameNotFound { name: String, table: PathBuf, found: Vec<String> },
    /// Columns described in a log of sentences.
    #[error("the file holds sentences or messages (NMEA), which have no columns; remove every [[column]]")]
    NoTable,
    /// The index is larger than the number of columns.
    #[error("there is no column {index}; {} has {columns} columns", table.display())]
    IndexBeyond { index: usize, table: PathBuf, columns: usize },
    /// Two entries for one column.
    #[error("the column `{name}` is described twice; keep one [[column]] for it")]
    DescribedTwice { name: String },
    /// The column keeps its own name, which says nothing.
    #[error("the name `{name}` of this column is not a known one; add `is` to say what it holds")]
    NameSaysNothing { name: String },
    /// A part that ends before it begins, or whose bounds are not numbers.
    #[error("the part from {from_s} s until {until_s} s holds nothing; expected numbers with `from-s` below `until-s`")]
    Part { from_s: f64, until_s: f64 },
    /// Length or speed alone, or two speeds.
    #[error("[ship] needs `length-m` and one of `speed-m-s` and `speed-kn`")]
    Ship,
    /// Particulars that no ship has.
    #[error("{0}")]
    Particulars(Box<ParticularsError>),
    /// A value that no ship, trial or table has.
    #[error("`{key}` is {found}, expected {expected}")]
    Value { key: String, found: String, expected: &'static str },
}

/// What is wrong, and the bytes of the text where it is.
pub(crate) type Fault = (Option<Range<usize>>, SidecarProblem);
