//! Telling what went wrong: in words, or as JSON where a program asked for it.

use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use campaign::failure::Failure;

use crate::documents::error;
use crate::screen;

/// Whether a program reads what went wrong.
static FOR_PROGRAMS: AtomicBool = AtomicBool::new(false);

/// Tells failures from now on as JSON, for programs.
pub fn tell_programs() {
    FOR_PROGRAMS.store(true, Ordering::Relaxed);
}

/// Whether failures are told as JSON.
pub fn is_for_programs() -> bool {
    FOR_PROGRAMS.load(Ordering::Relaxed)
}

/// Tells a failure on standard error, in words or as one line of JSON; returns the exit code of the program.
pub fn fail(failure: &Failure) -> u8 {
    match error::text(failure) {
        Ok(document) if is_for_programs() => drop(writeln!(std::io::stderr().lock(), "{document}")),
        _ => screen::warn(&failure.to_string()),
    }
    screen::exit_code(failure.blame)
}
