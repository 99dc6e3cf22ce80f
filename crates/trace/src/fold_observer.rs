//! Observer of the leave-one-out folds of a long analysis.

/// Observer of the leave-one-out folds of an analysis of several records, which follow its main result.
pub trait FoldObserver: Sync {
    /// Start of the leave-one-out folds, after the main result; the argument is their number.
    fn begin_folds(&self, _count: usize) {}

    /// End of one fold.
    fn end_fold(&self) {}

    /// `true` if the folds should stop; [`Analysis::leave_one_out`](crate::Analysis::leave_one_out) is then empty.
    fn should_stop(&self) -> bool {
        false
    }
}

/// Observer without action.
pub(crate) struct NoFoldObserver;

impl FoldObserver for NoFoldObserver {}
