//! Tests on records of known truth: K = 0.1 1/s, T = 16.3 s.

use approx::assert_abs_diff_eq;
use ship::angle::to_deg;

use super::*;
use crate::testing::{Case, Start, record};

fn method(settings: Settings) -> CharacteristicPoints {
    settings.build().expect("valid settings")
}

/// Settings with the half width of the reference values.
fn four_seconds() -> Settings {
    Settings { half_width_s: Some(4.0), ..Settings::default() }
}

fn identify(settings: Settings, trials: &[Trial]) -> Estimate {
    method(settings).identify(trials).expect("identifiable")
}

/// Errors of K and T, %.
fn errors(estimate: &Estimate) -> [f64; 2] {
    [100.0 * (estimate.response.K() / 0.1 - 1.0), 100.0 * (estimate.response.T() / 16.3 - 1.0)]
}

/// Record on another course, with an approach of `approach` rows before it.
fn turned(case: &Case, course_deg: f64, approach: usize) -> Trial {
    let trial = case.trial();
    let rows = approach + trial.len();
    let before = |column: &[f64]| [vec![column[0]; approach], column.to_vec()].concat();
    let time = (0..rows).map(|k| k as f64 * case.period_s).collect();
    let heading = before(trial.heading()).iter().map(|psi| psi + from_deg(course_deg)).collect();
    record("turned", time, heading, before(trial.rudder()))
}

#[test]
fn three_peaks_have_no_uncertainty() {
    let settings = Settings { variant: Variant::ThreePeaks, ..four_seconds() };
    for start in [Start::Mid, Start::Rest] {
        let estimate = identify(settings.clone(), &[Case { start, ..Case::default() }.trial()]);
        let [k, t] = errors(&estimate);
        assert!((k - 0.67).abs() < 0.05 && (t - 0.66).abs() < 0.05, "K {k:+.3} %, T {t:+.3} %");
        assert!(matches!(estimate.uncertainty, Uncertainty::None { .. }));
    }
    let short = Case { samples: 120, start: Start::Rest, ..Case::default() }.trial();
    assert_eq!(method(settings).identify(&[short]).expect_err("two peaks").kind(), "too-few-points");
}

/// With the corrected sign equation (8) is exact: the remaining error comes from the local cubics.
#[test]
fn equation_8_at_many_instants_is_unbiased_and_knows_its_scatter() {
    let settings = Settings { variant: Variant::Equation8, ..Settings::default() };
    for start in [Start::Mid, Start::Rest] {
        let [k, t] = errors(&identify(settings.clone(), &[Case { start, ..Case::default() }.trial()]));
        assert!(k.abs() < 0.15 && t.abs() < 0.15, "K {k:+.3} %, T {t:+.3} %");
    }
    let (mut squares, mut reported) = ([0.0; 2], [0.0; 2]);
    for seed in 0..200 {
        let estimate = identify(settings.clone(), &[Case { noise_deg: 0.2, seed, ..Case::default() }.trial()]);
        let sd = [estimate.K().sd.expect("sd") / 0.1, estimate.T().sd.expect("sd") / 16.3];
        for (i, error) in errors(&estimate).into_iter().enumerate() {
            squares[i] += error * error / 200.0;
            reported[i] += 100.0 * sd[i] / 200.0;
        }
    }
    for i in 0..2 {
        let rms = squares[i].sqrt();
        assert!((reported[i] / rms - 1.0).abs() < 0.2, "sd {:.3} %, rms {rms:.3} %", reported[i]);
    }
}

/// At the vertices r(t) = 0: in equation (8) T multiplies only r(0), which is zero for a start at rest.
#[test]
fn vertices_cannot_give_the_time_constant_from_rest() {
    let settings = Settings { variant: Variant::Equation8Vertices, ..four_seconds() };
    let rest = Case { start: Start::Rest, ..Case::default() }.trial();
    let error = method(settings.clone()).identify(&[rest]).expect_err("T is not in the equations");
    assert_eq!(error, IdentifyError::Singular { condition: f64::INFINITY, limit: 1e6 });
    let [k, t] = errors(&identify(settings, &[Case::default().trial()]));
    assert!(k.abs() < 1.0 && t.abs() < 1.0, "K {k:+.2} %, T {t:+.2} %");
}

