//! Tally of rows: running sums, and the summary computed from them.

use std::sync::Arc;

use rayon::prelude::*;

use super::detail::{CellDetail, ErrorDensity, JointErrors, MAX_PAIRS, MethodDetail};
use super::performance::{
    ErrorComparison, IndexErrors, MethodPerformance, MethodSummary, ReferenceComparison, Summary,
};
use super::predictions::{PredictionSummary, add_predictions};
use super::tracing::TraceTally;
use crate::design::{CellFacts, Design};
use crate::rows::StudyRow;
use crate::scenario::MethodName;
use crate::statistics::{
    BATCH_COUNT, ErrorSample, ErrorSums, NORMAL_QUANTILE_95, PairedErrorSums, Resamples, Statistic, wilson_share,
};

/// Label, or else id, of the reference method; in a study without it, the first method is the reference.
const REFERENCE: &str = "output-error";

/// Tally of rows, which are added in order, cell by cell.
pub struct Tally<'a> {
    design: &'a Design,
    detailed: Vec<usize>,
    cell: usize,
    replicate: u64,
    present: Vec<MethodTally>,
    overall: Vec<MethodTally>,
    resamples: Option<Arc<Resamples>>,
    /// Complete cells that are not yet summarised.
    waiting: Vec<ClosedCell>,
    summary: Summary,
}

/// Maximum number of rows in cells that wait for parallel summaries: large for efficiency, small for bounded
/// memory.
const MAX_WAITING_ROWS: u64 = 1 << 15;

/// Sums of a complete cell.
struct ClosedCell {
    cell: usize,
    present: Vec<MethodTally>,
    resamples: Arc<Resamples>,
}

impl<'a> Tally<'a> {
    /// Tally of the rows of a design.
    pub fn new(design: &'a Design) -> Self {
        let find = |is_reference: fn(&MethodName) -> bool| design.methods.iter().position(is_reference);
        let reference = find(|method| method.label == REFERENCE).or_else(|| find(|method| method.id == REFERENCE));
        let running = vec![MethodTally::default(); design.methods.len()];
        Self {
            design,
            detailed: design.detailed_cells(),
            cell: 0,
            replicate: 0,
            present: running.clone(),
            overall: running,
            resamples: None,
            waiting: Vec::new(),
            summary: Summary { reference: reference.unwrap_or(0), ..Summary::default() },
        }
    }

    /// Adds a row.
    pub fn add(&mut self, row: &StudyRow) {
        let cell = row.cell as usize;
        if (cell, row.replicate) != (self.cell, self.replicate) {
            self.end_trial();
            self.replicate = row.replicate;
        }
        if cell != self.cell {
            self.end_cell();
            self.cell = cell;
        }
        let errors = row.errors().map(|error| error.map(|error| 100.0 * error));
        let running = &mut self.present[row.method];
        running.add(row, &errors);
        running.add_details(row, &self.design.cells[cell], self.detailed.contains(&cell));
        // Batches span all cells: equal replicates of different cells may share a ship.
        self.overall[row.method].add(row, &errors);
    }

    /// Adds the errors of the finished trial to the comparisons with the reference.
    fn end_trial(&mut self) {
        let reference = self.present[self.summary.reference].latest;
        for running in &mut self.present {
            let errors = std::mem::take(&mut running.latest).into_iter().zip(reference);
            for (pair, (error, other)) in running.pairs.iter_mut().zip(errors) {
                error.zip(other).into_iter().for_each(|(error, other)| pair.add(self.replicate, error, other));
            }
        }
    }

    fn end_cell(&mut self) {
        if self.present.iter().all(|running| running.trials == 0) {
            return;
        }
        let resamples = self.resamples(most_batches(&self.present));
        let present = std::mem::replace(&mut self.present, vec![MethodTally::default(); self.overall.len()]);
        self.waiting.push(ClosedCell { cell: self.cell, present, resamples });
        let rows = self.waiting.iter().flat_map(|closed| &closed.present).map(|running| running.trials);
        if rows.sum::<u64>() >= MAX_WAITING_ROWS {
            self.summarise();
        }
    }

