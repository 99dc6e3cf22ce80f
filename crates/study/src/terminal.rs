//! Observer of a study at the command line: a bar, warnings on standard error, and Ctrl-C as a request to stop.

use std::sync::OnceLock;

use campaign::Observer;
use campaign::failure::Failure;

use crate::progress::ProgressSteps;
use crate::{interrupt, screen};

/// Observer that reports progress on the terminal.
pub struct Terminal {
    quiet: bool,
    label: &'static str,
    steps: OnceLock<ProgressSteps>,
}

impl Terminal {
    /// Observer whose bar appears at the beginning of the trials; `label` names their steps.
    pub fn new(label: &'static str, quiet: bool) -> Self {
        Self { quiet, label, steps: OnceLock::new() }
    }
}

impl Observer for Terminal {
    fn begin(&self, most: u64, done: u64) {
        interrupt::set_graceful_stop(true);
        let threads = rayon::current_num_threads();
        self.steps.get_or_init(|| ProgressSteps::new(self.label, most, done, threads, self.quiet));
    }

    fn advance(&self) {
        self.steps.get().iter().for_each(|steps| steps.advance());
    }

    fn end(&self) {
        self.steps.get().iter().for_each(|steps| steps.finish());
        interrupt::set_graceful_stop(false);
    }

    fn note(&self, line: &str) {
        if !self.quiet {
            screen::print_to_stderr(line);
        }
    }

    fn warn(&self, line: &str) {
        self.note(&format!("warning: {line}"));
    }

    fn should_stop(&self) -> bool {
        interrupt::is_stop_requested()
    }

    fn on_unstoppable_trial(&self, failure: &Failure) {
        interrupt::exit_with_failure(failure)
    }
}
