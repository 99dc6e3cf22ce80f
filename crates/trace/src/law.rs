//! The noise of the records: what the full model leaves, as the one law that explains it best.
//!
//! Every kind of colour is tried; its level is that of largest marginal likelihood, in which all unknowns of the full
//! model are integrated out to first order, so that what they have taken from the residual is given back:
//!
//! −2 log p = Σ n log σ² + Σ log S + J + log det(XᵀX/σ² + P).
//!
//! A colour pays log n for each of its parameters (Schwarz 1978). The law is common to all structures: what a structure
//! without an effect leaves is never taken for weather.

use estimation::levenberg_marquardt::Normal;
use estimation::minimum::minimum;
use nalgebra::{Cholesky, DVector, Dyn};
use rayon::prelude::*;

use crate::fit::{FittedRecords, StructureFit, curvature, deviation};
use crate::linear::Linear;
use crate::noise::{CorrelatedNoise, NoiseColour};
use crate::waves;
use crate::weights::{NoiseLaw, Weights};

/// No heading is believed to be better than this, rad: a thousandth of a degree.
pub const FINEST: f64 = 1.75e-5;

/// Share of the rows whose rudder bends most, by which the error of the rudder between rows is judged.
const BENT: f64 = 0.05;

/// Levels of a colour that are tried: variance of the heading that it leaves, in units of that of a row.
const LEVELS: [f64; 2] = [1e-2, 1e9];
const GRID: usize = 6;

/// Levels at which every kind of colour is tried, and the kinds whose level is then found.
const ROUGH: i32 = 4;
const FINALISTS: usize = 3;

/// How often the size of the noise is found anew for a colour.
const ROUNDS: usize = 2;

/// Variance, rad², that a rudder sampled at rows leaves: a corner between two rows is cut, which changes the integral
/// of the rudder by up to an eighth of its second difference times the step, and the heading by that times K.
pub fn floors(problem: &FittedRecords, gain: f64) -> Vec<f64> {
    let of = |record: &crate::record::PreparedRecord| {
        let mut bends: Vec<f64> =
            record.rudder.values().windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2)).collect();
        bends.sort_by(|one, other| other.total_cmp(one));
        let most = ((bends.len() as f64 * BENT) as usize).max(1);
        let square = bends.iter().take(most).sum::<f64>() / most as f64;
        (gain * problem.time * record.rudder_spacing * square.sqrt() / 16.0).max(FINEST).powi(2)
    };
    problem.records.iter().map(of).collect()
}

/// A fit as the law sees it.
#[derive(Debug, Clone)]
pub struct LinearisedFit<'a> {
    /// The records.
    pub problem: &'a FittedRecords,
    /// Residual and sensitivities.
    pub linear: Linear,
    /// Precision of what is expected of the unknowns, and where they stand beside it; none for those at the end.
    pub prior: Vec<(f64, f64)>,
    floors: Vec<f64>,
}

impl<'a> LinearisedFit<'a> {
    /// That of a fit. States at the beginning stand behind the fitted parameters.
    pub fn of(problem: &'a FittedRecords, fit: &StructureFit) -> Self {
        let linear = problem.linear(&fit.structure, &fit.theta, &fit.initial);
        let prior = fit.structure.fitted_priors(&fit.theta).into_iter().map(|(prior, value)| {
            let precision = curvature(prior);
            (precision, deviation(prior, value) / precision.sqrt())
        });
        let mut prior: Vec<(f64, f64)> = prior.collect();
        prior.resize(linear.unknowns, (0.0, 0.0));
        Self { problem, linear, prior, floors: floors(problem, fit.theta[1]) }
    }

