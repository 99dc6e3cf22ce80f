//! Structure against chance: whether what a structure leaves of the records is a moment of some shape, a random moment,
//! or the noise of the instruments.
//!
//! A random moment can follow almost any heading, so a shape is held against every random law with the law found anew
//! beside the shape: G = ½ (h₀ − h), in nats, of −2 log p under the best law without the shapes and with them.

mod conditioned;
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
use crate::weights::{NoiseLaw, Weights};
use conditioned::{Conditioned, LinearisedStructure};
use laws::RandomLaw;
use motion::ForeseenMotion;
use point::StructurePoint;
use search::ShapeSearch;

pub use dictionary::Shape;
pub use search::{Candidate, Explanation};

/// Gain in nats from which shapes are believed.
pub const BELIEVED: f64 = 4.0;

/// Within so many nats two explanations are alike.
pub const ALIKE: f64 = 3.0;

/// Gain in nats from which a smooth moment of unknown shape is believed.
const SMOOTH: f64 = 1.5;

/// How often the response of the ship is found anew under the best law, and the change of 1/T, as a share, that ends
/// it.
const ROUNDS: usize = 3;
const SETTLED: f64 = 0.02;

/// The unit of the lags as a share of T, and the longest T for it, s.
const UNIT: f64 = 1.0 / 16.0;
const LONGEST_TIME: f64 = 1000.0;

/// A shape that is believed.
#[derive(Debug, Clone)]
pub struct NamedShape {
    /// The shape.
    pub candidate: Arc<Candidate>,
    /// How much worse the records are explained without it, nats.
    pub loss: f64,
    /// Rudder angle that its root mean square is worth, rad.
    pub size: f64,
}

/// A shape whose absence costs less than this share of that of the clearest is no name.
const SMALLEST_LOSS: f64 = 0.25;

/// A moment that sets in within this share of a record from the change of a ship belongs to the change.
const BESIDE: f64 = 0.1;

/// A random moment, as a rudder angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MomentSize {
    /// Its root mean square over the longest record, of a white moment that of its mean over L/U, rad.
    pub rudder: f64,
    /// Spectral density of a white one, rad² s.
    pub white: Option<f64>,
}

/// What is behind the error of a structure.
#[derive(Debug, Clone)]
pub struct ShapeAnalysis {
    /// Shapes that explain it best with their law; none where none does better than chance.
    pub best: Explanation,
    /// Other explanations that the records cannot tell from the best.
    pub alike: Vec<Explanation>,
    /// Coefficients of the best, rad of rudder at the root mean square of each moment.
    pub coefficients: Vec<Vec<f64>>,
    /// How much worse the records are explained without every shape of the best, nats.
    pub losses: Vec<f64>,
    /// Gain of the best, nats.
    pub gain: f64,
    /// −2 log p under the best law without any shape.
    pub alone: f64,
    /// Power to which the likelihood is raised: below one where the noise holds the error of a model. Gain and losses
    /// hold it, heights do not.
    pub power: f64,
    /// Whether a smooth moment explains it better than any random law, where no shape does.
    pub is_smooth: bool,
    /// The random moment beside the best.
    pub moment: Option<MomentSize>,
    /// Standard deviations of the white noise of a row of the records, rad.
    pub heading_sd: Vec<f64>,
    /// Mean square of the heading error that the shapes leave, rad²; `None` without any.
    pub mean_square: Option<f64>,
    /// What is new in every heading of the records under the best, over its standard deviation.
    pub innovations: Vec<Vec<f64>>,
}

impl ShapeAnalysis {
    /// Whether shapes are believed.
    pub fn is_located(&self) -> bool {
        self.gain >= BELIEVED
    }

