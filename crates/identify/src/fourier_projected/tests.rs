//! Scale, order, calibration of the covariance and refusals of the corrected Fourier method.

use approx::{assert_abs_diff_eq, assert_relative_eq};

use super::*;
use crate::testing::{Case, Start};

fn build(settings: Settings) -> FourierProjected {
    settings.build().expect("valid settings")
}

fn estimate(settings: Settings, case: &Case) -> Estimate {
    build(settings).identify(&[case.trial()]).expect("a zig-zag is identified")
}

fn zigzag(rudder_deg: f64, heading_deg: f64) -> Case {
    Case { rudder_deg, heading_deg, ..Case::default() }
}

/// Settings of the published method, samples instead of triples.
fn plain(rudder: RudderTreatment) -> Settings {
    Settings { fundamental: Fundamental::Global, harmonics: Order::Fixed(8), rudder, response: RegressionForm::YawRate }
}

/// Ships of other size: the rules are in periods of the zig-zag, so scale has no effect.
#[test]
fn a_model_is_identified_as_the_ship() {
    let ship = estimate(Settings::default(), &Case::default()).response;
    let model =
        Case { K: 1.0, T: 1.63, rate_deg_s: 25.0, period_s: 0.1, start: Start::At(2.409 + 0.12), ..Case::default() };
    let found = estimate(Settings::default(), &model).response;
    assert_relative_eq!(found.K() / 10.0, ship.K(), max_relative = 1e-3);
    assert_relative_eq!(found.T() * 10.0, ship.T(), max_relative = 1e-3);
}

/// Comparison of the reported standard deviations with the scatter over 150 noise draws (6 % uncertain): not below it
/// by more than 30 %, and above it only by what truncation adds to the residual of the series (its ratio to the noise).
#[test]
fn reported_errors_are_those_of_repetition() {
    const DRAWS: u64 = 150;
    for (settings, noise_deg) in [
        (Settings::default(), 0.1),
        (Settings { harmonics: Order::Fixed(8), ..Settings::default() }, 0.5),
        (plain(RudderTreatment::Projected), 0.1),
    ] {
        let method = build(settings);
        let mut columns: [Vec<[f64; 2]>; 3] = Default::default();
        let mut truncation: f64 = 1.0;
        for seed in 0..DRAWS {
            let trial = Case { noise_deg, seed, bias_deg: 0.5, ..Case::default() }.trial();
            let estimate = method.identify(&[trial]).expect("identified");
            let residual = estimate.diagnostic("residual_sd_deg").expect("reported");
            truncation = truncation.max(residual / noise_deg);
            for (column, quantity) in columns.iter_mut().zip([estimate.K(), estimate.T(), estimate.rudder_bias()]) {
                column.push([quantity.value, quantity.sd.expect("a covariance")]);
            }
        }
        for column in columns {
            let count = DRAWS as f64;
            let mean = column.iter().map(|[value, _]| value).sum::<f64>() / count;
            let scatter = (column.iter().map(|[value, _]| (value - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
            let reported = column.iter().map(|[_, sd]| sd).sum::<f64>() / count;
            let ratio = reported / scatter;
            assert!(ratio > 0.7 && ratio < 1.3 * truncation, "reported {reported}, scatter {scatter}, {truncation}");
        }
    }
}

#[test]
fn noise_lowers_the_order() {
    let harmonics = |noise_deg: f64| {
        let case = Case { noise_deg, ..Case::default() };
        build(Settings { harmonics: Order::Gcv { reach: 5.0 }, ..Settings::default() })
            .curves(&case.trial())
            .expect("fits")
            .heading
            .basis
            .harmonics()
    };
    assert!(harmonics(3.0) < harmonics(0.0));
}

#[test]
fn truncation_is_distinguished_from_noise() {
    let warned = |noise_deg: f64| {
        let case = Case { noise_deg, ..zigzag(10.0, 20.0) };
        let settings = Settings { harmonics: Order::Fixed(8), ..Settings::default() };
        estimate(settings, &case).warnings.iter().any(|warning| warning.text.contains("not white noise"))
    };
    assert!(warned(0.0) && !warned(1.0));
}

/// From rest the global optimum of 10/20 has condition number 1.4e6: refused at 1e4.
#[test]
fn an_ill_conditioned_basis_is_refused() {
    let case = Case { start: Start::Rest, ..zigzag(10.0, 20.0) };
    let error = build(plain(RudderTreatment::Projected)).identify(&[case.trial()]).expect_err("condition 1.4e6");
    assert!(matches!(error, IdentifyError::Singular { condition, limit } if condition > 1e5 && limit == 1e4));
}

#[test]
fn short_records_are_refused() {
    let short = Case { samples: 19, ..Case::default() }.trial();
    assert_eq!(build(Settings::default()).identify(&[short]).expect_err("too short").kind(), "too-few-samples");
}

/// Means of three rows in place of 120 000 rows at 0.005 s: equal estimates within a hundredth of the standard
/// deviation. The standard deviation grows a little: the truncation residual counts as noise of every row, and there
/// are fewer rows.
#[test]
fn averaging_a_dense_record_changes_next_to_nothing() {
    let trial = Case { samples: 120_000, period_s: 0.005, noise_deg: 0.5, bias_deg: 0.5, ..Case::default() }.trial();
    let method = build(Settings::default());
    let averaged = method.identify(std::slice::from_ref(&trial)).expect("identified");
    let whole = FourierProjected { max_rows: usize::MAX, ..method }.identify(&[trial]).expect("identified");
    assert!(averaged.diagnostic("equations") < Some(40_000.0) && whole.diagnostic("equations") > Some(100_000.0));
    let pairs = [(averaged.K(), whole.K()), (averaged.T(), whole.T()), (averaged.rudder_bias(), whole.rudder_bias())];
    for (averaged, whole) in pairs {
        let sd = whole.sd.expect("a covariance");
        assert_abs_diff_eq!(averaged.value, whole.value, epsilon = 0.01 * sd);
        assert_relative_eq!(averaged.sd.expect("a covariance"), sd, max_relative = 0.1);
    }
}

/// Without the third harmonic of the zig-zag there is no estimate: 64 harmonics that ended below it gave K = 0.06 for
/// 0.1.
#[test]
fn a_record_of_more_zig_zags_than_the_series_can_follow_is_refused() {
    let long = |samples: usize| Case { samples, noise_deg: 0.1, ..Case::default() };
    let longest = estimate(Settings::default(), &long(2300)).response;
    assert_relative_eq!(longest.K(), 0.1, max_relative = 0.02);
    assert_relative_eq!(longest.T(), 16.3, max_relative = 0.05);
    for samples in [2600, 8000, 40_000] {
        let error = build(Settings::default()).identify(&[long(samples).trial()]).expect_err("beyond 64 harmonics");
        assert_eq!(error.kind(), "too-few-points");
        assert!(error.to_string().contains("shorter records"), "{error}");
    }
}
