//! Ctrl-C and termination by a scheduler. While trials run, the first signal stops between two trials, so that all rows
//! so far are kept; a second one, or one at any other time, ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use campaign::failure::{Failure, FailureKind};

use crate::{failures, screen};

/// `true` while trials run: the first interruption is then a request to stop.
static LISTENING: AtomicBool = AtomicBool::new(false);
/// `true` after the first interruption.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Reports a failure and ends the program at once, for work that cannot be stopped otherwise.
pub fn exit_with_failure(failure: &Failure) -> ! {
    std::process::exit(i32::from(failures::report_failure(failure)))
}

/// Installs the handler of Ctrl-C for the program `study`; Python handles Ctrl-C itself. Without a handler the signal
/// ends the program.
pub fn install_handler() {
    let handler = || {
        let first = !ASKED.swap(true, Ordering::SeqCst);
        if !(first && LISTENING.load(Ordering::SeqCst)) {
            std::process::exit(i32::from(screen::exit_code(FailureKind::Interrupted)));
        }
    };
    let _ = ctrlc::set_handler(handler);
}

/// Sets whether the next interruption is a request to stop; with `false` it ends the program at once.
pub fn set_graceful_stop(is_request: bool) {
    LISTENING.store(is_request, Ordering::SeqCst);
}

/// `true` after the first interruption, a request to stop between two trials.
pub fn is_stop_requested() -> bool {
    ASKED.load(Ordering::Relaxed)
}
