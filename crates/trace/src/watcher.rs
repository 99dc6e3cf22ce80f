//! Observer of the leave-one-out folds of a long analysis.

/// Observer of an analysis of several records: its leave-one-out folds take long after the main result is known.
pub trait Watcher: Sync {
    /// The main result is known; `_count` leave-one-out folds begin.
    fn begin_folds(&self, _count: usize) {}

    /// One fold is done.
    fn end_fold(&self) {}

    /// `true` if to stop; [`Analysis::left_out`](crate::Analysis::left_out) is then empty.
    fn is_asked_to_stop(&self) -> bool {
        false
    }
}

/// Observer that does nothing.
pub(crate) struct NoWatcher;

impl Watcher for NoWatcher {}
