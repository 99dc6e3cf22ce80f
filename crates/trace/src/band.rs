//! 95 % bands of a replay by Monte Carlo: noise of the record, errors of the parameters, spread of the members.
//!
//! The residual of a replay whose initial state was fitted to the record is e = M (w + J d). Here w is the noise of the
//! record, J the sensitivities of the heading, d the errors of the parameters (true minus estimated), and M the
//! projection off the fitted initial state. On a fitted record d is the effect of w on the estimate, d = −H⁻¹ Jᵀ Σ⁻¹ w,
//! with the covariance Σ of the noise and the posterior precision H of the parameters; on another record d is sampled
//! from their posterior covariance. The variances of the hulls and the variance between the replays of the members are
//! added. Effects that are not among the candidates are not covered.

use estimation::column::dot;
use estimation::kalman::{LinearSystem, MAX_STATES};
use identify::replay::Replay;
use nalgebra::{DMatrix, DVector, Matrix2, Vector2};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use rand_distr::StandardNormal;
use ship::Polyline;
use trial::Trial;

use crate::average::FittedAverage;
use crate::fit::{FittedRecords, StructureFit};
use crate::record::PreparedRecord;

/// 97.5 % quantile of the standard normal law.
const QUANTILE: f64 = 1.959_963_984_540_054;

/// Number of sampled residuals for each structure.
const DRAWS: usize = 100;

/// Half-width of the band at every row of the replay `mean`, rad; `None` without a structure, if the covariance of a
/// structure is singular, or if a hull has no variance on the record.
pub fn band_half_width(average: &FittedAverage, trial: &Trial, mean: &Replay, members: &[Replay]) -> Option<Vec<f64>> {
    let record = PreparedRecord::averaged(trial, average.ship_length_time);
    let first = average.members.first()?.1;
    let problem = FittedRecords::new(vec![record], first.theta[0], average.ship_length_time);
    let (law_variance, white) = variances(average, &problem);
    let record = &problem.records[0];
    let rows = record.observed_rows.len();
    let mut variance = vec![0.0; rows];
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let share = average.hull_weight();
    for ((weight, fit), replay) in average.members.iter().zip(members) {
        let sampler = ResidualSampler::new(average, &problem, fit, replay.initial_state(), law_variance)?;
        for _ in 0..DRAWS {
            let residual = sampler.draw(&mut generator);
            variance.iter_mut().zip(residual).for_each(|(sum, e)| *sum += share * weight * e * e / DRAWS as f64);
        }
    }
    let time: Vec<f64> = record.observed_rows.iter().map(|&row| record.time[row]).collect();
    let smooth = Polyline::new(time, smoothed(&variance)).ok()?;
    let of_hulls: Vec<Polyline> =
        average.hulls.iter().map(|hull| hull.heading_variance(trial)).collect::<Option<_>>()?;
    let hulls = |t: f64| share * of_hulls.iter().map(|variance| variance.value_at(t)).sum::<f64>();
    let weights: Vec<f64> = average.weights().collect();
    let between = |row: usize| -> f64 {
        let parts = weights.iter().zip(members);
        parts.map(|(weight, member)| weight * (member.heading[row] - mean.heading[row]).powi(2)).sum()
    };
    let half = |(row, &t): (usize, &f64)| QUANTILE * (smooth.value_at(t) + hulls(t) + white + between(row)).sqrt();
    let band: Vec<f64> = mean.time.iter().enumerate().map(half).collect();
    band.iter().all(|half| half.is_finite()).then_some(band)
}

/// Variance of the white noise of a full row and of one reading, rad²: of the record if it was fitted, otherwise the
/// mean over the records.
fn variances(average: &FittedAverage, problem: &FittedRecords) -> (f64, f64) {
    let all = &average.noise_law.row_variance;
    let row = average.fitted_record.map_or_else(|| all.iter().sum::<f64>() / all.len() as f64, |number| all[number]);
    (row, row * problem.records[0].full_readings as f64)
}

