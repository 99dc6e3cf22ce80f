//! Ctrl-C and termination by a scheduler: while trials are run, the first one asks to stop between two trials, so that
//! all rows so far are kept; a second one, or one at any other time, ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

use campaign::failure::{Blame, Failure};

use crate::{failures, screen};

static LISTENING: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);

/// Ends the program while work goes on that cannot be stopped, with the message of a failure.
pub fn give_up(failure: &Failure) -> ! {
    std::process::exit(i32::from(failures::fail(failure)))
}

/// Takes the interruptions of this process, which is the program `study`; another one, such as Python, sees to them
/// itself. Where no handler can be installed, an interruption ends the program by its signal.
pub fn of_program() {
    let handler = || {
        let first = !ASKED.swap(true, Ordering::SeqCst);
        if !(first && LISTENING.load(Ordering::SeqCst)) {
            std::process::exit(i32::from(screen::exit_code(Blame::Interrupted)));
        }
    };
    let _ = ctrlc::set_handler(handler);
}

/// Takes an interruption as a request from now on, or no more: then it ends the program again.
pub fn listen(is_request: bool) {
    LISTENING.store(is_request, Ordering::SeqCst);
}

/// Whether to stop.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
