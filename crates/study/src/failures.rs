//! Failures on standard error: as text, or as JSON if requested.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use campaign::failure::Failure;

use crate::documents::error;
use crate::screen;

/// `true` if failures are written as JSON.
static USES_JSON: AtomicBool = AtomicBool::new(false);

/// Switches all later failures to JSON, for programs.
pub fn report_failures_as_json() {
    USES_JSON.store(true, Ordering::Relaxed);
}

/// `true` if failures are written as JSON.
pub fn reports_failures_as_json() -> bool {
    USES_JSON.load(Ordering::Relaxed)
}

/// Writes a failure to standard error, as text or as one line of JSON; returns the exit code of the program.
pub fn report_failure(failure: &Failure) -> u8 {
    match error::to_json_line(failure) {
        Ok(document) if reports_failures_as_json() => drop(writeln!(std::io::stderr().lock(), "{document}")),
        _ => screen::print_to_stderr(&failure.to_string()),
    }
    screen::exit_code(failure.kind)
}
