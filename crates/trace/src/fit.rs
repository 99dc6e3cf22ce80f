//! Maximum a posteriori fit of a structure: prediction error in the whitened headings plus the priors of the parameters
//! (Levenberg–Marquardt with bounds and exact derivatives; Moré 1978), and its Laplace evidence (Tierney and Kadane
//! 1986).
//!
//! J(θ, x₀) = Σ p |W (ψ − ψ̂(θ, x₀))|²/σ² + Σ ((θ − μ)/s)². The first sum is over records with the whitening filter W,
//! the noise variance σ² and the power p of the likelihood. The second sum is over parameters with the prior mean μ and
//! the prior standard deviation s. Unknowns are the fitted entries of θ in order, then the initial heading and yaw rate
//! of every record.

use estimation::levenberg_marquardt::{NormalEquations, Objective, SearchResult, SearchSettings, minimise};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use ship::effects::ParameterPrior;
use statrs::distribution::{self, ContinuousCDF};

use crate::linear::{Linearisation, heading_sensitivities};
use crate::model::{Structure, replay_headings};
use crate::noise::RecordNoise;
use crate::noise_law::{NoiseLaw, RecordWhitening};
use crate::record::PreparedRecord;

/// Stopping rule of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoppingRule {
    /// Maximum number of accepted Levenberg–Marquardt steps; the fit then ends without convergence, at the best point.
    pub max_steps: usize,
    /// Decrease of J, predicted or actual, below which the fit ends.
    pub min_decrease: f64,
}

impl StoppingRule {
    /// Rule that suffices for a quadratic approximation of the posterior.
    pub const COARSE: Self = Self { max_steps: 6, min_decrease: 0.5 };
    /// Rule of a converged fit.
    pub const FINE: Self = Self { max_steps: 15, min_decrease: 0.03 };

    fn rules(self) -> SearchSettings {
        SearchSettings {
            max_steps: self.max_steps,
            initial_damping: 1e-3,
            damping_shrink: 0.1,
            trust_ratio: 0.5,
            damping_growth: 8.0,
            min_damping: [0.0, 1e-6],
            max_rejections: 8,
            min_decrease: self.min_decrease,
            decrease_tolerance: [self.min_decrease, 0.0],
            max_small_steps: 1,
        }
    }
}

/// Prepared records of one joint fit, with their noise transitions.
#[derive(Debug, Clone)]
pub struct FittedRecords {
    /// Prepared records.
    pub records: Vec<PreparedRecord>,
    /// Noise transitions of the records, independent of the level of the noise.
    pub noise: Vec<RecordNoise>,
    /// Ship time L/U, s.
    pub ship_length_time: f64,
}

impl FittedRecords {
    /// Prepares records of a ship with this 1/T (1/s) of the base and L/U = `ship_length_time` (s).
    pub fn new(records: Vec<PreparedRecord>, inverse_time: f64, ship_length_time: f64) -> Self {
        let mut all = Self { records, noise: Vec::new(), ship_length_time };
        all.noise = all.noise_transitions(inverse_time);
        all
    }

    /// Noise transitions of the records for a ship of this 1/T, 1/s.
    pub fn noise_transitions(&self, inverse_time: f64) -> Vec<RecordNoise> {
        let full = self.records.iter().map(|record| record.full_readings).max().unwrap_or(1);
        let noise = |record| RecordNoise::new(record, inverse_time, self.longest_duration(), full);
        self.records.iter().map(noise).collect()
    }

    /// Number of observed headings.
    pub fn heading_count(&self) -> usize {
        self.records.iter().map(|record| record.observed_rows.len()).sum()
    }

    /// Duration of the longest record, s.
    pub fn longest_duration(&self) -> f64 {
        self.records.iter().map(PreparedRecord::duration).fold(0.0, f64::max)
    }

    /// Log normaliser of the noise density under a law, up to a constant: −½ Σ p (n log σ² + Σ log S) over records with
    /// n headings and the power p; S are the variances of the innovations in units of σ².
    pub fn log_normaliser(&self, law: &NoiseLaw) -> f64 {
        let whiteners = self.whitening(law).whiteners;
        let normaliser = |(number, record): (usize, &PreparedRecord)| {
            let rows = record.observed_rows.len() as f64;
            law.likelihood_power[number] * (rows * law.row_variance[number].ln() + whiteners[number].log_determinant)
        };
        -0.5 * self.records.iter().enumerate().map(normaliser).sum::<f64>()
    }

