//! The pipeline on records of known truth, where `tests/tracing.rs` has no word on it.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use ship::effects::{Effect, listed};
use trial::Trial;

use crate::testing::{TrialPlan, record, ship, wandering};
use crate::{Analysis, Rule, Settings, Watcher, trace, watched};

/// A record of a ship whose damping grows with the cube of its yaw rate.
fn damped(plan: TrialPlan) -> Trial {
    let damping: Arc<dyn Effect> = listed("nonlinear_damping", "r³");
    record(&ship(vec![(damping, vec![80.0])]), plan)
}

fn named(analysis: &Analysis) -> Vec<&str> {
    analysis.document.effects.iter().map(|effect| effect.id.as_str()).collect()
}

fn traced(trials: &[Trial]) -> Analysis {
    trace(trials, &[], &Settings::default()).expect("a base")
}

#[test]
fn a_random_moment_is_no_effect_of_the_ship() {
    for seed in 1..4 {
        let analysis = traced(&[wandering(30.0, seed)]);
        let ship = ["second_order", "nonlinear_damping", "speed_loss", "rudder_saturation", "port_starboard_asymmetry"];
        assert!(named(&analysis).iter().all(|id| !ship.contains(id)), "seed {seed}: {:?}", named(&analysis));
    }
}

/// The search is over when the folds begin: whoever does not wait for them has the same result without them.
#[test]
fn nobody_has_to_wait_for_the_folds() {
    #[derive(Default)]
    struct Hurried(AtomicUsize);
    impl Watcher for Hurried {
        fn begin_folds(&self, count: usize) {
            self.0.fetch_add(count, Ordering::Relaxed);
        }

        fn is_asked_to_stop(&self) -> bool {
            self.0.load(Ordering::Relaxed) > 0
        }
    }
    let trials = [10.0, 15.0].map(|rudder_deg| damped(TrialPlan { rudder_deg, ..TrialPlan::default() }));
    let hurried = Hurried::default();
    let stopped = watched(&trials, &[], &Settings::default(), &hurried).expect("a base");
    let whole = traced(&trials);
    assert_eq!((hurried.0.into_inner(), stopped.left_out.len(), whole.left_out.len()), (2, 0, 2));
    assert_eq!((named(&stopped), stopped.base.response), (named(&whole), whole.base.response));
}

#[test]
fn both_rules_name_what_is_clear() {
    let trial = damped(TrialPlan::default());
    for rule in Rule::ALL {
        let settings = Settings { rule, thorough: false, ..Settings::default() };
        let analysis = trace(std::slice::from_ref(&trial), &[], &settings).expect("a base");
        assert_eq!(named(&analysis), ["nonlinear_damping"], "{}", rule.as_str());
    }
}

/// The band of a record holds most of it, and is no wider than the noise asks for.
#[test]
fn bands_hold_the_record() {
    let trial = damped(TrialPlan::default());
    let other = damped(TrialPlan { seed: 5, rudder_deg: 12.0, ..TrialPlan::default() });
    let analysis = trace(&[trial], &[other], &Settings::default()).expect("a base");
    for one in analysis.identification.iter().chain(&analysis.validation) {
        let (coverage, width) =
            (one.after.coverage().expect("a band").share(), one.after.width().expect("a band").to_degrees());
        assert!((0.85..=1.0).contains(&coverage) && (0.15..0.6).contains(&width), "{coverage}, {width} deg");
    }
}
