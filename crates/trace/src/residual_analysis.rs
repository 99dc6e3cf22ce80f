//! Residual analysis of the fitted records: whiteness and bands under the noise law, and its verdict.

use estimation::residuals::{GappedSeries, constant_variance_p_value, whiteness_test};
use trial::Trial;

use crate::comparison::{RecordComparison, ReplayResult};
use crate::fit::FittedRecords;
use crate::full::FullModel;
use crate::location::Attribution;
use crate::noise_law::NoiseLaw;
use crate::record::PreparedRecord;
use crate::replay_errors::ReplayErrors;
use crate::residual_peak::{ResidualPeak, residual_peak};
use crate::rudder::RudderNoise;
use crate::structures::Structures;

/// Sums of squared heading errors over all records, rad²: base, average.
pub fn heading_error_squares(all: &[RecordComparison]) -> [f64; 2] {
    let square = |errors: &ReplayErrors| errors.heading_rmse.powi(2) * errors.heading_count as f64;
    let before = all.iter().map(|comparison| square(&comparison.base_replay.errors)).sum();
    [before, all.iter().map(|comparison| square(&comparison.average_replay.errors)).sum()]
}

/// Normalised innovations of a record: one-step prediction errors of the heading over their standard deviations. They
/// are white, normal and of unit variance if model and noise law describe the record (Ljung 1999, chapter 16).
#[derive(Debug, Clone, PartialEq)]
pub struct Innovations {
    /// Times of the innovations, s.
    pub time: Vec<f64>,
    /// Usual time between rows, s.
    pub spacing: f64,
    /// Innovations in standard deviations.
    pub values: Vec<f64>,
}

impl Innovations {
    /// Series on an even time grid, with gaps.
    pub fn series(&self) -> GappedSeries {
        GappedSeries::new(&self.time, &self.values, self.spacing)
    }
}

/// Residual analysis of the structures: noise, credible, or unexplained residual (Ljung 1999, chapter 16).
#[derive(Debug, Clone)]
pub struct ResidualAnalysis {
    /// `true` if the noise law describes the residual and its bands cover the records.
    pub is_noise: bool,
    /// `true` if [`is_noise`](Self::is_noise), or if the structures replay better than the base; otherwise no effect is
    /// named that was not required.
    pub is_credible: bool,
    /// `true` if a large residual is neither random nor of a searched shape, or if a random moment acts in a declared
    /// calm.
    pub is_unexplained: bool,
    /// Peak of a residual that is unexplained, of a located shape, or large and more than noise; `None` otherwise.
    pub residual_peak: Option<ResidualPeak>,
}

/// Minimum unexplained residual, relative to the error of the base.
const MIN_UNEXPLAINED_RATIO: f64 = 0.3;

/// Minimum unexplained residual, in standard deviations of the white noise.
const MIN_UNEXPLAINED_SD: f64 = 1.5;

impl ResidualAnalysis {
    /// Analyses the residual of the most probable structure and of the average.
    pub fn new(
        problem: &FittedRecords,
        full: &FullModel,
        structures: &Structures,
        identification: &[RecordComparison],
        trials: &[Trial],
        attribution: &Attribution,
        rudder_noises: &[Option<RudderNoise>],
    ) -> Self {
        let Some(best) = structures.weighed.first() else {
            return Self { is_noise: true, is_credible: true, is_unexplained: false, residual_peak: None };
        };
        let is_covered =
            |fitted: &RecordComparison| fitted.average_replay.band_coverage().is_none_or(|band| band.is_nominal());
        let innovations = innovations(problem, &best.fit.residual, &full.noise_law);
        let is_noise = are_noise(&innovations) && identification.iter().all(is_covered);
        let [before, after] = heading_error_squares(identification);
        let is_credible = is_noise || after < before;
        let rows: f64 = identification.iter().map(|fitted| fitted.average_replay.errors.heading_count as f64).sum();
        let white = full
            .noise_law
            .row_variance
            .iter()
            .zip(&problem.records)
            .map(|(row, record)| row * record.full_readings as f64);
        let is_small = after / rows < MIN_UNEXPLAINED_SD * MIN_UNEXPLAINED_SD * white.fold(0.0, f64::max);
        let shapes = attribution.shapes.as_ref();
        let is_chance = match shapes {
            Some(all) if all.has_significant_shapes() || !is_noise => {
                are_noise(&with_values(innovations, &all.innovations))
            }
            _ => is_noise,
        };
        let is_smooth = shapes.is_some_and(|shapes| shapes.is_smooth_moment);
        let is_large = !is_small && (after / before).sqrt() >= MIN_UNEXPLAINED_RATIO;
        // In a calm there is no random yaw moment, so an estimated random moment is unexplained.
        let is_calm =
            attribution.unexplained_random_moment(rudder_noises).is_some() && trials.iter().all(Trial::is_calm);
        let is_unexplained = is_large && (is_smooth || !is_chance) || is_calm;
        let is_left = is_unexplained || attribution.has_significant_shapes() || is_large && !is_noise;
        let residual_peak = is_left.then(|| largest_residual_peak(identification, trials)).flatten();
        Self { is_noise, is_credible, is_unexplained, residual_peak }
    }
}

/// Peak of the residual in the record with the largest error.
fn largest_residual_peak(identification: &[RecordComparison], trials: &[Trial]) -> Option<ResidualPeak> {
    let error = |number: usize| identification[number].average_replay.errors.heading_rmse;
    let number = (0..identification.len()).max_by(|&a, &b| error(a).total_cmp(&error(b)))?;
    let (ReplayResult { replay, .. }, trial) = (&identification[number].average_replay, &trials[number]);
    let first = trial.observed_rows().next().unwrap_or(0);
    let rows = first..first + replay.time.len();
    let (heading, rudder) = (&trial.heading()[rows.clone()], &trial.rudder()[rows]);
    Some(residual_peak(number, &replay.time, &replay.residual, heading, rudder, trial.sampling_period()))
}

/// Innovations with the values of another law, at the same times.
fn with_values(all: Vec<Innovations>, values: &[Vec<f64>]) -> Vec<Innovations> {
    all.into_iter().zip(values).map(|(record, values)| Innovations { values: values.clone(), ..record }).collect()
}

/// Significance level: at smaller p values innovations contradict the noise law.
pub const SIGNIFICANCE_LEVEL: f64 = 1e-4;

/// Normalised innovations of all records: their residuals (rad) whitened under a law.
pub fn innovations(problem: &FittedRecords, residual: &[Vec<f64>], law: &NoiseLaw) -> Vec<Innovations> {
    let whitening = problem.whitening(law);
    let whitened = |(number, (record, residual)): (usize, (&PreparedRecord, &Vec<f64>))| {
        let mut values = residual.clone();
        whitening.apply(number, &mut [&mut values]);
        let time = record.observed_rows.iter().map(|&row| record.time[row]).collect();
        Innovations { time, spacing: record.spacing, values }
    };
    problem.records.iter().zip(residual).enumerate().map(whitened).collect()
}

/// `true` if innovations agree with their law: white (Ljung and Box 1978), of constant variance, and without outliers.
fn are_noise(all: &[Innovations]) -> bool {
    let even = all.iter().map(|record| constant_variance_p_value(&record.values)).fold(1.0, f64::min);
    let series: Vec<GappedSeries> = all.iter().map(Innovations::series).collect();
    whiteness_test(&series).p_value.min(even * series.len() as f64) > SIGNIFICANCE_LEVEL
}
