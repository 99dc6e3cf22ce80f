use approx::assert_relative_eq;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use ship::angle::{from_deg, to_deg};
use statrs::distribution::{ContinuousCDF, Normal};
use trial::SensorNoise;

use super::choice::PreparedRecords;
use super::point::{Record, evaluate};
use super::score::score_and_information;
use trial::noise_model::{MomentKind, NoiseModel};

use super::*;
use crate::likelihood::NoiseVector;
use crate::likelihood::track::TrialSignals;
use crate::output_error;
use crate::testing::{Case, record, record_with_gyro};
use trial::Trial;

/// Generator of independent normal numbers.
fn draws(seed: u64) -> impl FnMut() -> f64 {
    let (normal, mut generator) = (Normal::standard(), ChaCha8Rng::seed_from_u64(seed));
    move || normal.inverse_cdf((f64::from(generator.random::<u32>()) + 0.5) / 4294967296.0)
}

/// Random disturbance of a record, as rudder angle in degrees at every row, linear between rows.
enum ExtraNoise {
    /// Random walk with this standard deviation after one second.
    Walk(f64),
    /// White noise of the recorded rudder alone.
    RudderError(f64),
}

/// Record whose heading was computed with a rudder other than the recorded rudder.
fn disturbed(case: &Case, noise: &ExtraNoise) -> Trial {
    let truth = case.truth();
    let mut draw = draws(1000 + case.seed);
    let mut walk = 0.0;
    let extra: Vec<f64> = (truth.time.iter())
        .map(|_| match noise {
            ExtraNoise::Walk(step) => {
                walk += from_deg(*step) * draw();
                walk
            }
            ExtraNoise::RudderError(sd) => from_deg(*sd) * draw(),
        })
        .collect();
    // The response is linear: the response to the extra rudder is added.
    let ship = case.ship();
    let mut state = ship::first_order::YawState::default();
    let mut heading = Vec::new();
    for row in 0..extra.len() {
        if row > 0 {
            let h = truth.time[row] - truth.time[row - 1];
            let (u0, u1) = (ship.K_over_T * extra[row - 1], ship.K_over_T * extra[row]);
            state = ship::first_order::FirstOrderTransition::new(ship.inverse_T, h).advance(state, u0, (u1 - u0) / h);
        }
        heading.push(truth.heading[row] + state.heading + from_deg(case.noise_deg) * draw());
    }
    let rudder = match noise {
        ExtraNoise::Walk(_) => truth.rudder.clone(),
        ExtraNoise::RudderError(_) => truth.rudder.iter().zip(&extra).map(|(delta, error)| delta - error).collect(),
    };
    let trial = record("disturbed", truth.time, heading, rudder);
    match noise {
        ExtraNoise::Walk(_) => trial,
        ExtraNoise::RudderError(sd) => {
            trial.with_noise(SensorNoise { rudder_sd: Some(from_deg(*sd)), ..SensorNoise::default() })
        }
    }
}

fn identify(trials: &[Trial]) -> Estimate {
    Settings::default().build().expect("valid").identify(trials).expect("an answer")
}

fn noisy() -> Case {
    Case { noise_deg: 0.1, seed: 5, ..Case::default() }
}

/// Without process noise, estimate and interval agree with output error.
#[test]
fn a_calm_record_has_the_answer_of_output_error() {
    let method = Settings { moment: MomentChoice::None, ..Settings::default() }.build().expect("valid");
    let plain = output_error::Settings::default().build().expect("valid");
    for case in [noisy(), Case { K: -0.05, T: -60.0, rudder_deg: 20.0, ..noisy() }] {
        let trial = case.trial();
        let found = method.identify(std::slice::from_ref(&trial)).expect("an answer");
        let expected = plain.identify(std::slice::from_ref(&trial)).expect("an answer");
        for (likely, nearest) in
            [(found.K(), expected.K()), (found.T(), expected.T()), (found.rudder_bias(), expected.rudder_bias())]
        {
            assert_relative_eq!(likely.value, nearest.value, max_relative = 1e-6);
            for (a, b) in likely.ci95.expect("bounded").into_iter().zip(nearest.ci95.expect("bounded")) {
                assert_relative_eq!(a, b, max_relative = 1e-4);
            }
        }
        let chosen = identify(std::slice::from_ref(&trial));
        assert_relative_eq!(chosen.T().value, expected.T().value, max_relative = 1e-6);
    }
}

