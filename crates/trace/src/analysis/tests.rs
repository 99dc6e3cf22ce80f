//! Whole analyses of made-up records whose truth is known.

use std::sync::Arc;

use ship::effects::NonlinearDamping;

use super::*;
use crate::made_up::{Plan, record, ship};

/// K = 0.1 1/s, T = 16.3 s with damping of the third power.
fn damped(plan: Plan) -> Analysis {
    let truth = ship(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])]);
    trace(&[record(&truth, plan)], &[], &Settings { thorough: false, ..Settings::default() }).expect("a base")
}

fn noise_deg(analysis: &Analysis) -> f64 {
    analysis.randomness.white.to_degrees()
}

/// A rudder that was recorded twice or ten times as often as the heading takes no heading away.
#[test]
fn a_rudder_recorded_more_often_than_the_heading_hides_nothing() {
    for (rows, period, every) in [(4401, 0.5, 2), (4001, 0.1, 10)] {
        let analysis = damped(Plan { rows, period, every, noise_deg: 0.1, ..Plan::default() });
        let named: Vec<_> = analysis.effects.iter().map(|effect| effect.id).collect();
        assert_eq!((analysis.verdict, named), (Verdict::Traced, vec!["nonlinear_damping"]), "every {period} s");
        assert!((analysis.indices[0].value / 0.1 - 1.0).abs() < 0.01, "every {period} s: {:?}", analysis.indices[0]);
        assert!((noise_deg(&analysis) / 0.1 - 1.0).abs() < 0.06, "every {period} s: {}", noise_deg(&analysis));
    }
}

/// Where headings are averaged the noise is still that of one reading.
#[test]
fn the_noise_is_that_of_one_reading() {
    let analysis = damped(Plan { rows: 4001, period: 0.1, noise_deg: 0.1, ..Plan::default() });
    assert!(analysis.problem.records[0].full_readings > 4);
    assert!((noise_deg(&analysis) / 0.1 - 1.0).abs() < 0.06, "{}", noise_deg(&analysis));
}
