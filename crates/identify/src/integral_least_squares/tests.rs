//! Tests on records of known truth: K = 0.1 1/s, T = 16.3 s, unless a test states another value.

use approx::assert_relative_eq;
use ship::angle::from_deg;

use super::*;
use crate::testing::{Case, record};
use estimation::least_squares::LeastSquares;

fn identify(trials: &[Trial]) -> Estimate {
    Settings::default().build().expect("valid").identify(trials).expect("identifiable")
}

/// Errors of K and T in % of a truth.
fn errors(estimate: &Estimate, case: &Case) -> [f64; 2] {
    [100.0 * (estimate.response.K() / case.K - 1.0), 100.0 * (estimate.response.T() / case.T - 1.0)]
}

/// Record with the rows `keep`.
fn rows(case: &Case, keep: impl Fn(usize) -> bool) -> Trial {
    let trial = case.trial();
    let kept = |column: &[f64]| (0..trial.len()).filter(|&k| keep(k)).map(|k| column[k]).collect();
    record("thinned", kept(trial.time()), kept(trial.heading()), kept(trial.rudder()))
}

/// Record with a heading only in the rows `seen`.
fn hidden(case: &Case, seen: impl Fn(usize) -> bool) -> Trial {
    let trial = case.trial();
    let heading = (0..trial.len()).map(|k| if seen(k) { trial.heading()[k] } else { f64::NAN }).collect();
    record("hidden", trial.time().to_vec(), heading, trial.rudder().to_vec())
}

/// With 5 s between rows the trapezoid rule alone would lose (h/T)²/12 = 0.8 % of T.
#[test]
fn coarse_sampling_is_no_bias_of_the_integral() {
    let ramp = Case { rate_deg_s: 0.5, period_s: 5.0, samples: 61, ..Case::default() };
    let [_, t] = errors(&identify(&[ramp.trial()]), &ramp);
    assert!(t.abs() < 0.15, "T {t:+.3} %");
}

#[test]
fn a_course_unstable_ship_is_an_answer_and_its_deviation_honest() {
    // Large rudder and small heading: the ship must not reach the yaw rate |K| δ, beyond which the rudder cannot stop
    // the turn.
    let case = Case { K: -0.05, T: -60.0, rudder_deg: 20.0, heading_deg: 5.0, samples: 401, ..Case::default() };
    let [k, t] = errors(&identify(&[case.trial()]), &case);
    assert!(k.abs() < 0.3 && t.abs() < 0.3, "K {k:+.3} %, T {t:+.3} %");
    let (mut squares, mut reported) = (0.0, 0.0);
    for seed in 0..200 {
        let case = Case { noise_deg: 0.2, seed, ..case };
        let estimate = identify(&[case.trial()]);
        assert!(estimate.response.is_course_unstable());
        squares += (estimate.response.inverse_T * case.T - 1.0).powi(2) / 200.0;
        let Uncertainty::Covariance(covariance) = &estimate.uncertainty else { panic!("a covariance") };
        reported += covariance.matrix[(0, 0)].sqrt() * case.T.abs() / 200.0;
    }
    assert!((reported / squares.sqrt() - 1.0).abs() < 0.15, "sd {reported:.4}, rms {:.4}", squares.sqrt());
}

#[test]
fn normal_equations_agree_with_singular_values() {
    let case = Case { noise_deg: 0.3, bias_deg: 1.0, samples: 1201, period_s: 0.5, ..Case::default() };
    let trial = case.trial();
    // A base course of 350 deg costs digits.
    let heading = trial.heading().iter().map(|psi| psi + from_deg(350.0)).collect();
    let trial = record("base course", trial.time().to_vec(), heading, trial.rudder().to_vec());
    let samples = Samples::new(&trial, 8).expect("valid");
    let piece = IntegratedStretch::new(&samples, 0..samples.len());
    let columns = piece.columns;
    let one = vec![1.0; samples.len()];
    let reference =
        LeastSquares::solve(&[&columns[0], &columns[1], &columns[2], &one, &samples.time], &columns[3], 1e8)
            .expect("well conditioned");
    let response = identify(&[trial]).response;
    assert_relative_eq!(response.inverse_T, reference.parameters[0], max_relative = 1e-10);
    assert_relative_eq!(response.K_over_T, reference.parameters[1], max_relative = 1e-10);
    assert_relative_eq!(response.rudder_bias, reference.parameters[2] / reference.parameters[1], max_relative = 1e-9);
}

