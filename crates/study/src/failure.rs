//! How the command line fails: one message and an exit code, never a backtrace.

use std::fmt;
use std::ops::Range;
use std::path::Path;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

/// A failure as the user sees it.
#[derive(Debug)]
pub struct Failure {
    /// Whether the input or the work is at fault.
    pub blame: Blame,
    /// The whole message.
    pub message: String,
}

/// Who has to act.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blame {
    /// The input is wrong: usage, scenario or record. Exit code 2.
    Input,
    /// The work could not be done: a full disk, a folder that cannot be written. Exit code 1.
    Work,
}

impl Blame {
    /// The exit code of the process.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Work => 1,
            Self::Input => 2,
        }
    }
}

impl Failure {
    /// The input is wrong.
    pub fn input(message: impl fmt::Display) -> Self {
        Self { blame: Blame::Input, message: format!("error: {message}") }
    }

    /// The work could not be done.
    pub fn work(message: impl fmt::Display) -> Self {
        Self { blame: Blame::Work, message: format!("error: {message}") }
    }

    /// The input is wrong at a place of a text file: the line is shown, the place underlined with what was `expected`
    /// there, and `advice` says what to do.
    pub fn at(file: &Path, text: &str, span: Range<usize>, found: &str, expected: &str, advice: &str) -> Self {
        let name = file.display().to_string();
        let span = span.start.min(text.len())..span.end.min(text.len());
        let place = AnnotationKind::Primary.span(span).label(expected);
        let snippet = Snippet::source(text).path(&name).annotation(place);
        let group = Level::ERROR.primary_title(found).element(snippet).element(Level::HELP.message(advice));
        Self { blame: Blame::Input, message: Renderer::plain().render(&[group]) }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

/// Reading and writing files of the study's own: the path belongs in the message.
pub trait OnPath<T> {
    /// Turns an input/output error into a failure of the work that names the path and what was tried.
    fn on(self, tried: &str, path: &Path) -> Result<T, Failure>;
}

impl<T, E: fmt::Display> OnPath<T> for Result<T, E> {
    fn on(self, tried: &str, path: &Path) -> Result<T, Failure> {
        self.map_err(|error| Failure::work(format!("failed to {tried} {}: {error}", path.display())))
    }
}
