//! Writing to the terminal: results on standard output, warnings and errors on standard error. A reader that has gone
//! away (`study list ships | head -1`) ends the writing and not the work. What could act on the terminal is shown and
//! not sent: a path, a file or a stored label may hold it.

use std::borrow::Cow;
use std::io::{ErrorKind, Write};

use report::Table;
use report::printable::escaped;

use crate::options::{Common, Format};
use scenario::failure::{Blame, Failure};

/// Writes lines of results to standard output and ends them with a line break.
///
/// Fails when they cannot be written, except to a pipe that nobody reads any more.
pub fn say(lines: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match writeln!(output, "{}", shown(lines)).and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::work(format!("failed to write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a line to standard error. Where that is not possible, nobody is there to be told.
pub fn warn(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", shown(line));
}

/// Tells a result, unless nothing is to be said: a table in the format that was asked for with words before and behind
/// it, and notes, which go to standard error where another program reads the table.
///
/// Fails as [`say`] does.
pub fn tell(common: &Common, [before, behind]: [&str; 2], table: &Table, notes: &str) -> Result<(), Failure> {
    if common.quiet {
        return Ok(());
    }
    let table = common.format.render(table);
    if common.format == Format::Text {
        return say(&format!("{before}\n{table}{behind}{notes}"));
    }
    // Nothing else may stand beside it.
    say(table.trim_end())?;
    warn(notes.trim_start());
    Ok(())
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
    }
}
