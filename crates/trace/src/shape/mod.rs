//! Shape analysis: test of a residual for a moment of a listed shape, a random moment, and instrument noise.
//!
//! A random moment can follow almost any heading, so a shape competes with every random law, and the law is
//! re-estimated together with the shape. The gain is G = ½ (h₀ − h) nats, with the criterion h₀ of the best law without
//! shapes and h of the best law with them. Shapes are functions of predicted states, because smoothed states contain
//! the random moment.

mod criterion;
mod dictionary;
mod laws;
mod library;
mod motion;
mod point;
mod search;

use std::collections::BTreeSet;
use std::sync::Arc;

use rayon::prelude::*;

use crate::fit::{FittedRecords, StructureFit};
use crate::noise::{CorrelatedNoise, NoiseColour};
use crate::noise_law::{NoiseLaw, RecordWhitening};
use criterion::{LinearisedStructure, WhitenedStructure};
use laws::RandomLaw;
use motion::PredictedMotion;
use point::StructurePoint;
use search::ShapeSearch;

pub use dictionary::Shape;
pub use search::{ShapeCandidate, ShapeExplanation};

/// Minimum significant gain of shapes, nats.
pub const MIN_GAIN_NATS: f64 = 4.0;

/// Maximum difference of two equivalent explanations, nats.
pub const MAX_EQUIVALENT_GAIN_NATS: f64 = 3.0;

/// Minimum significant gain of a smooth moment of unknown shape, nats.
const MIN_SMOOTH_GAIN: f64 = 1.5;

/// Maximum number of updates of the response under the best law.
const MAX_ROUNDS: usize = 3;

/// Relative change of 1/T below which the updates end.
const TIME_TOLERANCE: f64 = 0.02;

/// Time unit of the lags, relative to T.
const UNIT: f64 = 1.0 / 16.0;

/// Maximum T from which the time unit is computed, s.
const MAX_TIME_S: f64 = 1000.0;

/// Shape of a missing moment, with its size and the loss of log likelihood without it.
#[derive(Debug, Clone)]
pub struct NamedShape {
    /// Shape.
    pub candidate: Arc<ShapeCandidate>,
    /// Loss of log likelihood without the shape, nats.
    pub loss_nats: f64,
    /// Root mean square of the moment as a rudder angle, rad.
    pub rudder_rms: f64,
}

/// Minimum loss of a listed shape, relative to the clearest shape.
const MIN_LOSS_RATIO: f64 = 0.25;

/// Maximum time, as a share of the record, between a change of the ship and a moment that belongs to it.
const MAX_DISTANCE_SHARE: f64 = 0.1;

/// Size of a random moment as a rudder angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentSize {
    /// Root mean square over the longest record, rad; for a white moment, of its mean over L/U.
    pub rudder_rms: f64,
    /// Spectral density of a white moment, rad² s; `None` for other kinds.
    pub white_density: Option<f64>,
}

/// Shape analysis of the residual of a structure.
#[derive(Debug, Clone)]
pub struct ShapeAnalysis {
    /// Best explanation; without shapes if none is significant.
    pub best_explanation: ShapeExplanation,
    /// Equivalent explanations: with no more shapes than the best, and within [`MAX_EQUIVALENT_GAIN_NATS`] of it.
    pub equivalent_explanations: Vec<ShapeExplanation>,
    /// Coefficients of every shape of the best explanation, as root mean square moments, rad of rudder.
    pub coefficients: Vec<Vec<f64>>,
    /// Loss of log likelihood without each shape of the best explanation, nats.
    pub losses_nats: Vec<f64>,
    /// Gain in log likelihood of the best explanation over the best random law without shapes, nats.
    pub gain_nats: f64,
    /// Criterion of the best random law without shapes.
    pub random_criterion: f64,
    /// Power of the likelihood: below one if the noise includes a model error. Gain and losses include it, criteria do
    /// not.
    pub likelihood_power: f64,
    /// `true` if a smooth moment of unknown shape is significant and no shape is.
    pub is_smooth_moment: bool,
    /// Random moment in addition to the shapes; `None` without one.
    pub random_moment: Option<MomentSize>,
    /// Standard deviations of the white noise of a row of the records, rad.
    pub white_heading_sd: Vec<f64>,
    /// Mean square heading residual with the shapes, rad²; `None` without shapes.
    pub heading_mean_square: Option<f64>,
    /// Innovations of the heading over their standard deviation, dimensionless, under the best explanation: a list for
    /// every record, a value for every observed row.
    pub innovations: Vec<Vec<f64>>,
}