/// Logs merged row by row: random intervals of 0.01 to 7 s. The noise of two nearly coincident rows must not act as a
/// slope.
#[test]
fn rows_that_nearly_coincide_do_no_harm() {
    for seed in 0..10 {
        let case = Case { period_s: 0.01, samples: 27001, noise_deg: 0.3, seed, ..Case::default() };
        let estimate = identify(&[rows(&case, |k| (k * k * 31 + k * 17) % 10007 < 100)]);
        let [k, t] = errors(&estimate, &case);
        assert!(k.abs() < 2.0 && t.abs() < 2.0, "K {k:+.2} %, T {t:+.2} %");
    }
}

#[test]
fn a_long_gap_starts_a_new_stretch() {
    let case = Case { samples: 401, noise_deg: 0.1, ..Case::default() };
    let estimate = identify(&[hidden(&case, |k| !(150..230).contains(&k))]);
    assert!(estimate.diagnostics.contains(&("stretches_without_gap", 2.0)));
    assert_eq!(estimate.warnings.len(), 1);
    let [k, t] = errors(&estimate, &case);
    let (sd_k, sd_t) = (estimate.K().sd.expect("sd") / case.K, estimate.T().sd.expect("sd") / case.T);
    assert!(k.abs() < 400.0 * sd_k && t.abs() < 400.0 * sd_t, "K {k:+.3} %, T {t:+.3} %");
}

#[test]
fn says_why_it_cannot() {
    let method = Settings::default().build().expect("valid");
    // Nine headings, each after a gap.
    let setting = Settings { longest_gap_s: Some(1.0), ..Settings::default() }.build().expect("valid");
    let sparse = Case { samples: 9, period_s: 10.0, ..Case::default() }.trial();
    assert_eq!(setting.identify(&[sparse]).expect_err("sparse").kind(), "too-few-points");
    // A rudder with reversed sign in the record, but not on the ship.
    let trial = Case::default().trial();
    let flipped = trial.rudder().iter().map(|delta| -delta).collect();
    let flipped = record("flipped", trial.time().to_vec(), trial.heading().to_vec(), flipped);
    assert_eq!(method.identify(&[flipped]).expect_err("flipped").kind(), "not-a-ship");
    // A rudder that never moves again: K and δ_r are not separable.
    let line: Vec<f64> = (0..100).map(f64::from).collect();
    let turning = record("turning", line.clone(), line.iter().map(|t| 0.01 * t).collect(), vec![0.1; 100]);
    assert!(method.identify(&[turning]).is_err());
}

/// The rudder moves only in rows isolated by gaps, so the stretches between gaps contain no rudder movement.
#[test]
fn stretches_without_any_rudder_are_refused() {
    let time: Vec<f64> = (0..40).map(f64::from).chain([400.0, 800.0]).collect();
    let heading = time.iter().map(|t| 0.2 * (0.1 * t).sin()).collect();
    let rudder = time.iter().map(|&t| if t > 40.0 { 0.2 } else { 0.0 }).collect();
    let settings = Settings { longest_gap_s: Some(5.0), ..Settings::default() };
    let method = settings.build().expect("valid settings");
    let error = method.identify(&[record("rudder in the gaps", time, heading, rudder)]).expect_err("no rudder");
    assert_eq!(error.kind(), "singular");
}
