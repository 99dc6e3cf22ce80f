//! Logs of one zig-zag of one ship whose K and T are known, in every format that is read and with every trouble that
//! loggers and instruments make. What has to come of each stands beside it; the test is `tests/logs.rs`. The small text
//! files among them lie in `tests/logs`.

pub mod combined;
pub mod faults;
pub mod messages;
pub mod sentences;
pub mod tables;
pub mod troubles;
pub mod voyage;

use std::path::PathBuf;

/// What has to come of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It is read: K and T are those of the sound log, and the warnings hold these words.
    Read(&'static [&'static str]),
    /// It is read, its K and T may be wrong, and the warnings hold these words.
    Doubted(&'static [&'static str]),
    /// It is refused, in a message with these words: the trouble and the cure.
    Refused(&'static [&'static str]),
}

/// A log as a file.
#[derive(Debug, Clone)]
pub struct File {
    /// Its name.
    pub name: &'static str,
    /// What it is, for a person.
    pub what: &'static str,
    /// Its bytes.
    pub bytes: Vec<u8>,
    /// What has to come of it.
    pub outcome: Outcome,
    /// The name of another file that belongs to it.
    pub beside: Option<&'static str>,
    /// `true` if it lies in `tests/logs`.
    pub kept: bool,
}

impl File {
    fn new(name: &'static str, what: &'static str, text: impl Into<Vec<u8>>, outcome: Outcome) -> Self {
        Self { name, what, bytes: text.into(), outcome, beside: None, kept: true }
    }

    /// The same, made when a test runs and nowhere else: it is large, or no text.
    fn not_kept(self) -> Self {
        Self { kept: false, ..self }
    }

    /// The same, read together with another.
    fn with(self, beside: &'static str) -> Self {
        Self { beside: Some(beside), ..self }
    }
}

/// Every log.
pub fn all() -> Vec<File> {
    let formats = tables::all().into_iter().chain(sentences::all());
    formats.chain(messages::all()).chain(troubles::all()).chain(faults::all()).collect()
}

/// The folder of the logs that are kept.
pub fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("logs")
}

/// Command that writes the folder.
pub const COMMAND: &str = "cargo run -p kempf-tests --bin logs";

/// The page of the folder.
pub fn page() -> String {
    let mut page = format!(
        "# Logs\n\nOne 10/10 zig-zag of a ship with K = 0.06 1/s and T = 25 s (first order, rudder at 2.5 deg/s, \
         0.1 deg of noise on the compass), in the\nformats and with the troubles of real logs. Not measured: made by \
         `tests/src/logs`, where it stands what has to come of each file.\n\n```sh\n{COMMAND}\n```\n\n\
         | file | what it is |\n|---|---|\n"
    );
    for file in all().iter().filter(|file| file.kept) {
        page += &format!("| `{}` | {} |\n", file.name, file.what);
    }
    page
}
