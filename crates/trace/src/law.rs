//! Estimation of the noise law from the residual of a fit.
//!
//! Every kind of colour is tried at the level of maximum marginal likelihood. All unknowns of the fit are integrated
//! out to first order, which corrects for the noise absorbed by them:
//!
//! −2 log p = Σ n log σ² + Σ log S + J + log det(XᵀX/σ² + P).
//!
//! X are the whitened sensitivities and P is the prior precision. The penalty of a colour is log n per parameter
//! (Schwarz 1978); the criterion of a law is −2 log p plus this penalty. All structures share the law, so the misfit of
//! a structure without an effect is never attributed to weather.

use estimation::levenberg_marquardt::NormalEquations;
use estimation::minimum::golden_section_minimum;
use nalgebra::{Cholesky, DVector, Dyn};
use rayon::prelude::*;

use crate::fit::{FittedRecords, StructureFit, prior_deviation, prior_precision};
use crate::linear::Linearisation;
use crate::noise::{CorrelatedNoise, NoiseColour};
use crate::noise_law::{NoiseLaw, RecordWhitening};
use crate::waves;

/// Lower bound of the standard deviation of a heading, rad: a thousandth of a degree.
pub const MIN_HEADING_SD_RAD: f64 = 1.75e-5;

/// Share of the rows, with the largest second differences of the rudder, from which the error of the rudder between
/// rows is estimated.
const BEND_SHARE: f64 = 0.05;

/// Bounds of the level of a colour: its heading variance over the variance of a row.
const LEVELS: [f64; 2] = [1e-2, 1e9];

/// Number of intervals of the search grid of the level.
const GRID: usize = 6;

/// Number of levels at which every kind of colour is screened.
const COARSE_GRID: i32 = 4;

/// Number of kinds of colour whose level is refined after the screening.
const FINALISTS: usize = 3;

/// Number of iterations of the noise variances for a colour.
const ROUNDS: usize = 2;

/// Lower bounds of the noise variance of the records, rad², from the sampling of the rudder.
///
/// A corner of the rudder between two rows is cut. This changes the integral of the rudder by up to an eighth of its
/// second difference times the step; the bound assumes half of this maximum. The heading changes by about
/// (K/T)(L/U) times as much. `gain` is K/T, 1/s².
pub fn min_noise_variances(problem: &FittedRecords, gain: f64) -> Vec<f64> {
    let floor = |record: &crate::record::PreparedRecord| {
        let mut bends: Vec<f64> =
            record.rudder.values().windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2)).collect();
        bends.sort_by(|a, b| b.total_cmp(a));
        let count = ((bends.len() as f64 * BEND_SHARE) as usize).max(1);
        let square = bends.iter().take(count).sum::<f64>() / count as f64;
        (gain * problem.ship_length_time * record.rudder_spacing * square.sqrt() / 16.0).max(MIN_HEADING_SD_RAD).powi(2)
    };
    problem.records.iter().map(floor).collect()
}

/// Linearisation of a fit at its solution, for the estimation of the noise law.
#[derive(Debug, Clone)]
pub struct LinearisedFit<'a> {
    /// Fitted records.
    pub problem: &'a FittedRecords,
    /// Residual and heading sensitivities.
    pub linear: Linearisation,
    /// Prior precision of every unknown and its offset from the prior mean; zero for the initial states.
    pub prior: Vec<(f64, f64)>,
    floors: Vec<f64>,
}

impl<'a> LinearisedFit<'a> {
    /// Linearises a fit. Unknowns are the fitted parameters, then the initial states.
    pub fn new(problem: &'a FittedRecords, fit: &StructureFit) -> Self {
        let linear = problem.linearise(&fit.structure, &fit.theta, &fit.initial);
        let prior = fit.structure.fitted_priors(&fit.theta).into_iter().map(|(prior, value)| {
            let precision = prior_precision(prior);
            (precision, prior_deviation(prior, value) / precision.sqrt())
        });
        let mut prior: Vec<(f64, f64)> = prior.collect();
        prior.resize(linear.unknowns, (0.0, 0.0));
        Self { problem, linear, prior, floors: min_noise_variances(problem, fit.theta[1]) }
    }

