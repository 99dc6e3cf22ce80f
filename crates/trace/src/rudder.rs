//! Measurement errors of the recorded rudder: white noise of its feedback, and rounded angles.
//!
//! δ_i = δ(t_i) + ν_i, ν white with standard deviation s, rad. This is an errors-in-variables problem: an effect that
//! is flat at large or small angles removes the noise and seems to explain it. A steering gear moves the rudder in
//! rests and strokes of one rate, which many readings determine far better than one reading ([`pieces`]), so the
//! recorded rudder is replaced by rests and strokes. The integrated error ∫ν dt, with the variance (s h)² per row of
//! duration h, acts on the ship as a white yaw moment of intensity K²/T² times [`RudderNoise::intensity`]. This moment
//! is a lower bound of the noise law.
//!
//! s is first 1.4826 median |δ_(i−1) − 2 δ_i + δ_(i+1)|/√6, which is robust to a few corners, then the standard
//! deviation of the readings about the pieces. Angles rounded to q have the error variance q²/12; the part that the
//! readings about a stroke do not show is common to all rows of the stroke.
//!
//! A record is unchanged if s is below 0.05 deg and angles are rounded to less than 0.5 deg, if the rudder needs many
//! pieces (waves, an autopilot) or the residual about them is correlated, and if the recorded rudder explains the
//! heading better. Limits: small true motions of the rudder that the heading does not show are treated as noise,
//! correlated noise is not modelled, and a constant error of all angles, such as that of rounded rests, stays.

mod pieces;

use std::borrow::Cow;

use estimation::statistics::median;
use identify::maximum_likelihood;
use rayon::prelude::*;
use ship::angle::{from_deg, to_deg};
use trial::Trial;

use crate::fit::FittedRecords;
use crate::full::FullModel;
use crate::law;
use crate::noise::CorrelatedNoise;
use crate::noise_law::NoiseLaw;
use pieces::RudderPiece;

/// Ratio of the standard deviation to the median absolute value of the normal law.
const SD_PER_MEDIAN: f64 = 1.4826;

/// Minimum standard deviation that is removed, deg.
const MIN_SD_DEG: f64 = 0.05;

/// Minimum mean number of rows per piece: with more pieces the rudder does not rest between strokes.
const MIN_ROWS_PER_PIECE: usize = 5;

/// Maximum autocorrelation of noise about the pieces, at any of [`LAGS`] lags; above it the residual is a motion of the
/// rudder.
const MAX_AUTOCORRELATION: f64 = 0.15;

/// Number of lags at which the autocorrelation is checked.
const LAGS: usize = 10;

/// Gain in log likelihood of the recorded over the estimated rudder above which the recorded rudder is kept.
const MIN_GAIN: f64 = 2.0;

/// Unit of the search for a common divisor of the angles, deg.
const UNIT_DEG: f64 = 0.5;

/// Maximum divisor of the angles that is treated as rounding, deg.
const MAX_ROUNDING_DEG: f64 = 2.0;

/// Measurement error of the rudder of one record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RudderNoise {
    /// Standard deviation of a reading, rad.
    pub sd: f64,
    /// Growth rate of the variance of the integrated error, rad² s.
    pub intensity: f64,
}

/// Records with the estimated true rudder, and the measurement errors; `None` for a record without measurement error.
pub fn estimate_rudders(trials: &[Trial]) -> (Cow<'_, [Trial]>, Vec<Option<RudderNoise>>) {
    let clean: Vec<Option<(Trial, RudderNoise)>> = trials.par_iter().map(smoothed).collect();
    let errors: Vec<Option<RudderNoise>> = clean.iter().map(|pair| pair.as_ref().map(|(_, error)| *error)).collect();
    let kept = match errors.iter().all(Option::is_none) {
        true => Cow::Borrowed(trials),
        false => {
            let kept = clean.into_iter().zip(trials);
            kept.map(|(pair, trial)| pair.map_or_else(|| trial.clone(), |(clean, _)| clean)).collect()
        }
    };
    (kept, errors)
}

/// Record with the estimated true rudder, and its measurement error; `None` if the readings are treated as exact. A
/// rounded rudder that explains the heading better than the estimate is kept, with its error.
fn smoothed(trial: &Trial) -> Option<(Trial, RudderNoise)> {
    let (time, angle) = (trial.time(), trial.rudder());
    let quantum = quantum(angle);
    let rounding = quantum / 12f64.sqrt();
    let sd = roughness(time, angle).max(rounding);
    if to_deg(sd) < MIN_SD_DEG {
        return None;
    }
    let pieces = pieces::pieces(time, angle, sd);
    if pieces.len() * MIN_ROWS_PER_PIECE > time.len() {
        return None;
    }
    let path: Vec<f64> =
        pieces.iter().flat_map(|p| time[p.from_row..p.end_row].iter().map(|t| p.angle_at(*t))).collect();
    let error = error_of(time, angle, &path, &pieces, rounding)?;
    let clean = trial.clone().with_rudder(path)?;
    let is_nearer = log_likelihood(trial)? > log_likelihood(&clean)? + MIN_GAIN;
    match (is_nearer, quantum > 0.0) {
        (false, _) => Some((clean, error)),
        (true, true) => Some((trial.clone(), error)),
        (true, false) => None,
    }
}

