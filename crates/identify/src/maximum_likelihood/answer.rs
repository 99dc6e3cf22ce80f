//! Estimate at the maximum likelihood: covariance from the information, diagnostics and warnings. Sources of the
//! degrees of freedom: Satterthwaite (1946); Kenward and Roger (1997).

use document::{HeadingNoise, RandomMoment, Warning, WarningCode};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use ship::angle::to_deg;
use ship::first_order::YawState;
use ship::{FirstOrder, ShortNumber};
use trial::Trial;

use super::choice::ChosenLaw;
use super::outliers::Suspects;
use super::point::{Point, Record, SHARED_PARAMETERS};
use super::search::Maximum;
use crate::error::IdentifyError;
use crate::estimate::{Covariance, Estimate, StopReason};
use crate::likelihood::NoiseVector;
use crate::likelihood::parameters::RUDDER_INDEX;
use crate::likelihood::track::{MotionCoefficients, TrialSignals, is_backward};
use crate::output_error::{MAX_CONDITION, MIN_GAIN_DEVIATIONS, UNSTABLE_WARNING, response_covariance};
use crate::profile::invert;
use crate::robust;
use trial::noise_model::{MomentKind, NoiseModel};

/// Step of a logarithm for the numerical derivative of a variance.
const DIFFERENCE: f64 = 0.05;

/// Maximum number of outlier times that are listed.
const LISTED: usize = 8;

/// Covariance of (1/T, b, b δ_r) from the information, with noise and initial states eliminated, and its condition
/// number. Fails with the condition number if it exceeds [`MAX_CONDITION`].
fn covariance(information: &DMatrix<f64>) -> Result<(Matrix3<f64>, f64), f64> {
    let entries = information.nrows() - SHARED_PARAMETERS;
    let mut reduced = information.fixed_view::<SHARED_PARAMETERS, SHARED_PARAMETERS>(0, 0).into_owned();
    if entries > 0 {
        let noise = information.view((SHARED_PARAMETERS, SHARED_PARAMETERS), (entries, entries)).into_owned();
        let cross = information.view((SHARED_PARAMETERS, 0), (entries, SHARED_PARAMETERS)).into_owned();
        // An entry at the edge of its range may have no information.
        let ridge = DMatrix::from_fn(entries, entries, |i, j| if i == j { 1e-10 * noise[(i, i)] + 1e-12 } else { 0.0 });
        if let Some(factor) = (noise + ridge).cholesky() {
            let explained = cross.transpose() * factor.solve(&cross);
            reduced -= Matrix3::from_fn(|i, j| explained[(i, j)]);
        }
    }
    invert(&reduced, MAX_CONDITION)
}

