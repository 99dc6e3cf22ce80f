//! Pipeline on records of known truth, in cases that `tests/tracing.rs` does not cover.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use document::trace::Dependence;
use ship::angle::to_deg;
use ship::effects::{Effect, Formula, listed_effect};
use trial::{DeclaredConditions, DeclaredWeather, Trial};

use crate::structures::WeighedStructure;
use crate::testing::{TrialPlan, noisy, of_columns, record, ship, wandering};
use crate::{
    Analysis, EffectId, FoldObserver, Selection, Settings, TraceVerdict, WeightingRule, trace, trace_with_observer,
};

/// Record of a ship with cubic damping.
fn damped(plan: TrialPlan) -> Trial {
    let damping: Arc<dyn Effect> = listed_effect("nonlinear_damping", "r³");
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

/// A step shows the contribution of one effect: after the damping only noise remains.
#[test]
fn an_inclusion_path_leads_from_the_base_to_the_noise() {
    let plan = TrialPlan { noise_deg: 0.1, ..TrialPlan::default() };
    let analysis = traced(&[damped(plan)]);
    let path = analysis.inclusion_path().expect("something is missing");
    let ids: Vec<Option<&str>> = path.steps.iter().map(|step| step.term.map(|(id, ..)| id)).collect();
    assert_eq!(ids, [None, Some("nonlinear_damping")]);
    let [base, last] = [0, 1].map(|step: usize| to_deg(path.steps[step].heading_rmse));
    assert!((0.08..0.12).contains(&last) && base > 1.3 * last, "{base} {last}");
    let before = &analysis.identification[0].base_replay.errors.heading_rmse;
    assert!(
        (base / to_deg(*before) - 1.0).abs() < 0.05,
        "the base is the nearest response: {base} {}",
        to_deg(*before)
    );
    assert!(path.steps.iter().all(|step| step.heading_residual.len() == path.row_times.len()));
}

#[test]
fn several_records_are_left_out_in_turn() {
    let trials = [10.0, 15.0, 20.0].map(|rudder_deg| damped(TrialPlan { rudder_deg, ..TrialPlan::default() }));
    let analysis = traced(&trials);
    assert_eq!(analysis.leave_one_out.len(), 3);
    for fold in analysis.leave_one_out.iter().flatten() {
        let [before, after] = [&fold.base_replay, &fold.average_replay].map(|on| on.errors.heading_rmse.to_degrees());
        assert!(before > 0.3 && after < 0.25 * before, "{before} and {after} deg");
    }
}

/// Root mean square of a residual between successive restarts, less the heading and yaw rate that fit it best there:
/// two replays of a first-order ship under one rudder differ by a + b exp(−t/T).
fn less_two_solutions(residual: &[f64], rows: usize, time_constant: f64) -> f64 {
    let square = |window: &[f64]| {
        let column = |row: usize| [1.0, (-(row as f64) / time_constant).exp()];
        let sum = |of: &dyn Fn([f64; 2], f64) -> f64| -> f64 {
            window.iter().enumerate().map(|(row, e)| of(column(row), *e)).sum()
        };
        let [aa, ab, bb] = [sum(&|x, _| x[0] * x[0]), sum(&|x, _| x[0] * x[1]), sum(&|x, _| x[1] * x[1])];
        let [ae, be] = [sum(&|x, e| x[0] * e), sum(&|x, e| x[1] * e)];
        let (a, b) = ((bb * ae - ab * be) / (aa * bb - ab * ab), (aa * be - ab * ae) / (aa * bb - ab * ab));
        sum(&|x, e| (e - a * x[0] - b * x[1]).powi(2))
    };
    let mut windows: Vec<&[f64]> = residual.chunks(rows).collect();
    // A last piece of less than half a window belongs to the window before.
    if windows.len() > 1 && 2 * (windows[windows.len() - 1].len() - 1) < rows {
        windows.truncate(windows.len() - 2);
        windows.push(&residual[windows.len() * rows..]);
    }
    (windows.into_iter().map(square).sum::<f64>() / residual.len() as f64).sqrt()
}

/// Held-out records have errors for growing horizons up to the whole record; fitted records do not.
#[test]
fn the_error_against_the_horizon_is_that_of_replays_begun_anew() {
    let held_out = damped(TrialPlan { seed: 5, rudder_deg: 12.0, ..TrialPlan::default() });
    let analysis = trace(&[damped(TrialPlan::default())], &[held_out], &Settings::default()).expect("a base");
    let error = &analysis.document.error;
    let horizons = &error.validation[0].horizons;
    let windows: Vec<f64> = horizons.iter().map(|entry| entry.horizon_s).collect();
    assert_eq!(windows, [5.0, 10.0, 20.0, 40.0, 60.0, 80.0, 160.0, 300.0]);
    let (residual, base) = (&analysis.validation[0].base_replay.replay.residual, analysis.base.response);
    for entry in &horizons[..7] {
        let expected = to_deg(less_two_solutions(residual, entry.horizon_s as usize, base.inverse_T.recip()));
        assert!((entry.before_deg / expected - 1.0).abs() < 0.02, "{entry:?}: {expected}");
    }
    for (when, of) in [("before", &error.validation[0].before), ("after", &error.validation[0].after)] {
        let error_at = |window: f64| {
            let entry = horizons.iter().find(|entry| entry.horizon_s == window).expect("a horizon");
            Some(if when == "before" { entry.before_deg } else { entry.after_deg })
        };
        assert_eq!([error_at(20.0), error_at(60.0)], ["20", "60"].map(|window| of.horizon_rmse_deg[window]), "{when}");
        assert_eq!(error_at(300.0), Some(of.heading_rmse_deg), "{when}");
    }
    assert!(horizons[3..].iter().all(|entry| entry.after_deg < 0.5 * entry.before_deg), "{horizons:?}");
    assert!(error.identification[0].horizons.is_empty());
    let quick = Settings { is_thorough: false, ..Settings::default() };
    let short = damped(TrialPlan { rows: 26, ..TrialPlan::default() });
    let analysis = trace(&[damped(TrialPlan::default())], &[short], &quick).expect("a base");
    let windows: Vec<f64> =
        analysis.document.error.validation[0].horizons.iter().map(|entry| entry.horizon_s).collect();
    assert_eq!(windows, [25.0], "no window of 20 s is less than the whole of 25 s");
}

/// The weights of the structures are their evidence times the prior odds of their terms; the probabilities of the
/// document follow from them for other odds.
#[test]
fn probabilities_move_with_the_prior_odds() {
    let damping: Arc<dyn Effect> = listed_effect("nonlinear_damping", "r³");
    let trial = record(&ship(vec![(damping, vec![25.0])]), TrialPlan { noise_deg: 0.2, ..TrialPlan::default() });
    let analysis = traced(std::slice::from_ref(&trial));
    let (document, all) = (&analysis.document, &analysis.structures.weighed);
    let of_other_laws = 1.0 - all.iter().map(|weighed| weighed.weight).sum::<f64>();
    assert!(of_other_laws.abs() < 1e-12, "other laws of the noise have no part here: {of_other_laws}");
    let weight = |weighed: &WeighedStructure, factor: f64| {
        let odds = weighed.fit.structure.terms.iter().map(|term| term.log_odds + factor.ln()).sum::<f64>();
        (weighed.fit.log_evidence + odds - all[0].fit.log_evidence).exp()
    };
    let mut moved = 0;
    for candidate in document.candidates.iter().filter(|candidate| !candidate.probability_by_prior_odds.is_empty()) {
        for (factor, probability) in document.prior.odds_factors.iter().zip(&candidate.probability_by_prior_odds) {
            let has =
                |all: &&WeighedStructure| all.fit.structure.terms.iter().any(|term| term.effect.id() == candidate.id);
            let with: f64 = all.iter().filter(has).map(|weighed| weight(weighed, *factor)).sum();
            let expected = with / all.iter().map(|weighed| weight(weighed, *factor)).sum::<f64>();
            assert!((probability - expected).abs() < 1e-9, "{} × {factor}: {probability}, {expected}", candidate.id);
        }
        let by_odds = &candidate.probability_by_prior_odds;
        assert!((by_odds[2] - candidate.probability).abs() < 1e-12, "{candidate:?}");
        moved += usize::from(by_odds[4] > by_odds[0] + 0.1);
    }
    assert!(moved > 0 && document.prior.odds_factors[2] == 1.0, "{:?}", document.candidates);
    // A required effect is present whatever its odds.
    let asked = Selection::only(vec![EffectId::find("nonlinear_damping").expect("on the list")]);
    let asked = trace(&[trial], &[], &Settings { selection: asked, ..Settings::default() }).expect("a base").document;
    let asked = &asked.effects[0];
    assert!(asked.probability_by_prior_odds.iter().all(|p| (p - asked.probability).abs() < 1e-12), "{asked:?}");
}

/// The main result precedes the folds: stopping them leaves it unchanged.
#[test]
fn nobody_has_to_wait_for_the_folds() {
    #[derive(Default)]
    struct Hurried(AtomicUsize);
    impl FoldObserver for Hurried {
        fn begin_folds(&self, count: usize) {
            self.0.fetch_add(count, Ordering::Relaxed);
        }

        fn should_stop(&self) -> bool {
            self.0.load(Ordering::Relaxed) > 0
        }
    }
    let trials = [10.0, 15.0].map(|rudder_deg| damped(TrialPlan { rudder_deg, ..TrialPlan::default() }));
    let hurried = Hurried::default();
    let stopped = trace_with_observer(&trials, &[], &Settings::default(), &hurried).expect("a base");
    let whole = traced(&trials);
    assert_eq!((hurried.0.into_inner(), stopped.leave_one_out.len(), whole.leave_one_out.len()), (2, 0, 2));
    assert_eq!((named(&stopped), stopped.base.response), (named(&whole), whole.base.response));
}

#[test]
fn what_is_asked_for_is_in_the_model_and_what_is_excluded_is_not() {
    let id = |name: &str| EffectId::find(name).expect("on the list");
    let trial = damped(TrialPlan::default());
    let with = |selection: Selection| {
        let settings = Settings { selection, ..Settings::default() };
        trace(std::slice::from_ref(&trial), &[], &settings)
    };
    let only = with(Selection::only(vec![id("speed_loss")])).expect("a base");
    assert_eq!(named(&only), ["speed_loss"]);
    let without = with(Selection { excluded: vec![id("nonlinear_damping")], ..Selection::default() }).expect("a base");
    assert!(!named(&without).contains(&"nonlinear_damping"));
    let lacking = with(Selection::only(vec![id("sway_coupling_measured")])).expect_err("no sway");
    assert!(lacking.to_string().contains("sway"), "{lacking}");
}

/// A formula is a candidate like a listed effect: it is named, with its text, if it acts, and otherwise not.
#[test]
fn a_formula_is_named_where_it_acts() {
    let bank = Formula::parse("bank = c * tanh(k * psi)").expect("a formula");
    let selection = Selection { formulas: vec![Arc::clone(&bank)], ..Selection::default() };
    let settings = Settings { selection, ..Settings::default() };
    let banked = record(&ship(vec![(bank, vec![-0.05, 8.0])]), TrialPlan::default());
    let analysis = trace(&[banked], &[], &settings).expect("a base");
    assert_eq!(named(&analysis), ["bank"], "{:?}", analysis.document.candidates);
    let effect = &analysis.document.effects[0];
    assert_eq!(effect.form, "c * tanh(k * psi)");
    let errors = &analysis.identification[0];
    assert!(errors.average_replay.errors.heading_rmse < 0.3 * errors.base_replay.errors.heading_rmse);
    let other = trace(&[damped(TrialPlan::default())], &[], &settings).expect("a base");
    assert_eq!(named(&other), ["nonlinear_damping"]);
    assert!(other.document.candidates.iter().any(|candidate| candidate.id == "bank"), "it is on the list");
}

#[test]
fn both_rules_name_what_is_clear() {
    let trial = damped(TrialPlan::default());
    for rule in WeightingRule::ALL {
        let settings = Settings { rule, is_thorough: false, ..Settings::default() };
        let analysis = trace(std::slice::from_ref(&trial), &[], &settings).expect("a base");
        assert_eq!(named(&analysis), ["nonlinear_damping"], "{}", rule.as_str());
    }
}

/// The band covers most of the record and is no wider than the noise requires.
#[test]
fn bands_hold_the_record() {
    let trial = damped(TrialPlan::default());
    let other = damped(TrialPlan { seed: 5, rudder_deg: 12.0, ..TrialPlan::default() });
    let analysis = trace(&[trial], &[other], &Settings::default()).expect("a base");
    for record in analysis.identification.iter().chain(&analysis.validation) {
        let (coverage, width) = (
            record.average_replay.band_coverage().expect("a band").share(),
            record.average_replay.band_width().expect("a band").to_degrees(),
        );
        assert!((0.85..=1.0).contains(&coverage) && (0.15..0.6).contains(&width), "{coverage}, {width} deg");
    }
}

#[test]
fn a_document_is_read_as_it_was_written() {
    let analysis = traced(&[damped(TrialPlan::default())]);
    let text = serde_json::to_string(&analysis.document).expect("plain data");
    let again: crate::AnalysisDocument = serde_json::from_str(&text).expect("the same");
    assert_eq!(serde_json::to_string(&again).expect("plain data"), text);
    // A document of an earlier version has no probabilities by prior odds.
    let mut earlier = serde_json::to_value(&again).expect("plain data");
    let remove = |from: &mut serde_json::Value, key: &str| from.as_object_mut().and_then(|all| all.remove(key));
    for list in ["effects", "candidates"] {
        let entries = earlier[list].as_array_mut().into_iter().flatten();
        entries.for_each(|entry| drop(remove(entry, "probability_by_prior_odds")));
    }
    assert!(remove(&mut earlier["prior"], "odds_factors").is_some());
    let earlier: crate::AnalysisDocument = serde_json::from_value(earlier).expect("an earlier document");
    assert!(earlier.prior.odds_factors.is_empty() && earlier.effects[0].probability_by_prior_odds.is_empty());
}

/// Errors of the recorded rudder are instrument noise: they give no named effect, no located shape and no random
/// moment.
#[test]
fn nothing_is_named_for_noise_of_the_rudder() {
    let clean = record(&ship(Vec::new()), TrialPlan::default());
    let rudder = noisy(clean.rudder(), 0.3);
    let document = traced(&[of_columns(clean.time().to_vec(), clean.heading().to_vec(), rudder)]).document;
    assert_eq!((document.verdict, document.effects.len()), (TraceVerdict::Clean, 0), "{}", document.headline);
    assert!(document.noise[0].rudder_sd_deg.is_some_and(|sd| (sd - 0.3).abs() < 0.05), "{:?}", document.noise);
}

/// A tug on one side is not named wind: the shape replaces the named effect.
#[test]
fn a_name_falls_where_a_shape_does_better() {
    let tug: Arc<dyn Effect> = Formula::parse("tug = c * max(psi, 0)").expect("a formula");
    let plan = TrialPlan { noise_deg: 0.1, seed: 5, ..TrialPlan::default() };
    let document = traced(&[record(&ship(vec![(tug, vec![-0.3])]), plan)]).document;
    assert_eq!((document.verdict, document.effects.len()), (TraceVerdict::Located, 0), "{}", document.headline);
    let located = &document.located[0];
    assert_eq!(
        (located.depends_on, located.formula.as_deref()),
        (Dependence::Heading, Some("located = c * max(psi, 0)"))
    );
    assert!(located.nats > 10.0 && located.rudder_deg > 0.1, "{located:?}");
}

/// A random-walk moment is a disturbance: it explains the heading error, and no shape or effect is reported. In a
/// declared calm the same residual is unexplained.
#[test]
fn a_random_moment_is_a_disturbance_and_in_a_calm_unexplained() {
    let walking = wandering(30.0, 2);
    let document = traced(std::slice::from_ref(&walking)).document;
    let disturbance = document.disturbance.expect("a random moment");
    assert_eq!((document.verdict, document.effects.len()), (TraceVerdict::Disturbed, 0), "{}", document.headline);
    assert!(disturbance.heading_error_share > 0.6, "{disturbance:?}");
    assert!(document.headline.contains("the ship was disturbed"), "{}", document.headline);
    let weather = Some(DeclaredWeather::Calm);
    let becalmed = walking.with_conditions(DeclaredConditions { weather, ..DeclaredConditions::default() });
    let document = traced(&[becalmed]).document;
    assert_eq!(document.verdict, TraceVerdict::Unexplained, "{}", document.headline);
    let wind = document.candidates.iter().find(|candidate| candidate.id == "wind_moment").expect("on the list");
    assert!(wind.reason.as_deref().is_some_and(|why| why.contains("calm")), "{wind:?}");
}
