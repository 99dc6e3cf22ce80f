//! Failures on standard error: as text, or as JSON if requested.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use campaign::failure::Failure;

use crate::documents::error;
use crate::screen;

/// `true` if failures are written as JSON.
static FOR_PROGRAMS: AtomicBool = AtomicBool::new(false);

/// Switches all later failures to JSON, for programs.
pub fn use_json() {
    FOR_PROGRAMS.store(true, Ordering::Relaxed);
}

/// `true` if failures are written as JSON.
pub fn is_for_programs() -> bool {
    FOR_PROGRAMS.load(Ordering::Relaxed)
}

/// Writes a failure to standard error, as text or as one line of JSON; returns the exit code of the program.
pub fn fail(failure: &Failure) -> u8 {
    match error::text(failure) {
        Ok(document) if is_for_programs() => drop(writeln!(std::io::stderr().lock(), "{document}")),
        _ => screen::warn(&failure.to_string()),
    }
    screen::exit_code(failure.kind)
}
