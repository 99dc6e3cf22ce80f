//! Logs fitted one by one: each has a verdict or an error.

use std::path::{Path, PathBuf};

use campaign::failure::Failure;
use document::fit::VerdictEntry;
use document::{Warning, Warnings};

use super::fit::fit;
use super::scale_comparison::LabelledMethod;
use crate::options::ReadingOptions;
use crate::records::read_records;

/// Result for one log.
pub struct LogFit {
    /// Path of the file as it was given.
    pub file: PathBuf,
    /// `true` if the log was read as a record.
    pub is_read: bool,
    /// Recommended estimate; `None` if there is an error.
    pub verdict: Option<VerdictEntry>,
    /// Warnings of the record and of that estimate, the worst first.
    pub warnings: Vec<Warning>,
    /// Reason why there is no estimate; `None` if there is one.
    pub error: Option<Failure>,
}

impl LogFit {
    /// Result for a log that is identified alone by every method.
    pub fn fit_file(file: &Path, methods: &[LabelledMethod], reading: &ReadingOptions) -> Self {
        let mut warnings = Warnings::default();
        let read = read_records(&[file.to_owned()], reading, &mut warnings);
        let (is_read, of_reader) = (read.is_ok(), warnings.ranked());
        let without = |error| Self { file: file.to_owned(), is_read, verdict: None, warnings: of_reader, error };
        match read.and_then(|trials| fit([&trials, &[]], methods, &[], true, warnings)) {
            Ok(fit) => Self {
                warnings: fit.document.verdict_warnings().cloned().collect(),
                verdict: fit.document.verdict,
                ..without(None)
            },
            Err(error) => without(Some(error)),
        }
    }
}
