//! How much a record may hold, and what is said where it holds nothing.

use crate::file::Kind;
use crate::record::Trial;

use super::error::Problem;

/// Most rows a log may have: eleven days at 20 Hz.
pub const MAX_ROWS: usize = 20_000_000;

/// Most numbers a record may have; bounds the memory of tables with very many columns (8 bytes each).
pub const MAX_CELLS: usize = 50_000_000;

/// A record; 20 characters for each of the most numbers.
pub const RECORD: Kind = Kind { name: "a record", largest: 20 * MAX_CELLS as u64 };

/// The problem of a table without rows after this line.
pub(super) fn no_rows(line: usize) -> Problem {
    Problem::NoRows { line, needed: Trial::FEWEST_ROWS }
}

/// Whether a line is passed over.
pub(super) fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}
