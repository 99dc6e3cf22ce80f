//! Properties of the method: exactness without noise, efficiency for white noise, consistency for coloured noise, and
//! typed refusals.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use ship::angle::from_deg;
use ship::first_order::YawState;
use statrs::distribution::{ContinuousCDF, Normal};
use trial::noise_model::NoiseModel;

use super::*;
use crate::maximum_likelihood;
use crate::testing::{Case, Start, record, steered};

fn srivc() -> Srivc {
    Settings::default().build().expect("the defaults are valid")
}

/// Exact motion of `ship` under the steering of `case`, from a turning start.
fn exact(case: &Case, ship: &FirstOrder) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let truth = case.truth();
    let start = YawState { heading: 0.3, yaw_rate: from_deg(0.4) };
    let heading = steered(ship, start, &truth.time, &truth.rudder);
    (truth.time, heading, truth.rudder)
}

fn assert_recovers(estimate: &Estimate, ship: &FirstOrder, tolerance: f64) {
    let found = &estimate.response;
    assert_abs_diff_eq!(found.inverse_T, ship.inverse_T, epsilon = tolerance * ship.inverse_T.abs().max(1e-3));
    assert_relative_eq!(found.K_over_T, ship.K_over_T, max_relative = tolerance);
    assert_abs_diff_eq!(found.rudder_bias, ship.rudder_bias, epsilon = tolerance);
}

fn white(count: usize, seed: u64) -> Vec<f64> {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    let normal = Normal::standard();
    (0..count).map(|_| normal.inverse_cdf((f64::from(generator.random::<u32>()) + 0.5) / 4294967296.0)).collect()
}

