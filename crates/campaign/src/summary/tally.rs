//! Running sums over rows, and the summary they end in.

use std::sync::Arc;

use rayon::prelude::*;

use super::detail::{CellDetail, MOST_PAIRS, MethodDetail};
use super::predictions::PredictionTally;
use super::record::{Comparison, Errors, MethodSummary, Overall, PairSummary, Record, Summary};
use super::tracing::TraceTally;
use crate::design::Design;
use crate::rows::Row;
use crate::statistics::{BATCHES, PairSums, Resamples, Sample, Statistic, Sums, Z95, share};

/// The method that others are compared with, where a study has it.
const REFERENCE: &str = "output-error";

/// Takes rows in their order, cell by cell, and summarises them.
pub struct Tally {
    reference: usize,
    detailed: Vec<usize>,
    cell: usize,
    present: Vec<Running>,
    pairs: Vec<[PairSums; 2]>,
    /// Errors of K and T of the reference on the present trial, and which trial that is.
    trial: Trial,
    overall: Vec<Running>,
    resamples: Option<Arc<Resamples>>,
    /// Cells that have ended and are not yet summarised.
    waiting: Vec<Ended>,
    methods: Vec<MethodSummary>,
    compared: Vec<PairSummary>,
    details: Vec<CellDetail>,
    tracing: TraceTally,
    predictions: PredictionTally,
}

/// Trials times methods of cells that wait to be summarised together, on all threads: enough to be worth it, few enough
/// that memory does not grow with the design.
const WAITING: u64 = 1 << 15;

/// Errors of all methods on one trial.
#[derive(Default)]
struct Trial {
    replicate: u64,
    errors: Vec<[Option<f64>; 2]>,
}

impl Tally {
    /// A tally of the rows of a design.
    pub fn new(design: &Design) -> Self {
        let methods = design.methods.len();
        let labelled = design.methods.iter().position(|method| method.label == REFERENCE);
        let reference =
            labelled.or_else(|| design.methods.iter().position(|method| method.id == REFERENCE)).unwrap_or(0);
        Self {
            reference,
            detailed: design.detail(),
            cell: 0,
            present: vec![Running::default(); methods],
            pairs: vec![Default::default(); methods],
            trial: Trial { replicate: 0, errors: vec![[None; 2]; methods] },
            overall: vec![Running::default(); methods],
            resamples: None,
            waiting: Vec::new(),
            methods: Vec::new(),
            compared: Vec::new(),
            details: Vec::new(),
            tracing: TraceTally::new(design),
            predictions: PredictionTally::default(),
        }
    }

    /// Takes note of a row.
    pub fn add(&mut self, row: &Row) {
        let cell = row.cell as usize;
        if cell != self.cell || row.replicate != self.trial.replicate {
            self.end_trial();
            self.trial.replicate = row.replicate;
        }
        if cell != self.cell {
            self.end_cell();
            self.cell = cell;
        }
        let errors = [row.k_error(), row.t_error(), row.k_over_t_error()].map(|error| error.map(|error| 100.0 * error));
        self.tracing.add(row);
        self.predictions.add(row);
        self.trial.errors[row.method] = [errors[0], errors[1]];
        let detailed = self.detailed.contains(&cell);
        self.present[row.method].add(row, row.replicate, &errors, detailed);
        // Batches over all cells: a replicate of one cell goes with the same of another, since they may share a ship.
        self.overall[row.method].add(row, row.replicate, &errors, false);
    }

    /// Compares all methods with the reference on the trial that has just been seen.
    fn end_trial(&mut self) {
        let reference = self.trial.errors[self.reference];
        for (pairs, errors) in self.pairs.iter_mut().zip(&self.trial.errors) {
            for (pair, (error, other)) in pairs.iter_mut().zip(errors.iter().zip(reference)) {
                if let (Some(error), Some(other)) = (error, other) {
                    pair.add(self.trial.replicate, *error, other);
                }
            }
        }
        self.trial.errors.fill([None; 2]);
    }

    fn end_cell(&mut self) {
        let (cell, reference) = (self.cell, self.reference);
        if self.present.iter().all(|running| running.trials == 0) {
            return;
        }
        let resamples = self.resamples(most_batches(&self.present));
        let present = std::mem::replace(&mut self.present, vec![Running::default(); self.overall.len()]);
        let pairs = std::mem::replace(&mut self.pairs, vec![Default::default(); self.overall.len()]);
        let detailed = self.detailed.contains(&cell);
        self.waiting.push(Ended { cell, reference, detailed, present, pairs, resamples });
        let rows = self.waiting.iter().flat_map(|ended| &ended.present).map(|running| running.trials);
        if rows.sum::<u64>() >= WAITING {
            self.summarise();
        }
    }

