//! Who watches a study while it runs: the command line with its bar, its warnings and Ctrl-C, or nobody.

use rayon::ThreadPool;

use crate::failure::Failure;

/// Is told how far a study is and what was odd, and asked whether to stop.
pub trait Observer: Sync {
    /// Trials are run from now on: `most` of them at most, of which `done` were stored before.
    fn begin(&self, _most: u64, _done: u64) {}

    /// One trial is done.
    fn advance(&self) {}

    /// No more trials are run.
    fn end(&self) {}

    /// Something a person may want to know.
    fn note(&self, _line: &str) {}

    /// Something a person should know.
    fn warn(&self, _line: &str) {}

    /// Whether to stop between two trials; what is done is kept.
    fn is_asked_to_stop(&self) -> bool {
        false
    }

    /// The threads on which trials are run; those of the whole program where it gives none.
    fn threads(&self) -> Option<&ThreadPool> {
        None
    }

    /// A trial does not end although the study was asked to stop. All trials before it are stored: a program may end
    /// itself here, with this failure. Where it returns, the trial is waited for.
    fn give_up(&self, _failure: &Failure) {}
}

/// Nobody watches.
pub struct NoObserver;

impl Observer for NoObserver {}
