//! Priors from earlier trials: synthetic numbers, and simulated trials of KVLCC2.

use document::earlier_trials::Likeness;
use nalgebra::DVector;
use ship::ships::kvlcc2::MODEL_L7;
use ship::vessel::mmg::Mmg;
use ship::vessel::prime::HullModel;
use ship::vessel::prior::HullParticulars;
use trial::{Channel, Columns, Trial};

use super::objective::HullObjective;
use super::tests::{LENGTH, SPEED, TRUTH, hull, record};
use super::track::HullSignals;
use super::{EarlierHull, HullEstimate, HullFormPrior, fit, merge_with_earlier};

const SHIP: HullParticulars = HullParticulars {
    length: LENGTH,
    speed: SPEED,
    beam: Some(1.27),
    draught: Some(0.455),
    block_coefficient: Some(0.81),
    rudder_area: None,
    rudder_height: None,
    propeller_diameter: None,
    propeller_rate: None,
    displacement: None,
    x_g: None,
};

/// Hull with every coefficient one deviation above the expected value and a standard deviation of a tenth of that
/// deviation in every direction.
fn earlier(particulars: HullParticulars, form: &str) -> EarlierHull {
    let form = HullModel::candidates(Some(&particulars)).into_iter().find(|f| f.as_str() == form).expect("known");
    let priors = form.coefficients();
    let values = DVector::from_iterator(priors.len(), priors.iter().map(|prior| prior.mean + prior.sd));
    let covariance = form.covariance() * 0.01;
    EarlierHull { form, particulars, coefficients: values, covariance }
}

/// Prior of a coefficient after earlier trials: its shift from the prior of her particulars and its deviation, both in
/// deviations of the prior of her particulars.
fn after(ship: &HullParticulars, form: &str, all: &[EarlierHull], key: &str) -> [f64; 2] {
    let expected = HullFormPrior::candidates(Some(ship), all);
    let expected = expected.into_iter().find(|hull| hull.form.as_str() == form).expect("known");
    let place = expected.coefficients.iter().position(|term| term.key == key).expect("known");
    let (own, generic) = (expected.coefficients[place], expected.form.coefficients()[place]);
    [(own.mean - generic.mean) / generic.sd, own.sd / generic.sd]
}

fn near(found: [f64; 2], expected: [f64; 2]) {
    assert!((0..2).all(|end| (found[end] - expected[end]).abs() < 1e-9), "{found:?} {expected:?}");
}

/// A trial of precision 100 has the information 99 in addition to the prior; 1/f² of it counts, and the prior counts
/// once.
#[test]
fn what_trials_told_is_widened_and_what_was_expected_counts_once() {
    let one = earlier(SHIP, "quadratic");
    let counted = |told: f64, heights: f64| [heights / (1.0 + told), (1.0 + told).powf(-0.5)];
    let told = 99.0 / 2.25;
    near(after(&SHIP, "quadratic", std::slice::from_ref(&one), "Nv"), counted(told, 100.0 / 2.25));
    near(after(&SHIP, "quadratic", &[one.clone(), one.clone()], "Nv"), counted(2.0 * told, 200.0 / 2.25));
    near(after(&SHIP, "quadratic", std::slice::from_ref(&one), "delta_r"), [0.0, 1.0]);
    near(after(&SHIP, "cubic", &[one], "Nv"), [0.0, 1.0]);
}

/// A hull with its own records, of precision 100, combined with the information of an earlier trial: both count, and
/// two equal estimates agree.
#[test]
fn a_hull_is_weighed_together_with_earlier_trials() {
    let own = earlier(SHIP, "quadratic");
    let (after, check) = merge_with_earlier(&own, std::slice::from_ref(&own)).expect("of its form");
    let nv = own.form.coefficients().iter().position(|one| one.key == "Nv").expect("known");
    let before = own.form.coefficients()[nv];
    let found = [(after.coefficients[nv] - before.mean) / before.sd, after.covariance[(nv, nv)].sqrt() / before.sd];
    let precision = 100.0 + 99.0 / 2.25;
    near(found, [(100.0 + 100.0 / 2.25) / precision, precision.powf(-0.5)]);
    assert!(!check.expect("both tell something").is_conflict());
    let apart = EarlierHull {
        coefficients: own.form.coefficients().iter().map(|one| one.mean - one.sd).collect::<Vec<_>>().into(),
        ..own.clone()
    };
    let (_, check) = merge_with_earlier(&own, &[apart]).expect("of its form");
    assert!(check.expect("both tell something").is_conflict(), "ten deviations to either side");
    assert!(merge_with_earlier(&own, &[earlier(SHIP, "cubic")]).is_none());
}

