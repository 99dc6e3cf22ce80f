//! Failure as reported to a user: its kind, one message, and the parts of the message for programs.

use std::borrow::Cow;
use std::error::Error;
use std::fmt;
use std::ops::Range;
use std::path::Path;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use document::ErrorCode;
use serde::Serialize;

/// Prefix of the message of a failure.
const ERROR: &str = "error: ";

/// Failure of a command, as reported to the user: kind, message, and its parts for programs.
#[derive(Debug)]
pub struct Failure {
    /// Kind of failure: wrong input, failed work, or a request to stop.
    pub kind: FailureKind,
    /// Whole message, without the word "error" in front.
    pub message: String,
    /// Parts of the message, for programs.
    pub parts: Box<FailureParts>,
}

/// Parts of a message; a part that a failure does not have is `None`.
#[derive(Debug, Default, PartialEq, Eq, Serialize, schemars::JsonSchema)]
pub struct FailureParts {
    /// Error code.
    pub code: ErrorCode,
    /// File at fault.
    pub file: Option<String>,
    /// Line of the file, from 1.
    pub line: Option<usize>,
    /// Character of the line, from 1.
    pub column: Option<usize>,
    /// Description of the fault, without the name of the file.
    pub problem: String,
    /// Text that was expected in place of the faulty one.
    pub expected: Option<String>,
    /// Advice on how to correct the fault.
    pub help: Option<String>,
}

/// Kind of failure, which determines the exit code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "Blame")]
pub enum FailureKind {
    /// The input is wrong: usage, scenario or record.
    Input,
    /// The work could not be done: a full disk, a folder that cannot be written.
    Work,
    /// Stopped on request: Ctrl-C, or a signal to end.
    Interrupted,
}

impl Failure {
    fn new(kind: FailureKind, message: String, parts: FailureParts) -> Self {
        Self { kind, message, parts: Box::new(parts) }
    }

    /// Failure of wrong input.
    pub fn input(message: impl fmt::Display) -> Self {
        let message = message.to_string();
        Self::new(FailureKind::Input, message.clone(), FailureParts { problem: message, ..FailureParts::default() })
    }

    /// Failure of wrong input in a file of this name.
    pub fn in_file(file: &(impl AsRef<Path> + ?Sized), problem: impl fmt::Display) -> Self {
        let (file, problem) = (file.as_ref().display().to_string(), problem.to_string());
        let message = format!("{file}: {problem}");
        Self::new(FailureKind::Input, message, FailureParts { file: Some(file), problem, ..FailureParts::default() })
    }

    /// Failure of the execution on valid input, such as a full disk; error code `work`.
    pub fn execution(message: impl fmt::Display) -> Self {
        Self { kind: FailureKind::Work, ..Self::input(message) }.with_code(ErrorCode::Work)
    }

    /// Failure of a stop on request.
    pub fn interrupted(message: impl fmt::Display) -> Self {
        Self { kind: FailureKind::Interrupted, ..Self::input(message) }.with_code(ErrorCode::Interrupted)
    }

    /// Same failure with another error code.
    #[must_use]
    pub fn with_code(mut self, code: ErrorCode) -> Self {
        self.parts.code = code;
        self
    }

    /// Wrong input at a byte range of a text file: the message quotes the line, underlines the range with `expected`,
    /// and ends with `advice`, the remedy.
    pub fn in_text(file: &Path, text: &str, span: Range<usize>, problem: &str, expected: &str, advice: &str) -> Self {
        let name = file.display().to_string();
        let span = span.start.min(text.len())..span.end.min(text.len());
        let start = span.start;
        let place = AnnotationKind::Primary.span(span).label(expected);
        let snippet = Snippet::source(text).path(&name).annotation(place);
        let (problem, advice) = (shortened(problem), shortened(advice));
        let group = Level::ERROR.primary_title(&*problem).element(snippet).element(Level::HELP.message(&*advice));
        let shown = Renderer::plain().render(&[group]);
        let before = text.get(..start).unwrap_or_default();
        let parts = FailureParts {
            code: ErrorCode::Scenario,
            line: Some(before.matches('\n').count() + 1),
            column: Some(before.rsplit('\n').next().unwrap_or_default().chars().count() + 1),
            problem: problem.to_string(),
            expected: Some(expected.to_owned()),
            help: Some(advice.to_string()),
            file: Some(name),
        };
        Self::new(FailureKind::Input, shown.strip_prefix(ERROR).unwrap_or(&shown).to_owned(), parts)
    }
}

