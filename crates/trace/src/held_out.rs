//! Does a term help where it was not fitted? On other records, or, where there are none, on parts of these that are
//! kept from the fit.

use identify::replay::Replay;
use nalgebra::DMatrix;
use rayon::prelude::*;
use ship::Response;
use trial::Trial;

use crate::fit::{Fit, Problem, whiten};
use crate::index::RecordNumber;
use crate::noise::Colour;
use crate::record::Record;
use crate::replay_errors::{self, Errors};
use crate::structure::Structure;

/// A record that is kept from the fit.
pub struct HeldOut<'a> {
    /// The trial.
    pub trial: &'a Trial,
    /// All of its rows.
    pub record: Record,
    /// Where its initial state may be.
    pub starts: Vec<[f64; 2]>,
}

impl<'a> HeldOut<'a> {
    /// Takes a trial; `starts` are initial states from which the best is looked for.
    pub fn new(trial: &'a Trial, starts: Vec<[f64; 2]>) -> Self {
        Self { trial, record: Record::whole(trial), starts }
    }

    /// Its rows averaged for a ship of the given 1/T, as those of the records that are fitted.
    pub fn averaged(&self, inverse_time: f64) -> Record {
        Record::averaged(self.trial, inverse_time.abs().recip())
    }

    /// Replay and errors of a response, looked for from the starts and another one; `None` when it is not finite.
    pub fn judge(&self, response: &Response, near: Option<[f64; 2]>) -> Option<(Replay, Errors)> {
        let starts: Vec<[f64; 2]> = self.starts.iter().copied().chain(near).collect();
        let replayed = replay_errors::full(response, &self.record, &starts)?;
        let errors = replay_errors::errors(self.trial, &self.record, response, &replayed);
        Some((replayed, errors))
    }
}

/// Errors of a fitted structure on every held-out record; `None` when a replay is not finite.
pub fn errors(held_out: &[HeldOut], structure: &Structure, fit: &Fit) -> Option<Vec<Errors>> {
    let response = portable(structure, &fit.theta);
    held_out.par_iter().map(|record| Some(record.judge(&response, None)?.1)).collect()
}

/// What of a fitted structure holds on other records: without terms that belong to the weather of one record.
pub fn portable(structure: &Structure, theta: &[f64]) -> Response {
    let (kept, values) = portable_structure(structure, theta);
    kept.response(RecordNumber(0), &values)
}

/// The same as a structure of one record with its parameters.
pub fn portable_structure(structure: &Structure, theta: &[f64]) -> (Structure, Vec<f64>) {
    let mut kept = structure.clone();
    let mut values = theta.to_vec();
    for place in structure.places().rev() {
        if kept.term(place).effect.is_of_time() {
            values = kept.drop_from(&values, place);
            kept = kept.without(place);
        }
    }
    if kept.own_bias {
        let mean = values[2..2 + kept.records].iter().sum::<f64>() / kept.records as f64;
        values.splice(2..2 + kept.records, [mean]);
        kept.own_bias = false;
    }
    kept.records = 1;
    (kept, values)
}

/// Covariance of the fitted parameters of [`portable_structure`], in order, from that of all fitted ones.
pub fn portable_covariance(problem: &Problem, structure: &Structure, covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let entries = problem.entries(structure);
    let mut place = 0..;
    // The place among the fitted ones of every entry that is.
    let places: Vec<Option<usize>> = entries.iter().map(|entry| entry.fitted.then(|| place.next()).flatten()).collect();
    // What is kept is a mean of some of them.
    let mut kept: Vec<&[Option<usize>]> = vec![&places[0..1], &places[1..2], &places[2..structure.base_count()]];
    for of in structure.places().filter(|&of| !structure.term(of).effect.is_of_time()) {
        kept.extend(places[structure.range(of)].chunks(1));
    }
    let kept: Vec<Vec<usize>> = kept
        .into_iter()
        .map(|places| places.iter().copied().flatten().collect::<Vec<usize>>())
        .filter(|places| !places.is_empty())
        .collect();
    DMatrix::from_fn(kept.len(), kept.len(), |i, j| {
        let pairs = kept[i].iter().flat_map(|&one| kept[j].iter().map(move |&other| covariance[(one, other)]));
        pairs.sum::<f64>() / (kept[i].len() * kept[j].len()) as f64
    })
}

/// How a model does against another one where neither was fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Error of the full replay, after over before.
    pub full: f64,
    /// Geometric mean of the ratios of full and restarted replays.
    pub mean: f64,
    /// The largest of them.
    pub largest: f64,
}

/// Ratio of the mean up to which an error counts as no worse: what the errors of the parameters themselves cost.
const MEAN_TOLERANCE: f64 = 1.01;

