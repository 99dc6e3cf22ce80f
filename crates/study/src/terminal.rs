//! Who watches a study at the command line: a bar, warnings on standard error, and Ctrl-C as a request to stop.

use std::sync::OnceLock;
use std::time::Duration;

use campaign::Observer;
use indicatif::ProgressBar;
use scenario::failure::Failure;

use crate::{interrupt, progress, screen};

/// The terminal of a person who waits.
pub struct Terminal {
    quiet: bool,
    bar: OnceLock<ProgressBar>,
}

impl Terminal {
    /// A terminal without a bar yet.
    pub fn new(quiet: bool) -> Self {
        Self { quiet, bar: OnceLock::new() }
    }
}

impl Observer for Terminal {
    fn begin(&self, most: u64, done: u64) {
        interrupt::listen(true);
        let bar = || progress::of("trials", most, self.quiet).with_position(done).with_elapsed(Duration::ZERO);
        self.bar.get_or_init(bar);
    }

    fn advance(&self) {
        self.bar.get().iter().for_each(|bar| bar.inc(1));
    }

    fn end(&self) {
        self.bar.get().iter().for_each(|bar| bar.finish());
        interrupt::listen(false);
    }

    fn note(&self, line: &str) {
        if !self.quiet {
            screen::warn(line);
        }
    }

    fn warn(&self, line: &str) {
        self.note(&format!("warning: {line}"));
    }

    fn is_asked_to_stop(&self) -> bool {
        interrupt::is_asked()
    }

    fn give_up(&self, failure: &Failure) {
        interrupt::give_up(failure)
    }
}