#[test]
fn trials_are_pooled_and_the_bias_is_identified() {
    let small = Case { bias_deg: 1.5, samples: 401, ..Case::default() };
    let large = Case { rudder_deg: -20.0, heading_deg: 20.0, start: Start::Rest, ..small };
    let both = identify(four_seconds(), &[small.trial(), large.trial()]);
    let [k, t] = errors(&both);
    assert!(k.abs() < 1.0 && t.abs() < 1.0, "K {k:+.2} %, T {t:+.2} %");
    assert_abs_diff_eq!(to_deg(both.response.rudder_bias), 1.5, epsilon = 0.02);
    let swapped = identify(four_seconds(), &[large.trial(), small.trial()]);
    assert_abs_diff_eq!(swapped.response.K(), both.response.K(), epsilon = 1e-9);
    let given = Settings { rudder_bias_deg: Some(1.5), ..four_seconds() };
    for variant in [Variant::LeastSquares, Variant::ThreePeaks, Variant::Equation8] {
        let estimate = identify(Settings { variant, ..given.clone() }, &[small.trial()]);
        assert_abs_diff_eq!(to_deg(estimate.response.rudder_bias), 1.5, epsilon = 1e-9);
        let [k, t] = errors(&estimate);
        assert!(k.abs() < 1.0 && t.abs() < 1.0, "{variant:?}: K {k:+.2} %, T {t:+.2} %");
    }
}

#[test]
fn figures_by_side_are_reported() {
    let estimate = identify(four_seconds(), &[Case { samples: 401, ..Case::default() }.trial()]);
    let figure = |name| estimate.diagnostic(name).expect("present");
    for name in ["K_to_starboard_per_s", "K_to_port_per_s", "K_without_first_swing_per_s"] {
        assert_abs_diff_eq!(figure(name), 0.1007, epsilon = 1e-4);
    }
    for name in ["T_to_starboard_s", "T_to_port_s"] {
        assert_abs_diff_eq!(figure(name), 16.41, epsilon = 0.02);
    }
    assert!(figure("T_range_s") < 0.1);
}

#[test]
fn a_missing_approach_is_reported() {
    let rest = Case { start: Start::Rest, noise_deg: 0.1, ..Case::default() };
    let straight = identify(four_seconds(), &[turned(&rest, 350.0, 20)]);
    assert!(straight.warnings.is_empty(), "{:?}", straight.warnings);
    for (course_deg, word) in [(0.0, "heading 0"), (350.0, "middle")] {
        let estimate = identify(four_seconds(), &[turned(&Case::default(), course_deg, 0)]);
        assert!(estimate.warnings[0].text.contains(word), "{:?}", estimate.warnings);
        let [k, t] = errors(&estimate);
        assert!(k.abs() < 1.0 && t.abs() < 1.0, "K {k:+.2} %, T {t:+.2} %");
    }
    let given = Settings { base_course_deg: Some(350.0), ..four_seconds() };
    assert!(identify(given, &[turned(&Case::default(), 350.0, 0)]).warnings.is_empty());
}

#[test]
fn says_why_it_cannot() {
    for variant in [Variant::ThreePeaks, Variant::Equation8, Variant::Equation8Vertices] {
        let method = method(Settings { variant, ..Settings::default() });
        for samples in 8..60 {
            let short = Case { samples, start: Start::Rest, ..Case::default() }.trial();
            // Some settings give an estimate, some fail; none may panic.
            if let Err(error) = method.identify(&[short]) {
                assert!(!error.kind().is_empty());
            }
        }
    }
    let short = Case { samples: 40, start: Start::Rest, ..Case::default() }.trial();
    let error = method(Settings::default()).identify(&[short]).expect_err("one peak");
    assert_eq!(error.kind(), "too-few-points");
}