    /// Whitening filters of all records under a law, with the scales √(p/σ²).
    pub fn whitening(&self, law: &NoiseLaw) -> RecordWhitening {
        let whiteners = self.noise.iter().map(|noise| noise.whitener(&law.colour)).collect();
        let scale =
            law.row_variance.iter().zip(&law.likelihood_power).map(|(variance, power)| (power / variance).sqrt());
        RecordWhitening { whiteners, scale: scale.collect() }
    }

    /// Heading residual (measured minus replayed) of every record, rad.
    pub fn residual(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Vec<Vec<f64>> {
        let residual = |(number, record): (usize, &PreparedRecord)| {
            let response = structure.response(Some(number), theta);
            let mut out = vec![0.0; record.observed_rows.len()];
            replay_headings(&response, record, initial[number], |row, heading| {
                out[row] = record.heading[record.observed_rows[row]] - heading;
            });
            out
        };
        self.records.par_iter().enumerate().map(residual).collect()
    }

    /// Heading residual of every record and its sensitivities to all unknowns, at a point.
    pub fn linearise(&self, structure: &Structure, theta: &[f64], initial: &[[f64; 2]]) -> Linearisation {
        let (entries, fitted) = (structure.entries(), structure.fitted_indices());
        let unknowns = fitted.len() + 2 * self.records.len();
        let sensitivities = |(number, record): (usize, &PreparedRecord)| {
            let state = fitted.len() + 2 * number;
            // Unknown and index in θ; the initial heading and yaw rate follow θ.
            let acting = fitted.iter().enumerate().filter(|(_, place)| Structure::acts_in(&entries[**place], number));
            let mut variables: Vec<(usize, usize)> = acting.map(|(unknown, &place)| (unknown, place)).collect();
            variables.push((state + 1, theta.len() + 1));
            if structure.is_heading_dependent() {
                variables.push((state, theta.len()));
            }
            let mut block = heading_sensitivities(structure, record, number, theta, initial[number], &variables);
            if !structure.is_heading_dependent() {
                // The initial heading then only shifts the heading.
                block.columns.push((state, vec![1.0; block.residual.len()]));
            }
            block
        };
        Linearisation { blocks: self.records.par_iter().enumerate().map(sensitivities).collect(), unknowns }
    }

    /// Maximum a posteriori estimate of a structure, searched from a start point to the stopping rule `effort`.
    pub fn fit(
        &self,
        structure: &Structure,
        theta: Vec<f64>,
        initial: Vec<[f64; 2]>,
        whitening: &RecordWhitening,
        effort: StoppingRule,
    ) -> StructureFit {
        let priors = structure.entries().into_iter().map(|entry| entry.prior).collect();
        let (last, kept) = (FitPoint::default(), FitPoint::default());
        let mut search = PosteriorSearch { problem: self, structure, whitening, priors, last, kept };
        let start = search.unknowns(&theta, &initial);
        search.last = search.point(theta, initial);
        let SearchResult { normal_equations: normal, .. } = minimise(&mut search, start, &effort.rules());
        let kept = search.kept;
        StructureFit {
            log_evidence: evidence(structure, &kept, &normal),
            structure: structure.clone(),
            misfit: kept.misfit,
            prior_penalty: kept.value - kept.misfit,
            residual: kept.residual,
            theta: kept.theta,
            initial: kept.initial,
            precision: normal.matrix,
        }
    }

    /// Normal equations of J at a point.
    pub fn normal_equations(
        &self,
        structure: &Structure,
        theta: &[f64],
        initial: &[[f64; 2]],
        whitening: &RecordWhitening,
    ) -> NormalEquations {
        normal_equations(&self.linearise(structure, theta, initial), structure, theta, whitening)
    }
}

/// Point of a fit, with its residual and objective.
#[derive(Clone, Default, PartialEq)]
struct FitPoint {
    theta: Vec<f64>,
    initial: Vec<[f64; 2]>,
    residual: Vec<Vec<f64>>,
    misfit: f64,
    /// Objective J.
    value: f64,
}

/// Objective of the fit of one structure, with its current points.
struct PosteriorSearch<'a> {
    problem: &'a FittedRecords,
    structure: &'a Structure,
    whitening: &'a RecordWhitening,
    priors: Vec<ParameterPrior>,
    /// Point evaluated last.
    last: FitPoint,
    /// Point accepted last.
    kept: FitPoint,
}