impl ShapeAnalysis {
    /// `true` if the gain of the shapes is significant.
    pub fn has_significant_shapes(&self) -> bool {
        self.gain_nats >= MIN_GAIN_NATS
    }

    /// Shapes of the best explanation with a clear loss, the clearest first; `duration` is the length of a record, s.
    pub fn named_shapes(&self, duration: impl Fn(Option<usize>) -> f64) -> Vec<NamedShape> {
        let size = |coefficients: &Vec<f64>| coefficients.iter().map(|x| x * x).sum::<f64>().sqrt();
        let shapes = self.best_explanation.shapes.iter().zip(&self.losses_nats).zip(&self.coefficients);
        let all = shapes.map(|((shape, &loss), rms)| NamedShape {
            candidate: Arc::clone(shape),
            loss_nats: loss,
            rudder_rms: size(rms),
        });
        let mut all: Vec<NamedShape> = all.collect();
        all.sort_by(|a, b| b.loss_nats.total_cmp(&a.loss_nats));
        let least = all
            .first()
            .map_or(0.0, |clearest| (MIN_LOSS_RATIO * clearest.loss_nats).max(MIN_GAIN_NATS).min(clearest.loss_nats));
        all.retain(|named| named.loss_nats >= least);
        let from = |named: &NamedShape| named.candidate.shape.span(0.0).map(|[from, _]| from);
        let changes: Vec<(Option<usize>, Option<f64>)> = all
            .iter()
            .filter(|named| named.candidate.shape.is_change())
            .map(|named| (named.candidate.record_index, from(named)))
            .collect();
        all.retain(|named| {
            let record = named.candidate.record_index;
            let is_near = |&(other, at): &(Option<usize>, Option<f64>)| {
                let distance = at.zip(from(named)).map(|(at, from)| (at - from).abs());
                other == record && distance.is_some_and(|distance| distance <= MAX_DISTANCE_SHARE * duration(record))
            };
            named.candidate.shape.is_change() || !changes.iter().any(is_near)
        });
        all
    }

    /// Descriptions of equivalent explanations by shapes of other classes; `span` is start and duration (s) of a
    /// record.
    pub fn alternatives(&self, span: impl Fn(Option<usize>) -> [f64; 2]) -> Vec<String> {
        let classes =
            |all: &ShapeExplanation| all.shapes.iter().map(|shape| shape.shape.class()).collect::<BTreeSet<usize>>();
        let mut seen = vec![classes(&self.best_explanation)];
        let mut all = Vec::new();
        for other in &self.equivalent_explanations {
            let classes = classes(other);
            if seen.iter().all(|seen| !classes.is_subset(seen) && !classes.is_superset(seen)) {
                let shapes = other.shapes.iter().map(|shape| shape.shape.description(span(shape.record_index)));
                all.push(shapes.collect::<Vec<_>>().join(" and "));
                seen.push(classes);
            }
        }
        all
    }
}

/// Shape analysis of the residual of a fit, with the waves of the noise law; `None` if its columns are dependent.
pub fn analyse_shapes(problem: &FittedRecords, fit: &StructureFit, law: &NoiseLaw) -> Option<ShapeAnalysis> {
    let mut current = ShapeProblem::new(StructurePoint::new(problem, fit, law), problem, law, &law.colour)?;
    for _ in 0..MAX_ROUNDS {
        let (before, colour) = (current.point.theta[0], current.laws[current.law].colour);
        let point = current.point.after_step(&current.structure[current.law].as_ref()?.gauss_newton_step());
        let change = (point.theta[0] / before - 1.0).abs();
        let Some(next) = ShapeProblem::new(point, problem, law, &colour) else { break };
        let is_settled = change < TIME_TOLERANCE && next.laws[next.law].colour == colour;
        current = next;
        if is_settled {
            break;
        }
    }
    current.explained(problem, law)
}

/// Structure at a point, with predicted motions, under all random laws.
struct ShapeProblem<'a> {
    point: StructurePoint<'a>,
    motions: Vec<PredictedMotion<'a>>,
    linearised: LinearisedStructure,
    laws: Vec<RandomLaw>,
    whitening: Vec<RecordWhitening>,
    structure: Vec<Option<WhitenedStructure>>,
    /// Criterion of the best law without shapes.
    criterion: f64,
    /// Index of that law.
    law: usize,
}