    /// The shapes of the best that are clear, the clearest first, for records that last so long, s.
    pub fn named(&self, duration: impl Fn(Option<usize>) -> f64) -> Vec<NamedShape> {
        let size = |own: &Vec<f64>| own.iter().map(|x| x * x).sum::<f64>().sqrt();
        let shapes = self.best.shapes.iter().zip(&self.losses).zip(&self.coefficients);
        let all =
            shapes.map(|((shape, &loss), own)| NamedShape { candidate: Arc::clone(shape), loss, size: size(own) });
        let mut all: Vec<NamedShape> = all.collect();
        all.sort_by(|one, other| other.loss.total_cmp(&one.loss));
        let least =
            all.first().map_or(0.0, |clearest| (SMALLEST_LOSS * clearest.loss).max(BELIEVED).min(clearest.loss));
        all.retain(|own| own.loss >= least);
        let from = |own: &NamedShape| own.candidate.shape.span(0.0).map(|[from, _]| from);
        let changes: Vec<(Option<usize>, Option<f64>)> = all
            .iter()
            .filter(|own| own.candidate.shape.is_change())
            .map(|own| (own.candidate.only, from(own)))
            .collect();
        all.retain(|own| {
            let only = own.candidate.only;
            let is_beside = |&(other, at): &(Option<usize>, Option<f64>)| {
                let apart = at.zip(from(own)).map(|(at, from)| (at - from).abs());
                other == only && apart.is_some_and(|apart| apart <= BESIDE * duration(only))
            };
            own.candidate.shape.is_change() || !changes.iter().any(is_beside)
        });
        all
    }

    /// What the records cannot tell from the best, in words: moments of other classes that explain the records as well.
    pub fn alternatives(&self, span: impl Fn(Option<usize>) -> [f64; 2]) -> Vec<String> {
        let classes =
            |own: &Explanation| own.shapes.iter().map(|shape| shape.shape.class()).collect::<BTreeSet<usize>>();
        let mut seen = vec![classes(&self.best)];
        let mut all = Vec::new();
        for other in &self.alike {
            let own = classes(other);
            if seen.iter().all(|seen| !own.is_subset(seen) && !own.is_superset(seen)) {
                let words = other.shapes.iter().map(|shape| shape.shape.words(span(shape.only)));
                all.push(words.collect::<Vec<_>>().join(" and "));
                seen.push(own);
            }
        }
        all
    }
}

/// Looks for shapes in what a fit leaves, beside a law whose waves are known; `None` where its unknowns cannot be told
/// apart.
pub fn analysis(problem: &FittedRecords, fit: &StructureFit, law: &NoiseLaw) -> Option<ShapeAnalysis> {
    let mut stand = Stand::new(StructurePoint::new(problem, fit, law), problem, law, &law.colour)?;
    for _ in 0..ROUNDS {
        let (before, colour) = (stand.point.theta[0], stand.laws[stand.law].colour);
        let point = stand.point.moved(&stand.structure[stand.law].as_ref()?.step());
        let change = (point.theta[0] / before - 1.0).abs();
        let Some(next) = Stand::new(point, problem, law, &colour) else { break };
        let is_settled = change < SETTLED && next.laws[next.law].colour == colour;
        stand = next;
        if is_settled {
            break;
        }
    }
    stand.explained(problem, law)
}

/// A point with its motions and laws.
struct Stand<'a> {
    point: StructurePoint<'a>,
    motions: Vec<ForeseenMotion<'a>>,
    linearised: LinearisedStructure,
    laws: Vec<RandomLaw>,
    weights: Vec<Weights>,
    structure: Vec<Option<Conditioned>>,
    height: f64,
    law: usize,
}