    /// Law with the least criterion among the given kinds, with the waves and the start variances of the law `start`.
    pub fn select_noise_law(&self, start: &NoiseLaw, kinds: &[CorrelatedNoise]) -> EstimatedNoiseLaw {
        let white = self.evaluate(NoiseColour { correlated: None, ..start.colour }, &start.row_variance);
        let log_n = (self.problem.heading_count() as f64).ln();
        let coloured = self.levels(kinds, &white.noise_law);
        let sum = |c: EstimatedNoiseLaw| EstimatedNoiseLaw {
            criterion: c.criterion + c.noise_law.colour.parameter_count() as f64 * log_n,
            ..c
        };
        let all = [white].into_iter().chain(coloured).map(sum);
        all.min_by(|a, b| a.criterion.total_cmp(&b.criterion)).expect("white noise is a candidate")
    }

    /// Cholesky factor of the precision of all unknowns under a whitening, and their Gauss–Newton step; `None` if the
    /// precision is singular.
    pub fn solve(&self, whitening: &RecordWhitening) -> Option<(Cholesky<f64, Dyn>, DVector<f64>)> {
        let (mut normal, _) = self.linear.normal_equations(whitening);
        self.add_prior(&mut normal);
        let factor = normal.matrix.cholesky()?;
        let step = factor.solve(&normal.right_hand_side);
        Some((factor, step))
    }

    /// Adds the prior of every unknown: its precision p to the diagonal, and −p times the offset from the prior mean to
    /// the right-hand side.
    fn add_prior(&self, normal: &mut NormalEquations) {
        for (k, &(precision, offset)) in self.prior.iter().enumerate() {
            normal.matrix[(k, k)] += precision;
            normal.right_hand_side[k] -= precision * offset;
        }
    }

    /// Noise variances of all records under a colour, from `start`, with the criterion −2 log p.
    fn evaluate(&self, colour: NoiseColour, start: &[f64]) -> EstimatedNoiseLaw {
        let unit = NoiseLaw { colour, ..NoiseLaw::white(start.len(), 1.0) };
        let whitening = self.problem.whitening(&unit);
        let mut law = NoiseLaw { row_variance: start.to_vec(), ..unit };
        // Normal equations of every record under unit variance: for other variances they are multiples.
        let blocks: Vec<(NormalEquations, Vec<f64>)> =
            (0..start.len()).map(|k| self.record_normal(k, &whitening)).collect();
        let mut criterion = f64::INFINITY;
        for _ in 0..ROUNDS {
            let Some((next, value)) = self.update(&law, &blocks, &whitening) else { break };
            law.row_variance = next;
            criterion = value;
        }
        EstimatedNoiseLaw { noise_law: law, criterion, waves_gain: 0.0 }
    }

    /// Normal equations of a single record, and its whitened residual sum of squares as the only entry of a list.
    fn record_normal(&self, record: usize, all: &RecordWhitening) -> (NormalEquations, Vec<f64>) {
        let alone = Linearisation { blocks: vec![self.linear.blocks[record].clone()], unknowns: self.linear.unknowns };
        let whitening =
            RecordWhitening { whiteners: vec![all.whiteners[record].clone()], scale: vec![all.scale[record]] };
        alone.normal_equations(&whitening)
    }

    /// Updated variances and the criterion at the old variances; `None` if the precision is singular.
    fn update(
        &self,
        law: &NoiseLaw,
        blocks: &[(NormalEquations, Vec<f64>)],
        whitening: &RecordWhitening,
    ) -> Option<(Vec<f64>, f64)> {
        let mut normal = NormalEquations::zeros(self.linear.unknowns);
        for ((block, _), variance) in blocks.iter().zip(&law.row_variance) {
            normal.matrix += &block.matrix / *variance;
            normal.right_hand_side += &block.right_hand_side / *variance;
        }
        self.add_prior(&mut normal);
        let NormalEquations { matrix, right_hand_side } = normal;
        let penalty = self.prior.iter().fold(0.0, |sum, &(precision, offset)| sum + precision * offset * offset);
        let factor = matrix.cholesky()?;
        let step = factor.solve(&right_hand_side);
        let inverse = factor.inverse();
        let mut criterion = factor.ln_determinant() + penalty - step.dot(&right_hand_side);
        let mut variances = Vec::with_capacity(blocks.len());
        for (record, ((block, squares), variance)) in blocks.iter().zip(&law.row_variance).enumerate() {
            let square = squares[0];
            let rows = self.linear.blocks[record].residual.len() as f64;
            criterion += rows * variance.ln() + whitening.whiteners[record].log_determinant + square / variance;
            let residual = square - 2.0 * step.dot(&block.right_hand_side) + step.dot(&(&block.matrix * &step));
            let absorbed = (inverse.component_mul(&block.matrix)).sum() / variance;
            variances.push((residual.max(0.0) / (rows - absorbed).max(0.2 * rows)).max(self.floors[record]));
        }
        criterion.is_finite().then_some((variances, criterion))
    }

