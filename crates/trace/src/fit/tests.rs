use std::sync::Arc;

use ship::effects::{Effect, MomentDrift, NonlinearDamping};

use super::*;
use crate::made_up::{BASE, Plan, record, ship};
use crate::noise::Colour;
use crate::record::Record;
use crate::structure::{Structure, Term};

/// A record of a ship with cubic damping of 80 s/rad².
fn problem() -> Problem {
    let truth = ship(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])]);
    Problem::new(vec![Record::whole(&record(&truth, Plan { noise_deg: 0.01, ..Plan::default() }))], BASE[0], BASE[1])
}

fn with(effect: impl Effect + 'static, range: [f64; 2], held: &'static [usize], scale: f64) -> Structure {
    let [lowest, highest] = range.map(|end| vec![end]);
    let term = Term { effect: Arc::new(effect), only: None, held, lowest, highest, scale: vec![scale] };
    Structure::base(1, false).with(term)
}

fn fit(problem: &Problem, structure: &Structure, start: f64) -> Fit {
    problem.fit(structure, &[BASE[0], BASE[1], BASE[2], start], &[[0.0; 2]], &Colour::WHITE)
}

#[test]
fn the_truth_is_found_and_no_point_beside_it_is_better() {
    let problem = problem();
    let structure = with(NonlinearDamping::Cubic, [0.0, 1e4], &[], 80.0);
    let found = fit(&problem, &structure, 5.0);
    assert!((found.theta[3] / 80.0 - 1.0).abs() < 0.1, "{:?}", found.theta);
    let noise = (found.rss / problem.observations() as f64).sqrt().to_degrees();
    assert!((noise / 0.01 - 1.0).abs() < 0.1, "{noise} deg");
    for k in 0..4 {
        for share in [-1e-3, 1e-3] {
            let mut beside = found.theta.clone();
            beside[k] *= 1.0 + share;
            let residual = problem.residual(&structure, &beside, &found.initial);
            let rss: f64 = residual.iter().flatten().map(|e| e * e).sum();
            assert!(rss > (1.0 - 1e-4) * found.rss, "entry {k} by {share}: {rss} is below {}", found.rss);
        }
    }
}

/// A parameter that wants to leave its range stays at the end of it, and the others are those of a fit that holds it
/// there.
#[test]
fn a_bound_is_kept_and_the_rest_is_still_the_best() {
    let problem = problem();
    for (range, start, end) in [([0.0, 30.0], 5.0, 30.0), ([200.0, 400.0], 300.0, 200.0)] {
        let bounded = fit(&problem, &with(NonlinearDamping::Cubic, range, &[], 80.0), start);
        let held = fit(&problem, &with(NonlinearDamping::Cubic, range, &[0], 80.0), end);
        assert_eq!((bounded.theta[3], held.theta[3]), (end, end));
        assert!((bounded.rss / held.rss - 1.0).abs() < 1e-3, "{} and {}", bounded.rss, held.rss);
        assert_eq!((bounded.freedom, held.freedom), (7, 6));
    }
    // A start outside of the range is brought inside.
    assert_eq!(fit(&problem, &with(NonlinearDamping::Cubic, [0.0, 30.0], &[0], 80.0), 90.0).theta[3], 30.0);
}

/// Whatever decides a fit is part of the question that is remembered.
#[test]
fn fits_that_differ_in_anything_are_not_taken_for_each_other() {
    let drifting = ship(vec![(Arc::new(MomentDrift { reference_time: 0.0 }), vec![7e-5])]);
    let problem = Problem::new(vec![Record::whole(&record(&drifting, Plan::default()))], BASE[0], BASE[1]);
    let range = [-0.01, 0.01];
    let from = |reference_time| fit(&problem, &with(MomentDrift { reference_time }, range, &[], 1e-4), 0.0);
    let (early, late) = (from(0.0), from(300.0));
    // The trend is the same, the moment at its zero is not.
    assert!((early.theta[3] - late.theta[3]).abs() < 1e-7);
    assert!((late.theta[2] - early.theta[2] - 300.0 * 7e-5).abs() < 1e-3, "{:?} {:?}", early.theta, late.theta);
    let free = with(MomentDrift { reference_time: 0.0 }, range, &[], 1e-4);
    let held = with(MomentDrift { reference_time: 0.0 }, range, &[0], 1e-4);
    let narrow = with(MomentDrift { reference_time: 0.0 }, [-1e-5, 1e-5], &[], 1e-4);
    let all = [&free, &held, &narrow].map(|structure| fit(&problem, structure, 0.0).theta[3]);
    assert!(all[0] > 5e-5 && all[1] == 0.0 && all[2] == 1e-5, "{all:?}");
    assert_eq!(fit(&problem, &free, 0.0).theta[3], all[0]);
}

/// A fit that begins with known sensitivities ends where one does that computes them all.
#[test]
fn known_sensitivities_lead_to_the_same_minimum() {
    let problem = problem();
    let base = Structure::base(1, false);
    let without = problem.fit(&base, &BASE, &[[0.0; 2]], &Colour::WHITE);
    let known = Linearised::new(&problem, &base, &without);
    let structure = with(NonlinearDamping::Cubic, [0.0, 1e4], &[], 80.0);
    let (one, other) = (problem.fit_with(&structure, &[5.0], &without, &known), fit(&problem, &structure, 5.0));
    assert!((one.rss / other.rss - 1.0).abs() < 1e-3, "{} and {}", one.rss, other.rss);
    assert!(without.rss > 10.0 * one.rss);
}