    /// Summarises the cells that wait, in parallel; what is said of each goes down in their order.
    fn summarise(&mut self) {
        let summarised: Vec<_> = std::mem::take(&mut self.waiting).into_par_iter().map(Ended::summarised).collect();
        for (methods, compared, detail) in summarised {
            self.methods.extend(methods);
            self.compared.extend(compared);
            self.details.extend(detail);
        }
    }

    /// Resamples of so many batches; the same for all cells of one size.
    fn resamples(&mut self, batches: usize) -> Arc<Resamples> {
        match &self.resamples {
            Some(known) if known.batches() == batches => Arc::clone(known),
            _ => Arc::clone(self.resamples.insert(Arc::new(Resamples::new(batches)))),
        }
    }

    /// Ends the tally.
    pub fn finish(mut self) -> Summary {
        self.end_trial();
        self.end_cell();
        self.summarise();
        let resamples = self.resamples(most_batches(&self.overall));
        let overall = self.overall.par_iter().map(|running| running.overall(&resamples));
        Summary {
            overall: overall.collect(),
            methods: self.methods,
            pairs: self.compared,
            reference: self.reference,
            details: self.details,
            tracing: self.tracing.finish(),
            predictions: self.predictions.finish(),
        }
    }
}

/// Summarises rows that are in memory.
pub fn summarise(rows: &[Row], design: &Design) -> Summary {
    let mut tally = Tally::new(design);
    rows.iter().for_each(|row| tally.add(row));
    tally.finish()
}

/// The sums of a cell that has ended.
struct Ended {
    cell: usize,
    reference: usize,
    detailed: bool,
    present: Vec<Running>,
    pairs: Vec<[PairSums; 2]>,
    resamples: Arc<Resamples>,
}

impl Ended {
    /// What is said of the cell: every method, every method against the reference, and the distributions where asked
    /// for.
    fn summarised(self) -> (Vec<MethodSummary>, Vec<PairSummary>, Option<CellDetail>) {
        let Self { cell, reference, detailed, present, pairs, resamples } = self;
        let detail = detailed.then(|| CellDetail {
            cell,
            methods: present.par_iter().map(Running::detail).collect::<Vec<MethodDetail>>(),
        });
        let methods = present.par_iter().enumerate().map(|(method, running)| MethodSummary {
            cell,
            method,
            record: running.record(&resamples),
        });
        let others = pairs.par_iter().enumerate().filter(|(method, _)| *method != reference);
        let compared = others.map(|(method, [k, t])| PairSummary {
            cell,
            method,
            trials: k.batches().iter().map(|batch| batch.count).sum::<f64>() as u64,
            k: comparison(k, &resamples),
            t: comparison(t, &resamples),
        });
        (methods.collect(), compared.collect(), detail)
    }
}

fn most_batches(methods: &[Running]) -> usize {
    methods.iter().map(|running| running.batches).max().unwrap_or(0)
}

fn comparison(pair: &PairSums, resamples: &Resamples) -> Comparison {
    let [rms_difference, rms_ratio] =
        resamples.figures(pair.batches(), |total| [PairSums::difference(total), PairSums::ratio(total)]);
    let trials = pair.batches().iter().map(|batch| batch.count).sum::<f64>();
    Comparison { rms_difference, rms_ratio, closer: share(pair.smaller.round() as u64, trials as u64) }
}

/// Running sums of one method.
#[derive(Debug, Clone, Default)]
struct Running {
    trials: u64,
    /// Batches that hold a trial, whether it was answered or not.
    batches: usize,
    failures: Vec<(String, u64)>,
    k: Index,
    t: Index,
    k_over_t: Index,
    heading: Sample,
    validation: Sample,
    evaluations: f64,
    pairs: Vec<(f64, f64)>,
}

/// Reasons that are told apart; a reason may hold numbers of its trial.
const MOST_REASONS: usize = 50;

impl Running {
    fn add(&mut self, row: &Row, replicate: u64, errors: &[Option<f64>; 3], detailed: bool) {
        self.trials += 1;
        self.batches = self.batches.max((replicate as usize % BATCHES) + 1);
        if let Some(reason) = row.failure.as_deref() {
            count_reason(&mut self.failures, reason);
        }
        let bound = |sd: Option<f64>, truth: Option<f64>| Some(100.0 * sd? / truth?.abs());
        let [k, t] = row.truth();
        let best = row.bound_of_truth();
        let ratio = k.zip(t).map(|(k, t)| k / t);
        self.k.add(replicate, errors[0], bound(best.map(|b| b.k_per_s), k), holds(row.k_ci95_per_s, k), row.k_per_s);
        self.t.add(replicate, errors[1], bound(best.map(|b| b.t_s), t), holds(row.t_ci95_s, t), row.t_s);
        self.k_over_t.add(replicate, errors[2], bound(best.map(|b| b.k_over_t_per_s2), ratio), None, None);
        row.heading_rmse_deg.into_iter().for_each(|error| self.heading.add(error));
        row.validation_rmse_deg.into_iter().for_each(|error| self.validation.add(error));
        self.evaluations += row.evaluations.unwrap_or(0) as f64;
        if let [Some(k), Some(t), _] = errors
            && detailed
            && self.pairs.len() < MOST_PAIRS
        {
            self.pairs.push((*k, *t));
        }
    }

