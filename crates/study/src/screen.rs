//! Writing to the terminal: results on standard output, warnings and errors on standard error. A reader that has gone
//! away (`study list ships | head -1`) ends the writing and not the work. What could act on the terminal is shown and
//! not sent: a path, a file or a stored label may hold it.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{ErrorKind, Write};

use report::Table;
use report::printable::escaped;

use crate::options::{Common, Format};
use campaign::failure::{Blame, Failure};

/// Writes lines of results to standard output and ends them with a line break.
///
/// Fails when they cannot be written, except to a pipe that nobody reads any more.
pub fn say(lines: &str) -> Result<(), Failure> {
    put(&shown(lines))
}

fn put(text: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match writeln!(output, "{text}").and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::work(format!("failed to write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a line to standard error, with the word it begins with in colour where a terminal shows that. Where it cannot
/// be written, nobody is there to be told.
pub fn warn(line: &str) {
    let stream = std::io::stderr();
    let line = shown(line);
    let line = if is_coloured(&stream) { coloured(&line) } else { line };
    let _ = writeln!(stream.lock(), "{line}");
}

/// Whether a stream goes to a terminal that shows colours, and nobody asked for none (`NO_COLOR`, `TERM=dumb`).
pub fn is_coloured(stream: &impl anstream::stream::RawStream) -> bool {
    anstream::AutoStream::choice(stream) != anstream::ColorChoice::Never
}

/// Words that say at the beginning of a line what it is, with their colours.
const MARKS: [(&str, &str); 5] = [
    ("error:", "\x1b[1;31m"),
    ("warning:", "\x1b[1;33m"),
    ("note:", "\x1b[1;36m"),
    ("help:", "\x1b[1;36m"),
    ("  = help:", "\x1b[1;36m"),
];

fn coloured(lines: &str) -> String {
    let one = |line: &str| match MARKS.iter().find(|(mark, _)| line.starts_with(mark)) {
        Some((mark, colour)) => format!("{colour}{mark}\x1b[0m{}", &line[mark.len()..]),
        None => line.to_owned(),
    };
    lines.split('\n').map(one).collect::<Vec<_>>().join("\n")
}

/// What a command found, in every form in which it may be asked for.
pub struct CommandOutput<'a> {
    /// Words before and behind the table.
    pub words: [&'a str; 2],
    /// The table.
    pub table: &'a Table,
    /// What else a person should know.
    pub notes: &'a str,
    /// The whole for a program: the text of the file that was written.
    pub document: &'a str,
}

/// Tells a result, unless nothing is to be said, and what was noticed on the way. Where another program reads, table or
/// document stand alone on standard output, and notes go to standard error.
///
/// Fails as [`say`] does.
pub fn tell(common: &Common, output: &CommandOutput, warnings: &[impl Display]) -> Result<(), Failure> {
    let CommandOutput { words: [before, behind], table, notes, document } = output;
    let note = |line: &str| {
        if !common.quiet {
            warn(line)
        }
    };
    match common.format {
        _ if common.is_silent() => {}
        Format::Text => say(&format!("{before}\n{}{behind}{notes}", table.to_text()))?,
        Format::Json => {
            say_document(document)?;
            note(notes.lines().last().unwrap_or_default());
        }
        format => {
            say(format.render(table).trim_end())?;
            note(notes.trim_start());
        }
    }
    warn_of(common, warnings);
    Ok(())
}

/// Writes warnings to standard error, one a line, unless none are wanted.
pub fn warn_of(common: &Common, warnings: &[impl Display]) {
    let wanted = warnings.iter().filter(|_| !common.quiet);
    wanted.for_each(|warning| warn(&format!("warning: {warning}")));
}

/// Writes a document to standard output as it is: JSON shows by itself what could act on the terminal.
///
/// Fails as [`say`] does.
pub fn say_document(document: &str) -> Result<(), Failure> {
    put(document.trim_end())
}

/// The lines without anything but text in them, as they are written.
pub fn shown(lines: &str) -> String {
    lines.split('\n').map(escaped).collect::<Vec<Cow<str>>>().join("\n")
}

/// The exit code of the program after a failure.
pub fn exit_code(blame: Blame) -> u8 {
    match blame {
        Blame::Work => 1,
        Blame::Input => 2,
        Blame::Interrupted => 130,
    }
}

#[cfg(test)]
mod tests {
    use super::coloured;

    #[test]
    fn only_the_word_at_the_beginning_of_a_line_is_coloured() {
        let lines = "error: no error: here\nsecond\nwarning: slow";
        assert_eq!(coloured(lines), "\x1b[1;31merror:\x1b[0m no error: here\nsecond\n\x1b[1;33mwarning:\x1b[0m slow");
    }
}
