//! Errors of the recorded rudder: white noise of its feedback, and angles that are rounded.
//!
//! δ_i = δ(t_i) + ν_i, ν white with the standard deviation s, rad. The noise stands in the regressor: an effect that is
//! flat at large or small angles takes it away and seems to explain it. A gear moves a rudder in rests and strokes of
//! one rate, which readings show far better than each of them is ([`pieces`]), so δ becomes these. What is left is what
//! no smoothing takes away, ∫ν dt over a stroke, with the variance (s h)² for each of its rows of length h: to the ship
//! it is a white yaw moment of the intensity K²/T² times [`RudderError::intensity`], and no law holds less.
//!
//! s is 1.4826 median |δ_(i−1) − 2 δ_i + δ_(i+1)|/√6, which few corners do not move, and then that of the readings
//! about the pieces. Angles rounded to q have the error q²/12; what of it the readings about a stroke do not show is
//! the same in all its rows.
//!
//! A record stays as it is where s is below 0.05 deg and angles are rounded to less than 0.5 deg, where the rudder has
//! no few pieces (waves, an autopilot) or what is about them lasts, and where the recorded rudder explains the heading
//! better, because then it is what the rudder did. It fails where a rough motion of the rudder is too small to be seen
//! in the heading, which takes it for noise, where the noise has a memory, and says nothing of a constant error of all
//! angles, such as that of rounded rests.

mod pieces;

use std::borrow::Cow;

use estimation::statistics::median;
use identify::maximum_likelihood;
use rayon::prelude::*;
use ship::angle::{from_deg, to_deg};
use trial::Trial;

use crate::fit::FittedRecords;
use crate::full::Full;
use crate::law;
use crate::noise::CorrelatedNoise;
use crate::weights::NoiseLaw;
use pieces::RudderPiece;

/// Standard deviation of normal numbers over the median of their magnitudes.
const NORMAL: f64 = 1.4826;

/// Smallest standard deviation that is looked at, deg.
const SMALLEST: f64 = 0.05;

/// Rows for every piece at least: a rudder with more pieces is no gear that rests.
const ROWS_PER_PIECE: usize = 5;

/// Autocorrelation, of so many lags, from which what is about the pieces is a motion.
const LASTING: f64 = 0.15;
const LAGS: usize = 10;

/// Gain in the log of the likelihood from which the recorded rudder is believed.
const BELIEVED: f64 = 2.0;

/// Unit in which angles are looked at for a common divisor, deg, and the largest that is a rounding.
const UNIT: f64 = 0.5;
const COARSEST: f64 = 2.0;

/// The error of the rudder of one record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RudderError {
    /// Standard deviation of a reading, rad.
    pub sd: f64,
    /// Variance that the integral of the error gains in a second, rad² s.
    pub intensity: f64,
}

/// Records with the rudder behind the readings, and the errors of these; as they are where there are none.
pub fn without_noise(trials: &[Trial]) -> (Cow<'_, [Trial]>, Vec<Option<RudderError>>) {
    let read: Vec<Option<(Trial, RudderError)>> = trials.par_iter().map(smoothed).collect();
    let errors: Vec<Option<RudderError>> = read.iter().map(|one| one.as_ref().map(|(_, error)| *error)).collect();
    let kept = match errors.iter().all(Option::is_none) {
        true => Cow::Borrowed(trials),
        false => trials.iter().zip(read).map(|(trial, read)| read.map_or_else(|| trial.clone(), |own| own.0)).collect(),
    };
    (kept, errors)
}

