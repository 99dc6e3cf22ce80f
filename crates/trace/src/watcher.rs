//! Who waits for a long analysis.

/// Who waits for an analysis of several records, which goes on for long after its result is there.
pub trait Watcher: Sync {
    /// The result is there; every one of so many records is now looked at as if it had been held out.
    fn begin_folds(&self, _count: usize) {}

    /// One of them is done.
    fn end_fold(&self) {}

    /// Whether to do without; then no record is [left out](crate::Analysis::left_out).
    fn is_asked_to_stop(&self) -> bool {
        false
    }
}

/// Nobody waits.
pub(crate) struct NoWatcher;

impl Watcher for NoWatcher {}
