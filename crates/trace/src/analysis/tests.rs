//! Whole analyses of made-up records whose truth is known.

use std::sync::Arc;

use identify::Identifier;
use rand::{SeedableRng, rngs::ChaCha8Rng};
use rand_distr::{Distribution, StandardNormal};
use ship::effects::{Effect, NonlinearDamping, TransientDisturbance};

use super::*;
use crate::made_up::{BASE, Plan, changing, of_columns, record, ship, wandering};
use crate::noise::Wander;
use crate::wanted::{EffectId, Wanted};

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

fn id(name: &str) -> EffectId {
    EffectId::find(name).expect("on the list")
}

fn traced(truth: &ship::Response, wanted: Wanted) -> Result<Analysis, TraceError> {
    let settings = Settings { wanted, thorough: false, ..Settings::default() };
    trace(&[record(truth, Plan::default())], &[], &settings)
}

fn named(analysis: &Analysis) -> Vec<(&'static str, bool)> {
    analysis.effects.iter().map(|effect| (effect.id, effect.asked)).collect()
}

/// What is asked for is in the model with its evidence, weak or not, and the search goes on beside it.
#[test]
fn an_effect_that_was_asked_for_stays_and_is_judged() {
    let asked = |truth: &ship::Response| {
        let wanted = Wanted { with: vec![id("port_starboard_asymmetry")], ..Wanted::default() };
        traced(truth, wanted).expect("a base")
    };
    let plain = asked(&ship(Vec::new()));
    assert_eq!(named(&plain), [("port_starboard_asymmetry", true)]);
    assert!(plain.effects[0].evidence.gain < 10.0);
    assert!(plain.effects[0].sentence.starts_with("asked for, not found:"), "{}", plain.effects[0].sentence);
    let damped = asked(&ship(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])]));
    assert_eq!(named(&damped), [("port_starboard_asymmetry", true), ("nonlinear_damping", false)]);
}

/// Exactly what was asked for, whatever is missing; of several forms the one of lowest BIC.
#[test]
fn only_what_was_asked_for_is_fitted() {
    let truth = ship(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])]);
    let analysis = traced(&truth, Wanted::only(vec![id("rudder_saturation")])).expect("a base");
    assert_eq!(named(&analysis), [("rudder_saturation", true)]);
    let reason = |name: &str| {
        let one = analysis.candidates.iter().find(|one| one.id == name);
        one.and_then(|one| one.reason)
    };
    assert_eq!(reason("speed_loss"), Some("excluded on request"));
    assert_eq!(reason("wave_yaw"), Some("excluded on request"));
    let analysis = traced(&truth, Wanted::only(vec![id("speed_loss"), id("nonlinear_damping")])).expect("a base");
    assert_eq!(named(&analysis), [("speed_loss", true), ("nonlinear_damping", true)]);
    assert_eq!(analysis.effects[1].form, NonlinearDamping::Cubic.form());
}

#[test]
fn what_is_excluded_is_not_found_and_what_cannot_be_had_is_refused() {
    let truth = ship(vec![(Arc::new(NonlinearDamping::Cubic), vec![80.0])]);
    let without = Wanted { without: vec![id("nonlinear_damping")], ..Wanted::default() };
    let analysis = traced(&truth, without.clone()).expect("a base");
    assert!(named(&analysis).iter().all(|(name, _)| *name != "nonlinear_damping"));
    for (name, why) in [("sway_coupling_measured", "sway velocity"), ("wave_yaw", "narrow band")] {
        let error = traced(&truth, Wanted::only(vec![id(name)])).err().expect("no such model").to_string();
        assert!(error.contains(name) && error.contains(why), "{error}");
    }
    let both = Wanted { with: without.without.clone(), ..without };
    assert!(matches!(traced(&truth, both), Err(TraceError::Settings(_))));
}