/// The record with the rudder behind its readings, where they have an error.
fn smoothed(trial: &Trial) -> Option<(Trial, RudderError)> {
    let (time, angle) = (trial.time(), trial.rudder());
    let quantum = quantum(angle);
    let rounding = quantum / 12f64.sqrt();
    let sd = roughness(time, angle).max(rounding);
    if to_deg(sd) < SMALLEST {
        return None;
    }
    let pieces = pieces::pieces(time, angle, sd);
    if pieces.len() * ROWS_PER_PIECE > time.len() {
        return None;
    }
    let path: Vec<f64> =
        pieces.iter().flat_map(|piece| time[piece.from..piece.to].iter().map(|t| piece.at(*t))).collect();
    let error = error_of(time, angle, &path, &pieces, rounding)?;
    let clean = trial.clone().with_rudder(path)?;
    let is_nearer = log_likelihood(trial)? > log_likelihood(&clean)? + BELIEVED;
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
    let mut bends: Vec<f64> = triples.map(|(_, own)| (own[0] - 2.0 * own[1] + own[2]).abs()).collect();
    median(&mut bends).map_or(0.0, |bend| NORMAL * bend / 6f64.sqrt())
}

/// What all angles are multiples of, rad; 0 where they are none of a coarse number, and where every stroke begins at a
/// row with its whole step, which an exact rudder of even numbers does.
fn quantum(angle: &[f64]) -> f64 {
    let units: Vec<f64> = angle.iter().map(|own| to_deg(*own) / UNIT).collect();
    if units.iter().any(|own| (own - own.round()).abs() > 1e-3) {
        return 0.0;
    }
    let steps: Vec<i64> = units.windows(2).map(|pair| pair[1].round() as i64 - pair[0].round() as i64).collect();
    let begins_between = steps.windows(3).any(|own| own[0] == 0 && own[1] * own[2] > 0 && own[1].abs() < own[2].abs());
    let divisor = steps.iter().fold(0, |divisor, step| gcd(divisor, step.unsigned_abs()));
    let quantum = UNIT * divisor as f64;
    if begins_between && quantum <= COARSEST { from_deg(quantum) } else { 0.0 }
}

fn gcd(one: u64, other: u64) -> u64 {
    if other == 0 { one } else { gcd(other, one % other) }
}

/// Whether a reading of a rest is seen in those after it.
fn lasts(left: &[f64]) -> bool {
    let products =
        |lag: usize| left.iter().zip(&left[lag.min(left.len())..]).map(|(one, other)| one * other).sum::<f64>();
    let chance = 4.0 / (left.len() as f64).sqrt();
    (1..=LAGS).any(|lag| products(lag).abs() > LASTING.max(chance) * products(0))
}

/// The error of readings about the rudder behind them; `None` where it is no noise but a motion that lasts.
fn error_of(time: &[f64], angle: &[f64], path: &[f64], pieces: &[RudderPiece], rounding: f64) -> Option<RudderError> {
    let left: Vec<f64> = angle.iter().zip(path).map(|(angle, path)| angle - path).collect();
    if rounding == 0.0 && lasts(&left) {
        return None;
    }
    let square = |from: usize, to: usize| -> f64 { (from..to).map(|row| (angle[row] - path[row]).powi(2)).sum() };
    let unknowns: usize = pieces.iter().map(|piece| if piece.is_stroke { 2 } else { 1 }).sum();
    let variance = square(0, time.len()) / time.len().saturating_sub(unknowns).max(1) as f64;
    let last = time.len() - 1;
    let length = |row: usize| 0.5 * (time[(row + 1).min(last)] - time[row.saturating_sub(1)]);
    let mut grown = 0.0;
    for piece in pieces {
        let lengths = (piece.from..piece.to).map(length);
        let squares: f64 = lengths.clone().map(|h| h * h).sum();
        grown += variance * squares;
        if piece.is_stroke && rounding > 0.0 {
            let hidden = rounding * rounding - square(piece.from, piece.to) / piece.rows() as f64;
            grown += hidden.max(0.0) * lengths.sum::<f64>().powi(2);
        }
    }
    let error = RudderError { sd: variance.sqrt().max(rounding), intensity: grown / (time[last] - time[0]) };
    (grown > 0.0).then_some(error)
}

