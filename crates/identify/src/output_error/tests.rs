//! Output error on records with given true parameters.

use super::*;
use crate::estimate::Uncertainty;
use crate::testing::{Case, Start, record, steered};
use approx::assert_relative_eq;
use ship::angle::from_deg;
use ship::first_order::YawState;

fn method() -> OutputError {
    Settings::default().build().expect("default settings are valid")
}

/// Record whose heading is exactly the response to the recorded rudder.
fn exact_record(response: &FirstOrder, initial: YawState, rows: usize, period: f64) -> Trial {
    let rudder = Case { samples: rows, period_s: period, start: Start::Rest, ..Case::default() }.truth().rudder;
    let time: Vec<f64> = (0..rows).map(|k| 5.0 + k as f64 * period).collect();
    let heading = steered(response, initial, &time, &rudder);
    record("exact", time, heading, rudder)
}

#[test]
fn recovers_ships_of_either_stability_to_rounding() {
    let initial = YawState { heading: 0.2, yaw_rate: -0.004 };
    for (inverse_T, K_over_T) in
        [(1.0 / 16.3, 0.1 / 16.3), (0.4, 0.03), (1e-6, 6e-3), (0.0, 6e-3), (-0.01, 5e-3), (-0.03, 6e-3)]
    {
        let truth = FirstOrder { inverse_T, K_over_T, rudder_bias: from_deg(0.7) };
        let trial = exact_record(&truth, initial, 271, 1.0);
        let response = method().identify(&[trial]).expect("noise-free").response;
        let scale = 1.0 / 271.0;
        assert!(
            (response.inverse_T - inverse_T).abs() < 1e-7 * (inverse_T.abs() + scale),
            "{response:?} for {truth:?}"
        );
        assert_relative_eq!(response.K_over_T, K_over_T, max_relative = 1e-6);
        assert_relative_eq!(response.rudder_bias, truth.rudder_bias, max_relative = 1e-5);
    }
}

/// The rudder rests or moves at one rate, so its corners follow from two rows of every stroke: the only remaining error
/// is rounding. A rudder that is linear from row to row would give an error of 0.02 % in K at 1 s.
#[test]
fn corners_of_the_rudder_between_rows_leave_no_bias() {
    for (rudder_deg, heading_deg, period_s) in
        [(10.0, 10.0, 1.0), (10.0, 20.0, 0.5), (10.0, 10.0, 2.0), (20.0, 20.0, 5.0)]
    {
        for start in [Start::Mid, Start::Rest] {
            let samples = (300.0 / period_s) as usize;
            let case = Case { rudder_deg, heading_deg, period_s, samples, start, bias_deg: 0.5, ..Case::default() };
            let response = method().identify(&[case.trial()]).expect("noise-free").response;
            assert_relative_eq!(response.K(), case.K, max_relative = 2e-6);
            assert_relative_eq!(response.T(), case.T, max_relative = 2e-6);
        }
    }
}

/// No start of a local search over T in 2..500 s, of either sign, ends lower than the scan.
#[test]
fn no_start_beats_the_scan() {
    for case in [
        Case { noise_deg: 0.5, seed: 3, ..Case::default() },
        Case {
            noise_deg: 0.1,
            seed: 4,
            rudder_deg: 20.0,
            heading_deg: 20.0,
            start: Start::Rest,
            bias_deg: 1.0,
            ..Case::default()
        },
    ] {
        let trial = case.trial();
        let estimate = method().identify(std::slice::from_ref(&trial)).expect("excited");
        let best = estimate.diagnostic("heading_rmse_deg").expect("reported");
        let mut profile = Profile::new(vec![TrialSignals::new(&trial)]);
        for k in 0..=60 {
            for sign in [1.0, -1.0] {
                let start = sign / (2.0 * 250f64.powf(k as f64 / 60.0));
                if let Some(minimum) = method().polish(&mut profile, start, 1.0 / trial.duration(), &method().goal()) {
                    let rmse = to_deg((minimum.rss / trial.len() as f64).sqrt());
                    assert!(rmse >= best * (1.0 - 1e-9), "1/T = {start} leads to {rmse} deg, the scan to {best} deg");
                }
            }
        }
    }
}