/// Ratio of the full replay beyond which good restarted replays are no excuse. It is wide because the full replay of a
/// course-unstable ship drifts with the smallest change of the model.
const FULL_TOLERANCE: f64 = 1.5;

/// Ratios below which a term is believed for its prediction alone.
const FULL_GAIN: f64 = 0.95;
const MEAN_GAIN: f64 = 0.9;

impl Comparison {
    /// Whether the second model is worse.
    pub fn is_worse(&self) -> bool {
        self.full > FULL_TOLERANCE || self.mean > MEAN_TOLERANCE
    }

    /// Whether the second model is better by more than errors of parameters could make it, and nowhere worse.
    pub fn is_much_better(&self) -> bool {
        self.full < FULL_GAIN && self.mean < MEAN_GAIN && self.largest <= MEAN_TOLERANCE
    }

    /// Compares errors over records, pooled row by row; restarted replays count where both models have them. `None`
    /// without a row.
    pub fn of(before: &[Errors], after: &[Errors]) -> Option<Self> {
        let pooled = |all: &[Errors], value: fn(&Errors) -> Option<f64>| {
            let mut square = 0.0;
            let mut rows = 0usize;
            for errors in all {
                square += value(errors)?.powi(2) * errors.rows as f64;
                rows += errors.rows;
            }
            (rows > 0).then(|| (square / rows as f64).sqrt())
        };
        let kinds: [fn(&Errors) -> Option<f64>; 3] = [|e| Some(e.heading), |e| e.horizon[0], |e| e.horizon[1]];
        let [full, short, long] = kinds.map(|kind| Some(ratio(pooled(before, kind)?, pooled(after, kind)?)));
        let full = full?;
        let ratios: Vec<f64> = [Some(full), short, long].into_iter().flatten().collect();
        // One endless ratio is not made good by another that is zero.
        let mean = match ratios.iter().any(|ratio| ratio.is_infinite()) {
            true => f64::INFINITY,
            false => (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp(),
        };
        let largest = ratios.iter().copied().fold(0.0, f64::max);
        Some(Self { full, mean, largest })
    }
}

/// After over before; two errors of zero are alike, and any error is endlessly worse than none.
fn ratio(before: f64, after: f64) -> f64 {
    if before == after { 1.0 } else { after / before }
}

/// Parts of the records that are kept from a fit in turn, as shares of their length.
const PARTS: [[f64; 2]; 2] = [[0.4, 0.7], [0.7, 1.0]];

/// Standard errors by which the squared error has to grow to count as worse.
const SIGNIFICANT: f64 = 2.0;

/// Whether a model predicts parts of its own records worse than a simpler one, each fitted to the rest: `true` when its
/// loss there ([`losses_on_parts`]) is larger by more than two standard errors.
pub fn is_worse_on_parts(problem: &Problem, simple: (&Structure, &Fit), rich: (&Structure, &Fit)) -> bool {
    match losses_on_parts(problem, &[simple, rich]).as_slice() {
        [simple, rich] => is_larger(rich, simple),
        _ => false,
    }
}

/// Losses of models on parts of the records that are kept from the fit in turn, each model fitted to the rest: for
/// every model a series for every part of every record.
///
/// The loss is what the fits were made for: the squared error of the replay, rad², or, where one of the models has a
/// random moment, −2 log of the density of every heading after those before it. A replay alone would ask a model to
/// foresee the moment.
pub fn losses_on_parts(problem: &Problem, models: &[(&Structure, &Fit)]) -> Vec<Vec<Vec<f64>>> {
    let random = models.iter().any(|(_, fit)| fit.colour.wander.is_some());
    let mut losses_of = vec![Vec::new(); models.len()];
    for part in PARTS {
        let kept: Vec<Record> = problem
            .records
            .iter()
            .map(|record| {
                let [from, to] = part.map(|share| record.time[0] + share * record.duration());
                record.without(from, if part[1] >= 1.0 { f64::INFINITY } else { to })
            })
            .collect();
        let fitted = problem.on(kept);
        for (all, (structure, start)) in losses_of.iter_mut().zip(models) {
            let fit = fitted.fit(structure, &start.theta, &start.initial, &start.colour);
            let residual = problem.residual(structure, &fit.theta, &fit.initial);
            let loss = match random {
                true => losses(problem, &residual, &fit.colour, fitted.variance(&fit)),
                false => squares(residual),
            };
            for (record, loss) in problem.records.iter().zip(loss) {
                let numbers = record.observed.iter().zip(loss).filter(|(row, _)| {
                    let share = (record.time[**row] - record.time[0]) / record.duration();
                    (part[0]..=part[1]).contains(&share)
                });
                all.push(numbers.map(|(_, loss)| loss).collect());
            }
        }
    }
    losses_of
}

/// Whether losses are larger than others on the same headings by more than two standard errors of the difference, or
/// no numbers.
pub fn is_larger(losses: &[Vec<f64>], than: &[Vec<f64>]) -> bool {
    let (mut differences, mut covariance) = (Vec::new(), 0.0);
    for (one, other) in losses.iter().zip(than) {
        let part: Vec<f64> = one.iter().zip(other).map(|(one, other)| one - other).collect();
        covariance += long_run(&part);
        differences.extend(part);
    }
    let sum: f64 = differences.iter().sum();
    !sum.is_finite() || sum > SIGNIFICANT * covariance.sqrt()
}

fn squares(mut residual: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    residual.iter_mut().flatten().for_each(|e| *e *= *e);
    residual
}

/// −2 log of the density of every heading after those before it, up to a constant.
fn losses(problem: &Problem, residual: &[Vec<f64>], colour: &Colour, variance: f64) -> Vec<Vec<f64>> {
    let whiteners = problem.whiteners(colour);
    let mut losses = squares(whiten(residual, &whiteners));
    for (losses, whitener) in losses.iter_mut().zip(&whiteners) {
        for (row, loss) in losses.iter_mut().enumerate() {
            *loss = *loss / variance + variance.ln() + whitener.log_variance_of(row);
        }
    }
    losses
}

/// Variance of the sum of a correlated series: windows of a tenth of it (Bartlett weights; Newey and West 1987).
fn long_run(series: &[f64]) -> f64 {
    let length = (series.len() / 10).max(1);
    let mean = series.iter().sum::<f64>() / series.len().max(1) as f64;
    let mut window = 0.0;
    let mut total = 0.0;
    for end in 0..series.len() + length - 1 {
        if let Some(entering) = series.get(end) {
            window += entering - mean;
        }
        if end >= length {
            window -= series[end - length] - mean;
        }
        total += window * window;
    }
    total / length as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(heading: f64, restarted: f64) -> Errors {
        Errors { heading, rows: 100, yaw_rate: None, overshoot: None, horizon: [Some(restarted), Some(restarted)] }
    }

    fn compared(before: (f64, f64), after: (f64, f64)) -> Comparison {
        Comparison::of(&[errors(before.0, before.1)], &[errors(after.0, after.1)]).expect("rows")
    }

    #[test]
    fn the_mean_is_that_of_full_and_restarted_replays() {
        let one = compared((1.0, 1.0), (0.5, 2.0));
        assert_eq!(one.full, 0.5);
        assert!((one.mean - 2f64.cbrt()).abs() < 1e-12);
        assert!(one.is_worse() && !one.is_much_better());
        assert!(compared((1.0, 1.0), (0.8, 0.8)).is_much_better());
        assert!(!compared((1.0, 1.0), (1.0, 1.0)).is_worse());
        let shorter_worse = compared((1.0, 1.0), (0.3, 1.05));
        assert!(!shorter_worse.is_worse() && !shorter_worse.is_much_better());
        assert!(compared((1.0, 1.0), (1.6, 0.1)).is_worse());
    }

    /// An error of zero is an error like any other.
    #[test]
    fn the_full_replay_decides_even_where_its_error_is_zero() {
        let worse = compared((0.0, 1.0), (1.0, 0.5));
        assert!(worse.full.is_infinite() && worse.is_worse() && !worse.is_much_better());
        assert_eq!(compared((0.0, 1.0), (0.0, 1.0)), Comparison { full: 1.0, mean: 1.0, largest: 1.0 });
        assert_eq!(compared((1.0, 1.0), (0.0, 0.0)), Comparison { full: 0.0, mean: 0.0, largest: 0.0 });
        assert!(compared((0.0, 1.0), (1.0, 0.0)).is_worse());
    }

    #[test]
    fn restarted_replays_that_one_model_lacks_do_not_count() {
        let without = Errors { horizon: [None, Some(1.0)], ..errors(1.0, 1.0) };
        let found = Comparison::of(&[without], &[errors(0.5, 0.5)]).expect("rows");
        assert!((found.mean - 0.5).abs() < 1e-12);
        assert_eq!(Comparison::of(&[], &[]), None);
    }

    /// A sum of independent numbers has the sum of their variances; one of ten that are alike each has ten times that.
    #[test]
    fn the_long_run_variance_knows_correlation() {
        let mut state = 1_u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1_u64 << 24) as f64 - 0.5
        };
        let independent: Vec<f64> = (0..2000).map(|_| draw()).collect();
        let alike: Vec<f64> = (0..2000).map(|k| independent[k / 10 * 10]).collect();
        let ratio = |series: &[f64]| long_run(series) / (2000.0 / 12.0);
        assert!((0.5..2.0).contains(&ratio(&independent)), "{}", ratio(&independent));
        assert!((2.5..20.0).contains(&ratio(&alike)), "{}", ratio(&alike));
    }
}