/// Log of the largest likelihood of a record with a random moment beside its rudder.
fn log_likelihood(trial: &Trial) -> Option<f64> {
    let settings = maximum_likelihood::Settings {
        rudder: maximum_likelihood::RudderChoice::None,
        ..maximum_likelihood::Settings::default()
    };
    let method = settings.build().expect("default settings are valid");
    method.log_likelihood(std::slice::from_ref(trial))
}

/// Fall of −2 log of the likelihood from which another noise is believed beside errors of the rudder.
const OTHER: f64 = 10.0;

/// Laws of the noise that hold no less than the errors of the rudder.
///
/// These are a white moment, and no other takes its place that does not explain the records far better.
pub fn beside(fulls: Vec<Full>, problem: &FittedRecords, gain: f64, errors: &[Option<RudderError>]) -> Vec<Full> {
    if errors.iter().all(Option::is_none) {
        return fulls;
    }
    let unit = CorrelatedNoise::White.size(1.0, problem.longest()).powi(2);
    let least = |law: &NoiseLaw| {
        let intensities = errors.iter().map(|error| error.map_or(0.0, |error| error.intensity));
        let levels = intensities.zip(&law.variance).map(|(own, variance)| gain * gain * own / (unit * variance));
        levels.sum::<f64>() / errors.len() as f64
    };
    let of = |full: Full| {
        let asked = |kind| law::of(problem, &full.fit, &full.law.variance, false, &[kind]);
        let white = asked(CorrelatedNoise::White);
        let kind = full.law.colour.wander.map(|(kind, _)| kind).filter(|kind| *kind != CorrelatedNoise::White);
        let is_other = kind.is_some_and(|kind| asked(kind).height + OTHER < white.height);
        // Waves are sized in the noise beside them.
        let mut law = if full.law.colour.waves.is_some() { full.law.clone() } else { white.law };
        let level = law.colour.wander.filter(|(kind, _)| *kind == CorrelatedNoise::White).map_or(0.0, |own| own.1);
        law.colour.wander = Some((CorrelatedNoise::White, level.max(least(&law))));
        let white = Full { law, ..full.clone() };
        [Some(white), is_other.then_some(full)]
    };
    let mut kept: Vec<Full> = Vec::new();
    for full in fulls.into_iter().flat_map(of).flatten() {
        if kept.iter().all(|other| !other.law.is_alike(&full.law)) {
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
        let (kept, errors) = without_noise(&trials);
        assert!(matches!(kept, Cow::Borrowed(_)) && errors == [None]);
    }

    #[test]
    fn noise_of_the_rudder_has_its_size() {
        for sd in [0.1, 0.3] {
            let (clean, read) = trial_with(|rudder| noisy(rudder, sd));
            let (kept, errors) = without_noise(std::slice::from_ref(&read));
            let error = errors[0].expect("noise");
            assert!((to_deg(error.sd) / sd - 1.0).abs() < 0.15, "{sd}: {error:?}");
            let off = |trial: &Trial| -> f64 {
                trial.rudder().iter().zip(clean.rudder()).map(|(one, other)| (one - other).powi(2)).sum()
            };
            assert!(off(&kept[0]) < 0.15 * off(&read), "{} {}", off(&kept[0]), off(&read));
        }
    }

    #[test]
    fn whole_degrees_are_an_error_and_a_step_is_not() {
        let (_, clean) = strokes(300);
        let rounded: Vec<f64> = clean.iter().map(|own| from_deg(to_deg(*own).round())).collect();
        assert!((to_deg(quantum(&rounded)) - 1.0).abs() < 1e-9);
        assert_eq!(quantum(&clean), 0.0);
        let gear = |rate: f64| (0..40).map(move |row| from_deg((rate * f64::from(row) - 15.0).clamp(-10.0, 10.0)));
        assert_eq!([2.5, 5.0].map(|rate| quantum(&gear(rate).collect::<Vec<f64>>())), [0.0; 2]);
    }
}
