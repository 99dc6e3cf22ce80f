//! Ctrl-C and termination by a scheduler: while trials are run, the first one asks to stop between two trials, so that
//! all rows so far are kept; a second one, or one at any other time, ends the program at once.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::failures;
use campaign::failure::Failure;

static LISTENING: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);
static INSTALLED: Once = Once::new();
static IS_PROGRAM: AtomicBool = AtomicBool::new(false);

/// Exit code of a program that was interrupted: the work was not done.
const INTERRUPTED: i32 = 1;

/// Ends the program while work goes on that cannot be stopped, with the message of a failure.
pub fn give_up(failure: &Failure) -> ! {
    std::process::exit(i32::from(failures::fail(failure)))
}

/// Takes interruptions from now on. Where no handler can be installed, an interruption ends the program, as without
/// one.
fn install() {
    INSTALLED.call_once(|| {
        let handler = || {
            let first = !ASKED.swap(true, Ordering::SeqCst);
            if !(first && LISTENING.load(Ordering::SeqCst)) {
                std::process::exit(INTERRUPTED);
            }
        };
        let _ = ctrlc::set_handler(handler);
    });
}

/// Says that this process is the program `study`, whose interruptions are its own; another one, such as Python, sees to
/// them itself.
pub fn of_program() {
    IS_PROGRAM.store(true, Ordering::SeqCst);
}

/// Takes an interruption as a request from now on, or no more: then it ends the program again.
pub fn listen(is_request: bool) {
    if IS_PROGRAM.load(Ordering::SeqCst) {
        install();
    }
    LISTENING.store(is_request, Ordering::SeqCst);
}

/// Whether to stop.
pub fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