#[test]
fn another_scale_tells_less_and_nothing_of_friction() {
    let large = HullParticulars { length: 320.0, speed: 8.11, beam: Some(58.0), draught: Some(20.8), ..SHIP };
    let one = earlier(large, "mmg");
    let found = after(&SHIP, "mmg", std::slice::from_ref(&one), "epsilon");
    near(found, [100.0 / 4.0 / (1.0 + 99.0 / 4.0), (1.0_f64 + 99.0 / 4.0).powf(-0.5)]);
    near(after(&SHIP, "mmg", &[one], "R0"), [0.0, 1.0]);
    assert_eq!(Likeness::from_particulars(&large, &SHIP), Likeness::OtherScale);
    assert_eq!(Likeness::from_particulars(&SHIP, &SHIP), Likeness::SameShip);
}

/// The departure from the prior of the particulars is carried to another draught, with the change of the formulas. The
/// spread of N_r is a share of the mean or absolute, so its departure is compared in units of the coefficient.
#[test]
fn another_draught_moves_what_is_expected_by_the_formulas() {
    let ballast = HullParticulars { draught: Some(0.3), block_coefficient: Some(0.78), ..SHIP };
    assert_eq!(Likeness::from_particulars(&SHIP, &ballast), Likeness::OtherHull);
    let of = |ship: &HullParticulars, all: &[EarlierHull]| {
        let expected = HullFormPrior::candidates(Some(ship), all).into_iter().find(|hull| hull.form.as_str() == "mmg");
        *expected.expect("known").coefficients.iter().find(|term| term.key == "Nr").expect("known")
    };
    let (full, light) = (of(&SHIP, &[]), of(&ballast, &[]));
    let found = of(&ballast, &[earlier(SHIP, "mmg")]);
    let (told, own) = (full.sd.powi(-2) / 9.0, light.sd.powi(-2));
    // Vector 100 (θ − μ₁) of the trial, with 99 about the mean in ballast.
    let departure = 100.0 * told * full.sd / (own + 99.0 * told);
    assert!((found.mean - light.mean - departure).abs() < 1e-9, "{found:?} {light:?} {departure}");
    assert!((light.mean - full.mean).abs() > 0.1 * full.sd, "the formulas say something of the draught");
}

/// At another loading the trial counts 99/9 and the prior 1: the expected hull follows the hull of the trials by 11/12.
/// Without trials there is no gain.
#[test]
fn what_is_expected_follows_the_hull_of_the_trials() {
    let ballast = HullParticulars { draught: Some(0.3), ..SHIP };
    let expected = HullFormPrior::candidates(Some(&ballast), &[earlier(SHIP, "mmg")]).pop().expect("the last is MMG");
    let [covariance, gain] = expected.covariance_and_gain().expect("trials are in it");
    let own = expected.form.coefficients();
    let place = |key: &str| own.iter().position(|one| one.key == key).expect("known");
    let of =
        |key: &str| [gain[(place(key), place(key))], covariance[(place(key), place(key))] / own[place(key)].sd.powi(2)];
    near(of("epsilon"), [11.0 / 12.0, 1.0 / 12.0]);
    near(of("R0"), [0.0, 1.0]);
    near(of("delta_r"), [0.0, 1.0]);
    assert!(HullFormPrior::candidates(Some(&ballast), &[])[0].covariance_and_gain().is_none());
}

/// Particulars that only one ship declares are used for both ships.
#[test]
fn particulars_that_are_missing_are_those_of_the_earlier_ship() {
    let bare = HullParticulars { length: LENGTH, speed: SPEED, ..HullParticulars::default() };
    let of = |ship: &HullParticulars| {
        let all = HullFormPrior::candidates(Some(ship), &[earlier(SHIP, "mmg")]);
        all.into_iter().find(|hull| hull.form.as_str() == "mmg").expect("known").mean()
    };
    assert!((of(&bare) - of(&SHIP)).amax() < 1e-12);
}