impl PosteriorSearch<'_> {
    /// Vector of unknowns: fitted entries of θ, then the initial states.
    fn unknowns(&self, theta: &[f64], initial: &[[f64; 2]]) -> DVector<f64> {
        let fitted = theta.iter().zip(&self.priors).filter(|(_, prior)| prior.is_fitted()).map(|(value, _)| *value);
        let all: Vec<f64> = fitted.chain(initial.iter().flatten().copied()).collect();
        DVector::from_vec(all)
    }

    /// Residual, misfit and J = misfit + Σ (prior deviations)² at a point; J is infinite where it is not a number.
    fn point(&self, theta: Vec<f64>, initial: Vec<[f64; 2]>) -> FitPoint {
        let residual = self.problem.residual(self.structure, &theta, &initial);
        let misfit = self.whitening.misfit(&residual);
        let penalty: f64 = self.priors.iter().zip(&theta).map(|(prior, &x)| prior_deviation(*prior, x).powi(2)).sum();
        let value = misfit + penalty;
        FitPoint { theta, initial, residual, misfit, value: if value.is_finite() { value } else { f64::INFINITY } }
    }
}

impl Objective for PosteriorSearch<'_> {
    fn bounds(&self, unknown: usize) -> [f64; 2] {
        let prior = self.priors.iter().filter(|prior| prior.is_fitted()).nth(unknown);
        prior.map_or([f64::NEG_INFINITY, f64::INFINITY], |prior| [prior.lowest, prior.highest])
    }

    fn value(&mut self, at: &[f64]) -> f64 {
        let mut values = at.iter().copied();
        let mut next = || values.next().unwrap_or(f64::NAN);
        let before = &self.last;
        let theta = self.priors.iter().zip(&before.theta).map(|(p, fixed)| if p.is_fitted() { next() } else { *fixed });
        let theta = theta.collect();
        let initial = before.initial.iter().map(|_| [next(), next()]).collect();
        self.last = self.point(theta, initial);
        self.last.value
    }

    fn linearise(&mut self, _: &[f64], normal: &mut NormalEquations) -> f64 {
        self.kept.clone_from(&self.last);
        let FitPoint { theta, initial, .. } = &self.kept;
        *normal = self.problem.normal_equations(self.structure, theta, initial, self.whitening);
        self.kept.value
    }
}

/// Normal equations of J from residual and sensitivities at a point.
pub fn normal_equations(
    linear: &Linearisation,
    structure: &Structure,
    theta: &[f64],
    whitening: &RecordWhitening,
) -> NormalEquations {
    let (mut normal, _) = linear.normal_equations(whitening);
    for (k, (prior, value)) in structure.fitted_priors(theta).into_iter().enumerate() {
        normal.matrix[(k, k)] += prior_precision(prior);
        normal.right_hand_side[k] -= prior_deviation(prior, value) * prior_precision(prior).sqrt();
    }
    normal
}

/// Distance of a value from the prior mean, in prior standard deviations; 0 for a uniform prior or a fixed value.
pub fn prior_deviation(prior: ParameterPrior, value: f64) -> f64 {
    if prior.sd > 0.0 && prior.sd.is_finite() { (value - prior.mean) / prior.sd } else { 0.0 }
}

/// Precision of a prior; 12/(range)² for a uniform prior.
pub fn prior_precision(prior: ParameterPrior) -> f64 {
    if prior.sd.is_finite() { prior.sd.powi(-2) } else { 12.0 / (prior.highest - prior.lowest).powi(2) }
}

/// Log normaliser of a prior truncated to its bounds: the logarithm of the factor before exp(−½ ((x − μ)/s)²). 0 for a
/// fixed value.
pub fn log_prior_normaliser(prior: ParameterPrior) -> f64 {
    if !prior.is_fitted() {
        return 0.0;
    }
    if prior.sd.is_infinite() {
        return -(prior.highest - prior.lowest).ln();
    }
    let law = distribution::Normal::standard();
    let inside = law.cdf((prior.highest - prior.mean) / prior.sd) - law.cdf((prior.lowest - prior.mean) / prior.sd);
    -0.5 * std::f64::consts::TAU.ln() - prior.sd.ln() - inside.max(1e-12).ln()
}

