//! Parameters of largest posterior density: the replay nearest to the records, weighed with the noise, and to what is
//! expected of the parameters (Levenberg–Marquardt with bounds and exact derivatives; Moré 1978).
//!
//! J(θ, x₀) = Σ_records |W (ψ − ψ̂(θ, x₀))|²/σ² + Σ ((θ − μ)/s)², with the filter W that makes the noise of a record
//! white. Unknowns are the fitted entries of θ in order, then heading and yaw rate at the beginning of every record.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use ship::effects::Prior;
use statrs::distribution::{ContinuousCDF, Normal};

use crate::linear::{Linear, NormalEquations, tangents};
use crate::model::{Structure, headings};
use crate::noise::RecordNoise;
use crate::record::Record;
use crate::weights::{Law, Weights};

/// How far a fit is driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Most steps.
    pub steps: usize,
    /// A step that promises to lower J by less than this ends the fit.
    pub negligible: f64,
}

impl Effort {
    /// To where the posterior is seen well enough to be approximated.
    pub const COARSE: Self = Self { steps: 6, negligible: 0.5 };
    /// To the end.
    pub const FINE: Self = Self { steps: 15, negligible: 0.03 };
}

/// First damping, and the number of dampings that are tried before a point counts as a minimum.
const DAMPING: f64 = 1e-3;
const MOST_DAMPINGS: usize = 8;

/// The records that are fitted together.
#[derive(Debug, Clone)]
pub struct Problem {
    /// The records.
    pub records: Vec<Record>,
    /// What is the same for every intensity of the noise of a record.
    pub noise: Vec<RecordNoise>,
    /// Time of the ship L/U, s.
    pub time: f64,
}

impl Problem {
    /// Prepares records of a ship whose base has about this 1/T (1/s) and which sails its length in `time` seconds.
    pub fn new(records: Vec<Record>, inverse_time: f64, time: f64) -> Self {
        let longest = records.iter().map(Record::duration).fold(0.0, f64::max);
        let full = records.iter().map(|record| record.full_readings).max().unwrap_or(1);
        let noise = records.iter().map(|record| RecordNoise::new(record, inverse_time, longest, full)).collect();
        Self { records, noise, time }
    }

    /// Number of observed headings.
    pub fn observations(&self) -> usize {
        self.records.iter().map(|record| record.observed.len()).sum()
    }

    /// Length of the longest record, s.
    pub fn longest(&self) -> f64 {
        self.records.iter().map(Record::duration).fold(0.0, f64::max)
    }

    /// −½ (Σ n log σ² + Σ log S): log of the density of the noise of a law but for its exponent.
    pub fn log_normaliser(&self, law: &Law) -> f64 {
        let whiteners = self.weights(law).whiteners;
        let of = |(number, record): (usize, &Record)| {
            let rows = record.observed.len() as f64;
            law.power[number] * (rows * law.variance[number].ln() + whiteners[number].log_variance)
        };
        -0.5 * self.records.iter().enumerate().map(of).sum::<f64>()
    }

    /// The filters of all records under a law.
    pub fn weights(&self, law: &Law) -> Weights {
        let whiteners = self.noise.iter().map(|noise| noise.whitener(&law.colour)).collect();
        let scale = law.variance.iter().zip(&law.power).map(|(variance, power)| (power / variance).sqrt());
        Weights { whiteners, scale: scale.collect() }
    }