/// A heading that oscillates by itself, at another frequency than the rudder, gives no K.
#[test]
fn a_heading_that_does_not_answer_the_rudder_is_refused() {
    let steered = Case { start: Start::Rest, ..Case::default() }.trial();
    let heading = steered.time().iter().map(|t| 0.2 * (0.71 * t).sin()).collect();
    let adrift = record("adrift", steered.time().to_vec(), heading, steered.rudder().to_vec());
    let error = method().identify(&[adrift]).expect_err("the rudder does nothing");
    assert_eq!(error.kind(), "no-rudder-effect", "{error}");
}

/// Twenty seconds in much noise: the best fit may be a T of a hundredth of a second, whose information is singular to
/// rounding. It must not have intervals of zero width.
#[test]
fn what_rounding_decides_is_refused() {
    let mut refused = 0;
    for seed in 0..300 {
        let case = Case { samples: 20, noise_deg: 1.5, start: Start::Rest, seed, ..Case::default() };
        match method().identify(&[case.trial()]) {
            Ok(estimate) => {
                let Uncertainty::Covariance(covariance) = &estimate.uncertainty else { panic!("has a covariance") };
                assert!(covariance.matrix.diagonal().min() > 0.0, "{}", covariance.matrix);
            }
            Err(error) => refused += usize::from(error.kind() == "singular"),
        }
    }
    assert!(refused > 0);
}

/// A rudder with only the sign wrong is not a course-unstable ship with a vanishing T: the refusal gives the best fit
/// to within a step of the scan (33 %).
#[test]
fn a_rudder_of_the_wrong_sign_is_refused() {
    for case in [
        Case::default(),
        Case { noise_deg: 0.3, start: Start::Rest, ..Case::default() },
        Case { heading_deg: 20.0, ..Case::default() },
    ] {
        let steered = case.trial();
        let opposite = steered.rudder().iter().map(|delta| -delta).collect();
        let trial = record("sign", steered.time().to_vec(), steered.heading().to_vec(), opposite);
        let error = method().identify(&[trial]).expect_err("the rudder turns the ship to the other side");
        let IdentifyError::NotAShip { inverse_T, K_over_T } = error else { panic!("{error}") };
        assert_relative_eq!(inverse_T, 1.0 / 16.3, max_relative = 0.33);
        assert_relative_eq!(K_over_T, -0.1 / 16.3, max_relative = 0.33);
    }
}

/// Both methods have equal estimates for white noise and equal sandwich covariances: on few rows the correction for the
/// degrees of freedom counts.
#[test]
fn the_robust_covariance_is_that_of_the_instrumental_variables() {
    let trial = [Case { samples: 15, period_s: 8.0, noise_deg: 0.2, ..Case::default() }.trial()];
    let instruments = crate::srivc::Settings::default().build().expect("valid");
    let [output_error, srivc] = [method().identify(&trial), instruments.identify(&trial)]
        .map(|estimate| estimate.expect("steered").robust_covariance.expect("a robust covariance").matrix);
    for i in 0..3 {
        assert_relative_eq!(output_error[(i, i)], srivc[(i, i)], max_relative = 1e-5);
    }
}

/// A ship that responds faster than the range of the search: the end of the search is not an estimate, and must not
/// look like one.
#[test]
fn a_time_constant_at_the_end_of_the_search_says_so() {
    let bounded = |smallest| Settings { smallest_time_constant_s: Some(smallest), ..Settings::default() };
    for case in [Case::default(), Case { noise_deg: 0.2, seed: 5, start: Start::Rest, ..Case::default() }] {
        let trial = [case.trial()];
        let bounded_fit = |smallest| bounded(smallest).build().expect("valid").identify(&trial).expect("steered");
        let (free, held) = (bounded_fit(1.0), bounded_fit(2.0 * case.T));
        assert_eq!(free.stop, StopReason::Converged);
        assert!(free.warnings.iter().all(|warning| !warning.text.contains("limit of")));
        assert_eq!(held.stop, StopReason::RangeLimit, "T = {} s", held.response.T());
        assert!(held.warnings.iter().any(|warning| warning.text.contains("limit of")), "{:?}", held.warnings);
    }
}
