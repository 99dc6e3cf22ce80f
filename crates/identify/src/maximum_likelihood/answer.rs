//! From the largest likelihood to an estimate: covariance from the information, and what a reader should know.

use document::{Code, HeadingNoise, RandomMoment, Warning};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use ship::angle::to_deg;
use ship::first_order::State;
use ship::{FirstOrder, ShortNumber};
use trial::Trial;

use super::choice::Chosen;
use super::outliers::Suspects;
use super::point::{Point, Record, SHARED};
use super::search::Maximum;
use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason};
use crate::likelihood::NoiseVector;
use crate::likelihood::parameters::RUDDER;
use crate::likelihood::track::{Coefficients, Track, is_backward};
use crate::output_error::{CONDITION_LIMIT, COURSE_UNSTABLE, SIGNIFICANT, to_response};
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
fn degrees_of_freedom(records: &[Record], found: &Maximum) -> f64 {
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

/// Covariance of (1/T, b, b δ_r) and degrees of freedom of its variances, with the doubt which noise it is: the value
/// is that of the most likely one.
fn doubt(chosen: &Chosen, freedom: f64) -> (Matrix3<f64>, f64) {
    let of = |point: &Point| Vector3::new(point.inverse_time, point.gain, point.offset);
    let here = of(&chosen.found[0].1.point);
    let (mut doubt, mut weights, mut per_freedom) = (Matrix3::zeros(), 0.0, 0.0);
    for (weight, other) in &chosen.found {
        let Ok((own, _)) = covariance(&other.linearised.information) else { continue };
        let apart = of(&other.point) - here;
        doubt += (own + apart * apart.transpose()) * *weight;
        weights += weight;
        per_freedom += weight / degrees_of_freedom(&chosen.records, other).min(freedom);
    }
    (doubt / weights, weights / per_freedom)
}

/// The estimate of a chosen noise.
pub(super) fn estimate(trials: &[Trial], chosen: Chosen) -> Result<Estimate, IdentifyError> {
    let Chosen { records, found: all, at_bound, .. } = &chosen;
    let found = &all[0].1;
    let Point { inverse_time, gain, offset, deviance, ref places, ref parts, .. } = found.point;
    let response = FirstOrder { inverse_T: inverse_time, K_over_T: gain, rudder_bias: offset / gain };
    let readings: usize = parts.iter().map(|part| part.readings).sum();
    let jumps: usize = records.iter().map(|record| record.jumps.len()).sum();
    let freedom = readings as f64 - (SHARED + 2 * trials.len() + jumps) as f64;
    let singular = |condition| IdentifyError::Singular { condition, limit: CONDITION_LIMIT };
    let (inverse, condition) = covariance(&found.linearised.information).map_err(singular)?;
    let (with_doubt, degrees_of_freedom) = doubt(&chosen, freedom);
    let white = to_response(&with_doubt, &response, degrees_of_freedom);
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
    warnings.extend(response.is_course_unstable().then(|| Code::CourseUnstable.warning(COURSE_UNSTABLE)));
    let beyond = || format!("T = {} s is at its bound or beyond", ShortNumber(response.T()));
    warnings.extend(at_bound.then(|| Code::AtBound.warning(beyond())));
    let noises: Vec<NoiseModel> = (records.iter().zip(places.iter().zip(parts)))
        .map(|(record, (place, part))| place.noise(gain, part.variance.sqrt(), record.has_gyro()))
        .collect();
    warnings.extend(trials.iter().zip(&noises).filter_map(|(trial, noise)| described(trial, noise, gain)));
    warnings.extend(of_outliers(trials, &chosen));
    let mut diagnostics = vec![
        ("log_likelihood", -0.5 * deviance),
        ("condition", condition),
        ("lag1_autocorrelation", lag1),
        ("degrees_of_freedom", degrees_of_freedom),
    ];
    diagnostics.extend(of_noise(&noises[0], gain, &chosen));
    Ok(Estimate {
        response,
        uncertainty,
        robust: Some(robust_covariance),
        stop: match (at_bound, found.converged) {
            (true, _) => StopReason::RangeLimit,
            (false, true) => StopReason::Converged,
            (false, false) => StopReason::IterationLimit,
        },
        evaluations: chosen.evaluations,
        noise: Some(HeadingNoise { heading_sd_rad: noises[0].heading_sd, moment: random_moment(&noises[0], gain) }),
        diagnostics,
        warnings,
    })
}

/// What a reader should know of readings that belong to no ship.
fn of_outliers(trials: &[Trial], chosen: &Chosen) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for ((trial, record), found) in trials.iter().zip(&chosen.records).zip(&chosen.outliers) {
        let (name, time) = (trial.title(), &record.track.time);
        let times = |rows: &[usize]| {
            let shown: Vec<String> = rows.iter().take(LISTED).map(|&row| ShortNumber(time[row]).to_string()).collect();
            format!("{}{}", shown.join(", "), if rows.len() > LISTED { ", …" } else { "" })
        };
        if !found.spikes.is_empty() {
            let (count, times) = (found.spikes.len(), times(&found.spikes));
            let text = format!("{name}: headings far from those around are left out ({count}), at t = {times} s");
            warnings.push(Code::RejectedReadings.warning(text));
        }
        if !found.jumps.is_empty() {
            let times = times(&found.jumps);
            let text = format!("{name}: the heading jumps and stays off at t = {times} s; the jumps are estimated");
            warnings.push(Code::HeadingJump.warning(text));
        }
    }
    if chosen.too_many {
        let text = "more than a tenth of the headings are far from those around: none is left out; check the compass";
        warnings.push(Code::OddHeadings.warning(text));
    }
    warnings
}

