//! Result of `study fit --each` for one log: one line of JSON.

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
    /// Recommended estimate; `null` if there is an error.
    pub verdict: Option<&'a VerdictEntry>,
    /// Warnings of the record and of that estimate, the worst first.
    pub warnings: &'a [Warning],
    /// Reason why there is no estimate.
    pub error: Option<ErrorEntry<'a>>,
}
