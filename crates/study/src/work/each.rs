//! Logs fitted one by one: each has a verdict, or an error.

use std::path::{Path, PathBuf};

use campaign::failure::Failure;
use document::fit::VerdictEntry;
use document::{Warning, Warnings};

use super::every_scale::Named;
use super::fit::fit;
use crate::options::ReadingOptions;
use crate::records::read_all;

/// Result of one log.
pub struct LogFit {
    /// The file as it was named.
    pub file: PathBuf,
    /// `true` if it is a record.
    pub is_read: bool,
    /// The answer to take.
    pub verdict: Option<VerdictEntry>,
    /// Warnings of the record and of that answer, the worst first.
    pub warnings: Vec<Warning>,
    /// Why there is no answer.
    pub error: Option<Failure>,
}

impl LogFit {
    /// A log identified alone by every method.
    pub fn of(file: &Path, methods: &[Named], reading: &ReadingOptions) -> Self {
        let mut warnings = Warnings::default();
        let read = read_all(&[file.to_owned()], reading, &mut warnings);
        let (is_read, of_reader) = (read.is_ok(), warnings.ranked());
        let without = |error| Self { file: file.to_owned(), is_read, verdict: None, warnings: of_reader, error };
        match read.and_then(|trials| fit([&trials, &[]], methods, &[], true, warnings)) {
            Ok(fit) => Self {
                warnings: fit.document.answer_warnings().cloned().collect(),
                verdict: fit.document.verdict,
                ..without(None)
            },
            Err(error) => without(Some(error)),
        }
    }
}
