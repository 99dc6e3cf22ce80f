//! Output to the terminal: results on standard output, warnings and errors on standard error. A closed pipe (`study
//! list ships | head -1`) ends the output, not the work. Control characters in a path, a file or a stored label are
//! escaped.

use std::borrow::Cow;
use std::fmt::Display;
use std::io::{ErrorKind, Write};

use report::Table;
use report::printable::escaped;

use crate::options::{CommonOptions, Format};
use campaign::failure::{Failure, FailureKind};

/// Writes lines of results to standard output and ends them with a line break.
///
/// Fails if the lines cannot be written, except to a closed pipe.
pub fn print_lines(lines: &str) -> Result<(), Failure> {
    put(&escaped_lines(lines))
}

fn put(text: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match writeln!(output, "{text}").and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::execution(format!("failed to write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a line to standard error, with its first word in colour on a terminal. A failure to write is ignored.
pub fn print_to_stderr(line: &str) {
    let stream = std::io::stderr();
    let line = escaped_lines(line);
    let line = if has_terminal_colours(&stream) { coloured(&line) } else { line };
    let _ = writeln!(stream.lock(), "{line}");
}

/// `true` if a stream is a terminal with colours, not switched off by `NO_COLOR` or `TERM=dumb`.
pub fn has_terminal_colours(stream: &impl anstream::stream::RawStream) -> bool {
    anstream::AutoStream::choice(stream) != anstream::ColorChoice::Never
}

/// First words of lines with their colours.
const MARKS: [(&str, &str); 5] = [
    ("error:", "\x1b[1;31m"),
    ("warning:", "\x1b[1;33m"),
    ("note:", "\x1b[1;36m"),
    ("help:", "\x1b[1;36m"),
    ("  = help:", "\x1b[1;36m"),
];

fn coloured(lines: &str) -> String {
    let coloured_line = |line: &str| match MARKS.iter().find(|(mark, _)| line.starts_with(mark)) {
        Some((mark, colour)) => format!("{colour}{mark}\x1b[0m{}", &line[mark.len()..]),
        None => line.to_owned(),
    };
    lines.split('\n').map(coloured_line).collect::<Vec<_>>().join("\n")
}

/// Output of a command in every format.
pub struct CommandOutput<'a> {
    /// Text before and after the table.
    pub texts_around_table: [&'a str; 2],
    /// The table.
    pub table: &'a Table,
    /// Notes below the table, such as the path of the file.
    pub notes: &'a str,
    /// JSON document: the text of the file that was written.
    pub document: &'a str,
}

/// Prints a result and its warnings, unless the output is silent. In formats for programs, standard output has only the
/// table or the document, and notes go to standard error.
///
/// Fails as [`print_lines`] does.
pub fn print_output(common: &CommonOptions, output: &CommandOutput, warnings: &[impl Display]) -> Result<(), Failure> {
    let CommandOutput { texts_around_table: [before, behind], table, notes, document } = output;
    let note = |line: &str| {
        if !common.quiet {
            print_to_stderr(line)
        }
    };
    match common.format {
        _ if common.is_silent() => {}
        Format::Text => print_lines(&format!("{before}\n{}{behind}{notes}", table.to_text()))?,
        Format::Json => {
            print_unescaped(document)?;
            note(notes.lines().last().unwrap_or_default());
        }
        format => {
            print_lines(format.render(table).trim_end())?;
            note(notes.trim_start());
        }
    }
    print_warnings(common, warnings);
    Ok(())
}

/// Writes warnings to standard error, one per line, unless `--quiet` is given.
pub fn print_warnings(common: &CommonOptions, warnings: &[impl Display]) {
    let wanted = warnings.iter().filter(|_| !common.quiet);
    wanted.for_each(|warning| print_to_stderr(&format!("warning: {warning}")));
}

/// Writes a text to standard output without escapes, for JSON, which escapes control characters itself, and for
/// scripts.
///
/// Fails as [`print_lines`] does.
pub fn print_unescaped(document: &str) -> Result<(), Failure> {
    put(document.trim_end())
}

/// Lines with control characters escaped.
pub fn escaped_lines(lines: &str) -> String {
    lines.split('\n').map(escaped).collect::<Vec<Cow<str>>>().join("\n")
}

/// Exit code of the program after a failure: 1 if the work failed, 2 for wrong input, 130 after an interruption.
pub fn exit_code(blame: FailureKind) -> u8 {
    match blame {
        FailureKind::Work => 1,
        FailureKind::Input => 2,
        FailureKind::Interrupted => 130,
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