    /// Summarises the waiting cells in parallel; results are appended in order.
    fn summarise(&mut self) {
        let (reference, detailed) = (self.summary.reference, &self.detailed);
        let waiting = std::mem::take(&mut self.waiting).into_par_iter();
        let summarised = waiting.map(|closed| closed.summarised(reference, detailed)).collect::<Vec<Summary>>();
        for Summary { methods, comparisons, details, tracing, predictions, .. } in summarised {
            self.summary.methods.extend(methods);
            self.summary.comparisons.extend(comparisons);
            self.summary.details.extend(details);
            self.summary.tracing.extend(tracing);
            self.summary.predictions.extend(predictions);
        }
    }

    /// Resamples of `batches` batches, shared by all cells of one size.
    fn resamples(&mut self, batches: usize) -> Arc<Resamples> {
        match &self.resamples {
            Some(resamples) if resamples.batches() == batches => Arc::clone(resamples),
            _ => Arc::clone(self.resamples.insert(Arc::new(Resamples::new(batches)))),
        }
    }

    /// Summary of all rows.
    pub fn finish(mut self) -> Summary {
        self.end_trial();
        self.end_cell();
        self.summarise();
        let resamples = self.resamples(most_batches(&self.overall));
        let overall = self.overall.par_iter().map(|running| running.performance(&resamples)).collect();
        Summary { overall, ..self.summary }
    }
}

/// Summary of rows in memory.
pub fn summarise(rows: &[StudyRow], design: &Design) -> Summary {
    let mut tally = Tally::new(design);
    rows.iter().for_each(|row| tally.add(row));
    tally.finish()
}

impl ClosedCell {
    /// Summary of the cell: methods, comparisons with the reference, and distributions if requested.
    fn summarised(self, reference: usize, detailed: &[usize]) -> Summary {
        let Self { cell, present, resamples } = self;
        let methods = present.par_iter().enumerate();
        let compared_methods = methods.clone().filter(|(method, _)| *method != reference);
        let compared = compared_methods.map(|(method, running)| {
            let [k, t] = running.pairs.each_ref().map(|pair| comparison(pair, &resamples));
            ReferenceComparison { cell, method, trials: running.pairs[0].trial_count(), k, t }
        });
        let detail = || CellDetail { cell, methods: present.par_iter().map(MethodTally::detail).collect() };
        Summary {
            comparisons: compared.collect(),
            methods: methods
                .map(|(method, running)| MethodSummary { cell, method, performance: running.performance(&resamples) })
                .collect(),
            details: detailed.contains(&cell).then(detail).into_iter().collect(),
            tracing: present.iter().filter_map(|running| running.trace.as_ref()).map(TraceTally::summary).collect(),
            predictions: present.iter().flat_map(|running| running.predictions.clone()).collect(),
            ..Summary::default()
        }
    }
}

fn most_batches(methods: &[MethodTally]) -> usize {
    methods.iter().map(|running| running.batches).max().unwrap_or(0)
}

fn comparison(pair: &PairedErrorSums, resamples: &Resamples) -> ErrorComparison {
    let [rms_difference, rms_ratio] = resamples
        .bootstrap(pair.batches(), |total| [PairedErrorSums::rms_difference(total), PairedErrorSums::rms_ratio(total)]);
    ErrorComparison {
        rms_difference,
        rms_ratio,
        smaller_error_share: wilson_share(pair.smaller_error_count.round() as u64, pair.trial_count()),
    }
}

