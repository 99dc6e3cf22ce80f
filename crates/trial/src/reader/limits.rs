//! Limits of the size of a record.

use crate::file::FileKind;
use crate::record::Trial;

use super::error::ReadProblem;

/// Maximum number of rows of a log, eleven days at 20 Hz.
pub const MAX_ROWS: usize = 20_000_000;

/// Maximum number of cells of a record (8 bytes each): a bound on the memory of tables with very many columns.
pub const MAX_CELLS: usize = 50_000_000;

/// Kind of file of a record; its maximum size is 20 characters for each of [`MAX_CELLS`].
pub const RECORD_FILE: FileKind = FileKind { name: "a record", max_bytes: 20 * MAX_CELLS as u64 };

/// Problem of a table without rows after a line.
pub(super) fn no_rows_problem(line: usize) -> ReadProblem {
    ReadProblem::NoRows { line, needed: Trial::MIN_ROWS }
}

/// `true` for a comment, which is skipped.
pub(super) fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}
