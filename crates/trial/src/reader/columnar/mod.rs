//! Binary tables: MATLAB variables, Parquet with the feature `parquet`, and spreadsheets with the feature
//! `spreadsheets`.
//!
//! Each is converted to the text of a table, line by line, and read like any other table. Names, units, stamps and
//! sidecars are handled by the reader of tables. Only content that fits no table is omitted here: nested columns, and
//! variables of other lengths.

mod matlab;
#[cfg(feature = "parquet")]
mod parquet;
#[cfg(feature = "spreadsheets")]
mod spreadsheet;
#[cfg(test)]
#[cfg_attr(not(feature = "parquet"), allow(unused, reason = "files that Parquet packs"))]
mod tests;
#[cfg_attr(not(feature = "parquet"), allow(dead_code, reason = "kinds of values that Parquet alone has"))]
mod text;

use std::io::Read;

use super::error::ReadProblem;

/// Kind of a binary table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum BinaryFormat {
    Parquet,
    Spreadsheet,
    Matlab,
}

impl BinaryFormat {
    /// Kind of a file by its first bytes; `None` for any other file.
    pub fn detect(start: &[u8]) -> Option<Self> {
        match start {
            [b'P', b'A', b'R', b'1', ..] => Some(Self::Parquet),
            [b'P', b'K', 3, 4, ..] => Some(Self::Spreadsheet),
            start if start.starts_with(b"MATLAB 5.0") || matlab::is_level4(start) => Some(Self::Matlab),
            _ => None,
        }
    }

    /// Reader of the table in a binary file as tab-separated UTF-8 text: column names, then one line per row.
    ///
    /// Fails if the file is damaged, uses an unsupported compression, or contains no table.
    pub fn read_as_text(self, bytes: Vec<u8>) -> Result<Box<dyn Read>, ReadProblem> {
        match self {
            #[cfg(feature = "parquet")]
            Self::Parquet => parquet::read_as_text(bytes),
            #[cfg(not(feature = "parquet"))]
            Self::Parquet => Err(ReadProblem::Format {
                format: "a Parquet file",
                cure: "export it as CSV, or use a build with the feature `parquet`",
            }),
            #[cfg(feature = "spreadsheets")]
            Self::Spreadsheet => spreadsheet::read_as_text(bytes),
            #[cfg(not(feature = "spreadsheets"))]
            Self::Spreadsheet => Err(ReadProblem::Format {
                format: "a spreadsheet or an archive (ZIP)",
                cure: "export it as CSV, or use a build with the feature `spreadsheets`",
            }),
            Self::Matlab => matlab::read_as_text(bytes),
        }
    }
}