    /// The law of largest marginal likelihood beside the waves of a law, from its sizes.
    pub fn law(&self, start: &NoiseLaw, kinds: &[CorrelatedNoise]) -> ChosenLaw {
        let white = self.judge(NoiseColour { wander: None, ..start.colour }, &start.variance);
        let log_n = (self.problem.observations() as f64).ln();
        let coloured = self.levels(kinds, &white.law);
        let priced = |own: ChosenLaw| ChosenLaw { height: own.height + own.law.colour.freedom() as f64 * log_n, ..own };
        let all = [white].into_iter().chain(coloured).map(priced);
        all.min_by(|one, other| one.height.total_cmp(&other.height)).expect("white noise is one")
    }

    /// Factor of the precision of all unknowns under weights, and their step from where they stand.
    pub fn solved(&self, weights: &Weights) -> Option<(Cholesky<f64, Dyn>, DVector<f64>)> {
        let (mut normal, _) = self.linear.normal(weights);
        self.add_prior(&mut normal);
        let factor = normal.matrix.cholesky()?;
        let step = factor.solve(&normal.gradient);
        Some((factor, step))
    }

    /// Adds what is expected of the unknowns.
    fn add_prior(&self, normal: &mut Normal) {
        for (k, &(precision, beside)) in self.prior.iter().enumerate() {
            normal.matrix[(k, k)] += precision;
            normal.gradient[k] -= precision * beside;
        }
    }

    /// The sizes of the noise of all records under a colour, from `start`.
    fn judge(&self, colour: NoiseColour, start: &[f64]) -> ChosenLaw {
        let unit = NoiseLaw { colour, ..NoiseLaw::white(start.len(), 1.0) };
        let weights = self.problem.weights(&unit);
        let mut law = NoiseLaw { variance: start.to_vec(), ..unit };
        // Of every record by itself, under unit variance: the sums for other sizes follow.
        let blocks: Vec<(Normal, Vec<f64>)> = (0..start.len()).map(|record| self.of_record(record, &weights)).collect();
        let mut height = f64::INFINITY;
        for _ in 0..ROUNDS {
            let Some((next, value)) = self.round(&law, &blocks, &weights) else { break };
            law.variance = next;
            height = value;
        }
        ChosenLaw { law, height, waves_gain: 0.0 }
    }

    fn of_record(&self, record: usize, weights: &Weights) -> (Normal, Vec<f64>) {
        let alone = Linear { blocks: vec![self.linear.blocks[record].clone()], unknowns: self.linear.unknowns };
        let own = Weights { whiteners: vec![weights.whiteners[record].clone()], scale: vec![weights.scale[record]] };
        alone.normal(&own)
    }

    /// New sizes and the height at the old ones.
    fn round(&self, law: &NoiseLaw, blocks: &[(Normal, Vec<f64>)], weights: &Weights) -> Option<(Vec<f64>, f64)> {
        let mut normal = Normal::zeros(self.linear.unknowns);
        for ((block, _), variance) in blocks.iter().zip(&law.variance) {
            normal.matrix += &block.matrix / *variance;
            normal.gradient += &block.gradient / *variance;
        }
        self.add_prior(&mut normal);
        let Normal { matrix, gradient } = normal;
        let penalty = self.prior.iter().fold(0.0, |sum, &(precision, beside)| sum + precision * beside * beside);
        let factor = matrix.cholesky()?;
        let step = factor.solve(&gradient);
        let inverse = factor.inverse();
        let mut height = factor.ln_determinant() + penalty - step.dot(&gradient);
        let mut sizes = Vec::with_capacity(blocks.len());
        for (record, ((block, squares), variance)) in blocks.iter().zip(&law.variance).enumerate() {
            let square = squares[0];
            let rows = self.linear.blocks[record].residual.len() as f64;
            height += rows * variance.ln() + weights.whiteners[record].log_variance + square / variance;
            let left = square - 2.0 * step.dot(&block.gradient) + step.dot(&(&block.matrix * &step));
            let taken = (inverse.component_mul(&block.matrix)).sum() / variance;
            sizes.push((left.max(0.0) / (rows - taken).max(0.2 * rows)).max(self.floors[record]));
        }
        height.is_finite().then_some((sizes, height))
    }

