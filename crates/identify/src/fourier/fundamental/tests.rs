//! Local optima, periods and refusals, from an independent computation.

use super::*;
use crate::testing::{Case, Truth};
use approx::assert_abs_diff_eq;

fn ten_twenty() -> Case {
    Case { heading_deg: 20.0, ..Case::default() }
}

/// From 2π/T_rec and π/T_rec the local search ends in the global optimum of 10/10 and 10/20; from 2π/T_rec 20/20
/// stops at 0.0239 rad/s (independent computation).
#[test]
fn long_starts_end_at_a_period_beyond_the_record() {
    let twenty = Case { rudder_deg: 20.0, ..ten_twenty() };
    for (case, periods, found) in [
        (Case::default(), 1.0, 0.0204),
        (Case::default(), 0.5, 0.0204),
        (ten_twenty(), 1.0, 0.0162),
        (ten_twenty(), 0.5, 0.0162),
        (twenty, 1.0, 0.0239),
    ] {
        let Truth { time, heading, .. } = case.truth();
        let start = periods * TAU / (time[time.len() - 1] - time[0]);
        assert_abs_diff_eq!(search_from(&[start], &time, &heading, 8).fundamental, found, epsilon = 3e-4);
    }
}

/// Limit-cycle periods 116.63 s (10/10) and 159.13 s (10/20) from an independent simulation.
#[test]
fn zero_crossings_give_the_limit_cycle_under_noise() {
    for (case, period) in [(Case::default(), 116.63), (ten_twenty(), 159.13)] {
        let trial = Case { noise_deg: 0.5, ..case }.trial();
        let period_s = zero_crossing_period(trial.time(), trial.heading()).expect("a zig-zag crosses");
        assert_abs_diff_eq!(period_s, period, epsilon = 2.0);
    }
}

#[test]
fn a_record_without_a_crossing_has_no_period() {
    let time: Vec<f64> = (0..40).map(f64::from).collect();
    let error = zero_crossing_period(&time, &time).expect_err("a line crosses its mean once");
    assert_eq!(error.kind(), "too-few-points");
}
