//! Published method on records of known truth.

use super::*;
use crate::testing::Case;
use approx::assert_relative_eq;

fn ten_twenty() -> Case {
    Case { heading_deg: 20.0, ..Case::default() }
}

fn estimate(settings: Settings, case: &Case) -> Estimate {
    settings.build().expect("valid settings").identify(&[case.trial()]).expect("a zig-zag is identified")
}

fn robust() -> Settings {
    Settings { triples: 200, aggregation: Aggregation::Median, fundamental: Fundamental::Global, ..Settings::default() }
}

/// Triples drawn uniformly from a noise-free 10/20: 14 % give a negative K or T, and 6 % give both K and T within 10 %
/// of the truth (independent computation; 2000 draws here, so within 4 percentage points).
#[test]
fn uniform_triples_are_useless() {
    let case = ten_twenty();
    let settings = Settings { selection: Selection::Uniform, triples: 2000, ..robust() };
    let method = settings.build().expect("valid settings");
    let trial = case.trial();
    let samples = Samples::new(&trial, 18).expect("long enough");
    let fitted = method.fit(&samples).expect("fits");
    let instants = method.instants(&trial, &samples, &fitted);
    let drawn = triples::sample_triples(&instants, Selection::Uniform, 2000, 0).expect("most are usable");
    let share = |holds: &dyn Fn(&TripleEstimate) -> bool| {
        drawn.estimates.iter().filter(|answer| holds(answer)).count() as f64 / drawn.estimates.len() as f64
    };
    let negative = share(&|a| a.K < 0.0 || a.T < 0.0);
    let good = share(&|a| (a.K / case.K - 1.0).abs() < 0.1 && (a.T / case.T - 1.0).abs() < 0.1);
    assert!((negative - 0.14).abs() < 0.04, "negative {negative}");
    assert!((good - 0.06).abs() < 0.04, "good {good}");
}

#[test]
fn the_starts_of_the_paper_find_the_global_optimum_here() {
    for case in [Case::default(), ten_twenty()] {
        let [starts, global] = [Settings::default().fundamental, Fundamental::Global].map(|fundamental| {
            let method = Settings { fundamental, ..Settings::default() }.build().expect("valid settings");
            method.curve(&case.trial()).expect("fits").curve.fundamental
        });
        assert_relative_eq!(starts, global, max_relative = 1e-5);
    }
}

/// The range of the rudder in a window covers its values and corners there.
#[test]
fn the_range_of_the_rudder_is_that_of_its_window() {
    let trial = Case { samples: 120, ..Case::default() }.trial();
    let signal = trial.rudder_signal();
    for reach in [0.0, 2.0, 40.0] {
        for t in (0..480).map(|k| 0.25 * f64::from(k)) {
            let moved = range_about(signal, t, reach);
            let values = (0..=400).map(|k| signal.value_at(t + reach * (0.005 * f64::from(k) - 1.0)));
            let corners = signal.times().iter().filter(|at| (*at - t).abs() <= reach).map(|&at| signal.value_at(at));
            let (lo, hi) = values.chain(corners).fold((f64::MAX, f64::MIN), |(lo, hi), x| (lo.min(x), hi.max(x)));
            assert!((moved - (hi - lo)).abs() < 1e-9, "at {t} s within {reach} s: {moved} and {}", hi - lo);
        }
    }
}

#[test]
fn a_median_has_an_interval_and_a_mean_has_none() {
    let median = estimate(robust(), &Case::default());
    let [lo, hi] = median.K().ci95.expect("200 triples");
    assert!(lo < median.response.K() && median.response.K() < hi);
    assert_eq!(estimate(Settings::default(), &Case::default()).K().ci95, None);
    let few = Settings { triples: 5, ..robust() };
    assert!(matches!(estimate(few, &Case::default()).uncertainty, Uncertainty::None { .. }));
}

/// Conover, Practical Nonparametric Statistics: 95 % ranks of a median are 1 and 6 of 6, 2 and 9 of 10, 40 and 61 of
/// 100 (from 1).
#[test]
fn ranks_of_the_median_are_those_of_the_tables() {
    assert_eq!(median_ranks(5), None);
    assert_eq!(median_ranks(6), Some((0, 5)));
    assert_eq!(median_ranks(10), Some((1, 8)));
    assert_eq!(median_ranks(100), Some((39, 60)));
}

#[test]
fn short_records_are_refused() {
    let method = Settings::default().build().expect("valid settings");
    let short = Case { samples: 17, ..Case::default() }.trial();
    assert_eq!(method.identify(&[short]).expect_err("too short").kind(), "too-few-samples");
}
