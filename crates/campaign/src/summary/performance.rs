//! Summaries of methods: by cell, against the reference, and over all cells.

use crate::statistics::Statistic;

use super::detail::CellDetail;
use super::predictions::PredictionSummary;
use super::records::RecordSummary;
use super::tracing::TraceSummary;

/// Statistics of the relative errors of one index over trials: errors in %, shares from 0 to 1, `None` if undefined.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct IndexErrors {
    /// Mean estimate, SI units, with its normal interval.
    pub mean_estimate: Option<Statistic>,
    /// Mean error, %.
    pub mean: Option<Statistic>,
    /// Median error, %.
    pub median: Option<Statistic>,
    /// Standard deviation of the errors, %.
    pub sd: Option<Statistic>,
    /// Root mean square error, %.
    pub rms: Option<Statistic>,
    /// Median absolute deviation from the median, not scaled to a standard deviation, %.
    pub mad: Option<Statistic>,
    /// 2.5, 25, 75 and 97.5 % quantiles of the error, %.
    pub quantiles: [Option<Statistic>; 4],
    /// Median absolute error, %.
    pub median_absolute_error: Option<Statistic>,
    /// 90 % quantile of the absolute error, %.
    pub absolute_error_p90: Option<Statistic>,
    /// Coverage of the quoted 95 % intervals.
    pub coverage: Option<Statistic>,
    /// Median width of the quoted 95 % intervals, relative to the truth, %.
    pub median_interval_width: Option<Statistic>,
    /// Share of estimates with an interval.
    pub share_with_interval: Option<Statistic>,
    /// Ratio of the standard deviation of the errors to the Cramér–Rao bound, of which the root mean square over trials
    /// is taken.
    pub sd_over_bound: Option<Statistic>,
}

/// Performance of one method on a set of trials.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MethodPerformance {
    /// Number of trials run.
    pub trials: u64,
    /// Reasons for missing estimates, with counts, in order of first occurrence; at most 50.
    pub failure_counts: Vec<(String, u64)>,
    /// Share of trials without an estimate.
    pub failure_rate: Option<Statistic>,
    /// Errors of K.
    pub k: IndexErrors,
    /// Errors of T.
    pub t: IndexErrors,
    /// Errors of K/T, without intervals and a mean estimate.
    pub k_over_t: IndexErrors,
    /// Median over trials of the heading error of the replay on the trial itself, deg.
    pub heading_rmse_deg: Option<Statistic>,
    /// Median heading error on the validation manoeuvre, deg.
    pub validation_rmse_deg: Option<Statistic>,
    /// 90 % quantile of the heading error on the validation manoeuvre, deg.
    pub validation_rmse_p90_deg: Option<Statistic>,
    /// Mean number of model evaluations per estimate; `None` without an estimate.
    pub mean_evaluations: Option<f64>,
}

impl MethodPerformance {
    /// Number of failed trials.
    pub fn failed(&self) -> u64 {
        self.failure_counts.iter().map(|(_, count)| count).sum()
    }
}

/// Performance of one method in one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodSummary {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method.
    pub method: usize,
    /// Performance of the method.
    pub performance: MethodPerformance,
}

/// Comparison of one index of one method with the reference, on trials with an estimate of both.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ErrorComparison {
    /// Difference of the rms errors, %; negative if the method is better.
    pub rms_difference: Option<Statistic>,
    /// Ratio of the rms errors, method over reference.
    pub rms_ratio: Option<Statistic>,
    /// Share of trials in which the error of the method is smaller; ties count half.
    pub smaller_error_share: Option<Statistic>,
}

/// Comparison of one method with the reference method in one cell.
#[derive(Debug, Clone, PartialEq)]
pub struct ReferenceComparison {
    /// Index of the cell.
    pub cell: usize,
    /// Index of the method.
    pub method: usize,
    /// Number of trials with an estimate of both.
    pub trials: u64,
    /// Errors of K.
    pub k: ErrorComparison,
    /// Errors of T.
    pub t: ErrorComparison,
}

/// Summary of a study.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Summary {
    /// Summaries per cell and method, in the order of the rows.
    pub methods: Vec<MethodSummary>,
    /// Comparisons per cell and method other than the reference.
    pub comparisons: Vec<ReferenceComparison>,
    /// Index of the reference method.
    pub reference: usize,
    /// Performance per method, over all cells.
    pub overall: Vec<MethodPerformance>,
    /// Error distributions of the cells shown in detail.
    pub details: Vec<CellDetail>,
    /// Summaries of traces, by cell and method.
    pub tracing: Vec<TraceSummary>,
    /// Coverage of predictions, in studies that predict manoeuvres.
    pub predictions: Vec<PredictionSummary>,
    /// Replay errors, in studies of measured records.
    pub records: Vec<RecordSummary>,
}

impl Summary {
    /// Performance of a method in a cell; `None` for a cell without rows.
    pub fn performance(&self, cell: usize, method: usize) -> Option<&MethodPerformance> {
        let key = |summary: &MethodSummary| (summary.cell, summary.method);
        let place = self.methods.binary_search_by_key(&(cell, method), key).ok()?;
        Some(&self.methods[place].performance)
    }
}
