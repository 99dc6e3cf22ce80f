//! Does a term help where it was not fitted? On other records, or, where there are none, on parts of these that are kept
//! from the fit.

use rayon::prelude::*;
use ship::Response;
use trial::Trial;

use crate::errors::{self, Errors, Replayed};
use crate::fit::{Fit, Problem};
use crate::record::Record;
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

    /// Replay and errors of a response; `None` when it is not finite.
    pub fn judge(&self, response: &Response) -> Option<(Replayed, Errors)> {
        let replayed = errors::full(response, &self.record, &self.starts)?;
        let errors = errors::errors(self.trial, &self.record, response, &replayed);
        Some((replayed, errors))
    }
}

/// Errors of a fitted structure on every held-out record; `None` when a replay is not finite.
pub fn errors(held_out: &[HeldOut], structure: &Structure, fit: &Fit) -> Option<Vec<Errors>> {
    let response = portable(structure, &fit.theta);
    held_out.par_iter().map(|record| Some(record.judge(&response)?.1)).collect()
}

/// What of a fitted structure holds on other records: without terms that belong to the weather of one record.
pub fn portable(structure: &Structure, theta: &[f64]) -> Response {
    let mut kept = structure.clone();
    let mut values = theta.to_vec();
    for place in (0..kept.terms.len()).rev() {
        if is_of_one_record(kept.terms[place].effect.id()) {
            values = kept.drop_from(&values, place);
            kept = kept.without(place);
        }
    }
    if kept.own_bias {
        let mean = values[2..2 + kept.records].iter().sum::<f64>() / kept.records as f64;
        values.splice(2..2 + kept.records, [mean]);
        kept.own_bias = false;
    }
    kept.response(0, &values)
}

/// Whether an effect belongs to the time of one record and not to the ship.
pub fn is_of_one_record(id: &str) -> bool {
    matches!(id, "moment_drift" | "transient_disturbance")
}

/// How a model does against another one where neither was fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Comparison {
    /// Error of the full replay, after over before.
    pub full: f64,
    /// Geometric mean of the ratios of full and restarted replays.
    pub mean: f64,
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

    /// Whether the second model is better by more than errors of parameters could make it.
    pub fn is_much_better(&self) -> bool {
        self.full < FULL_GAIN && self.mean < MEAN_GAIN
    }

    /// Compares errors over records, pooled row by row.
    pub fn of(before: &[Errors], after: &[Errors]) -> Option<Self> {
        let pooled = |all: &[Errors], value: fn(&Errors) -> Option<f64>| {
            let mut square = 0.0;
            let mut rows = 0usize;
            for errors in all {
                square += value(errors)?.powi(2) * errors.rows as f64;
                rows += errors.rows;
            }
            (rows > 0 && square > 0.0).then(|| (square / rows as f64).sqrt())
        };
        let kinds: [fn(&Errors) -> Option<f64>; 3] = [|e| Some(e.heading), |e| e.horizon[0], |e| e.horizon[1]];
        let ratios: Vec<f64> =
            kinds.iter().filter_map(|kind| Some(pooled(after, *kind)? / pooled(before, *kind)?)).collect();
        let full = *ratios.first()?;
        let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
        Some(Self { full, mean })
    }
}

/// Parts of the records that are kept from a fit in turn, as shares of their length.
const PARTS: [[f64; 2]; 2] = [[0.4, 0.7], [0.7, 1.0]];

/// Standard errors by which the squared error has to grow to count as worse.
const SIGNIFICANT: f64 = 2.0;

/// Whether a model predicts parts of its own records worse than a simpler one, each fitted to the rest: `true` when its
/// squared error there is larger by more than two standard errors.
pub fn is_worse_on_parts(problem: &Problem, simple: (&Structure, &Fit), rich: (&Structure, &Fit)) -> bool {
    let (mut differences, mut covariance) = (Vec::new(), 0.0);
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
        let predict = |(structure, start): (&Structure, &Fit)| {
            let fit = fitted.fit(structure, &start.theta, &start.initial, &start.colour);
            problem.residual(structure, &fit.theta, &fit.initial)
        };
        let (one, other) = (predict(simple), predict(rich));
        for (number, record) in problem.records.iter().enumerate() {
            let seats = record.observed.iter().enumerate().filter(|(_, row)| {
                let share = (record.time[**row] - record.time[0]) / record.duration();
                (part[0]..=part[1]).contains(&share)
            });
            let part: Vec<f64> =
                seats.map(|(seat, _)| other[number][seat].powi(2) - one[number][seat].powi(2)).collect();
            covariance += long_run(&part);
            differences.extend(part);
        }
    }
    let sum: f64 = differences.iter().sum();
    !sum.is_finite() || sum > SIGNIFICANT * covariance.sqrt()
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