/// Degrees of freedom of the variances of K, T and δ_r, the minimum of the three: the uncertainty of the noise sizes
/// makes the variances uncertain, dof = 2/Var(log v) (Satterthwaite 1946; Kenward and Roger 1997).
fn degrees_of_freedom(records: &[Record], maximum: &Maximum) -> f64 {
    let Point { inverse_T, K_over_T, offset, ref vectors, ref parts, .. } = maximum.point;
    let motion = |number: usize, vector: &NoiseVector| {
        let part = &parts[number];
        let coefficients = MotionCoefficients { anchor: part.anchor, K_over_T, offset };
        let products = records[number].information(inverse_T, vector, &coefficients);
        products.map(|products| products / part.variance)
    };
    let motions: Vec<Matrix3<f64>> = parts.iter().map(|part| part.motion / part.variance).collect();
    let inverse = motions.iter().sum::<Matrix3<f64>>().try_inverse();
    let Some(inverse) = inverse else { return 1.0 };
    // Gradients of log K, log T and δ_r with respect to (1/T, b, b δ_r).
    let (a, b) = (inverse_T, K_over_T);
    let directions = [
        Vector3::new(-1.0 / a, 1.0 / b, 0.0),
        Vector3::new(1.0, 0.0, 0.0),
        Vector3::new(0.0, -offset / (b * b), 1.0 / b),
    ];
    let mut variance = [0.0; 3];
    let mut first = SHARED_PARAMETERS;
    for (number, (record, vector)) in records.iter().zip(vectors).enumerate() {
        let readings = parts[number].readings as f64;
        let entries: Vec<usize> = vector.active_entries(record.has_gyro()).collect();
        let by_entry: Vec<Matrix3<f64>> = (entries.iter())
            .map(|&entry| {
                let moved = |by: f64| {
                    let mut shifted = *vector;
                    shifted.log_entries[entry] += by;
                    motion(number, &shifted).unwrap_or_else(Matrix3::zeros)
                };
                let change = (moved(DIFFERENCE) - moved(-DIFFERENCE)) / (2.0 * DIFFERENCE);
                // A tied compass error shrinks as its entry grows.
                let tied = entry == RUDDER_INDEX && record.declared_rudder_sd.is_some();
                if tied { change + motions[number] * 2.0 } else { change }
            })
            .collect();
        let count = entries.len();
        let information = maximum.derivatives.information.view((first, first), (count, count)).into_owned();
        let ridge = DMatrix::from_fn(count, count, |i, j| if i == j { 1e-9 * information[(i, i)] + 1e-9 } else { 0.0 });
        let factor = (information + ridge).cholesky();
        let is_tied = vector.has_rudder_error && record.declared_rudder_sd.is_some();
        for (variance, direction) in variance.iter_mut().zip(&directions) {
            let seen = inverse * direction;
            let size = direction.dot(&seen);
            let change = |by: &Matrix3<f64>| -seen.dot(&(by * seen)) / size;
            let by_size = change(&(motions[number] * -2.0));
            let mut slopes = DVector::from_iterator(count, by_entry.iter().map(change));
            if !is_tied {
                slopes -= &maximum.derivatives.log_variance_slopes[number] * (by_size / (2.0 * readings));
                *variance += by_size * by_size / (2.0 * readings);
            }
            *variance += factor.as_ref().map_or(0.0, |factor| slopes.dot(&factor.solve(&slopes)));
        }
        first += count;
    }
    2.0 / variance.into_iter().fold(0.0, f64::max)
}

/// Covariance of (1/T, b, b δ_r) and degrees of freedom of the variances, averaged over the plausible noise laws, about
/// the estimate of the most plausible law.
fn averaged_covariance(chosen: &ChosenLaw, freedom: f64) -> (Matrix3<f64>, f64) {
    let estimate_of = |point: &Point| Vector3::new(point.inverse_T, point.K_over_T, point.offset);
    let here = estimate_of(&chosen.maxima[0].1.point);
    let (mut total, mut weights, mut per_freedom) = (Matrix3::zeros(), 0.0, 0.0);
    for (weight, maximum) in &chosen.maxima {
        let Ok((within, _)) = covariance(&maximum.derivatives.information) else { continue };
        let shift = estimate_of(&maximum.point) - here;
        total += (within + shift * shift.transpose()) * *weight;
        weights += weight;
        per_freedom += weight / degrees_of_freedom(&chosen.records, maximum).min(freedom);
    }
    (total / weights, weights / per_freedom)
}