/// A squall belongs to one record: asked for, it is looked for in each.
#[test]
fn a_moment_of_time_that_was_asked_for_is_one_of_every_record() {
    let trials = [1, 2].map(|seed| record(&ship(Vec::new()), Plan { seed, ..Plan::default() }));
    let wanted = Wanted::only(vec![id("moment_drift")]);
    let settings = Settings { wanted, thorough: false, ..Settings::default() };
    let analysis = trace(&trials, &[], &settings).expect("a base");
    assert_eq!(named(&analysis), [("moment_drift", true); 2]);
}

/// A moment that walks is told as noise, of its size, and the parameters are those of the likelihood under it: nearer
/// to the truth than output error, with intervals that hold it.
#[test]
fn a_moment_that_wanders_is_named_and_no_riddle() {
    const RECORDS: u64 = 24;
    let (mut clean, mut held, mut size, mut square) = (0, 0, 0.0, [0.0; 2]);
    for seed in 0..RECORDS {
        let trial = wandering(60.0, seed);
        let settings = Settings { thorough: false, ..Settings::default() };
        let analysis = trace(std::slice::from_ref(&trial), &[], &settings).expect("a base");
        if analysis.verdict != Verdict::Clean {
            continue;
        }
        clean += 1;
        let nearest = output_error::Settings::default().build().expect("valid").identify(&[trial]).expect("a fit");
        let [low, high] = analysis.indices[0].ci95.expect("an interval");
        held += u64::from((low..=high).contains(&0.1));
        square[0] += (analysis.indices[0].value - 0.1).powi(2);
        square[1] += (nearest.K().value - 0.1).powi(2);
        assert!(analysis.randomness.holds && analysis.randomness.wander.is_some(), "{seed}");
        size += analysis.randomness.rudder.ln();
    }
    assert!(clean >= RECORDS - 2, "{clean} of {RECORDS}");
    assert!(held as f64 >= 0.8 * clean as f64, "{held} of {clean}");
    assert!(square[0] < 0.65_f64.powi(2) * square[1], "{square:?}");
    // What the walk adds in a second, as rudder.
    let truth = 60f64.to_radians() * (20.0 / 300f64.powi(5)).sqrt() / BASE[1];
    let ratio = (size / clean as f64).exp() / truth;
    assert!((0.75..1.33).contains(&ratio), "{ratio}");
}

/// A moment that sets in and stays is found with its instant, and is no random walk.
#[test]
fn a_moment_that_stays_is_located() {
    let step: Arc<dyn Effect> = Arc::new(TransientDisturbance::Lasting { edge: 0.5 });
    let analysis = traced(&ship(vec![(step, vec![0.02, 131.0])]), Wanted::default()).expect("a base");
    assert_eq!((analysis.verdict, named(&analysis)), (Verdict::Traced, vec![("transient_disturbance", false)]));
    let [moment, instant] = [0, 1].map(|k| analysis.effects[0].parameters[k].quantity.value);
    assert!((moment / 0.02 - 1.0).abs() < 0.05 && (instant - 131.0).abs() < 1.0, "{moment} {instant}");
}

/// Two squalls of opposite sign are two terms, each at its time.
#[test]
fn two_squalls_are_located() {
    let squall = |moment: f64, at: f64| -> (Arc<dyn Effect>, Vec<f64>) {
        (Arc::new(TransientDisturbance::Passing), vec![moment, at, 25.0])
    };
    let analysis = traced(&ship(vec![squall(0.05, 80.0), squall(-0.05, 210.0)]), Wanted::default()).expect("a base");
    assert_eq!((analysis.verdict, named(&analysis)), (Verdict::Traced, vec![("transient_disturbance", false); 2]));
    let mut at: Vec<f64> = analysis.effects.iter().map(|effect| effect.parameters[1].quantity.value).collect();
    at.sort_by(f64::total_cmp);
    assert!((at[0] - 80.0).abs() < 2.0 && (at[1] - 210.0).abs() < 2.0, "{at:?}");
}