/// Running sums of one method.
#[derive(Debug, Clone, Default)]
struct MethodTally {
    trials: u64,
    /// Number of batches with a trial, failed trials included.
    batches: usize,
    failures: Vec<(String, u64)>,
    /// Error sums of K, T and K/T.
    indices: [IndexSums; 3],
    /// Errors of K and T on the current trial, %.
    latest: [Option<f64>; 2],
    /// Paired sums of the errors of K and T, method and reference.
    pairs: [PairedErrorSums; 2],
    heading: ErrorSample,
    validation: ErrorSample,
    evaluations: f64,
    cloud: Vec<(f64, f64)>,
    trace: Option<TraceTally>,
    predictions: Vec<PredictionSummary>,
}

/// Maximum number of distinct reasons; a reason may contain numbers from its trial.
const MAX_REASONS: usize = 50;

impl MethodTally {
    fn add(&mut self, row: &StudyRow, errors: &[Option<f64>; 3]) {
        self.trials += 1;
        self.batches = self.batches.max((row.replicate as usize % BATCH_COUNT) + 1);
        if let Some(reason) = row.failure.as_deref() {
            self.failed(reason);
        }
        let [k, t] = row.true_indices();
        let truths = [k, t, k.zip(t).map(|(k, t)| k / t)];
        let intervals = [row.k_ci95_per_s, row.t_ci95_s, None];
        let answers = [row.k_per_s, row.t_s, None];
        // The Cramér–Rao bound is undefined for a base with effects.
        let bound = row.cramer_rao_sd.filter(|_| row.traced.is_none() || row.base_k_per_s.is_none());
        for (place, index) in self.indices.iter_mut().enumerate() {
            let truth = truths[place];
            let bound = bound.zip(truth).map(|(sd, truth)| 100.0 * sd[place] / truth.abs());
            let error = |end: f64, truth: f64| 100.0 * (end - truth) / truth.abs();
            let interval = intervals[place].zip(truth).map(|(ends, truth)| ends.map(|end| error(end, truth)));
            index.add(row.replicate, errors[place], bound, interval, answers[place]);
        }
        row.heading_rmse_deg.into_iter().for_each(|error| self.heading.add(error));
        row.validation_rmse_deg.into_iter().for_each(|error| self.validation.add(error));
        self.evaluations += row.evaluations.unwrap_or(0.0);
        self.latest = [errors[0], errors[1]];
    }

    /// Adds the values that are not summed over all cells.
    fn add_details(&mut self, row: &StudyRow, cell: &CellFacts, detailed: bool) {
        if let Some(answer) = &row.traced {
            self.trace.get_or_insert_with(|| TraceTally::new(row, cell)).add(answer);
        }
        add_predictions(&mut self.predictions, row, cell.length_over_speed_s);
        if let [Some(k), Some(t)] = self.latest
            && detailed
            && self.cloud.len() < MAX_PAIRS
        {
            self.cloud.push((k, t));
        }
    }

    fn failed(&mut self, reason: &str) {
        let failures = &mut self.failures;
        let last = failures.len().saturating_sub(1);
        match failures.iter().position(|(counted, _)| counted == reason) {
            Some(place) => failures[place].1 += 1,
            None if failures.len() < MAX_REASONS => failures.push((reason.to_owned(), 1)),
            None => failures[last] = ("other reasons".to_owned(), failures[last].1 + 1),
        }
    }

    fn performance(&self, resamples: &Resamples) -> MethodPerformance {
        let failed: u64 = self.failures.iter().map(|(_, count)| count).sum();
        let (heading, validation) = (self.heading.ordered(), self.validation.ordered());
        let answered = self.trials - failed;
        let [k, t, k_over_t] = self.indices.each_ref().map(|index| index.errors(resamples));
        MethodPerformance {
            trials: self.trials,
            failure_counts: self.failures.clone(),
            failure_rate: wilson_share(failed, self.trials),
            k,
            t,
            k_over_t,
            heading_rmse_deg: heading.quantile_statistic(0.5),
            validation_rmse_deg: validation.quantile_statistic(0.5),
            validation_rmse_p90_deg: validation.quantile_statistic(0.9),
            mean_evaluations: (answered > 0).then(|| self.evaluations / answered as f64),
        }
    }