/// Estimate under the selected noise law.
pub(super) fn estimate(trials: &[Trial], chosen: ChosenLaw) -> Result<Estimate, IdentifyError> {
    let ChosenLaw { records, maxima, is_at_bound, .. } = &chosen;
    let maximum = &maxima[0].1;
    let Point { inverse_T, K_over_T, offset, deviance, ref vectors, ref parts, .. } = maximum.point;
    let response = FirstOrder { inverse_T, K_over_T, rudder_bias: offset / K_over_T };
    let readings: usize = parts.iter().map(|part| part.readings).sum();
    let jumps: usize = records.iter().map(|record| record.jump_rows.len()).sum();
    let freedom = readings as f64 - (SHARED_PARAMETERS + 2 * trials.len() + jumps) as f64;
    let singular = |condition| IdentifyError::Singular { condition, limit: MAX_CONDITION };
    let (inverse, condition) = covariance(&maximum.derivatives.information).map_err(singular)?;
    let (averaged, degrees_of_freedom) = averaged_covariance(&chosen, freedom);
    let white = response_covariance(&averaged, &response, degrees_of_freedom);
    let sd = white.matrix[(1, 1)].sqrt();
    if K_over_T < MIN_GAIN_DEVIATIONS * sd {
        return Err(IdentifyError::NoRudderEffect { K_over_T, sd });
    }
    let scores: Vec<[Vec<f64>; 3]> = (maximum.derivatives.scores.iter().zip(parts))
        .map(|(scores, part)| scores.each_ref().map(|column| column.iter().map(|x| x / part.variance).collect()))
        .collect();
    let long_run = robust::newey_west_three(&scores) * (readings as f64 / freedom);
    let robust_covariance = response_covariance(&(inverse * long_run * inverse), &response, freedom);
    let lag1 = robust::lag1_autocorrelation(parts.iter().map(|part| part.innovations.as_slice()));
    let (uncertainty, warning) = robust::reported_covariance(white, &robust_covariance, lag1, readings);
    let mut warnings = Vec::from_iter(warning);
    warnings.extend(response.is_course_unstable().then(|| WarningCode::CourseUnstable.warning(UNSTABLE_WARNING)));
    let beyond = || format!("T = {} s lies at or beyond the limit of the search", ShortNumber(response.T()));
    warnings.extend(is_at_bound.then(|| WarningCode::AtBound.warning(beyond())));
    let noises: Vec<NoiseModel> = (records.iter().zip(vectors.iter().zip(parts)))
        .map(|(record, (vector, part))| vector.to_model(K_over_T, part.variance.sqrt(), record.has_gyro()))
        .collect();
    warnings.extend(trials.iter().zip(&noises).filter_map(|(trial, noise)| noise_warning(trial, noise, K_over_T)));
    warnings.extend(outlier_warnings(trials, &chosen));
    let mut diagnostics = vec![
        ("log_likelihood", -0.5 * deviance),
        ("condition", condition),
        ("lag1_autocorrelation", lag1),
        ("degrees_of_freedom", degrees_of_freedom),
    ];
    diagnostics.extend(noise_diagnostics(&noises[0], K_over_T, &chosen));
    Ok(Estimate {
        response,
        uncertainty,
        robust_covariance: Some(robust_covariance),
        stop: match (is_at_bound, maximum.has_converged) {
            (true, _) => StopReason::RangeLimit,
            (false, true) => StopReason::Converged,
            (false, false) => StopReason::IterationLimit,
        },
        evaluations: chosen.evaluations,
        noise: Some(HeadingNoise { heading_sd_rad: noises[0].heading_sd, moment: random_moment(&noises[0], K_over_T) }),
        diagnostics,
        warnings,
    })
}

/// Warnings on the outliers of the compass.
fn outlier_warnings(trials: &[Trial], chosen: &ChosenLaw) -> Vec<Warning> {
    let mut warnings = Vec::new();
    for ((trial, record), suspects) in trials.iter().zip(&chosen.records).zip(&chosen.outliers) {
        let (name, time) = (trial.title(), &record.signals.time);
        let times = |rows: &[usize]| {
            let shown: Vec<String> = rows.iter().take(LISTED).map(|&row| ShortNumber(time[row]).to_string()).collect();
            format!("{}{}", shown.join(", "), if rows.len() > LISTED { ", …" } else { "" })
        };
        if !suspects.spike_rows.is_empty() {
            let (count, times) = (suspects.spike_rows.len(), times(&suspects.spike_rows));
            let text = format!("{name}: headings far from their neighbours are left out ({count}), at t = {times} s");
            warnings.push(WarningCode::RejectedReadings.warning(text));
        }
        if !suspects.jump_rows.is_empty() {
            let times = times(&suspects.jump_rows);
            let text = format!("{name}: the heading jumps and stays off at t = {times} s; jump sizes are estimated");
            warnings.push(WarningCode::HeadingJump.warning(text));
        }
    }
    if chosen.has_too_many_outliers {
        let text = "more than a tenth of the headings are far from their neighbours: none left out; check the compass";
        warnings.push(WarningCode::OddHeadings.warning(text));
    }
    warnings
}