/// Moving average over about a thirtieth of the rows, because sampled variances are noisy.
fn smoothed(values: &[f64]) -> Vec<f64> {
    let reach = (values.len() / 60).max(1);
    let mean = |row: usize| {
        let part = &values[row.saturating_sub(reach)..(row + reach + 1).min(values.len())];
        part.iter().sum::<f64>() / part.len() as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Sampler of the residual of one structure on one record.
struct ResidualSampler {
    system: LinearSystem<MAX_STATES>,
    /// Standard deviation of the white noise of a full row, rad.
    deviation: f64,
    /// Standard deviation of the white noise of every row, rad.
    white: Vec<f64>,
    /// Sensitivities of the heading to the fitted parameters.
    columns: Vec<Vec<f64>>,
    /// Sensitivities of the heading to the initial state.
    state: [Vec<f64>; 2],
    /// Inverse of the Gram matrix of the sensitivities to the initial state.
    inverse: Matrix2<f64>,
    errors: ParameterErrors,
}

/// Law of the parameter errors of one structure.
enum ParameterErrors {
    /// Matrix H⁻¹ Jᵀ Σ⁻¹ of a fitted record, one row per parameter: the errors follow from the noise of the record.
    OfRecord(DMatrix<f64>),
    /// Root of the covariance of the parameters, for a record that was not fitted.
    Independent(DMatrix<f64>),
}

impl ResidualSampler {
    fn new(
        average: &FittedAverage,
        problem: &FittedRecords,
        fit: &StructureFit,
        initial: [f64; 2],
        variance: f64,
    ) -> Option<Self> {
        let (structure, theta) = fit.structure.for_record(average.fitted_record, &fit.theta);
        let linear = problem.linearise(&structure, &theta, &[initial]);
        let rows = linear.blocks[0].residual.len();
        let count = linear.unknowns - 2;
        let column = |unknown: usize| {
            let sensitivity = linear.blocks[0].columns.iter().find(|(place, _)| *place == unknown);
            sensitivity.map_or_else(|| vec![0.0; rows], |(_, column)| column.clone())
        };
        let columns: Vec<Vec<f64>> = (0..count).map(column).collect();
        let state = [column(count), column(count + 1)];
        let inverse = Matrix2::from_fn(|i, j| dot(&state[i], &state[j])).try_inverse()?;
        let covariance = fit.record_covariance(average.fitted_record)?;
        let law = crate::noise_law::NoiseLaw {
            colour: average.noise_law.colour,
            row_variance: vec![variance],
            likelihood_power: vec![
                average.fitted_record.map_or(1.0, |number| average.noise_law.likelihood_power[number]),
            ],
        };
        let record = &problem.records[0];
        let errors = match average.fitted_record {
            Some(_) => {
                // The noise of the record entered the fit: the errors of the parameters are −H⁻¹ Jᵀ Σ⁻¹ w.
                let whitening = problem.whitening(&law);
                let mut whitened = columns.clone();
                whitening.apply(0, &mut whitened.iter_mut().collect::<Vec<_>>());
                for column in &mut whitened {
                    whitening.apply_transposed(0, column);
                }
                ParameterErrors::OfRecord(&covariance * DMatrix::from_fn(count, rows, |i, row| whitened[i][row]))
            }
            None => ParameterErrors::Independent(covariance_root(&covariance)),
        };
        let full = record.full_readings as f64;
        Some(Self {
            system: problem.noise[0].system(&law.colour).0,
            deviation: variance.sqrt(),
            white: record
                .observed_rows
                .iter()
                .map(|&row| (variance * full / record.row_readings[row] as f64).sqrt())
                .collect(),
            columns,
            state,
            inverse,
            errors,
        })
    }

    /// One draw of the residual M (w + J d) at the observed rows, rad, with the correlated noise alone in w. The white
    /// noise of a fitted record enters d; its direct contribution is added to the band by [`band_half_width`].
    fn draw(&self, generator: &mut ChaCha8Rng) -> Vec<f64> {
        let mut normal = || -> f64 { generator.sample(StandardNormal) };
        let coloured: Vec<f64> = self.system.sample_path(&mut normal).into_iter().map(|x| x * self.deviation).collect();
        let mut residual = coloured.clone();
        let change = match &self.errors {
            ParameterErrors::OfRecord(weights) => {
                let noise = DVector::from_iterator(
                    residual.len(),
                    coloured.iter().zip(&self.white).map(|(x, sd)| x + sd * normal()),
                );
                -(weights * noise)
            }
            ParameterErrors::Independent(root) => root * DVector::from_fn(root.ncols(), |_, _| normal()),
        };
        for (column, change) in self.columns.iter().zip(change.iter()) {
            residual.iter_mut().zip(column).for_each(|(e, c)| *e += change * c);
        }
        let share = self.inverse * Vector2::new(dot(&self.state[0], &residual), dot(&self.state[1], &residual));
        for (row, e) in residual.iter_mut().enumerate() {
            *e -= share[0] * self.state[0][row] + share[1] * self.state[1][row];
        }
        residual
    }
}

/// Matrix root R of a covariance that may be singular: R Rᵀ = covariance.
pub fn covariance_root(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = covariance.clone().symmetric_eigen();
    let scale = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    eigen.eigenvectors * DMatrix::from_diagonal(&scale)
}
