//! The pipeline on records of known truth.

use std::sync::Arc;

use ship::effects::{Effect, MomentDrift, NonlinearDamping, PortStarboardAsymmetry, SpeedLoss, SteeringLag};
use trial::Trial;

use crate::document::Verdict;
use crate::testing::{TrialPlan, record, ship, wandering};
use crate::{Analysis, EffectId, Rule, Selection, Settings, trace};

fn of(effects: Vec<(Arc<dyn Effect>, Vec<f64>)>, plan: TrialPlan) -> Trial {
    record(&ship(effects), plan)
}

fn named(analysis: &Analysis) -> Vec<&str> {
    analysis.document.effects.iter().map(|effect| effect.id.as_str()).collect()
}

fn traced(trials: &[Trial]) -> Analysis {
    trace(trials, &[], &Settings::default()).expect("a base")
}

#[test]
fn a_first_order_ship_lacks_nothing() {
    for seed in 1..6 {
        let analysis = traced(&[of(Vec::new(), TrialPlan { seed, ..TrialPlan::default() })]);
        assert_eq!((analysis.document.verdict, named(&analysis)), (Verdict::Clean, vec![]), "seed {seed}");
        let one = &analysis.identification[0];
        assert!(one.after.errors.heading <= 1.0001 * one.before.errors.heading);
    }
}

#[test]
fn one_effect_is_named_and_its_size_found() {
    let cases: [(Arc<dyn Effect>, f64, &str, f64); 3] = [
        (Arc::new(NonlinearDamping::Cubic), 80.0, "n₃/T", 8.0),
        (Arc::new(PortStarboardAsymmetry::Gain), 0.2, "a", 0.03),
        (Arc::new(MomentDrift { reference_time: 0.0 }), 7e-5, "m", 1e-5),
    ];
    for (effect, value, symbol, tolerance) in cases {
        let id = effect.id();
        let analysis = traced(&[of(vec![(effect, vec![value])], TrialPlan::default())]);
        assert_eq!((analysis.document.verdict, named(&analysis)), (Verdict::Traced, vec![id]));
        let parameters = &analysis.document.effects[0].parameters;
        if let Some(found) = parameters.get(symbol) {
            assert!((found.quantity.value - value).abs() < tolerance, "{id}: {:?}", found.quantity);
        }
        let one = &analysis.identification[0];
        assert!(one.after.errors.heading.to_degrees() < 0.055, "{id}: {}", one.after.errors.heading.to_degrees());
    }
}

/// A speed that falls in the turn is an effect like any other.
#[test]
fn two_effects_are_named_together() {
    let both: Vec<(Arc<dyn Effect>, Vec<f64>)> =
        vec![(Arc::new(SpeedLoss::Modelled), vec![13.0, 100.0, 2.0]), (Arc::new(SteeringLag::DeadTime), vec![1.0])];
    let analysis = traced(&[of(both, TrialPlan::default())]);
    let all: Vec<String> =
        analysis.document.effects.iter().flat_map(|one| [vec![one.id.clone()], one.aliases.clone()].concat()).collect();
    for id in ["speed_loss", "steering_lag"] {
        assert!(all.iter().any(|own| own == id), "{id}: {all:?}");
    }
}

#[test]
fn a_random_moment_is_no_effect_of_the_ship() {
    for seed in 1..4 {
        let analysis = traced(&[wandering(30.0, seed)]);
        let ship = ["second_order", "nonlinear_damping", "speed_loss", "rudder_saturation", "port_starboard_asymmetry"];
        assert!(named(&analysis).iter().all(|id| !ship.contains(id)), "seed {seed}: {:?}", named(&analysis));
    }
}

