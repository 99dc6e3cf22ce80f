//! Tests on records of known truth: K = 0.1 1/s, T = 16.3 s, unless a test states another value.

use ship::angle::from_deg;

use super::*;
use crate::testing::{Case, record, record_with_gyro};

fn smoothed() -> Settings {
    Settings { smoothing: Some(SavitzkyGolay::default()), ..Settings::default() }
}

fn gyro() -> Settings {
    Settings { signal: Signal::YawRate, ..Settings::default() }
}

fn method(settings: Settings) -> MotionRegression {
    settings.build().expect("valid settings")
}

fn identify(settings: Settings, trials: &[Trial]) -> Estimate {
    method(settings).identify(trials).expect("identifiable")
}

/// Errors of K and T, %.
fn errors(estimate: &Estimate) -> [f64; 2] {
    [100.0 * (estimate.response.K() / 0.1 - 1.0), 100.0 * (estimate.response.T() / 16.3 - 1.0)]
}

/// Record with a rate gyro, whose noise is the heading noise of the case per second.
fn with_gyro(case: &Case) -> Trial {
    let (truth, noisy) = (case.truth(), case.trial());
    let noise = noisy.heading().iter().zip(&truth.heading).map(|(seen, psi)| seen - psi);
    let rate = truth.yaw_rate.iter().zip(noise).map(|(r, n)| r + n).collect();
    record_with_gyro(truth.time, truth.heading, truth.rudder, rate)
}

/// The bias of 1/T by noise in r is predicted: median over repeats against the diagnostic.
#[test]
fn the_bias_of_noise_is_predicted() {
    for noise_deg in [0.2, 0.5, 1.0] {
        let (mut bias, mut stated) = (Vec::new(), Vec::new());
        for seed in 0..60 {
            let estimate = identify(Settings::default(), &[Case { noise_deg, seed, ..Case::default() }.trial()]);
            bias.push(100.0 * (estimate.response.inverse_T * 16.3 - 1.0));
            stated.push(estimate.diagnostic("noise_bias_of_inverse_T_percent").expect("present"));
            assert_eq!(estimate.warnings.len(), 1);
        }
        bias.sort_by(f64::total_cmp);
        stated.sort_by(f64::total_cmp);
        assert!((bias[30] - stated[30]).abs() < 4.0, "found {:+.1} %, stated {:+.1} %", bias[30], stated[30]);
    }
}

/// A smoothed rudder is closer to the input of the smoothed heading.
#[test]
fn smoothing_the_rudder_too_lessens_the_bias() {
    let trial = [Case::default().trial()];
    let [_, plain] = errors(&identify(smoothed(), &trial));
    let [_, both] = errors(&identify(Settings { smooth_rudder: true, ..smoothed() }, &trial));
    assert!(both.abs() < 0.85 * plain.abs(), "T {plain:+.2} % and {both:+.2} %");
}

#[test]
fn the_gyro_gives_the_ship_and_its_scatter() {
    // r' is a mean over two intervals, too small by (h/T)²/6 within a swing and by more at the corners of the rudder.
    let [k, t] = errors(&identify(gyro(), &[with_gyro(&Case::default())]));
    assert!(k.abs() < 0.1 && t.abs() < 0.4, "K {k:+.3} %, T {t:+.3} %");
    let (mut squares, mut reported, mut mean) = (0.0, 0.0, 0.0);
    for seed in 0..200 {
        let estimate = identify(gyro(), &[with_gyro(&Case { noise_deg: 0.01, seed, ..Case::default() })]);
        let [k, _] = errors(&estimate);
        squares += k * k / 200.0;
        mean += k / 200.0;
        reported += 1000.0 * estimate.K().sd.expect("sd") / 200.0;
    }
    let sd = (squares - mean * mean).sqrt();
    assert!((reported / sd - 1.0).abs() < 0.2, "reported {reported:.3} %, scatter {sd:.3} %");
    let error = method(gyro()).identify(&[Case::default().trial()]).expect_err("no gyro");
    assert_eq!(error, IdentifyError::NoChannel { trial: "zigzag".into(), channel: "yaw rate" });
}

#[test]
fn says_why_it_cannot() {
    let short = Case { samples: 12, period_s: 4.0, ..Case::default() }.trial();
    let error = method(smoothed()).identify(&[short]).expect_err("shorter than a window");
    assert_eq!(error.kind(), "too-few-points");
    let trial = Case::default().trial();
    let rudder = trial.rudder().iter().map(|delta| -delta).collect();
    let flipped = record("flipped", trial.time().to_vec(), trial.heading().to_vec(), rudder);
    assert_eq!(method(Settings::default()).identify(&[flipped]).expect_err("flipped").kind(), "not-a-ship");
    let line: Vec<f64> = (0..100).map(f64::from).collect();
    let heading = line.iter().map(|t| from_deg(1.0) * t).collect();
    let held = record("held", line, heading, (0..100).map(|k| if k < 99 { 0.1 } else { 0.2 }).collect());
    // The rudder moves in the last row only, which has no window.
    assert_eq!(method(Settings::default()).identify(&[held]).expect_err("held").kind(), "singular");
}

/// A turn in seven rows and an eighth six hours later. Five equations gave a K of 0.56 ± 0.49, and seven integrated
/// equations 1.6 ± 9.
#[test]
fn a_handful_of_rows_before_a_gap_is_too_little() {
    let time = vec![0.0, 9.0, 46.0, 55.0, 64.0, 73.0, 82.0, 23_600.0];
    let heading = [0.0, 0.0, 0.0, 10.0, -685.0, 0.0, 0.0, 0.0].map(from_deg).to_vec();
    let rudder = [0.0, 0.0, 0.0, 0.0, -24.0, 0.0, 0.0, 0.0].map(from_deg).to_vec();
    let trial = record("burst", time, heading, rudder);
    for settings in crate::registry::default_settings() {
        let method = settings.build().expect("valid defaults");
        let error = method.identify(std::slice::from_ref(&trial)).expect_err("too few rows");
        assert!(error.kind().starts_with("too-few"), "{}: {error}", method.id());
    }
}