    /// Measured less replayed headings of every record, rad.
    pub fn residual(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Vec<Vec<f64>> {
        let of = |(number, record): (usize, &Record)| {
            let response = structure.response(Some(number), theta);
            let mut out = vec![0.0; record.observed.len()];
            headings(&response, record, initial[number], |row, heading| {
                out[row] = record.heading[record.observed[row]] - heading;
            });
            out
        };
        self.records.par_iter().enumerate().map(of).collect()
    }

    /// Residual and sensitivities at a point.
    pub fn linear(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Linear {
        let (entries, fitted) = (structure.entries(), structure.fitted());
        let unknowns = fitted.len() + 2 * self.records.len();
        let of = |(number, record): (usize, &Record)| {
            let state = fitted.len() + 2 * number;
            // Unknown and place in θ, behind which stand the initial heading and yaw rate.
            let acting = fitted.iter().enumerate().filter(|(_, place)| Structure::acts(&entries[**place], number));
            let mut variables: Vec<(usize, usize)> = acting.map(|(unknown, &place)| (unknown, place)).collect();
            variables.push((state + 1, theta.len() + 1));
            if structure.sees_heading() {
                variables.push((state, theta.len()));
            }
            let mut block = tangents(structure, record, number, theta, initial[number], &variables);
            if !structure.sees_heading() {
                // The whole heading turns with where it begins.
                block.columns.push((state, vec![1.0; block.residual.len()]));
            }
            block
        };
        Linear { blocks: self.records.par_iter().enumerate().map(of).collect(), unknowns }
    }

    /// Fits a structure from a start.
    pub fn fit(
        &self,
        structure: &Structure,
        theta: Vec<f64>,
        initial: Vec<[f64; 2]>,
        weights: &Weights,
        effort: Effort,
    ) -> Fit {
        let entries = structure.entries();
        let mut point = Point::new(self, structure, theta, initial, weights);
        let mut system = System::at(self, structure, &point.theta, &point.initial, weights);
        let mut damping = DAMPING;
        for _ in 0..effort.steps {
            let mut next = None;
            for _ in 0..MOST_DAMPINGS {
                let Some((step, gain)) = system.step(damping) else { break };
                if gain < effort.negligible {
                    break;
                }
                let (theta, initial) = point.moved(&entries, &step);
                let trial = Point::new(self, structure, theta, initial, weights);
                if trial.value < point.value {
                    damping *= if point.value - trial.value > 0.5 * gain { 0.1 } else { 1.0 };
                    next = Some(trial);
                    break;
                }
                damping = (damping * 8.0).max(1e-6);
            }
            let Some(next) = next else { break };
            let gained = point.value - next.value;
            point = next;
            system = System::at(self, structure, &point.theta, &point.initial, weights);
            if gained < effort.negligible {
                break;
            }
        }
        Fit {
            evidence: system.evidence(point.value),
            structure: structure.clone(),
            misfit: point.misfit,
            penalty: point.value - point.misfit,
            residual: point.residual,
            theta: point.theta,
            initial: point.initial,
            precision: system.precision,
        }
    }
}

/// Where a fit stands.
struct Point {
    theta: Vec<f64>,
    initial: Vec<[f64; 2]>,
    residual: Vec<Vec<f64>>,
    misfit: f64,
    /// J.
    value: f64,
}

impl Point {
    fn new(
        problem: &Problem,
        structure: &Structure,
        theta: Vec<f64>,
        initial: Vec<[f64; 2]>,
        weights: &Weights,
    ) -> Self {
        let residual = problem.residual(structure, &theta, &initial);
        let misfit = weights.misfit(&residual);
        let penalty: f64 =
            structure.entries().iter().zip(&theta).map(|(entry, &x)| deviation(entry.prior, x).powi(2)).sum();
        let value = misfit + penalty;
        Self { theta, initial, residual, misfit, value: if value.is_finite() { value } else { f64::INFINITY } }
    }

    /// The point a step away, within the bounds.
    fn moved(&self, entries: &[crate::model::Entry], step: &DVector<f64>) -> (Vec<f64>, Vec<[f64; 2]>) {
        let mut steps = step.iter();
        let mut next = || steps.next().copied().unwrap_or(0.0);
        let theta = self.theta.iter().zip(entries).map(|(&value, entry)| match entry.prior.is_fitted() {
            true => (value + next()).clamp(entry.prior.lowest, entry.prior.highest),
            false => value,
        });
        let theta: Vec<f64> = theta.collect();
        (theta, self.initial.iter().map(|[psi, r]| [psi + next(), r + next()]).collect())
    }
}

/// Distance of a value from what is expected, in standard deviations.
pub fn deviation(prior: Prior, value: f64) -> f64 {
    if prior.sd > 0.0 && prior.sd.is_finite() { (value - prior.mean) / prior.sd } else { 0.0 }
}

/// Precision of a prior; a range is as good as a normal law of its variance.
pub fn curvature(prior: Prior) -> f64 {
    if prior.sd.is_finite() { prior.sd.powi(-2) } else { 12.0 / (prior.highest - prior.lowest).powi(2) }
}

/// Log of the factor in front of exp(−½ ((x − μ)/s)²) of a prior within its range.
pub fn log_normaliser(prior: Prior) -> f64 {
    if !prior.is_fitted() {
        return 0.0;
    }
    if prior.sd.is_infinite() {
        return -(prior.highest - prior.lowest).ln();
    }
    let law = Normal::standard();
    let inside = law.cdf((prior.highest - prior.mean) / prior.sd) - law.cdf((prior.lowest - prior.mean) / prior.sd);
    -0.5 * std::f64::consts::TAU.ln() - prior.sd.ln() - inside.max(1e-12).ln()
}

/// Normal equations of J at a point.
pub struct System {
    /// Second derivatives of J/2 by the unknowns.
    pub precision: DMatrix<f64>,
    /// First derivatives of −J/2.
    pub gradient: DVector<f64>,
    /// Whether an unknown lies at an end of its range and would leave it.
    held: Vec<bool>,
    /// What is expected of the fitted entries, and where they are.
    priors: Vec<(Prior, f64)>,
    /// Entries that belong to terms.
    of_terms: usize,
}

impl System {
    /// The system of a structure at some parameters.
    pub fn at(
        problem: &Problem,
        structure: &Structure,
        theta: &[f64],
        initial: &[[f64; 2]],
        weights: &Weights,
    ) -> Self {
        Self::of(&problem.linear(structure, theta, initial), structure, theta, weights)
    }

    /// The same from residual and sensitivities there.
    pub fn of(linear: &Linear, structure: &Structure, theta: &[f64], weights: &Weights) -> Self {
        let NormalEquations { matrix: mut precision, mut gradient, .. } = linear.normal(weights);
        let entries = structure.entries();
        let fitted = entries.iter().zip(theta).filter(|(entry, _)| entry.prior.is_fitted());
        let priors: Vec<(Prior, f64)> = fitted.map(|(entry, &value)| (entry.prior, value)).collect();
        let mut held = vec![false; linear.unknowns];
        for (k, &(prior, value)) in priors.iter().enumerate() {
            precision[(k, k)] += curvature(prior);
            gradient[k] -= deviation(prior, value) * curvature(prior).sqrt();
            let [low, high] =
                [prior.lowest, prior.highest].map(|end| (value - end).abs() <= 1e-12 * (1e-6 + end.abs()));
            held[k] = low && gradient[k] < 0.0 || high && gradient[k] > 0.0;
        }
        let of_terms = entries[structure.base_count()..].iter().filter(|entry| entry.prior.is_fitted()).count();
        Self { precision, gradient, held, priors, of_terms }
    }

    /// A damped step and what it promises to take from J.
    fn step(&self, damping: f64) -> Option<(DVector<f64>, f64)> {
        let n = self.gradient.len();
        let scale: Vec<f64> = (0..n).map(|k| self.precision[(k, k)].sqrt().recip()).collect();
        let matrix = DMatrix::from_fn(n, n, |i, j| match (i == j, self.held[i] || self.held[j]) {
            (true, _) => 1.0 + damping + 1e-11,
            (false, true) => 0.0,
            (false, false) => self.precision[(i, j)] * scale[i] * scale[j],
        });
        let right = DVector::from_fn(n, |i, _| if self.held[i] { 0.0 } else { self.gradient[i] * scale[i] });
        let scaled = matrix.cholesky()?.solve(&right);
        let gain = scaled.dot(&right) + damping * scaled.norm_squared();
        let step = DVector::from_fn(n, |i, _| scaled[i] * scale[i]);
        step.iter().all(|x| x.is_finite()).then_some((step, gain))
    }

    /// Log of the marginal likelihood up to what all structures share (Laplace), from the value of J. The part of a
    /// normal law that lies beyond the end of a range is left out.
    fn evidence(&self, value: f64) -> f64 {
        let Some(factor) = self.precision.clone().cholesky() else { return f64::NEG_INFINITY };
        let constants: f64 =
            self.priors[self.priors.len() - self.of_terms..].iter().map(|(prior, _)| log_normaliser(*prior)).sum();
        let volume = 0.5 * self.of_terms as f64 * std::f64::consts::TAU.ln() - 0.5 * factor.ln_determinant();
        let covariance = factor.inverse();
        let law = Normal::standard();
        let inside = |(k, (prior, value)): (usize, &(Prior, f64))| {
            let sd = covariance[(k, k)].sqrt();
            let push = if self.held[k] { self.gradient[k] * sd } else { 0.0 };
            let [to_low, to_high] = [(value - prior.lowest) / sd, (prior.highest - value) / sd];
            let room = if push > 0.0 { to_high - push } else { to_low + push };
            // ∫ over the range of exp(−½ (x − push)²) against that of the whole line at its height within the range.
            match room < -5.0 {
                true => -(-room * std::f64::consts::TAU.sqrt()).ln(),
                false => law.cdf(room).ln() + 0.5 * push * push,
            }
        };
        let ends: f64 = self.priors.iter().enumerate().map(inside).sum();
        -0.5 * value + constants + volume + ends
    }
}

/// A fitted structure.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The structure.
    pub structure: Structure,
    /// Parameters, in the order of [`Structure::entries`].
    pub theta: Vec<f64>,
    /// Heading (rad) and yaw rate (rad/s) at the beginning of every record.
    pub initial: Vec<[f64; 2]>,
    /// Measured less replayed heading at the observed rows of every record, rad.
    pub residual: Vec<Vec<f64>>,
    /// Σ |W e|²/σ².
    pub misfit: f64,
    /// Σ ((θ − μ)/s)².
    pub penalty: f64,
    /// Second derivatives of J/2 by the unknowns.
    pub precision: DMatrix<f64>,
    /// Log of the marginal likelihood, up to what all structures on these records share.
    pub evidence: f64,
}

impl Fit {
    /// Covariance of all entries of θ; zero for those that are not fitted. `None` when they cannot be told apart.
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        let inverse = self.precision.clone().cholesky()?.inverse();
        let covariance = self.structure.spread(&inverse);
        covariance.iter().all(|x| x.is_finite()).then_some(covariance)
    }

    /// Covariance of the fitted entries of [`Structure::alone`] of a record.
    pub fn kept_covariance(&self, record: Option<usize>) -> Option<DMatrix<f64>> {
        let all = self.covariance()?;
        let entries = self.structure.entries();
        let kept = self.structure.places(record).into_iter().filter(|&place| entries[place].prior.is_fitted());
        let kept: Vec<usize> = kept.collect();
        Some(DMatrix::from_fn(kept.len(), kept.len(), |i, j| all[(kept[i], kept[j])]))
    }
}
