//! From the largest likelihood to an estimate: covariance from the information, and what a reader should know.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use ship::angle::to_deg;
use ship::first_order::State;
use ship::{FirstOrder, Shown};
use trial::Trial;

use super::choice::Chosen;
use super::point::{Point, Record, SHARED};
use super::search::Found;
use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason};
use crate::likelihood::NoiseVector;
use crate::likelihood::parameters::RUDDER;
use crate::likelihood::track::{Coefficients, Track, is_backward};
use crate::output_error::{CONDITION_LIMIT, SIGNIFICANT, to_response};
use crate::profile::invert;
use crate::robust;
use trial::noise_model::{Moment, NoiseModel};

/// Step in a logarithm over which the change of a variance is taken.
const DIFFERENCE: f64 = 0.05;

/// Times of outliers that are listed.
const LISTED: usize = 8;

/// Covariance of (1/T, b, b δ_r) from the information, the noise and the starts eliminated, with its condition number.
fn covariance(information: &DMatrix<f64>) -> Result<(Matrix3<f64>, f64), f64> {
    let own = information.fixed_view::<SHARED, SHARED>(0, 0).into_owned();
    let rest = information.nrows() - SHARED;
    let mut reduced = own;
    if rest > 0 {
        let noise = information.view((SHARED, SHARED), (rest, rest)).into_owned();
        let cross = information.view((SHARED, 0), (rest, SHARED)).into_owned();
        // An entry at the end of its range may say nothing at all.
        let ridge = DMatrix::from_fn(rest, rest, |i, j| if i == j { 1e-10 * noise[(i, i)] + 1e-12 } else { 0.0 });
        if let Some(factor) = (noise + ridge).cholesky() {
            let explained = cross.transpose() * factor.solve(&cross);
            reduced -= Matrix3::from_fn(|i, j| explained[(i, j)]);
        }
    }
    invert(&reduced, CONDITION_LIMIT)
}

/// Degrees of freedom of the variances of K, T and δ_r, the fewest of the three: what the sizes of the noise are not
/// known to makes the variances uncertain, dof = 2/Var(log v) (Satterthwaite 1946; Kenward and Roger 1997).
fn degrees_of_freedom(records: &[Record], found: &Found) -> f64 {
    let Point { inverse_time, gain, offset, ref places, ref parts, .. } = found.point;
    let motion = |number: usize, place: &NoiseVector| {
        let part = &parts[number];
        let coefficients = Coefficients { anchor: part.anchor, gain, offset };
        let products = records[number].information(inverse_time, place, &coefficients);
        products.map(|products| products / part.variance)
    };
    let own: Option<Vec<Matrix3<f64>>> = places.iter().enumerate().map(|(k, place)| motion(k, place)).collect();
    let Some(inverse) = own.as_ref().and_then(|own| own.iter().sum::<Matrix3<f64>>().try_inverse()) else { return 1.0 };
    // Gradients of log K, log T and δ_r by (1/T, b, b δ_r).
    let (a, b) = (inverse_time, gain);
    let directions = [
        Vector3::new(-1.0 / a, 1.0 / b, 0.0),
        Vector3::new(1.0, 0.0, 0.0),
        Vector3::new(0.0, -offset / (b * b), 1.0 / b),
    ];
    let mut variance = [0.0; 3];
    let mut first = SHARED;
    for (number, (record, place)) in records.iter().zip(places).enumerate() {
        let readings = parts[number].readings as f64;
        let entries: Vec<usize> = place.entries(record.has_gyro()).collect();
        let by_entry: Vec<Matrix3<f64>> = (entries.iter())
            .map(|&entry| {
                let moved = |by: f64| {
                    let mut other = *place;
                    other.log[entry] += by;
                    motion(number, &other).unwrap_or_else(Matrix3::zeros)
                };
                let change = (moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE);
                // A tied compass error shrinks as its entry grows.
                let tied = entry == RUDDER && record.declared.is_some();
                own.as_ref().filter(|_| tied).map_or(change, |own| change + own[number] * 2.0)
            })
            .collect();
        let count = entries.len();
        let information = found.linearised.information.view((first, first), (count, count)).into_owned();
        let ridge = DMatrix::from_fn(count, count, |i, j| if i == j { 1e-9 * information[(i, i)] + 1e-9 } else { 0.0 });
        let factor = (information + ridge).cholesky();
        let is_tied = place.rudder && record.declared.is_some();
        for (variance, direction) in variance.iter_mut().zip(&directions) {
            let seen = inverse * direction;
            let size = direction.dot(&seen);
            let change = |by: &Matrix3<f64>| -seen.dot(&(by * seen)) / size;
            let by_size = own.as_ref().map_or(0.0, |own| change(&(own[number] * -2.0)));
            let mut slopes = DVector::from_iterator(count, by_entry.iter().map(change));
            if !is_tied {
                slopes -= &found.linearised.totals[number] * (by_size / (2.0 * readings));
                *variance += by_size * by_size / (2.0 * readings);
            }
            *variance += factor.as_ref().map_or(0.0, |factor| slopes.dot(&factor.solve(&slopes)));
        }
        first += count;
    }
    2.0 / variance.into_iter().fold(0.0, f64::max)
}

