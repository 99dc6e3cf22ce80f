//! JSON document of a failure: the message and its parts, as `--format json` writes them to standard error.

use campaign::failure::{Blame, Failure, FailureParts};
use serde::Serialize;

use crate::screen;

/// A command that failed.
#[derive(Serialize, schemars::JsonSchema)]
pub struct ErrorDocument<'a> {
    /// Version of the document.
    pub schema: &'static str,
    /// The failure.
    pub error: ErrorEntry<'a>,
    /// Exit code of the program: 1 where the work could not be done, 2 where the input is wrong, 130 after Ctrl-C.
    pub exit_code: u8,
}

/// The failure.
#[derive(Serialize, schemars::JsonSchema)]
pub struct ErrorEntry<'a> {
    /// `error`: there is no answer, whatever the `severity` of warnings.
    #[schemars(extend("const" = "error"))]
    pub severity: &'static str,
    /// `true` if the input is wrong, the work could not be done, or somebody asked to stop.
    pub blame: Blame,
    /// The whole message, as a person reads it.
    pub message: &'a str,
    /// Parts of the message.
    #[serde(flatten)]
    pub parts: &'a FailureParts,
}

impl<'a> ErrorEntry<'a> {
    /// The entry of a failure.
    pub fn of(Failure { blame, message, parts }: &'a Failure) -> Self {
        Self { severity: "error", blame: *blame, message, parts }
    }
}

/// The document of a failure in one line. Fails if it cannot be written as JSON.
pub fn text(failure: &Failure) -> Result<String, serde_json::Error> {
    let exit_code = screen::exit_code(failure.blame);
    let document = ErrorDocument { schema: "error/1", error: ErrorEntry::of(failure), exit_code };
    serde_json::to_string(&document)
}