    /// Some kinds of colour at their best levels: all are tried roughly, the best few finely.
    fn levels(&self, kinds: &[CorrelatedNoise], white: &NoiseLaw) -> Vec<ChosenLaw> {
        let at = |kind: CorrelatedNoise, log: f64| {
            let colour = NoiseColour { wander: Some((kind, log.exp())), ..white.colour };
            self.judge(colour, &white.variance)
        };
        let [low, high] = LEVELS.map(f64::ln);
        let roughly = |&kind: &CorrelatedNoise| {
            let levels = (0..ROUGH).map(|k| low + (high - low) * (f64::from(k) + 0.5) / f64::from(ROUGH));
            (levels.map(|log| at(kind, log).height).fold(f64::INFINITY, f64::min), kind)
        };
        let mut all: Vec<(f64, CorrelatedNoise)> = kinds.par_iter().map(roughly).collect();
        all.sort_by(|one, other| one.0.total_cmp(&other.0));
        all.truncate(FINALISTS);
        all.into_par_iter().map(|(_, kind)| at(kind, minimum(low, high, GRID, |log| at(kind, log).height).0)).collect()
    }
}

/// A law, and the fall of −2 log p with the waves in it.
#[derive(Debug, Clone, PartialEq)]
pub struct ChosenLaw {
    /// The law.
    pub law: NoiseLaw,
    /// −2 log p; of the law that is chosen with the price of its colour.
    pub height: f64,
    /// How much better waves explain what is left, with the price of their parameters.
    pub waves_gain: f64,
}

/// The law of what a fit leaves, of some kinds of colour; `variance` are sizes to begin with, rad².
pub fn of(
    problem: &FittedRecords,
    fit: &StructureFit,
    variance: &[f64],
    with_waves: bool,
    kinds: &[CorrelatedNoise],
) -> ChosenLaw {
    let linearised = LinearisedFit::of(problem, fit);
    let start = NoiseLaw { variance: variance.to_vec(), ..NoiseLaw::white(variance.len(), 1.0) };
    let mut best = linearised.law(&start, kinds);
    if with_waves && let Some(sea) = waves::find(problem, &fit.residual, &best.law) {
        let log_n = (problem.observations() as f64).ln();
        let colours = [
            Some(NoiseColour { waves: Some(sea), wander: None }),
            best.law.colour.wander.map(|_| NoiseColour { waves: Some(sea), ..best.law.colour }),
        ];
        for colour in colours.into_iter().flatten() {
            let ChosenLaw { law, height, .. } = linearised.judge(colour, &best.law.variance);
            let height = height + colour.freedom() as f64 * log_n;
            if height < best.height {
                best = ChosenLaw { law, height, waves_gain: best.waves_gain + best.height - height };
            }
        }
    }
    ChosenLaw { law: best.law.of_model(problem), ..best }
}

/// Smallest smooth error of a model, as a share of the standard deviation of the heading: no response is nearer to a
/// hull.
const OF_MODEL: f64 = 0.02;

/// Independent readings for every length that the ship sails, where the noise holds the error of a model.
const TOLD_PER_TIME: f64 = 3.0;

impl NoiseLaw {
    /// A smooth error that is no smaller than that of any model.
    fn of_model(mut self, problem: &FittedRecords) -> Self {
        let Some((CorrelatedNoise::Smooth(_), level)) = self.colour.wander else { return self };
        for ((variance, power), record) in self.variance.iter_mut().zip(&mut self.power).zip(&problem.records) {
            let rows = record.observed.len() as f64;
            let heading = || record.observed.iter().map(|&row| record.heading[row]);
            let mean = heading().sum::<f64>() / rows;
            let square = heading().map(|psi| (psi - mean).powi(2)).sum::<f64>() / rows;
            *variance = variance.max(OF_MODEL * OF_MODEL * square / level);
            *power = (TOLD_PER_TIME * record.duration() / problem.time / rows).min(1.0);
        }
        self
    }
}
