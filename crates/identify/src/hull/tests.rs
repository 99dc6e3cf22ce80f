use std::collections::BTreeMap;

use ship::integrate::RungeKutta4;
use ship::ships::kvlcc2::MODEL_L7;
use ship::vessel::mmg::Mmg;
use ship::vessel::prior::{HullParticulars, priors};
use ship::{Dynamics, Input, Particulars};
use trial::{Channel, Columns, Origin};

use super::*;

/// A 7 m model at 1.179 m/s.
const SHIP: Particulars = Particulars { length: 7.0, speed: 1.179 };

/// A zig-zag of a ship of which nothing else is known, `side` 1 for a first execute to starboard; rows every 0.5 s, the rudder at 15°/s.
fn record(ship: &dyn Dynamics, rudder_deg: f64, heading_deg: f64, seconds: f64, side: f64) -> Trial {
    const STEP: f64 = 0.05;
    let mut state = vec![0.0; ship.dimension()];
    ship.approach(0.0, 0.0, &mut state);
    let mut solver = RungeKutta4::new(ship.dimension());
    let (mut rudder, mut order) = (0.0_f64, side * rudder_deg.to_radians());
    let [mut time, mut headings, mut rudders, mut speeds] = [(); 4].map(|()| Vec::new());
    for step in 0..(seconds / STEP) as usize {
        let t = step as f64 * STEP;
        if step % 10 == 0 {
            time.push(t);
            headings.push(state[0]);
            rudders.push(rudder);
            speeds.push(ship.motion(t, &state, &Input::default()).speed.expect("a hull has a speed"));
        }
        if state[0] * order.signum() > heading_deg.to_radians() {
            order = -order;
        }
        let most = STEP * 15_f64.to_radians();
        let next = rudder + (order - rudder).clamp(-most, most);
        let inputs = [rudder, 0.5 * (rudder + next), next].map(|rudder| Input { rudder, ..Input::default() });
        solver.step_with(ship, t, STEP, &mut state, &inputs);
        rudder = next;
    }
    let channels: BTreeMap<Channel, Vec<f64>> =
        [(Channel::Heading, headings), (Channel::Rudder, rudders), (Channel::Speed, speeds)].into();
    let origin = Origin::Simulated { scenario: "made up".into(), cell: 0, replicate: 0 };
    Trial::new("zig-zag", origin, Columns { time, channels, unknown: Vec::new() }).expect("a record")
}

/// The same of the 7 m model.
fn zigzag(ship: &dyn Dynamics, rudder_deg: f64, heading_deg: f64, seconds: f64, side: f64) -> Trial {
    record(ship, rudder_deg, heading_deg, seconds, side).with_particulars(SHIP)
}

/// A hull of the quadratic form that is not the expected one.
fn other_hull() -> ScaledHull {
    let form = HullForm::Quadratic;
    let values: Vec<f64> =
        form.coefficients().iter().enumerate().map(|(place, own)| own.mean + [0.4, -0.3][place % 2] * own.sd).collect();
    ScaledHull { hull: form.with(&values).expect("a ship"), length: SHIP.length, speed: SHIP.speed, propeller: None }
}

fn fitted(trials: &[Trial], form: &HullForm) -> HullEstimate {
    fit(trials, form, &form.coefficients()).expect("it can be fitted")
}

/// Root mean square of what a hull leaves of a record that it has not seen, deg.
fn left_of(estimate: &HullEstimate, trial: &Trial) -> f64 {
    let tracks = [HullTrack::of(trial, &estimate.reference).expect("a record")];
    let mut problem = HullObjective::new(&estimate.form, estimate.expected.clone(), &tracks);
    problem.left(estimate.values.as_slice()).expect("a ship")[0].whole.sqrt().to_degrees()
}

/// Two records tell a hull of the form so well that a third, with a larger rudder, is foreseen.
#[test]
fn a_hull_of_the_form_is_found_and_foresees_another_trial() {
    let ship = other_hull();
    let trials = [zigzag(&ship, 20.0, 20.0, 150.0, 1.0), zigzag(&ship, 10.0, 10.0, 150.0, 1.0)];
    let estimate = fitted(&trials, &HullForm::Quadratic);
    assert!(estimate.records.iter().all(|record| record.whole.to_degrees() < 0.3), "{:?}", estimate.records);
    let error = left_of(&estimate, &zigzag(&ship, 35.0, 20.0, 150.0, 1.0));
    assert!(error < 1.0, "{error}");
}

/// KVLCC2 is of no polynomial form, and of the MMG one with other wake and propeller than expected; a 20/20 alone foretells
/// her 10/10 within 2.5°, rms, of which she turns 25°.
#[test]
fn a_hull_of_another_form_is_foreseen_as_well() {
    let ship = Mmg::at_speed(MODEL_L7, SHIP.speed).expect("it balances");
    let trials = [zigzag(&ship, 20.0, 20.0, 200.0, 1.0)];
    let Particulars { length, speed } = SHIP;
    let dimensions =
        HullParticulars { length, speed, beam: Some(1.27), draught: Some(0.455), ..HullParticulars::default() };
    let mmg = HullForm::mmg(&priors(&dimensions).expect("a ship"));
    for form in [HullForm::Quadratic, HullForm::Cubic, mmg] {
        let error = left_of(&fitted(&trials, &form), &zigzag(&ship, 10.0, 10.0, 200.0, 1.0));
        assert!(error < 2.5, "{}: {error}", form.as_str());
    }
}

/// Port and starboard exchanged: what is odd in them changes its sign, all else stays.
#[test]
fn a_mirrored_record_has_the_mirrored_hull() {
    let ship = other_hull();
    let own = fitted(&[zigzag(&ship, 20.0, 20.0, 150.0, 1.0)], &HullForm::Quadratic);
    let mut mirrored = ship;
    if let ship::vessel::prime::PrimeHull::Quadratic(values) = &mut mirrored.hull {
        [7, 8].into_iter().for_each(|odd| values[odd] = -values[odd]);
    }
    let other = fitted(&[zigzag(&mirrored, 20.0, 20.0, 150.0, -1.0)], &HullForm::Quadratic);
    for (place, coefficient) in own.expected.iter().enumerate() {
        let sign = if matches!(coefficient.key, "b" | "delta_r") { -1.0 } else { 1.0 };
        let difference = (own.values[place] - sign * other.values[place]).abs() / coefficient.sd;
        assert!(difference < 1e-3, "{}: {difference}", coefficient.key);
    }
}

#[test]
fn records_that_tell_no_hull_are_refused() {
    let trial = zigzag(&other_hull(), 20.0, 20.0, 60.0, 1.0);
    let of = |trial: Trial| fit(&[trial], &HullForm::Cubic, &HullForm::Cubic.coefficients()).err();
    assert_eq!(of(record(&other_hull(), 20.0, 20.0, 60.0, 1.0)), Some(HullError::Particulars));
    let short = zigzag(&other_hull(), 20.0, 20.0, 4.0, 1.0);
    assert!(matches!(of(short), Some(HullError::Short { .. })));
    let at_half_speed = trial.with_particulars(Particulars { speed: 2.4, ..SHIP });
    assert!(matches!(of(at_half_speed), Some(HullError::GathersWay { .. })));
}