impl<'a> Stand<'a> {
    /// A point whose motions are foreseen under a colour; `None` where its unknowns cannot be told apart.
    fn new(point: StructurePoint<'a>, problem: &FittedRecords, law: &NoiseLaw, colour: &NoiseColour) -> Option<Self> {
        let spacing = problem.records.iter().map(|record| record.spacing).fold(f64::INFINITY, f64::min);
        let laws = laws::all(point.theta[1].abs(), problem.longest(), spacing, law.colour.waves);
        let motions = point.motions(colour);
        let linearised = point.linearised(&motions);
        let under = |law: &RandomLaw| {
            let weights = point.weights(&law.colour);
            (Conditioned::new(&linearised, &weights, law.freedom), weights)
        };
        let (structure, weights): (Vec<_>, Vec<_>) = laws.par_iter().map(under).unzip();
        let (height, law) = search::best(&structure)?;
        Some(Self { point, motions, linearised, laws, weights, structure, height, law })
    }

    /// −2 log p under another law.
    fn under(&self, law: &RandomLaw) -> f64 {
        let weights = self.point.weights(&law.colour);
        Conditioned::new(&self.linearised, &weights, law.freedom).map_or(f64::INFINITY, |own| own.height())
    }

    /// Looks for the shapes.
    fn explained(self, problem: &FittedRecords, law: &NoiseLaw) -> Option<ShapeAnalysis> {
        let longest = problem.longest();
        let smooth = law.colour.waves.is_none().then(|| laws::smooth(self.point.theta[1].abs(), longest));
        let smooth =
            smooth.unwrap_or_default().par_iter().map(|law| self.under(law)).reduce(|| f64::INFINITY, f64::min);
        let search = ShapeSearch {
            motions: &self.motions,
            laws: &self.laws,
            weights: &self.weights,
            structure: &self.structure,
            unknowns: self.linearised.linear.unknowns,
        };
        let unit = UNIT / self.point.theta[0].max(LONGEST_TIME.recip());
        let ((mut best, mut without), mut tried) = search.explain(unit);
        let rows = self.linearised.linear.blocks.iter().map(|block| block.residual.len() as f64);
        let power = rows.zip(&law.power).map(|(rows, power)| rows * power).sum::<f64>() / self.linearised.rows() as f64;
        if 0.5 * power * (self.height - best.height) < BELIEVED {
            (best, without) = (Explanation { shapes: Vec::new(), height: self.height, law: self.law }, Vec::new());
        }
        tried.retain(|other| {
            other.shapes.len() <= best.shapes.len() && power * (other.height - best.height) < 2.0 * ALIKE
        });
        let whole = search.whole(&best)?;
        let step = whole.step();
        Some(ShapeAnalysis {
            losses: without.iter().map(|height| 0.5 * power * (height - best.height)).collect(),
            coefficients: search::coefficients(&best.shapes, &step),
            mean_square: (!best.shapes.is_empty()).then(|| {
                search::square_left(&self.linearised.linear, &best.shapes, &step) / self.linearised.rows() as f64
            }),
            heading_sd: self.point.sd.iter().map(|sd| sd * whole.sd()).collect(),
            moment: self.moment(&best, whole.sd(), [longest, problem.time]),
            alike: tried,
            gain: 0.5 * power * (self.height - best.height),
            power,
            alone: self.height,
            is_smooth: best.shapes.is_empty() && 0.5 * power * (self.height - smooth) >= SMOOTH,
            innovations: whole.innovations(),
            best,
        })
    }

    /// The random moment of an explanation whose white noise has a standard deviation in units of that of the records.
    fn moment(&self, best: &Explanation, sd: f64, [longest, time]: [f64; 2]) -> Option<MomentSize> {
        let law = &self.laws[best.law];
        let (kind, _) = law.colour.wander.filter(|_| law.is_moment())?;
        let size = law.size * sd * self.point.sd.iter().copied().fold(0.0, f64::max);
        Some(match kind {
            CorrelatedNoise::White => MomentSize { rudder: size / time.sqrt(), white: Some(size * size) },
            CorrelatedNoise::Walk => MomentSize { rudder: size * (0.5 * longest).sqrt(), white: None },
            _ => MomentSize { rudder: size, white: None },
        })
    }
}

#[cfg(test)]
mod tests;