impl<'a> ShapeProblem<'a> {
    /// Problem at a point, with motions predicted under a colour; `None` if its columns are dependent.
    fn new(point: StructurePoint<'a>, problem: &FittedRecords, law: &NoiseLaw, colour: &NoiseColour) -> Option<Self> {
        let spacing = problem.records.iter().map(|record| record.spacing).fold(f64::INFINITY, f64::min);
        let laws = laws::random_laws(point.theta[1].abs(), problem.longest_duration(), spacing, law.colour.waves);
        let motions = point.motions(colour);
        let linearised = point.linearised(&motions);
        let whitened = |law: &RandomLaw| {
            let whitening = point.whitening(&law.colour);
            (WhitenedStructure::new(&linearised, &whitening, law.parameter_count), whitening)
        };
        let (structure, whitening): (Vec<_>, Vec<_>) = laws.par_iter().map(whitened).unzip();
        let (criterion, law) = search::best_law(&structure)?;
        Some(Self { point, motions, linearised, laws, whitening, structure, criterion, law })
    }

    /// Criterion of the structure without shapes under another law; infinite if its columns are dependent.
    fn criterion_under(&self, law: &RandomLaw) -> f64 {
        let whitening = self.point.whitening(&law.colour);
        let whitened = WhitenedStructure::new(&self.linearised, &whitening, law.parameter_count);
        whitened.map_or(f64::INFINITY, |structure| structure.criterion())
    }

    /// Searches the shapes and summarises the best explanation.
    fn explained(self, problem: &FittedRecords, law: &NoiseLaw) -> Option<ShapeAnalysis> {
        let longest = problem.longest_duration();
        let smooth = law.colour.waves.is_none().then(|| laws::smooth_moment_laws(self.point.theta[1].abs(), longest));
        let smooth = smooth.unwrap_or_default();
        let smooth = smooth.par_iter().map(|law| self.criterion_under(law)).reduce(|| f64::INFINITY, f64::min);
        let search = ShapeSearch {
            motions: &self.motions,
            random_laws: &self.laws,
            whitening: &self.whitening,
            structure: &self.structure,
            unknowns: self.linearised.linear.unknowns,
        };
        let unit = UNIT / self.point.theta[0].max(MAX_TIME_S.recip());
        let ((mut best, mut without), mut tried) = search.explain(unit);
        let rows = self.linearised.linear.blocks.iter().map(|block| block.residual.len() as f64);
        let power = rows.zip(&law.likelihood_power).map(|(rows, power)| rows * power).sum::<f64>()
            / self.linearised.rows() as f64;
        if 0.5 * power * (self.criterion - best.criterion) < MIN_GAIN_NATS {
            best = ShapeExplanation { shapes: Vec::new(), criterion: self.criterion, random_law_index: self.law };
            without.clear();
        }
        tried.retain(|other| {
            other.shapes.len() <= best.shapes.len()
                && power * (other.criterion - best.criterion) < 2.0 * MAX_EQUIVALENT_GAIN_NATS
        });
        let whole = search.with_shapes(&best)?;
        let step = whole.gauss_newton_step();
        Some(ShapeAnalysis {
            losses_nats: without.iter().map(|criterion| 0.5 * power * (criterion - best.criterion)).collect(),
            coefficients: search::coefficients(&best.shapes, &step),
            heading_mean_square: (!best.shapes.is_empty()).then(|| {
                search::residual_sum_of_squares(&self.linearised.linear, &best.shapes, &step)
                    / self.linearised.rows() as f64
            }),
            white_heading_sd: self.point.sd.iter().map(|sd| sd * whole.sd()).collect(),
            random_moment: self.moment(&best, whole.sd(), [longest, problem.ship_length_time]),
            equivalent_explanations: tried,
            gain_nats: 0.5 * power * (self.criterion - best.criterion),
            likelihood_power: power,
            random_criterion: self.criterion,
            is_smooth_moment: best.shapes.is_empty() && 0.5 * power * (self.criterion - smooth) >= MIN_SMOOTH_GAIN,
            innovations: whole.innovations(),
            best_explanation: best,
        })
    }

    /// Random moment of an explanation; `sd` is the standard deviation of the white noise in units of the white noise
    /// of the records.
    fn moment(&self, best: &ShapeExplanation, sd: f64, [longest, time]: [f64; 2]) -> Option<MomentSize> {
        let law = &self.laws[best.random_law_index];
        let (kind, _) = law.colour.correlated.filter(|_| law.is_moment())?;
        let size = law.size * sd * self.point.sd.iter().copied().fold(0.0, f64::max);
        Some(match kind {
            CorrelatedNoise::WhiteMoment => {
                MomentSize { rudder_rms: size / time.sqrt(), white_density: Some(size * size) }
            }
            CorrelatedNoise::WalkMoment => {
                MomentSize { rudder_rms: size * (0.5 * longest).sqrt(), white_density: None }
            }
            _ => MomentSize { rudder_rms: size, white_density: None },
        })
    }
}

#[cfg(test)]
mod tests;