/// The estimate of a chosen noise.
pub(super) fn estimate(trials: &[Trial], chosen: Chosen) -> Result<Estimate, IdentifyError> {
    let Chosen { records, found: all, outliers, too_many, tried, evaluations, at_bound } = chosen;
    let found = &all[0].1;
    let Point { inverse_time, gain, offset, deviance, ref places, ref parts, .. } = found.point;
    let response = FirstOrder { inverse_T: inverse_time, K_over_T: gain, rudder_bias: offset / gain };
    let readings: usize = parts.iter().map(|part| part.readings).sum();
    let jumps: usize = records.iter().map(|record| record.jumps.len()).sum();
    let freedom = readings as f64 - (SHARED + 2 * trials.len() + jumps) as f64;
    let singular = |condition| IdentifyError::Singular { condition, limit: CONDITION_LIMIT };
    let (inverse, condition) = covariance(&found.linearised.information).map_err(singular)?;
    // The value is that of the most likely noise; its error holds the doubt which noise it is.
    let here = Vector3::new(inverse_time, gain, offset);
    let (mut doubt, mut weights, mut per_freedom) = (Matrix3::zeros(), 0.0, 0.0);
    for (weight, other) in &all {
        let Ok((own, _)) = covariance(&other.linearised.information) else { continue };
        let apart = Vector3::new(other.point.inverse_time, other.point.gain, other.point.offset) - here;
        doubt += (own + apart * apart.transpose()) * *weight;
        weights += weight;
        per_freedom += weight / degrees_of_freedom(&records, other).min(freedom);
    }
    let white = to_response(&(doubt / weights), &response, weights / per_freedom);
    let gain_sd = white.matrix[(1, 1)].sqrt();
    if gain < SIGNIFICANT * gain_sd {
        return Err(IdentifyError::NoRudderEffect { gain, sd: gain_sd });
    }
    let scores: Vec<[Vec<f64>; 3]> = (found.linearised.scores.iter().zip(parts))
        .map(|(scores, part)| scores.each_ref().map(|column| column.iter().map(|x| x / part.variance).collect()))
        .collect();
    let long_run = robust::newey_west_of_three(&scores) * (readings as f64 / freedom);
    let robust_covariance = to_response(&(inverse * long_run * inverse), &response, freedom);
    let lag1 = robust::lag1_autocorrelation(parts.iter().map(|part| part.innovations.as_slice()));
    let (uncertainty, warning) = robust::judge(white, &robust_covariance, lag1, readings);

    let mut warnings = Vec::from_iter(warning);
    if response.is_course_unstable() {
        warnings.push("course-unstable: 1/T is negative, K and T are negative".into());
    }
    if at_bound {
        warnings.push(format!("T = {} s is at its bound or beyond", Shown(response.T())));
    }
    let noises: Vec<NoiseModel> = records
        .iter()
        .zip(places.iter().zip(parts))
        .map(|(record, (place, part))| place.noise(gain, part.variance.sqrt(), record.has_gyro()))
        .collect();
    for (trial, noise) in trials.iter().zip(&noises) {
        warnings.extend(described(trial, noise, gain));
    }
    for ((trial, record), found) in trials.iter().zip(&records).zip(&outliers) {
        let times = |rows: &[usize]| {
            let shown: Vec<String> =
                rows.iter().take(LISTED).map(|&row| format!("{}", Shown(record.track.time()[row]))).collect();
            format!("{}{}", shown.join(", "), if rows.len() > LISTED { ", …" } else { "" })
        };
        if !found.spikes.is_empty() {
            let (count, name) = (found.spikes.len(), trial.name());
            warnings.push(format!(
                "{name}: {count} headings stand alone and are left out, at t = {} s",
                times(&found.spikes)
            ));
        }
        if !found.jumps.is_empty() {
            let name = trial.name();
            warnings.push(format!(
                "{name}: the heading jumps and stays off at t = {} s; the jumps are estimated",
                times(&found.jumps)
            ));
        }
    }
    if too_many {
        warnings.push("more than a tenth of the headings stand alone: none is left out, look at the compass".into());
    }
    let count = |of: fn(&super::outliers::Suspects) -> usize| outliers.iter().map(of).sum::<usize>() as f64;
    let mut diagnostics = vec![
        ("log_likelihood", -0.5 * deviance),
        ("condition", condition),
        ("lag1_autocorrelation", lag1),
        ("degrees_of_freedom", weights / per_freedom),
        ("heading_sd_deg", to_deg(noises[0].heading_sd)),
        ("left_out", count(|found| found.spikes.len())),
        ("jumps", count(|found| found.jumps.len())),
    ];
    diagnostics.extend(noises[0].heading_correlation.map(|time| ("heading_correlation_s", time)));
    diagnostics.extend(noises[0].yaw_rate_sd.map(|sd| ("yaw_rate_sd_deg_s", to_deg(sd))));
    let level = to_deg(noises[0].moment_level / gain);
    match noises[0].moment {
        Moment::None => {}
        Moment::White => diagnostics.push(("white_moment_rudder_deg_root_s", level)),
        Moment::Walk => diagnostics.push(("moment_walk_rudder_deg_per_root_s", level)),
        Moment::OrnsteinUhlenbeck => {
            diagnostics.push(("gusts_sd_rudder_deg", level));
            diagnostics.push(("gusts_correlation_s", noises[0].moment_correlation));
        }
    }
    if noises[0].rudder_sd > 0.0 {
        diagnostics.push(("rudder_sd_deg", to_deg(noises[0].rudder_sd)));
    }
    let lowest = tried.iter().map(|(_, bic)| *bic).fold(f64::INFINITY, f64::min);
    for (kind, name) in [
        (Moment::None, "bic_none"),
        (Moment::White, "bic_white"),
        (Moment::Walk, "bic_walk"),
        (Moment::OrnsteinUhlenbeck, "bic_ornstein_uhlenbeck"),
    ] {
        let best = tried.iter().filter(|(moment, _)| *moment == kind).map(|(_, bic)| *bic).min_by(f64::total_cmp);
        diagnostics.extend(best.map(|bic| (name, bic - lowest)));
    }
    Ok(Estimate {
        response,
        uncertainty,
        robust: Some(robust_covariance),
        stop: match (at_bound, found.converged) {
            (true, _) => StopReason::RangeLimit,
            (false, true) => StopReason::Converged,
            (false, false) => StopReason::IterationLimit,
        },
        evaluations,
        diagnostics,
        warnings,
    })
}