/// Diagnostics of the noise of the first record, of the outliers, and of the kinds of moment that were fitted.
fn noise_diagnostics(noise: &NoiseModel, K_over_T: f64, chosen: &ChosenLaw) -> Vec<(&'static str, f64)> {
    let count = |suspects: fn(&Suspects) -> usize| chosen.outliers.iter().map(suspects).sum::<usize>() as f64;
    let mut diagnostics = vec![
        ("heading_sd_deg", to_deg(noise.heading_sd)),
        ("left_out", count(|suspects| suspects.spike_rows.len())),
        ("jumps", count(|suspects| suspects.jump_rows.len())),
    ];
    diagnostics.extend(noise.heading_correlation_time.map(|time| ("heading_correlation_s", time)));
    diagnostics.extend(noise.yaw_rate_sd.map(|sd| ("yaw_rate_sd_deg_s", to_deg(sd))));
    match random_moment(noise, K_over_T) {
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
    let lowest = chosen.bic_by_moment.iter().map(|(_, bic)| *bic).fold(f64::INFINITY, f64::min);
    for (kind, name) in [
        (MomentKind::None, "bic_none"),
        (MomentKind::White, "bic_white"),
        (MomentKind::Walk, "bic_walk"),
        (MomentKind::OrnsteinUhlenbeck, "bic_ornstein_uhlenbeck"),
    ] {
        let fitted = chosen.bic_by_moment.iter().filter(|(moment, _)| *moment == kind).map(|(_, bic)| *bic);
        diagnostics.extend(fitted.min_by(f64::total_cmp).map(|bic| (name, bic - lowest)));
    }
    diagnostics
}

/// Random moment of a noise law as the rudder angle of a ship with this K/T, 1/s².
fn random_moment(noise: &NoiseModel, K_over_T: f64) -> RandomMoment {
    let rudder = noise.moment_level / K_over_T;
    match noise.moment {
        MomentKind::None => RandomMoment::None,
        MomentKind::White => RandomMoment::White { rudder_rad_root_s: rudder },
        MomentKind::Walk => RandomMoment::Walk { rudder_rad_per_root_s: rudder },
        MomentKind::OrnsteinUhlenbeck => {
            RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: rudder, correlation_s: noise.moment_correlation_time }
        }
    }
}

/// Warning that lists the noise beyond a white compass error.
fn noise_warning(trial: &Trial, noise: &NoiseModel, K_over_T: f64) -> Option<Warning> {
    let mut parts = Vec::new();
    match random_moment(noise, K_over_T) {
        RandomMoment::None => {}
        RandomMoment::White { rudder_rad_root_s: size } => {
            parts.push(format!("gusts whose mean over 1 s is like {:.3} deg of rudder", to_deg(size)));
        }
        RandomMoment::Walk { rudder_rad_per_root_s: size } => {
            parts.push(format!("a random drift of the yaw moment, about {:.3} deg of rudder in 1 s", to_deg(size)));
        }
        RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: sd, correlation_s } => {
            let sd = to_deg(sd);
            parts.push(format!("gusts like {sd:.3} deg of rudder that last about {correlation_s:.0} s"));
        }
    }
    if noise.rudder_sd > 0.0 {
        parts.push(format!("an error of the recorded rudder of {:.3} deg", to_deg(noise.rudder_sd)));
    }
    if let Some(time) = noise.heading_correlation_time {
        let sd = to_deg(noise.heading_sd);
        parts.push(format!("a compass error of {sd:.3} deg that lasts about {time:.1} s"));
    }
    let text = || format!("{}: besides compass noise the record shows {}", trial.title(), parts.join(" and "));
    (!parts.is_empty()).then(|| WarningCode::Noise.warning(text()))
}

/// Cramér–Rao bound of (1/T, K/T, δ_r) for one trial with given true parameters and noise: the minimum covariance of an
/// unbiased method that also estimates the initial state.
///
/// The information is Σ (∂ν/∂θ)(∂ν/∂θ)ᵀ/S over the innovations; the small information of the noise spectrum on 1/T is
/// neglected. `initial` is the true heading (rad) and yaw rate (rad/s) at the first observed row. `None` if the
/// record does not determine the parameters. Source: Cramér (1946), Rao (1945).
pub fn cramer_rao(trial: &Trial, truth: &FirstOrder, initial: YawState, noise: &NoiseModel) -> Option<Covariance> {
    let signals = TrialSignals::new(trial).with_rates(noise.yaw_rate_sd.and(trial.yaw_rate()), trial);
    let mut coefficients = MotionCoefficients { anchor: initial, ..MotionCoefficients::from_response(truth) };
    if is_backward(truth.inverse_T) {
        coefficients.anchor = signals.last_state_from(truth.inverse_T, &coefficients);
    }
    let record = Record::new(signals, noise.rudder_sd > 0.0, None);
    let information = record.information(truth.inverse_T, &NoiseVector::from_model(noise, truth), &coefficients)?;
    let (inverse, _) = invert(&information, MAX_CONDITION).ok()?;
    let covariance = inverse * noise.heading_sd.powi(2);
    Some(Covariance { degrees_of_freedom: None, ..response_covariance(&covariance, truth, 1.0) })
}