    fn detail(&self) -> MethodDetail {
        let [k, t, _] = self.indices.each_ref().map(|index| ErrorDensity::from_errors(&index.sample.ordered()));
        MethodDetail { k_errors: k, t_errors: t, joint_errors: JointErrors::from_pairs(&self.cloud) }
    }
}

/// Running sums of the estimates of K, T or K/T: their errors, bounds and quoted intervals.
#[derive(Debug, Clone, Default)]
struct IndexSums {
    sample: ErrorSample,
    sums: ErrorSums,
    /// First estimate, and sums of the differences from it and of their squares; `None` without an estimate.
    answers: Option<(f64, [f64; 2])>,
    /// Sum of the squared bounds, %², and their number.
    bounds: (f64, f64),
    answered: u64,
    /// Widths of the quoted intervals, %.
    widths: ErrorSample,
    quoted: u64,
    held: u64,
}

impl IndexSums {
    /// Adds the error of a trial, its bound and the errors of the interval ends, all in %, and the estimate itself.
    fn add(
        &mut self,
        replicate: u64,
        error: Option<f64>,
        bound: Option<f64>,
        interval: Option<[f64; 2]>,
        value: Option<f64>,
    ) {
        if let Some(error) = error {
            self.sample.add(error);
            self.sums.add(replicate, error);
        }
        if let Some(bound) = bound {
            self.bounds.0 += bound * bound;
            self.bounds.1 += 1.0;
        }
        if let Some(value) = value {
            let (first, [sum, square]) = self.answers.get_or_insert((value, [0.0; 2]));
            let away = value - *first;
            (*sum, *square) = (*sum + away, *square + away * away);
            self.answered += 1;
        }
        if let Some([low, high]) = interval {
            self.quoted += 1;
            self.held += u64::from(low <= 0.0 && 0.0 <= high);
            self.widths.add(high - low);
        }
    }

    /// Mean estimate; with an interval for two estimates or more.
    fn mean_estimate(&self) -> Option<Statistic> {
        let (first, [sum, square]) = self.answers?;
        let count = self.answered as f64;
        let value = first + sum / count;
        let half = NORMAL_QUANTILE_95 * ((square - sum * sum / count).max(0.0) / (count - 1.0) / count).sqrt();
        Some(Statistic { value, ci95: half.is_finite().then_some([value - half, value + half]) })
    }

    fn errors(&self, resamples: &Resamples) -> IndexErrors {
        let ordered = self.sample.ordered();
        let absolute_errors = ordered.absolute_deviations(0.0);
        let sums = &self.sums;
        let [mean, sd, rms] =
            resamples.bootstrap(sums.batches(), |total| [sums.mean(total), sums.sd(total), sums.rms(total)]);
        let (squares, count) = self.bounds;
        let bound = (count > 0.0 && squares > 0.0).then(|| (squares / count).sqrt());
        IndexErrors {
            mean_estimate: self.mean_estimate(),
            mean,
            median: ordered.quantile_statistic(0.5),
            sd,
            rms,
            mad: ordered.mad(),
            quantiles: [0.025, 0.25, 0.75, 0.975].map(|p| ordered.quantile_statistic(p)),
            median_absolute_error: absolute_errors.quantile_statistic(0.5),
            absolute_error_p90: absolute_errors.quantile_statistic(0.9),
            coverage: wilson_share(self.held, self.quoted),
            median_interval_width: self.widths.ordered().quantile_statistic(0.5),
            share_with_interval: if self.quoted > 0 { wilson_share(self.quoted, self.answered) } else { None },
            sd_over_bound: sd.zip(bound).map(|(sd, bound)| sd.times(1.0 / bound)),
        }
    }
}