fn left_by(estimate: &HullEstimate) -> EarlierHull {
    EarlierHull {
        form: estimate.prior.form.clone(),
        particulars: SHIP,
        coefficients: estimate.coefficients.clone(),
        covariance: estimate.covariance.clone(),
    }
}

fn quadratic(all: &[EarlierHull]) -> HullFormPrior {
    HullFormPrior::candidates(Some(&SHIP), all).remove(0)
}

/// Mean square heading error of the replays of other records, rad².
fn error_on(estimate: &HullEstimate, others: &[Trial]) -> f64 {
    let signals = |trial: &Trial| HullSignals::from_trial(trial, &estimate.reference).expect("a record");
    let hull_signals: Vec<HullSignals> = others.iter().map(signals).collect();
    let mut problem = HullObjective::new(&estimate.prior, &hull_signals);
    let left = problem.misfits(estimate.coefficients.as_slice()).expect("a ship");
    left.iter().map(|error| error.whole_heading).sum::<f64>() / left.len() as f64
}

fn half_of(trial: &Trial) -> Trial {
    let rows = trial.time().len() / 2;
    let of = |channel: Channel| (channel, trial.channel(channel).expect("recorded")[..rows].to_vec());
    let channels = [Channel::Rudder, Channel::Heading, Channel::Speed].map(of);
    let columns =
        Columns { time: trial.time()[..rows].to_vec(), channels: channels.into(), unknown_columns: Vec::new() };
    let ship = trial.particulars().expect("declared");
    Trial::new("half", trial.origin().clone(), columns).expect("a record").with_particulars(ship)
}

/// KVLCC2, which no form describes exactly: with a prior from her 10/10 and 20/20, half of a 15/15 predicts three other
/// zig-zags as well as the whole 15/15 without that prior, to 5 % over all forms and to 30 % for the worst form.
#[test]
fn half_a_trial_after_two_tells_as_much_as_a_whole_one() {
    let ship = Mmg::at_speed(MODEL_L7, SPEED).expect("it balances");
    let sailed = |angles: [f64; 2]| record(&ship, angles, |_| 0.0);
    let two = [sailed([10.0, 10.0]), sailed([-20.0, 20.0])];
    let third = sailed([15.0, 15.0]);
    let others = [[20.0, 10.0], [-15.0, 10.0], [25.0, 20.0]].map(sailed);
    let mut squares = [0.0; 2];
    for (place, expected) in HullFormPrior::candidates(Some(&SHIP), &[]).iter().enumerate() {
        let earlier = left_by(&fit(&two, expected).expect("a fit"));
        let whole = fit(std::slice::from_ref(&third), expected).expect("a fit");
        let after_trials = HullFormPrior::candidates(Some(&SHIP), &[earlier]).swap_remove(place);
        let half = fit(&[half_of(&third)], &after_trials).expect("a fit");
        let [half_square, whole_square] = [&half, &whole].map(|fit| error_on(fit, &others));
        squares = [squares[0] + half_square, squares[1] + whole_square];
        let ratio = (half_square / whole_square).sqrt();
        assert!(ratio < 1.3, "{}: {ratio}", expected.form.as_str());
        let check = half.prior_check().expect("a record tells something");
        assert!(!check.is_conflict(), "{}: {check:?}", expected.form.as_str());
    }
    assert!(squares[0] < 1.05 * 1.05 * squares[1], "{squares:?}");
}

/// The same ship agrees with her earlier trials; a ship with other N_v, N_r and N_δ does not.
#[test]
fn another_ship_contradicts_the_prior() {
    let sailed = |ship: &dyn ship::Dynamics, angles: [f64; 2]| record(ship, angles, |_| 0.0);
    let two = [sailed(&hull(&TRUTH), [10.0, 10.0]), sailed(&hull(&TRUTH), [-20.0, 20.0])];
    let expected = quadratic(&[left_by(&fit(&two, &quadratic(&[])).expect("a fit"))]);
    let check = |truth: &[f64; 19]| {
        let found = fit(&[sailed(&hull(truth), [15.0, 15.0])], &expected).expect("a fit");
        found.prior_check().expect("a record tells something")
    };
    let own = check(&TRUTH);
    assert!(own.p_value > 0.05, "{own:?}");
    let mut other = TRUTH;
    (other[0], other[1], other[2]) = (-1.8, -2.6, 0.6);
    let found = check(&other);
    assert!(found.is_conflict() && found.shifts[0].1.abs() > 1.0, "{found:?}");
}