/// First-order autoregressive noise of unit variance.
fn coloured(count: usize, rho: f64, seed: u64) -> Vec<f64> {
    let mut last = 0.0;
    let fresh = (1.0 - rho * rho).sqrt();
    let mut noise: Vec<f64> = white(count + 200, seed)
        .into_iter()
        .map(|e| {
            last = rho * last + fresh * e;
            last
        })
        .collect();
    noise.drain(..200);
    noise
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn sd(values: &[f64]) -> f64 {
    let centre = mean(values);
    (values.iter().map(|x| (x - centre).powi(2)).sum::<f64>() / (values.len() as f64 - 1.0)).sqrt()
}

/// Cramér–Rao standard deviations of K and T, relative, for white heading noise of standard deviation `sigma` (rad).
fn cramer_rao(case: &Case, sigma: f64) -> [f64; 2] {
    let (truth, ship) = (case.truth(), case.ship());
    let start = YawState { heading: truth.heading[0], yaw_rate: truth.yaw_rate[0] };
    let bound = maximum_likelihood::cramer_rao(&case.trial(), &ship, start, &NoiseModel::compass(sigma));
    let (K, T) = bound.expect("a zig-zag informs on all").indices(&ship);
    [K, T].map(|index| index.sd.expect("a bound") / index.value)
}

/// Estimates over 2000 records that differ in noise; K and T relative to the truth.
#[derive(Default)]
struct Spread {
    value: [Vec<f64>; 2],
    least_squares: [Vec<f64>; 2],
    quoted: [Vec<f64>; 2],
    robust: [Vec<f64>; 2],
    /// Share of the 95 % intervals of K, T and δ_r that contain the truth.
    covered: [f64; 3],
}

impl Spread {
    /// `noise(seed)` is added to the exact heading of `case` in units of `case.noise_deg`.
    fn of(case: &Case, noise: impl Fn(u64) -> Vec<f64>) -> Self {
        const REPEATS: u64 = 2000;
        let mut spread = Self::default();
        let ship = case.ship();
        let truth = [ship.K(), ship.T(), ship.rudder_bias];
        let (time, heading, rudder) = exact(case, &ship);
        let true_filter = Point {
            shared: SharedParameters { inverse_T: ship.inverse_T, K_over_T: ship.K_over_T, offset: 0.0 },
            starts: vec![YawState::default()],
        };
        for seed in 0..REPEATS {
            let noisy = heading.iter().zip(noise(seed)).map(|(psi, e)| psi + from_deg(case.noise_deg) * e).collect();
            let trial = record("noisy", time.clone(), noisy, rudder.clone());
            let least_squares =
                srivc().solve(&[SrivcRecord::new(&trial)], &true_filter, LeftColumns::Regressors).expect("steered");
            let SharedParameters { inverse_T: a, K_over_T: b, .. } = least_squares.point.shared;
            let estimate = srivc().identify(&[trial]).expect("steered");
            let robust = estimate.robust_covariance.as_ref().expect("a robust covariance").indices(&estimate.response);
            let found = [estimate.K(), estimate.T(), estimate.rudder_bias()];
            for i in 0..2 {
                spread.value[i].push(found[i].value / truth[i]);
                spread.least_squares[i].push([b / a, 1.0 / a][i] / truth[i]);
                spread.quoted[i].push(found[i].sd.expect("a covariance") / truth[i]);
                spread.robust[i].push([robust.0, robust.1][i].sd.expect("a covariance") / truth[i]);
            }
            for i in 0..3 {
                let [lo, hi] = found[i].ci95.expect("bounded");
                spread.covered[i] += f64::from(u8::from(lo <= truth[i] && truth[i] <= hi)) / REPEATS as f64;
            }
        }
        spread
    }
}

/// Rudder/heading pairs of the manoeuvre, deg.
const PAIRS: [(f64, f64); 6] = [(5.0, 5.0), (10.0, 5.0), (10.0, 10.0), (-10.0, 20.0), (20.0, 10.0), (20.0, 20.0)];

#[test]
fn exact_without_noise_for_every_zig_zag_start_and_sampling() {
    for (rudder_deg, heading_deg) in PAIRS {
        for start in [Start::Rest, Start::Mid] {
            for (samples, period_s, bias_deg) in [(271, 1.0, 0.0), (271, 1.0, 2.0), (541, 0.5, -1.0), (60, 5.0, 1.0)] {
                let case = Case { rudder_deg, heading_deg, start, samples, period_s, bias_deg, ..Case::default() };
                let (time, heading, rudder) = exact(&case, &case.ship());
                let estimate = srivc().identify(&[record("exact", time, heading, rudder)]).expect("steered");
                assert_recovers(&estimate, &case.ship(), 1e-8);
                assert_eq!(estimate.stop, StopReason::Converged);
            }
        }
    }
}

/// With 2000 records the standard error is 1.6 % of the scatter, 0.5 % of the coverage and 0.02 standard deviations of
/// the mean.
#[test]
fn efficient_and_honest_under_white_noise() {
    for noise_deg in [0.1, 0.5, 2.0] {
        let case = Case { noise_deg, bias_deg: 0.5, ..Case::default() };
        let bound = cramer_rao(&case, from_deg(noise_deg));
        let spread = Spread::of(&case, |seed| white(case.samples, seed));
        for (i, bound) in bound.into_iter().enumerate() {
            let scatter = sd(&spread.value[i]);
            assert_relative_eq!(scatter, bound, max_relative = 0.05);
            assert_relative_eq!(mean(&spread.quoted[i]), scatter, max_relative = 0.05);
            assert_relative_eq!(mean(&spread.robust[i]), scatter, max_relative = 0.08);
            assert_abs_diff_eq!(mean(&spread.value[i]), 1.0, epsilon = 0.08 * bound);
        }
        for covered in spread.covered {
            assert_abs_diff_eq!(covered, 0.95, epsilon = 0.02);
        }
    }
}

/// Noise with a correlation time of ten samples, 1 deg. The filters are true for the least squares too: only the
/// instrument differs. The reported errors are the robust errors, because the residual is coloured; they are some 15 %
/// too small, as Bartlett weights are if the noise is nearly as slow as the ship.
#[test]
fn consistent_under_coloured_noise_where_least_squares_is_not() {
    let case = Case { samples: 1001, noise_deg: 1.0, ..Case::default() };
    let spread = Spread::of(&case, |seed| coloured(case.samples, 0.9, seed));
    for i in 0..2 {
        let bias = (mean(&spread.value[i]) - 1.0).abs();
        let of_least_squares = (mean(&spread.least_squares[i]) - 1.0).abs();
        let scatter = sd(&spread.value[i]);
        assert!(bias < 0.2 * of_least_squares, "{bias} against {of_least_squares}");
        assert!(bias < 0.08 * scatter, "{bias} against a scatter of {scatter}");
        assert_relative_eq!(mean(&spread.quoted[i]), scatter, max_relative = 0.2);
        assert_eq!(spread.quoted[i], spread.robust[i]);
    }
}

#[test]
fn a_course_unstable_and_a_neutral_ship_are_regular() {
    let steering = Case { rudder_deg: 20.0, heading_deg: 5.0, samples: 600, ..Case::default() };
    for inverse_T in [-1.0 / 124.0, -1e-3, -1e-9, 0.0, 1e-9, 1e-3] {
        let ship = FirstOrder { inverse_T, K_over_T: 1.5e-4, rudder_bias: from_deg(0.3) };
        let (time, heading, rudder) = exact(&steering, &ship);
        let estimate = srivc().identify(&[record("slow", time.clone(), heading.clone(), rudder.clone())]);
        assert_recovers(&estimate.expect("steered"), &ship, 1e-7);
        let noisy = heading.iter().zip(white(600, 7)).map(|(psi, e)| psi + from_deg(0.2) * e).collect();
        let estimate = srivc().identify(&[record("slow", time, noisy, rudder)]).expect("steered");
        let crate::Uncertainty::Covariance(covariance) = &estimate.uncertainty else { panic!("has a covariance") };
        let sd = covariance.matrix[(0, 0)].sqrt();
        assert_abs_diff_eq!(estimate.response.inverse_T, inverse_T, epsilon = 4.0 * sd);
        assert_abs_diff_eq!(
            estimate.response.rudder_bias,
            ship.rudder_bias,
            epsilon = 4.0 * covariance.matrix[(2, 2)].sqrt()
        );
        assert_eq!(estimate.T().ci95.is_none(), inverse_T.abs() < 1e-6);
    }
}

#[test]
fn either_direction_of_time_gives_the_same_answer() {
    let case = Case { noise_deg: 0.3, T: 60.0, ..Case::default() };
    let method = srivc();
    let forwards = vec![SrivcRecord::new(&case.trial())];
    let backwards = vec![forwards[0].reversed()];
    let [forwards, backwards] = [forwards, backwards].map(|records| {
        let start = method.integral_least_squares(&records).expect("steered");
        method.iterate(&records, start).expect("steered").0.point.shared
    });
    assert_relative_eq!(forwards.inverse_T, -backwards.inverse_T, max_relative = 1e-7);
    assert_relative_eq!(forwards.K_over_T, backwards.K_over_T, max_relative = 1e-7);
    assert_relative_eq!(forwards.offset, backwards.offset, max_relative = 1e-6, epsilon = 1e-10);
}

/// A rudder put over between two rows leaves a residual of degrees, about which full steps oscillate; the fixed point
/// is still that of the output error.
#[test]
fn settles_where_whole_steps_sway() {
    for (K, T, period_s, seed) in [(0.08, 147.0, 20.7, 0), (0.16, 48.0, 6.75, 1), (0.073, 81.6, 5.9, 2)] {
        let case = Case {
            K,
            T,
            heading_deg: 5.0,
            rate_deg_s: 100.0,
            samples: 260,
            period_s,
            noise_deg: 0.1,
            start: Start::At(2.0 * T),
            seed,
            ..Case::default()
        };
        let trial = [case.trial()];
        let found = srivc().identify(&trial).expect("settles").response;
        let output_error = crate::output_error::Settings { iterations: 500, ..Default::default() };
        let least = output_error.build().expect("valid").identify(&trial).expect("steered").response;
        assert_relative_eq!(found.inverse_T, least.inverse_T, max_relative = 1e-5);
        assert_relative_eq!(found.K_over_T, least.K_over_T, max_relative = 1e-5);
    }
}

#[test]
fn refuses_what_cannot_be_identified() {
    let kind = |trial: Trial| srivc().identify(&[trial]).expect_err("not identifiable").kind();
    assert_eq!(srivc().identify(&[]).expect_err("nothing given"), IdentifyError::NoTrial);

    let time: Vec<f64> = (0..100).map(f64::from).collect();
    let noise: Vec<f64> = white(100, 1).iter().map(|e| from_deg(0.5) * e).collect();
    assert_eq!(kind(record("straight", time.clone(), noise, vec![0.0; 100])), "not-excited");

    let short = Case { samples: 9, ..Case::default() }.trial();
    assert_eq!(kind(short), "too-few-samples");

    // A rudder with only the sign wrong turns the ship to the opposite side.
    let case = Case::default().truth();
    let opposite = case.rudder.iter().map(|delta| -delta).collect();
    assert_eq!(kind(record("sign", case.time, case.heading, opposite)), "not-a-ship");

    // In a steady turn K and δ_r act alike; only the last interval separates them.
    let mut rudder = vec![from_deg(10.0); 100];
    rudder[99] = from_deg(8.0);
    let turn = steered(&Case::default().ship(), YawState::default(), &time, &rudder);
    let strict = Settings { condition_limit: 1e3, ..Settings::default() }.build().expect("valid");
    let error = strict.identify(&[record("turn", time, turn, rudder)]).expect_err("nearly singular");
    assert!(matches!(error, IdentifyError::Singular { condition, limit: 1e3 } if condition > 1e3), "{error}");

    let once = Settings { max_iterations: 1, ..Settings::default() }.build().expect("valid");
    let error = once.identify(&[Case { noise_deg: 1.0, ..Case::default() }.trial()]).expect_err("needs more");
    assert_eq!(error.kind(), "not-converged");
}

#[test]
fn a_short_record_is_identified_with_wide_intervals() {
    let case = Case { samples: 60, noise_deg: 0.1, ..Case::default() };
    let estimate = srivc().identify(&[case.trial()]).expect("one leg and a half");
    let T = estimate.T();
    let [lo, hi] = T.ci95.expect("bounded");
    assert!(lo < 16.3 && 16.3 < hi, "{lo}..{hi}");
    let whole = srivc().identify(&[Case { samples: 271, ..case }.trial()]).expect("steered");
    assert!(T.sd > whole.T().sd);
}
