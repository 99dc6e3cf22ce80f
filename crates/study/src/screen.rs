//! Writing to the terminal: results on standard output, warnings and errors on standard error. A reader that has gone away
//! (`study list ships | head -1`) ends the writing and not the work.

use std::io::{ErrorKind, Write};

use crate::failure::Failure;

/// Writes lines of results to standard output and ends them with a line break.
///
/// Fails when they cannot be written, except to a pipe that nobody reads any more.
pub fn say(lines: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match writeln!(output, "{lines}").and_then(|()| output.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::work(format!("failed to write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes a line to standard error. Where that is not possible, nobody is there to be told.
pub fn warn(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}