/// Standard deviation of the white noise of angles, rad, from the second differences of even rows.
fn roughness(time: &[f64], angle: &[f64]) -> f64 {
    let is_even = |t: &[f64]| ((t[2] - t[1]) / (t[1] - t[0]) - 1.0).abs() < 0.1;
    let triples = time.windows(3).zip(angle.windows(3)).filter(|(t, _)| is_even(t));
    let mut bends: Vec<f64> = triples.map(|(_, angle)| (angle[0] - 2.0 * angle[1] + angle[2]).abs()).collect();
    median(&mut bends).map_or(0.0, |bend| SD_PER_MEDIAN * bend / 6f64.sqrt())
}

/// Rounding unit of the angles, rad; 0 without a common divisor of at most [`MAX_ROUNDING_DEG`], or if every stroke
/// begins with a full step at a row, as in an exact record of round numbers.
fn quantum(angle: &[f64]) -> f64 {
    let units: Vec<f64> = angle.iter().map(|angle| to_deg(*angle) / UNIT_DEG).collect();
    if units.iter().any(|unit| (unit - unit.round()).abs() > 1e-3) {
        return 0.0;
    }
    let steps: Vec<i64> = units.windows(2).map(|pair| pair[1].round() as i64 - pair[0].round() as i64).collect();
    let begins_between = steps.windows(3).any(|s| s[0] == 0 && s[1] * s[2] > 0 && s[1].abs() < s[2].abs());
    let divisor = steps.iter().fold(0, |divisor, step| gcd(divisor, step.unsigned_abs()));
    let quantum = UNIT_DEG * divisor as f64;
    if begins_between && quantum <= MAX_ROUNDING_DEG { from_deg(quantum) } else { 0.0 }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// `true` if the autocorrelation of a residual at a lag up to [`LAGS`] exceeds 4/√n and [`MAX_AUTOCORRELATION`].
fn is_correlated(residual: &[f64]) -> bool {
    let products =
        |lag: usize| residual.iter().zip(&residual[lag.min(residual.len())..]).map(|(a, b)| a * b).sum::<f64>();
    let chance = 4.0 / (residual.len() as f64).sqrt();
    (1..=LAGS).any(|lag| products(lag).abs() > MAX_AUTOCORRELATION.max(chance) * products(0))
}

/// Error of readings about the estimated rudder `path`; `None` if it is zero, or a correlated motion and not noise.
fn error_of(time: &[f64], angle: &[f64], path: &[f64], pieces: &[RudderPiece], rounding: f64) -> Option<RudderNoise> {
    let residual: Vec<f64> = angle.iter().zip(path).map(|(angle, path)| angle - path).collect();
    if rounding == 0.0 && is_correlated(&residual) {
        return None;
    }
    let square = |from: usize, to: usize| -> f64 { (from..to).map(|row| (angle[row] - path[row]).powi(2)).sum() };
    let unknowns: usize = pieces.iter().map(|piece| if piece.is_stroke { 2 } else { 1 }).sum();
    let variance = square(0, time.len()) / time.len().saturating_sub(unknowns).max(1) as f64;
    let last = time.len() - 1;
    let row_duration = |row: usize| 0.5 * (time[(row + 1).min(last)] - time[row.saturating_sub(1)]);
    let mut growth = 0.0;
    for piece in pieces {
        let durations = (piece.from_row..piece.end_row).map(row_duration);
        let squares: f64 = durations.clone().map(|h| h * h).sum();
        growth += variance * squares;
        if piece.is_stroke && rounding > 0.0 {
            let hidden = rounding * rounding - square(piece.from_row, piece.end_row) / piece.rows() as f64;
            growth += hidden.max(0.0) * durations.sum::<f64>().powi(2);
        }
    }
    let error = RudderNoise { sd: variance.sqrt().max(rounding), intensity: growth / (time[last] - time[0]) };
    (growth > 0.0).then_some(error)
}

/// Maximised log likelihood of a record with an exact rudder, under the random moment of the lowest BIC; `None` if the
/// method fails.
fn log_likelihood(trial: &Trial) -> Option<f64> {
    let settings = maximum_likelihood::Settings {
        rudder: maximum_likelihood::RudderChoice::None,
        ..maximum_likelihood::Settings::default()
    };
    let method = settings.build().expect("default settings are valid");
    method.log_likelihood(std::slice::from_ref(trial))
}

/// Minimum decrease of the criterion by another noise law that is kept in addition to the rudder noise.
const MIN_CRITERION_DECREASE: f64 = 10.0;

/// Full models with noise laws that contain at least the rudder noise, as a white moment.
///
/// A law of another kind is kept in addition if its criterion is lower by more than [`MIN_CRITERION_DECREASE`]. Without
/// rudder noise the models are unchanged. `gain` is K/T, 1/s².
pub fn with_rudder_noise(
    fulls: Vec<FullModel>,
    problem: &FittedRecords,
    gain: f64,
    errors: &[Option<RudderNoise>],
) -> Vec<FullModel> {
    if errors.iter().all(Option::is_none) {
        return fulls;
    }
    let unit = CorrelatedNoise::WhiteMoment.size(1.0, problem.longest_duration()).powi(2);
    let least = |law: &NoiseLaw| {
        let intensities = errors.iter().map(|error| error.map_or(0.0, |error| error.intensity));
        let levels =
            intensities.zip(&law.row_variance).map(|(rudder, variance)| gain * gain * rudder / (unit * variance));
        levels.sum::<f64>() / errors.len() as f64
    };
    let raise = |full: FullModel| {
        let estimate = |kind| law::estimate_noise_law(problem, &full.fit, &full.noise_law.row_variance, false, &[kind]);
        let white = estimate(CorrelatedNoise::WhiteMoment);
        let kind =
            full.noise_law.colour.correlated.map(|(kind, _)| kind).filter(|kind| *kind != CorrelatedNoise::WhiteMoment);
        let is_other = kind.is_some_and(|kind| estimate(kind).criterion + MIN_CRITERION_DECREASE < white.criterion);
        // The size of waves is relative to the white noise, so a law with waves keeps its variances.
        let mut law = if full.noise_law.colour.waves.is_some() { full.noise_law.clone() } else { white.noise_law };
        let level =
            law.colour.correlated.filter(|(kind, _)| *kind == CorrelatedNoise::WhiteMoment).map_or(0.0, |(_, x)| x);
        law.colour.correlated = Some((CorrelatedNoise::WhiteMoment, level.max(least(&law))));
        let white = FullModel { noise_law: law, ..full.clone() };
        [Some(white), is_other.then_some(full)]
    };
    let mut kept: Vec<FullModel> = Vec::new();
    for full in fulls.into_iter().flat_map(raise).flatten() {
        if kept.iter().all(|other| !other.noise_law.is_alike(&full.noise_law)) {
            kept.push(full);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{TrialPlan, noisy, of_columns, record, ship, strokes};

    fn trial_with(of_rudder: impl Fn(&[f64]) -> Vec<f64>) -> (Trial, Trial) {
        let clean = record(&ship(Vec::new()), TrialPlan::default());
        let read = of_columns(clean.time().to_vec(), clean.heading().to_vec(), of_rudder(clean.rudder()));
        (clean, read)
    }

    #[test]
    fn a_clean_rudder_stays() {
        let (clean, _) = trial_with(<[f64]>::to_vec);
        let trials = [clean];
        let (kept, errors) = estimate_rudders(&trials);
        assert!(matches!(kept, Cow::Borrowed(_)) && errors == [None]);
    }

    #[test]
    fn noise_of_the_rudder_has_its_size() {
        for sd in [0.1, 0.3] {
            let (clean, read) = trial_with(|rudder| noisy(rudder, sd));
            let (kept, errors) = estimate_rudders(std::slice::from_ref(&read));
            let error = errors[0].expect("noise");
            assert!((to_deg(error.sd) / sd - 1.0).abs() < 0.15, "{sd}: {error:?}");
            let off = |trial: &Trial| -> f64 {
                trial.rudder().iter().zip(clean.rudder()).map(|(angle, clean)| (angle - clean).powi(2)).sum()
            };
            assert!(off(&kept[0]) < 0.15 * off(&read), "{} {}", off(&kept[0]), off(&read));
        }
    }

    #[test]
    fn whole_degrees_are_an_error_and_a_step_is_not() {
        let (_, clean) = strokes(300);
        let rounded: Vec<f64> = clean.iter().map(|angle| from_deg(to_deg(*angle).round())).collect();
        assert!((to_deg(quantum(&rounded)) - 1.0).abs() < 1e-9);
        assert_eq!(quantum(&clean), 0.0);
        let gear = |rate: f64| (0..40).map(move |row| from_deg((rate * f64::from(row) - 15.0).clamp(-10.0, 10.0)));
        assert_eq!([2.5, 5.0].map(|rate| quantum(&gear(rate).collect::<Vec<f64>>())), [0.0; 2]);
    }
}