/// Comparison of the slopes of both likelihoods with their differences, for two records of one ship.
#[test]
fn the_score_is_the_derivative() {
    let gyro = |trial: &Trial| {
        let rate: Vec<f64> = noisy().truth().yaw_rate.iter().map(|r| r + 1e-4 * (1e3 * r).sin()).collect();
        record_with_gyro(trial.time().to_vec(), trial.heading().to_vec(), trial.rudder().to_vec(), rate)
    };
    let trials = [disturbed(&noisy(), &ExtraNoise::Walk(0.1)), gyro(&Case { seed: 6, ..noisy() }.trial())];
    let records: Vec<Record> = trials
        .iter()
        .map(|trial| Record::new(TrialSignals::new(trial).with_rates(trial.yaw_rate(), trial), true, None))
        .collect();
    for moment in MomentKind::ALL {
        let plain = NoiseVector { moment, log_entries: [-6.0, 2.0, 0.0, 0.0, 0.0], ..NoiseVector::default() };
        let log = [-6.5, 3.0, -6.0, 1.0, -1.0];
        let vectors =
            [plain, NoiseVector { moment, has_rudder_error: true, has_coloured_compass: true, log_entries: log }];
        let a = 0.063;
        let fit = |a: f64, vectors: &[NoiseVector]| {
            // Beside another start, as a search evaluates them.
            let starts = [(a, vectors.to_vec()), (1.3 * a, vectors.to_vec())];
            evaluate(&records, &starts).swap_remove(0).expect("a fit")
        };
        let point = fit(a, &vectors);
        let derivatives = score_and_information(&records, &point).expect("a fit");
        // With respect to 1/T: the likelihood with all other unknowns at their optimum.
        let height = |a: f64| fit(a, &vectors).deviance;
        let numeric = 0.5 * (height(a + 1e-6) - height(a - 1e-6)) / 2e-6;
        // The sizes of the compass errors, and so the weights of the records, come from the restricted likelihood: the
        // two differ by the fitted unknowns.
        assert_relative_eq!(derivatives.gradient[0], numeric, max_relative = 0.05);
        let mut at = 3;
        for number in 0..2 {
            for entry in vectors[number].active_entries(records[number].has_gyro()) {
                let height = |by: f64| {
                    let mut vectors = vectors;
                    vectors[number].log_entries[entry] += by;
                    fit(a, &vectors).restricted_deviance
                };
                let numeric = 0.5 * (height(1e-4) - height(-1e-4)) / 2e-4;
                assert_relative_eq!(derivatives.gradient[at], numeric, max_relative = 1e-2, epsilon = 5e-2);
                at += 1;
            }
        }
    }
}

/// Under a random-walk moment the errors are far below the errors of output error, and the intervals contain the truth.
#[test]
fn a_walking_moment_leaves_smaller_errors() {
    let plain = output_error::Settings::default().build().expect("valid");
    let (mut likely, mut nearest, mut held) = (0.0, 0.0, 0);
    for seed in 0..40 {
        let trial = disturbed(&Case { seed, ..noisy() }, &ExtraNoise::Walk(0.1));
        let time_constant = identify(std::slice::from_ref(&trial)).T();
        let [low, high] = time_constant.ci95.expect("bounded");
        held += usize::from((low..=high).contains(&16.3));
        likely += (time_constant.value - 16.3).powi(2);
        nearest += (plain.identify(&[trial]).expect("an answer").T().value - 16.3).powi(2);
    }
    assert!(likely < 0.65_f64.powi(2) * nearest, "{likely} against {nearest}");
    // Fewer than 33 of 40 intervals of 95 % contain the truth once in 3000 times.
    assert!(held >= 33, "{held}");
}

/// A declared rudder error is included: intervals are wider and contain the truth.
#[test]
fn a_declared_rudder_error_counts() {
    let (mut held, mut estimated_well) = (0, 0);
    for seed in 0..40 {
        let trial = disturbed(&Case { seed, ..noisy() }, &ExtraNoise::RudderError(0.2));
        let estimate = identify(std::slice::from_ref(&trial));
        let [low, high] = estimate.rudder_bias().ci95.expect("bounded");
        held += usize::from((low..=high).contains(&0.0));
        let without = Settings { rudder: RudderChoice::Estimated, ..Settings::default() }.build().expect("valid");
        let estimated = without.identify(&[trial]).expect("an answer");
        let size = estimated.diagnostic("rudder_sd_deg").expect("estimated");
        estimated_well += usize::from((0.05..0.5).contains(&size));
    }
    assert!(held >= 33, "{held}");
    assert!(estimated_well >= 30, "{estimated_well}");
}

