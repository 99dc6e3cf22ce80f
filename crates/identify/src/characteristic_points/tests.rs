//! Truth everywhere: K = 0.1 1/s, T = 16.3 s.

use approx::assert_abs_diff_eq;
use ship::angle::to_deg;

use super::*;
use crate::testing::{Case, Start, record};

fn method(settings: Settings) -> CharacteristicPoints {
    settings.build().expect("valid settings")
}

/// The half width the reference numbers were made with.
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

/// The record on another course, with an approach of `approach` rows in front.
fn turned(case: &Case, course_deg: f64, approach: usize) -> Trial {
    let trial = case.trial();
    let rows = approach + trial.len();
    let before = |column: &[f64]| [vec![column[0]; approach], column.to_vec()].concat();
    let time = (0..rows).map(|k| k as f64 * case.period_s).collect();
    let heading = before(trial.heading()).iter().map(|psi| psi + from_deg(course_deg)).collect();
    record("turned", time, heading, before(trial.rudder()))
}

/// Independent computation, noise-free, 1 s, from rest; the parabola at the peaks is what biases. Tolerance: two units
/// of the last digit given, because the window here moves to its own vertex.
#[test]
fn bias_of_the_parabola_is_that_of_the_reference() {
    let trial = Case { start: Start::Rest, ..Case::default() }.trial();
    for (half_width, gain, time) in
        [(2.0, 0.1002, 16.33), (3.0, 0.1004, 16.36), (4.0, 0.1007, 16.41), (6.0, 0.1015, 16.54), (8.0, 0.1026, 16.72)]
    {
        let settings = Settings { half_width_s: Some(half_width), ..Settings::default() };
        let response = identify(settings, std::slice::from_ref(&trial)).response;
        assert_abs_diff_eq!(response.K(), gain, epsilon = 2e-4);
        assert_abs_diff_eq!(response.T(), time, epsilon = 0.03);
    }
    // The half width found in the record is near four rows here.
    let default = identify(Settings::default(), &[trial]);
    assert_abs_diff_eq!(default.response.K(), 0.1007, epsilon = 1e-4);
}

/// Reference, median bias (rms) in %, of 100 repeats, so that an rms is known to 10 % and a median to an eighth of it.
/// The choice of the row a peak is looked for around differs, which shows in the rms at large noise: within 35 %.
#[test]
fn noise_biases_and_scatters_as_in_the_reference() {
    let table = [
        (0.0, [(0.67, 0.67), (0.66, 0.66)]),
        (0.1, [(0.6, 0.9), (0.2, 2.0)]),
        (0.5, [(1.5, 3.5), (-3.1, 9.1)]),
        (1.0, [(2.9, 6.4), (-13.0, 17.0)]),
    ];
    for (noise_deg, reference) in table {
        let repeats = if noise_deg == 0.0 { 1 } else { 100 };
        let mut found = [Vec::new(), Vec::new()];
        for seed in 0..repeats {
            let trial = Case { noise_deg, seed, ..Case::default() }.trial();
            // A record may lose its peaks in 1 deg of noise; that is a failure, not an error in K.
            if let Ok(estimate) = method(four_seconds()).identify(&[trial]) {
                errors(&estimate).into_iter().zip(&mut found).for_each(|(error, found)| found.push(error));
            }
        }
        assert!(found[0].len() as f64 >= 0.95 * repeats as f64, "{noise_deg} deg: {} answers", found[0].len());
        for (values, (median, rms)) in found.iter_mut().zip(reference) {
            values.sort_by(f64::total_cmp);
            let own_median = values[values.len() / 2];
            let own_rms = (values.iter().map(|error| error * error).sum::<f64>() / values.len() as f64).sqrt();
            assert!((own_rms / rms - 1.0).abs() < 0.35, "{noise_deg} deg: rms {own_rms:.2} %, reference {rms} %");
            assert!(
                (own_median - median).abs() < 0.3 * rms + 0.05,
                "{noise_deg} deg: median {own_median:+.2} %, reference {median:+} %"
            );
        }
    }
}

