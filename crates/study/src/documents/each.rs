//! Answer of `study fit --each` for a log: one line of JSON.

use document::Warning;
use document::fit::VerdictEntry;
use schemars::JsonSchema;
use serde::Serialize;

use super::error::ErrorEntry;

/// One log of `study fit --each`.
#[derive(Serialize, JsonSchema)]
pub struct LogFitEntry<'a> {
    /// `fit-each/1`.
    #[schemars(extend("const" = "fit-each/1"))]
    pub schema: &'static str,
    /// The file as it was named.
    pub file: String,
    /// The answer to take; `null` where there is an error.
    pub verdict: Option<&'a VerdictEntry>,
    /// Warnings of the record and of that answer, the worst first.
    pub warnings: &'a [Warning],
    /// Why there is no answer.
    pub error: Option<ErrorEntry<'a>>,
}
