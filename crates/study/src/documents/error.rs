//! JSON document of a failure: the message and its parts, as `--format json` writes them to standard error.

use campaign::failure::{Failure, FailureKind, FailureParts};
use serde::Serialize;

use crate::screen;

/// Failure of a command.
#[derive(Serialize, schemars::JsonSchema)]
pub struct ErrorDocument<'a> {
    /// Name and version of the document, such as `error/1`.
    pub schema: &'static str,
    /// Entry of the failure.
    pub error: ErrorEntry<'a>,
    /// Exit code of the program: 1 if the work could not be done, 2 if the input is wrong, 130 after Ctrl-C.
    pub exit_code: u8,
}

/// Entry of a failure.
#[derive(Serialize, schemars::JsonSchema)]
pub struct ErrorEntry<'a> {
    /// `error`: there is no result, whatever the `severity` of warnings.
    #[schemars(extend("const" = "error"))]
    pub severity: &'static str,
    /// Kind of failure: the input is wrong, the work could not be done, or it was stopped on request.
    pub blame: FailureKind,
    /// The whole message, for a person.
    pub message: &'a str,
    /// Parts of the message.
    #[serde(flatten)]
    pub parts: &'a FailureParts,
}

impl<'a> ErrorEntry<'a> {
    /// Entry of a failure.
    pub fn from_failure(Failure { kind: blame, message, parts }: &'a Failure) -> Self {
        Self { severity: "error", blame: *blame, message, parts }
    }
}

/// Document of a failure in one line. Fails if it cannot be written as JSON.
pub fn to_json_line(failure: &Failure) -> Result<String, serde_json::Error> {
    let exit_code = screen::exit_code(failure.kind);
    let document = ErrorDocument { schema: "error/1", error: ErrorEntry::from_failure(failure), exit_code };
    serde_json::to_string(&document)
}