    /// Best of the given kinds of colour, each at its best level: all kinds are screened on a coarse grid of levels,
    /// then the levels of the best kinds are refined.
    fn levels(&self, kinds: &[CorrelatedNoise], white: &NoiseLaw) -> Vec<EstimatedNoiseLaw> {
        let at = |kind: CorrelatedNoise, log: f64| {
            let colour = NoiseColour { correlated: Some((kind, log.exp())), ..white.colour };
            self.evaluate(colour, &white.row_variance)
        };
        let [low, high] = LEVELS.map(f64::ln);
        let screen = |&kind: &CorrelatedNoise| {
            let levels = (0..COARSE_GRID).map(|k| low + (high - low) * (f64::from(k) + 0.5) / f64::from(COARSE_GRID));
            (levels.map(|log| at(kind, log).criterion).fold(f64::INFINITY, f64::min), kind)
        };
        let mut all: Vec<(f64, CorrelatedNoise)> = kinds.par_iter().map(screen).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all.truncate(FINALISTS);
        all.into_par_iter()
            .map(|(_, k)| at(k, golden_section_minimum(low, high, GRID, |log| at(k, log).criterion).0))
            .collect()
    }
}

/// Estimated noise law with its criterion.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimatedNoiseLaw {
    /// Noise law.
    pub noise_law: NoiseLaw,
    /// Criterion −2 log p; for the chosen law it includes the penalty of the colour.
    pub criterion: f64,
    /// Decrease of the criterion by waves, penalty included; 0 without waves.
    pub waves_gain: f64,
}

/// Noise law of the residual of a fit, estimated among the given kinds of colour; `variance` (rad²) is the start.
pub fn estimate_noise_law(
    problem: &FittedRecords,
    fit: &StructureFit,
    variance: &[f64],
    with_waves: bool,
    kinds: &[CorrelatedNoise],
) -> EstimatedNoiseLaw {
    let linearised = LinearisedFit::new(problem, fit);
    let start = NoiseLaw { row_variance: variance.to_vec(), ..NoiseLaw::white(variance.len(), 1.0) };
    let mut best = linearised.select_noise_law(&start, kinds);
    if with_waves && let Some(sea) = waves::estimate_waves(problem, &fit.residual, &best.noise_law) {
        let log_n = (problem.heading_count() as f64).ln();
        let colours = [
            Some(NoiseColour { waves: Some(sea), correlated: None }),
            best.noise_law.colour.correlated.map(|_| NoiseColour { waves: Some(sea), ..best.noise_law.colour }),
        ];
        for colour in colours.into_iter().flatten() {
            let EstimatedNoiseLaw { noise_law: law, criterion, .. } =
                linearised.evaluate(colour, &best.noise_law.row_variance);
            let criterion = criterion + colour.parameter_count() as f64 * log_n;
            if criterion < best.criterion {
                best = EstimatedNoiseLaw {
                    noise_law: law,
                    criterion,
                    waves_gain: best.waves_gain + best.criterion - criterion,
                };
            }
        }
    }
    EstimatedNoiseLaw { noise_law: best.noise_law.with_model_error_bound(problem), ..best }
}

/// Minimum smooth model error, relative to the standard deviation of the heading: no response describes a hull better.
const MIN_MODEL_ERROR: f64 = 0.02;

/// Effective number of independent readings per time L/U, if the noise includes a model error.
const READINGS_PER_TIME: f64 = 3.0;

impl NoiseLaw {
    /// Raises a smooth model error to its lower bound, and sets the power of the likelihood to the effective number of
    /// readings. Other laws are unchanged.
    fn with_model_error_bound(mut self, problem: &FittedRecords) -> Self {
        let Some((CorrelatedNoise::SmoothError(_), level)) = self.colour.correlated else { return self };
        for ((variance, power), record) in
            self.row_variance.iter_mut().zip(&mut self.likelihood_power).zip(&problem.records)
        {
            let rows = record.observed_rows.len() as f64;
            let heading = || record.observed_rows.iter().map(|&row| record.heading[row]);
            let mean = heading().sum::<f64>() / rows;
            let square = heading().map(|psi| (psi - mean).powi(2)).sum::<f64>() / rows;
            *variance = variance.max(MIN_MODEL_ERROR * MIN_MODEL_ERROR * square / level);
            *power = (READINGS_PER_TIME * record.duration() / problem.ship_length_time / rows).min(1.0);
        }
        self
    }
}