/// What is random beside a white compass error, in words.
fn described(trial: &Trial, noise: &NoiseModel, gain: f64) -> Option<String> {
    let mut parts = Vec::new();
    let degrees = to_deg(noise.moment_level / gain);
    match noise.moment {
        Moment::None => {}
        Moment::White => parts.push(format!("a white yaw moment of {degrees:.3} deg √s of rudder")),
        Moment::Walk => parts.push(format!("a yaw moment that walks by {degrees:.3} deg/√s of rudder")),
        Moment::OrnsteinUhlenbeck => parts.push(format!(
            "gusts of {degrees:.3} deg of rudder with a correlation time of {:.0} s",
            noise.moment_correlation
        )),
    }
    if noise.rudder_sd > 0.0 {
        parts.push(format!("a rudder error of {:.3} deg", to_deg(noise.rudder_sd)));
    }
    if let Some(time) = noise.heading_correlation {
        let sd = to_deg(noise.heading_sd);
        parts.push(format!("a compass error of {sd:.3} deg with a correlation time of {time:.1} s"));
    }
    (!parts.is_empty()).then(|| format!("{}: random is also {}", trial.name(), parts.join(" and ")))
}

/// Cramér–Rao bound of (1/T, K/T, δ_r) for one trial of known truth and known noise: the smallest covariance an
/// unbiased method can have when the initial state is unknown as well.
///
/// The information is that of the filter's own sensitivities, Σ (∂ν/∂θ)(∂ν/∂θ)ᵀ/S; what little the colour of the noise
/// itself tells of 1/T is left out. `initial` is the true heading (rad) and yaw rate (rad/s) at the first observed row.
/// `None` when the record does not determine the parameters. Source: Cramér (1946), Rao (1945).
pub fn cramer_rao(trial: &Trial, truth: &FirstOrder, initial: State, noise: &NoiseModel) -> Option<Covariance> {
    let track = Track::new(trial).with_rates(noise.yaw_rate_sd.and(trial.yaw_rate()), trial);
    let mut coefficients = Coefficients { anchor: initial, ..Coefficients::of(truth) };
    if is_backward(truth.inverse_T) {
        coefficients.anchor = track.last_state_from(truth.inverse_T, &coefficients);
    }
    let record = Record::new(track, noise.rudder_sd > 0.0);
    let information = record.information(truth.inverse_T, &NoiseVector::of(noise, truth), &coefficients)?;
    let (inverse, _) = invert(&information, CONDITION_LIMIT).ok()?;
    let covariance = inverse * noise.heading_sd.powi(2);
    Some(Covariance { degrees_of_freedom: None, ..to_response(&covariance, truth, 1.0) })
}