/// A compass whose errors last is told as that, with its size and its correlation time, and is no riddle.
#[test]
fn a_coloured_error_of_the_compass_is_named() {
    const RECORDS: u64 = 12;
    let (sd, time) = (0.4_f64.to_radians(), 8.0_f64);
    let (mut told, mut logarithms) = (0, [0.0; 2]);
    for seed in 0..RECORDS {
        let calm = record(&ship(Vec::new()), Plan { seed, ..Plan::default() });
        let mut generator = ChaCha8Rng::seed_from_u64(seed + 1_000_000);
        let mut draw = || -> f64 { StandardNormal.sample(&mut generator) };
        let mut error = sd * draw();
        let (kept, fresh) = ((-1.0 / time).exp(), sd * (1.0 - (-2.0 / time).exp()).sqrt());
        let coloured = calm.heading().iter().map(|heading| {
            error = kept * error + fresh * draw();
            heading + error
        });
        let trial = of_columns(calm.time().to_vec(), coloured.collect(), calm.rudder().to_vec());
        let settings = Settings { thorough: false, ..Settings::default() };
        let analysis = trace(&[trial], &[], &settings).expect("a base");
        let noise = &analysis.randomness;
        let Some(Wander::Compass(_)) = noise.wander.filter(|_| noise.holds && analysis.verdict == Verdict::Clean)
        else {
            continue;
        };
        told += 1;
        logarithms[0] += (noise.heading / sd).ln();
        logarithms[1] += (noise.correlation.expect("of a compass") / time).ln();
    }
    assert!(told >= RECORDS - 1, "{told} of {RECORDS}");
    let ratios = logarithms.map(|sum| (sum / told as f64).exp());
    assert!(ratios.iter().all(|ratio| (0.7..1.43).contains(ratio)), "{ratios:?}");
}

/// A ship that becomes another one half-way has no effect that is on the list: it is told with the instant and the
/// shares by which its indices change.
#[test]
fn a_ship_that_changes_is_located() {
    let [before, after] = [BASE, [1.6 * BASE[0], 1.6 * BASE[1], BASE[2]]]
        .map(|base| ship::ResponseModel::first_order().with(base.to_vec()));
    let trial = changing(&before, &after, 150.0);
    let analysis = trace(&[trial], &[], &Settings { thorough: false, ..Settings::default() }).expect("a base");
    let empirical = analysis.empirical.as_ref().map(|found| (found.group[0], &found.parameters));
    let values = empirical.map(|(form, parameters)| (form, parameters.iter().map(|p| p.quantity.value).collect()));
    let (form, values): (&str, Vec<f64>) = values.expect("a nameless shape");
    assert_eq!((analysis.verdict, form), (Verdict::Unexplained, "another 1/T and K/T from t₀ on"));
    assert!(
        (values[2] - 150.0).abs() < 5.0 && (values[0] - 0.6).abs() < 0.1 && (values[1] - 0.6).abs() < 0.1,
        "{values:?}"
    );
}

/// A sentinel and a spike are left out, listed, and change nothing.
#[test]
fn readings_that_belong_to_no_ship_are_left_out_and_listed() {
    let clean = record(&ship(Vec::new()), Plan::default());
    let mut heading = clean.heading().to_vec();
    (heading[0], heading[77]) = ((-999_f64).to_radians(), heading[77] + 5_f64.to_radians());
    let spoilt = of_columns(clean.time().to_vec(), heading, clean.rudder().to_vec());
    let traced = |trial: &Trial| {
        trace(std::slice::from_ref(trial), &[], &Settings { thorough: false, ..Settings::default() }).expect("a base")
    };
    let (with, without) = (traced(&spoilt), traced(&clean));
    assert_eq!(
        (with.verdict, &with.outliers, &without.outliers),
        (Verdict::Clean, &vec![vec![0.0, 77.0]], &vec![vec![]])
    );
    let away = (with.indices[0].value - without.indices[0].value).abs();
    assert!(away < without.indices[0].sd.expect("known"), "{away}");
}