/// Maximum length of a sentence in a message, characters; it may quote a key of any length.
const MAX_SENTENCE_CHARACTERS: usize = 1000;

/// Sentence with `…` for its middle if it is too long.
fn shortened(sentence: &str) -> Cow<'_, str> {
    let count = sentence.chars().count();
    if count <= MAX_SENTENCE_CHARACTERS {
        return Cow::Borrowed(sentence);
    }
    let half = MAX_SENTENCE_CHARACTERS / 2;
    let (head, tail) = (sentence.chars().take(half), sentence.chars().skip(count - half));
    Cow::Owned(head.chain(['…']).chain(tail).collect())
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{ERROR}{}", self.message)
    }
}

impl Error for Failure {}

/// Conversion of an error on a file of the study into a failure.
pub trait OnPath<T> {
    /// Result whose error is a failure of kind [`FailureKind::Work`]: "failed to ACTION PATH: cause".
    fn on(self, action: &str, path: &Path) -> Result<T, Failure>;
}

impl<T, E: Error> OnPath<T> for Result<T, E> {
    fn on(self, action: &str, path: &Path) -> Result<T, Failure> {
        self.map_err(|error| {
            let file = path.display().to_string();
            let mut failure = Failure::execution(format!("failed to {action} {file}: {}", with_causes(&error)));
            failure.parts.file = Some(file);
            failure
        })
    }
}

/// Text of an error with its causes, without repeating a cause that the text already contains.
fn with_causes(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let message = error.to_string();
        if !text.contains(&message) {
            text += &format!(": {message}");
        }
        cause = error.source();
    }
    text
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use report::ReportError;

    use super::*;

    #[test]
    fn the_word_error_is_told_once_and_only_in_front() {
        let failures = [
            Failure::input("no such thing"),
            Failure::execution("no such thing"),
            Failure::in_text(Path::new("a.toml"), "seed = -1\n", 7..9, "no such thing", "expected more", "change it"),
        ];
        for failure in failures {
            assert!(failure.to_string().starts_with("error: no such thing"), "{failure}");
            assert!(failure.message.starts_with("no such thing"), "{}", failure.message);
        }
    }

    #[test]
    fn a_failure_has_the_parts_that_it_tells() {
        let at = Failure::in_text(Path::new("a.toml"), "x = 1\nß = -1\n", 11..13, "no such thing", "more", "change it");
        let parts = FailureParts {
            code: ErrorCode::Scenario,
            file: Some("a.toml".into()),
            line: Some(2),
            column: Some(5),
            problem: "no such thing".into(),
            expected: Some("more".into()),
            help: Some("change it".into()),
        };
        assert_eq!(*at.parts, parts);
        let about = Failure::in_file("b.csv", "it is empty");
        assert_eq!((about.parts.file.as_deref(), about.parts.problem.as_str()), (Some("b.csv"), "it is empty"));
        assert_eq!(about.message, "b.csv: it is empty");
        let io = Err::<(), _>(std::io::Error::other("full")).on("write", Path::new("c")).expect_err("it failed");
        assert_eq!((io.kind, io.parts.code, io.parts.file.as_deref()), (FailureKind::Work, ErrorCode::Work, Some("c")));
    }

    #[test]
    fn the_cause_of_an_error_is_told_once() {
        let full = || std::io::Error::other("no space is left");
        let write = ReportError::Write { path: PathBuf::from("a.svg"), source: full() };
        let message = Err::<(), _>(write).on("write the figure", Path::new("a")).expect_err("it failed").message;
        assert_eq!(message, "failed to write the figure a: failed to write a.svg: no space is left");
        let message = Err::<(), _>(full()).on("write", Path::new("b")).expect_err("it failed").message;
        assert_eq!(message, "failed to write b: no space is left");
    }
}