    fn record(&self, resamples: &Resamples) -> Record {
        let failed: u64 = self.failures.iter().map(|(_, count)| count).sum();
        let (heading, validation) = (self.heading.ordered(), self.validation.ordered());
        let answered = self.trials - failed;
        Record {
            trials: self.trials,
            failures: self.failures.clone(),
            failure_rate: share(failed, self.trials),
            k: self.k.errors(resamples),
            t: self.t.errors(resamples),
            k_over_t: self.k_over_t.errors(resamples),
            heading_rmse_deg: heading.figure(0.5),
            validation_rmse_deg: validation.figure(0.5),
            high_validation_rmse_deg: validation.figure(0.9),
            evaluations: (answered > 0).then(|| self.evaluations / answered as f64),
        }
    }

    fn overall(&self, resamples: &Resamples) -> Overall {
        let detail = MethodDetail::of_all_cells(&self.k.sample.ordered(), &self.t.sample.ordered(), self.trials);
        Overall { record: self.record(resamples), detail }
    }

    fn detail(&self) -> MethodDetail {
        MethodDetail::of(&self.k.sample.ordered(), &self.t.sample.ordered(), self.trials, &self.pairs)
    }
}

fn count_reason(failures: &mut Vec<(String, u64)>, reason: &str) {
    let known = failures.iter().position(|(known, _)| known == reason);
    let last = failures.len().saturating_sub(1);
    match known {
        Some(known) => failures[known].1 += 1,
        None if failures.len() < MOST_REASONS => failures.push((reason.to_owned(), 1)),
        None => failures[last] = ("other reasons".to_owned(), failures[last].1 + 1),
    }
}

/// Whether an interval holds the truth.
fn holds(interval: Option<[f64; 2]>, truth: Option<f64>) -> Option<bool> {
    let ([low, high], truth) = (interval?, truth?);
    Some(low <= truth && truth <= high)
}

/// Running sums of the errors of one index.
#[derive(Debug, Clone, Default)]
struct Index {
    sample: Sample,
    sums: Sums,
    /// Sums of the answers less the first of them, and of their squares, after that first one.
    answers: Option<(f64, [f64; 2])>,
    /// Sum of the squared bounds, per cent, and their number.
    bounds: (f64, f64),
    answered: u64,
    quoted: u64,
    held: u64,
}

impl Index {
    fn add(&mut self, replicate: u64, error: Option<f64>, bound: Option<f64>, held: Option<bool>, value: Option<f64>) {
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
        self.quoted += u64::from(held.is_some());
        self.held += u64::from(held == Some(true));
    }

    /// The mean of the answers; its interval from two of them on.
    fn answer(&self) -> Option<Statistic> {
        let (first, [sum, square]) = self.answers?;
        let count = self.answered as f64;
        let value = first + sum / count;
        let half = Z95 * ((square - sum * sum / count).max(0.0) / (count - 1.0) / count).sqrt();
        Some(Statistic { value, ci95: half.is_finite().then_some([value - half, value + half]) })
    }

    fn errors(&self, resamples: &Resamples) -> Errors {
        let ordered = self.sample.ordered();
        let sizes = ordered.distances(0.0);
        let sums = &self.sums;
        let [mean, sd, rms] =
            resamples.figures(sums.batches(), |total| [sums.mean(total), sums.sd(total), sums.rms(total)]);
        let (squares, count) = self.bounds;
        let bound = (count > 0.0 && squares > 0.0).then(|| (squares / count).sqrt());
        let over = |sd: Statistic, bound: f64| sd.times(1.0 / bound);
        Errors {
            answer: self.answer(),
            mean,
            median: ordered.figure(0.5),
            sd,
            rms,
            mad: ordered.mad(),
            quantiles: [0.025, 0.25, 0.75, 0.975].map(|p| ordered.figure(p)),
            median_size: sizes.figure(0.5),
            high_size: sizes.figure(0.9),
            coverage: share(self.held, self.quoted),
            quoting: if self.quoted > 0 { share(self.quoted, self.answered) } else { None },
            sd_over_bound: sd.zip(bound).map(|(sd, bound)| over(sd, bound)),
        }
    }
}