/// Log marginal likelihood by Laplace's approximation, up to a constant shared by all structures. The probability mass
/// below a lower bound, or above an upper bound that holds the unknown, is excluded.
fn evidence(structure: &Structure, at: &FitPoint, normal: &NormalEquations) -> f64 {
    let Some(factor) = normal.matrix.clone().cholesky() else { return f64::NEG_INFINITY };
    let priors = structure.fitted_priors(&at.theta);
    let of_terms =
        structure.entries()[structure.base_parameter_count()..].iter().filter(|entry| entry.prior.is_fitted()).count();
    let constants: f64 = priors[priors.len() - of_terms..].iter().map(|(prior, _)| log_prior_normaliser(*prior)).sum();
    let volume = 0.5 * of_terms as f64 * std::f64::consts::TAU.ln() - 0.5 * factor.ln_determinant();
    let covariance = factor.inverse();
    let law = distribution::Normal::standard();
    let inside = |(k, &(prior, value)): (usize, &(ParameterPrior, f64))| {
        let sd = covariance[(k, k)].sqrt();
        let held = normal.is_bound_active(k, value, [prior.lowest, prior.highest]);
        let push = if held { normal.right_hand_side[k] * sd } else { 0.0 };
        let [to_low, to_high] = [(value - prior.lowest) / sd, (prior.highest - value) / sd];
        let room = if push > 0.0 { to_high - push } else { to_low + push };
        // Logarithm of ∫ exp(|push| x − ½ x²) dx/√2π up to the bound; far beyond the bound its asymptotic value.
        match room < -5.0 {
            true => -(-room * std::f64::consts::TAU.sqrt()).ln(),
            false => law.cdf(room).ln() + 0.5 * push * push,
        }
    };
    -0.5 * at.value + constants + volume + priors.iter().enumerate().map(inside).sum::<f64>()
}

/// Maximum a posteriori estimate of a structure.
#[derive(Debug, Clone)]
pub struct StructureFit {
    /// Structure.
    pub structure: Structure,
    /// Parameters, in the order of [`Structure::entries`].
    pub theta: Vec<f64>,
    /// Initial heading (rad) and yaw rate (rad/s) of every record.
    pub initial: Vec<[f64; 2]>,
    /// Heading residual (measured minus replayed) at the observed rows of every record, rad.
    pub residual: Vec<Vec<f64>>,
    /// Misfit Σ p |W e|²/σ².
    pub misfit: f64,
    /// Prior penalty Σ ((θ − μ)/s)².
    pub prior_penalty: f64,
    /// Posterior precision of the unknowns: second derivatives of J/2.
    pub precision: DMatrix<f64>,
    /// Log marginal likelihood, up to a constant shared by all structures on these records.
    pub log_evidence: f64,
}

impl StructureFit {
    /// Refit without the term of index `out`.
    pub fn refit_without(
        &self,
        out: usize,
        problem: &FittedRecords,
        whitening: &RecordWhitening,
        effort: StoppingRule,
    ) -> Self {
        let (mut terms, mut theta) = (self.structure.terms.clone(), self.theta.clone());
        theta.drain(self.structure.term_ranges()[out].clone());
        terms.remove(out);
        problem.fit(&self.structure.with_terms(terms), theta, self.initial.clone(), whitening, effort)
    }

    /// Covariance of all entries of θ, zero for fixed entries; `None` if the precision is singular.
    pub fn covariance(&self) -> Option<DMatrix<f64>> {
        let inverse = self.precision.clone().cholesky()?.inverse();
        let covariance = self.structure.expanded_covariance(&inverse);
        covariance.iter().all(|x| x.is_finite()).then_some(covariance)
    }

    /// Physical values of all entries of θ with standard deviations, which are infinite if the precision is singular.
    pub fn physical_values(&self) -> Vec<(f64, f64)> {
        let covariance = self.covariance().map(|all| self.structure.physical_covariance(&all));
        let sd = |place: usize| covariance.as_ref().map_or(f64::INFINITY, |all| all[(place, place)].max(0.0).sqrt());
        let values = self.structure.physical(&self.theta).into_iter().enumerate();
        values.map(|(place, value)| (value, sd(place))).collect()
    }

    /// Covariance of the fitted entries of [`Structure::for_record`] for a record; `None` if the precision is singular.
    /// The deviation of the rudder bias in that record counts as exact.
    pub fn record_covariance(&self, record: Option<usize>) -> Option<DMatrix<f64>> {
        let all = self.covariance()?;
        let entries = self.structure.entries();
        let kept = self.structure.response_indices(record).into_iter().filter(|&k| entries[k].prior.is_fitted());
        let kept: Vec<usize> = kept.collect();
        Some(DMatrix::from_fn(kept.len(), kept.len(), |i, j| all[(kept[i], kept[j])]))
    }
}