/// Figures of the noise of the first record, of the outliers, and of the kinds of moment that were fitted.
fn of_noise(noise: &NoiseModel, gain: f64, chosen: &Chosen) -> Vec<(&'static str, f64)> {
    let count = |of: fn(&Suspects) -> usize| chosen.outliers.iter().map(of).sum::<usize>() as f64;
    let mut diagnostics = vec![
        ("heading_sd_deg", to_deg(noise.heading_sd)),
        ("left_out", count(|found| found.spikes.len())),
        ("jumps", count(|found| found.jumps.len())),
    ];
    diagnostics.extend(noise.heading_correlation.map(|time| ("heading_correlation_s", time)));
    diagnostics.extend(noise.yaw_rate_sd.map(|sd| ("yaw_rate_sd_deg_s", to_deg(sd))));
    match random_moment(noise, gain) {
        RandomMoment::None => {}
        RandomMoment::White { rudder_rad_root_s: size } => {
            diagnostics.push(("white_moment_rudder_deg_root_s", to_deg(size)));
        }
        RandomMoment::Walk { rudder_rad_per_root_s: size } => {
            diagnostics.push(("moment_walk_rudder_deg_per_root_s", to_deg(size)));
        }
        RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: sd, correlation_s } => {
            diagnostics.extend([("gusts_sd_rudder_deg", to_deg(sd)), ("gusts_correlation_s", correlation_s)]);
        }
    }
    diagnostics.extend((noise.rudder_sd > 0.0).then(|| ("rudder_sd_deg", to_deg(noise.rudder_sd))));
    let lowest = chosen.tried.iter().map(|(_, bic)| *bic).fold(f64::INFINITY, f64::min);
    for (kind, name) in [
        (Moment::None, "bic_none"),
        (Moment::White, "bic_white"),
        (Moment::Walk, "bic_walk"),
        (Moment::OrnsteinUhlenbeck, "bic_ornstein_uhlenbeck"),
    ] {
        let own = chosen.tried.iter().filter(|(moment, _)| *moment == kind).map(|(_, bic)| *bic);
        diagnostics.extend(own.min_by(f64::total_cmp).map(|bic| (name, bic - lowest)));
    }
    diagnostics
}

/// The random moment of a noise as the rudder angle of a ship of K/T = `gain`.
fn random_moment(noise: &NoiseModel, gain: f64) -> RandomMoment {
    let rudder = noise.moment_level / gain;
    match noise.moment {
        Moment::None => RandomMoment::None,
        Moment::White => RandomMoment::White { rudder_rad_root_s: rudder },
        Moment::Walk => RandomMoment::Walk { rudder_rad_per_root_s: rudder },
        Moment::OrnsteinUhlenbeck => {
            RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: rudder, correlation_s: noise.moment_correlation }
        }
    }
}

/// The warning of what is random beside a white compass error.
fn described(trial: &Trial, noise: &NoiseModel, gain: f64) -> Option<Warning> {
    let mut parts = Vec::new();
    match random_moment(noise, gain) {
        RandomMoment::None => {}
        RandomMoment::White { rudder_rad_root_s: size } => {
            parts.push(format!("a white yaw moment of {:.3} deg √s of rudder", to_deg(size)));
        }
        RandomMoment::Walk { rudder_rad_per_root_s: size } => {
            parts.push(format!("a yaw moment that walks by {:.3} deg/√s of rudder", to_deg(size)));
        }
        RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: sd, correlation_s } => {
            let sd = to_deg(sd);
            parts.push(format!("gusts of {sd:.3} deg of rudder with a correlation time of {correlation_s:.0} s"));
        }
    }
    if noise.rudder_sd > 0.0 {
        parts.push(format!("a rudder error of {:.3} deg", to_deg(noise.rudder_sd)));
    }
    if let Some(time) = noise.heading_correlation {
        let sd = to_deg(noise.heading_sd);
        parts.push(format!("a compass error of {sd:.3} deg with a correlation time of {time:.1} s"));
    }
    let told = || format!("{}: beside the white noise of the compass there is {}", trial.title(), parts.join(" and "));
    (!parts.is_empty()).then(|| Code::Noise.warning(told()))
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