/// A spike, a sentinel and a jump are found and listed, and do not bias the estimate.
#[test]
fn outliers_are_left_out_and_listed() {
    let clean = noisy().trial();
    let expected = identify(std::slice::from_ref(&clean));
    let spoilt = |change: &dyn Fn(usize, f64) -> f64| {
        let heading = clean.heading().iter().enumerate().map(|(row, &psi)| change(row, psi)).collect();
        record("spoilt", clean.time().to_vec(), heading, clean.rudder().to_vec())
    };
    let sentinel = from_deg(-999.0);
    for (trial, spikes, jumps) in [
        (spoilt(&|row, psi| if row == 77 { psi + from_deg(1.5) } else { psi }), 1.0, 0.0),
        (spoilt(&|row, psi| if row == 40 || row == 200 { sentinel } else { psi }), 2.0, 0.0),
        (spoilt(&|row, psi| if (90..93).contains(&row) { sentinel } else { psi }), 3.0, 0.0),
        (spoilt(&|row, psi| if row >= 150 { psi + from_deg(4.0) } else { psi }), 0.0, 1.0),
    ] {
        let estimate = identify(std::slice::from_ref(&trial));
        assert_eq!(estimate.diagnostic("left_out"), Some(spikes), "{:?}", estimate.warnings);
        assert_eq!(estimate.diagnostic("jumps"), Some(jumps), "{:?}", estimate.warnings);
        assert!(estimate.warnings.iter().any(|warning| warning.text.contains("t = ")), "{:?}", estimate.warnings);
        for (spoilt, clean) in [(estimate.K(), expected.K()), (estimate.T(), expected.T())] {
            let sd = clean.sd.expect("a covariance");
            assert!((spoilt.value - clean.value).abs() < sd, "{} against {} ± {sd}", spoilt.value, clean.value);
        }
    }
    let raw = Settings { removes_outliers: false, ..Settings::default() }.build().expect("valid");
    let trial = spoilt(&|row, psi| if row == 77 { psi + from_deg(1.5) } else { psi });
    assert_eq!(raw.identify(&[trial]).expect("an answer").diagnostic("left_out"), Some(0.0));
}

/// A correlated compass error is reported, and intervals are wider than for a white error.
#[test]
fn a_coloured_compass_is_named() {
    let truth = noisy().truth();
    let mut draw = draws(3);
    let decay: f64 = (-1.0_f64 / 4.0).exp();
    let mut error = 0.0;
    let heading = (truth.heading.iter())
        .map(|psi| {
            error = decay * error + from_deg(0.1) * (1.0 - decay * decay).sqrt() * draw();
            psi + error
        })
        .collect();
    let estimate = identify(&[record("coloured", truth.time, heading, truth.rudder)]);
    let time = estimate.diagnostic("heading_correlation_s").expect("coloured");
    assert!((1.5..10.0).contains(&time), "{time}");
    assert!(estimate.warnings.iter().any(|warning| warning.text.contains("compass error")), "{:?}", estimate.warnings);
}

/// The bound under a small walk equals the bound in a calm, and under a large walk it is that of simulated trials.
#[test]
fn the_bound_knows_the_noise() {
    let case = noisy();
    let (trial, truth) = (case.trial(), case.ship());
    let initial = ship::first_order::YawState { heading: case.truth().heading[0], yaw_rate: case.truth().yaw_rate[0] };
    let noise = NoiseModel::compass(from_deg(0.1));
    let calm = cramer_rao(&trial, &truth, initial, &noise).expect("known").matrix;
    let walking = |degrees: f64| NoiseModel {
        moment: MomentKind::Walk,
        moment_level: truth.K_over_T * from_deg(degrees),
        ..noise
    };
    let wide = cramer_rao(&trial, &truth, initial, &walking(0.1)).expect("known");
    // 2.1 % of T from 400 simulated trials.
    let percent = 100.0 * wide.indices(&truth).1.sd.expect("known") / 16.3;
    assert!((1.8..2.4).contains(&percent), "{percent}");
    let narrow = cramer_rao(&trial, &truth, initial, &walking(1e-5)).expect("known").matrix;
    assert_relative_eq!(narrow[(0, 0)], calm[(0, 0)], max_relative = 1e-3);
}

#[test]
fn settings_are_checked_and_prepared() {
    let error = Settings { iterations: 0, ..Settings::default() }.build().expect_err("nothing to do");
    assert_eq!(error.key, "iterations");
    let trial = noisy().trial();
    let prepared = PreparedRecords::new(&Settings::default(), std::slice::from_ref(&trial)).expect("a start");
    assert_eq!(prepared.outliers[0], Default::default());
    assert!(to_deg(trial.heading()[0]).is_finite());
}