#[test]
fn three_peaks_have_no_error_of_their_own() {
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

/// With its mended sign equation (8) is exact: what is left comes from the local cubics.
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

/// At the vertices r(t) = 0: T stands in equation (8) with r(0) alone, and a start at rest leaves nothing of it.
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
fn trials_are_pooled_and_the_bias_is_found() {
    let small = Case { bias_deg: 1.5, samples: 401, ..Case::default() };
    let large = Case { rudder_deg: -20.0, heading_deg: 20.0, start: Start::Rest, ..small };
    let both = identify(four_seconds(), &[small.trial(), large.trial()]);
    let [k, t] = errors(&both);
    assert!(k.abs() < 1.0 && t.abs() < 1.0, "K {k:+.2} %, T {t:+.2} %");
    assert_abs_diff_eq!(to_deg(both.response.rudder_bias), 1.5, epsilon = 0.02);
    let swapped = identify(four_seconds(), &[large.trial(), small.trial()]);
    assert_abs_diff_eq!(swapped.response.K(), both.response.K(), epsilon = 1e-9);
    let known = Settings { rudder_bias_deg: Some(1.5), ..four_seconds() };
    for variant in [Variant::LeastSquares, Variant::ThreePeaks, Variant::Equation8] {
        let estimate = identify(Settings { variant, ..known.clone() }, &[small.trial()]);
        assert_abs_diff_eq!(to_deg(estimate.response.rudder_bias), 1.5, epsilon = 1e-9);
        let [k, t] = errors(&estimate);
        assert!(k.abs() < 1.0 && t.abs() < 1.0, "{variant:?}: K {k:+.2} %, T {t:+.2} %");
    }
}

#[test]
fn swings_to_either_side_are_told_apart() {
    let estimate = identify(four_seconds(), &[Case { samples: 401, ..Case::default() }.trial()]);
    let figure = |name| estimate.diagnostics.iter().find(|(key, _)| *key == name).expect("present").1;
    for name in ["K_to_starboard_per_s", "K_to_port_per_s", "K_without_first_swing_per_s"] {
        assert_abs_diff_eq!(figure(name), 0.1007, epsilon = 1e-4);
    }
    for name in ["T_to_starboard_s", "T_to_port_s"] {
        assert_abs_diff_eq!(figure(name), 16.41, epsilon = 0.02);
    }
    assert!(figure("T_range_s") < 0.1);
}

#[test]
fn the_base_course_is_read_off_the_approach_or_owned_up_to() {
    let rest = Case { start: Start::Rest, noise_deg: 0.1, ..Case::default() };
    let straight = identify(four_seconds(), &[turned(&rest, 350.0, 20)]);
    assert!(straight.warnings.is_empty(), "{:?}", straight.warnings);
    for (course_deg, word) in [(0.0, "heading 0"), (350.0, "middle")] {
        let estimate = identify(four_seconds(), &[turned(&Case::default(), course_deg, 0)]);
        assert!(estimate.warnings[0].contains(word), "{:?}", estimate.warnings);
        let [k, t] = errors(&estimate);
        assert!(k.abs() < 1.0 && t.abs() < 1.0, "K {k:+.2} %, T {t:+.2} %");
    }
    let given = Settings { base_course_deg: Some(350.0), ..four_seconds() };
    assert!(identify(given, &[turned(&Case::default(), 350.0, 0)]).warnings.is_empty());
}

#[test]
fn uneven_rows_and_missing_headings_do_no_harm() {
    let case = Case { period_s: 0.5, samples: 541, ..Case::default() };
    let trial = case.trial();
    let keep = |k: usize| !k.is_multiple_of(3) && k % 7 != 2;
    let kept = |column: &[f64]| (0..trial.len()).filter(|&k| keep(k)).map(|k| column[k]).collect();
    let thinned = record("thinned", kept(trial.time()), kept(trial.heading()), kept(trial.rudder()));
    let heading = (0..trial.len()).map(|k| if keep(k) { trial.heading()[k] } else { f64::NAN }).collect();
    let hidden = record("hidden", trial.time().to_vec(), heading, trial.rudder().to_vec());
    for variant in [Variant::LeastSquares, Variant::Equation8] {
        for trial in [&thinned, &hidden] {
            let [k, t] = errors(&identify(Settings { variant, ..four_seconds() }, std::slice::from_ref(trial)));
            assert!(k.abs() < 1.0 && t.abs() < 1.0, "{variant:?}: K {k:+.2} %, T {t:+.2} %");
        }
    }
}

#[test]
fn says_why_it_cannot() {
    let line: Vec<f64> = (0..100).map(f64::from).collect();
    let straight = record("straight", line.clone(), vec![0.2; 100], vec![0.0; 100]);
    for variant in [Variant::LeastSquares, Variant::ThreePeaks, Variant::Equation8, Variant::Equation8Vertices] {
        let method = method(Settings { variant, ..Settings::default() });
        assert_eq!(method.identify(std::slice::from_ref(&straight)).expect_err("straight").kind(), "not-excited");
        assert_eq!(method.identify(&[]).expect_err("nothing").kind(), "no-trial");
        for samples in 8..60 {
            let short = Case { samples, start: Start::Rest, ..Case::default() }.trial();
            // Some answer, some refuse; none may panic.
            if let Err(error) = method.identify(&[short]) {
                assert!(!error.kind().is_empty());
            }
        }
    }
    let short = Case { samples: 40, start: Start::Rest, ..Case::default() }.trial();
    let error = method(Settings::default()).identify(&[short]).expect_err("one peak");
    assert_eq!(error.kind(), "too-few-points");
}

#[test]
fn settings_out_of_range_are_named() {
    let refused = |settings: Settings| settings.build().expect_err("out of range").key;
    assert_eq!(refused(Settings { half_width_s: Some(-1.0), ..Settings::default() }), "half-width-s");
    assert_eq!(refused(Settings { base_course_deg: Some(f64::NAN), ..Settings::default() }), "base-course-deg");
    assert_eq!(refused(Settings { rudder_bias_deg: Some(f64::INFINITY), ..Settings::default() }), "rudder-bias-deg");
    assert_eq!(refused(Settings { condition_limit: 0.5, ..Settings::default() }), "condition-limit");
}
