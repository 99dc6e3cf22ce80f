//! Observers of a running study: the command line with its progress bar, warnings and Ctrl-C, or none.

use rayon::ThreadPool;

use crate::failure::Failure;

/// Receiver of progress, notes and warnings, which may also request a stop.
pub trait Observer: Sync {
    /// Called before the first trial; `most` is the maximum number of trials, of which `done` are stored.
    fn begin(&self, _most: u64, _done: u64) {}

    /// Called after every trial.
    fn advance(&self) {}

    /// Called after the last trial.
    fn end(&self) {}

    /// Receives a note for the user.
    fn note(&self, _line: &str) {}

    /// Receives a warning for the user.
    fn warn(&self, _line: &str) {}

    /// `true` requests a stop before the next trial; finished trials are kept.
    fn should_stop(&self) -> bool {
        false
    }

    /// Thread pool for the trials; `None` for the global pool.
    fn threads(&self) -> Option<&ThreadPool> {
        None
    }

    /// Called if a trial does not end after a request to stop. All trials before it are stored, so a program may
    /// exit here with this failure. If the call returns, the run waits for the trial.
    fn on_unstoppable_trial(&self, _failure: &Failure) {}
}

/// Observer that ignores everything.
pub struct NoObserver;

impl Observer for NoObserver {}