/// Nothing but their own comparisons depends on records that were held out.
#[test]
fn held_out_records_judge_and_nothing_else() {
    let damping = || -> Vec<(Arc<dyn Effect>, Vec<f64>)> { vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])] };
    let own = [of(damping(), TrialPlan::default())];
    let others = [
        of(damping(), TrialPlan { rudder_deg: 15.0, seed: 7, ..TrialPlan::default() }),
        of(Vec::new(), TrialPlan { rudder_deg: 20.0, seed: 8, ..TrialPlan::default() }),
    ];
    let swapped = [others[1].clone(), others[0].clone()];
    let stripped = |validation: &[Trial]| {
        let mut document = trace(&own, validation, &Settings::default()).expect("a base").document;
        document.error.validation.clear();
        document.headline.clear();
        serde_json::to_string(&document).expect("plain data")
    };
    let (both, one, none) = (stripped(&others), stripped(&swapped), stripped(&[]));
    assert!(both == one && one == none);
    let judged = trace(&own, &others, &Settings::default()).expect("a base").validation;
    let ratio = |k: usize| judged[k].after.errors.heading / judged[k].before.errors.heading;
    assert!(ratio(0) < 0.3 && ratio(1) > 1.0, "{} and {}", ratio(0), ratio(1));
}

#[test]
fn several_records_are_left_out_in_turn() {
    let damping: Arc<dyn Effect> = Arc::new(NonlinearDamping::Cubic);
    let trials = [10.0, 15.0, 20.0]
        .map(|rudder_deg| of(vec![(damping.clone(), vec![80.0])], TrialPlan { rudder_deg, ..TrialPlan::default() }));
    let analysis = traced(&trials);
    assert_eq!(analysis.left_out.len(), 3);
    for fold in analysis.left_out.iter().flatten() {
        let [before, after] = [&fold.before, &fold.after].map(|on| on.errors.heading.to_degrees());
        assert!(before > 0.3 && after < 0.25 * before, "{before} and {after} deg");
    }
}

#[test]
fn what_is_asked_for_is_in_the_model_and_what_is_excluded_is_not() {
    let id = |name: &str| EffectId::find(name).expect("on the list");
    let trial = of(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])], TrialPlan::default());
    let with = |selection: Selection| {
        let settings = Settings { selection, ..Settings::default() };
        trace(std::slice::from_ref(&trial), &[], &settings)
    };
    let only = with(Selection::only(vec![id("speed_loss")])).expect("a base");
    assert_eq!(named(&only), ["speed_loss"]);
    let without = with(Selection { without: vec![id("nonlinear_damping")], ..Selection::default() }).expect("a base");
    assert!(!named(&without).contains(&"nonlinear_damping"));
    let lacking = with(Selection::only(vec![id("sway_coupling_measured")])).expect_err("no sway");
    assert!(lacking.to_string().contains("sway"), "{lacking}");
}

#[test]
fn both_rules_name_what_is_clear() {
    let trial = of(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])], TrialPlan::default());
    for rule in Rule::ALL {
        let settings = Settings { rule, thorough: false, ..Settings::default() };
        let analysis = trace(std::slice::from_ref(&trial), &[], &settings).expect("a base");
        assert_eq!(named(&analysis), ["nonlinear_damping"], "{}", rule.as_str());
    }
}

/// The band of a record holds most of it, and is no wider than the noise asks for.
#[test]
fn bands_hold_the_record() {
    let trial = of(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])], TrialPlan::default());
    let other = of(
        vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])],
        TrialPlan { seed: 5, rudder_deg: 12.0, ..TrialPlan::default() },
    );
    let analysis = trace(&[trial], &[other], &Settings::default()).expect("a base");
    for one in analysis.identification.iter().chain(&analysis.validation) {
        let (coverage, width) =
            (one.after.coverage().expect("a band"), one.after.width().expect("a band").to_degrees());
        assert!((0.85..=1.0).contains(&coverage) && (0.15..0.6).contains(&width), "{coverage}, {width} deg");
    }
}

#[test]
fn a_document_is_read_as_it_was_written() {
    let analysis = traced(&[of(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])], TrialPlan::default())]);
    let text = serde_json::to_string(&analysis.document).expect("plain data");
    let again: crate::Document = serde_json::from_str(&text).expect("the same");
    assert_eq!(serde_json::to_string(&again).expect("plain data"), text);
}
