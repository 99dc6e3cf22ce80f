//! Measured records, which are not part of the project: every test says in one line that it was skipped where they are
//! not.

mod boat;
mod characteristics;
mod manoeuvres;
mod reading;

use identify::{Identifier, output_error, registry};
use kempf_tests::measured;
use nalgebra::{DMatrix, DVector};
use ship::angle::to_deg;
use trial::Trial;

/// KVLCC2, HSVA 2006, 20/10 starboard first.
const TWENTY_TEN: &str = "kvlcc2_hsva/zigzag_20_10_s.csv";

const OTHERS: [&str; 8] = [
    "kvlcc2_marin/zigzag_10.csv",
    "kvlcc2_marin/zigzag_20.csv",
    "kvlcc2_marin/turning_35.csv",
    "esso_osaka/zigzag_13_04_24.csv",
    "esso_osaka/zigzag_13_14_21.csv",
    "esso_osaka/zigzag_13_42_53.csv",
    "esso_osaka/zigzag_13_57_45.csv",
    "esso_osaka/zigzag_14_10_05.csv",
];

fn output_error() -> output_error::OutputError {
    output_error::Settings::default().build().expect("default settings are valid")
}

/// Heading rms, deg, and 1/T, 1/s, that output error finds.
fn found(trial: &Trial) -> (f64, f64) {
    let estimate = output_error().identify(std::slice::from_ref(trial)).expect("the record is excited");
    let rms = estimate.diagnostic("heading_rmse_deg").expect("reported");
    (rms, estimate.response.inverse_T)
}

/// Headings of ψ'' + a ψ' = u from rest for an input that is linear between rows, a > 0; by the textbook integrals of
/// exp(−a t), which share nothing with the transition that identification uses.
fn response(time: &[f64], input: &[f64], a: f64) -> Vec<f64> {
    let (mut heading, mut rate) = (0.0, 0.0);
    let mut headings = vec![heading];
    for k in 1..time.len() {
        let h = time[k] - time[k - 1];
        let (u, slope) = (input[k - 1], (input[k] - input[k - 1]) / h);
        // r = A + B t + C exp(−a t) with a particular solution linear in time.
        let b = slope / a;
        let c = (u - b) / a;
        let free = rate - c;
        let decay = -(-a * h).exp_m1();
        heading += c * h + 0.5 * b * h * h + free * decay / a;
        rate = c + b * h + free * (1.0 - decay);
        headings.push(heading);
    }
    headings
}

/// Least heading rms, deg, of all first-order responses with this 1/T: linear least squares on the initial state, K/T
/// and K δ_r/T. A negative 1/T is a positive one in reversed time. `None` if the rudder would turn the ship the
/// wrong way.
fn least_rms_deg(trial: &Trial, inverse_time: f64) -> Option<f64> {
    let rows = trial.len();
    let take = |row: usize| if inverse_time < 0.0 { rows - 1 - row } else { row };
    let end = trial.time()[take(0)];
    let time: Vec<f64> = (0..rows).map(|row| (trial.time()[take(row)] - end).abs()).collect();
    let rudder: Vec<f64> = (0..rows).map(|row| trial.rudder()[take(row)]).collect();
    let a = inverse_time.abs();
    let columns = [
        vec![1.0; rows],
        time.iter().map(|t| -(-a * t).exp_m1()).collect(),
        response(&time, &rudder, a),
        response(&time, &vec![1.0; rows], a),
    ];
    let observed: Vec<usize> = (0..rows).filter(|&row| trial.heading()[take(row)].is_finite()).collect();
    let scales = columns.each_ref().map(|column| column.iter().fold(0.0_f64, |most, x| most.max(x.abs())));
    let matrix = DMatrix::from_fn(observed.len(), 4, |i, j| columns[j][observed[i]] / scales[j]);
    let heading = DVector::from_iterator(observed.len(), observed.iter().map(|&row| trial.heading()[take(row)]));
    let solution = matrix.clone().svd(true, true).solve(&heading, 1e-13).expect("both factors were computed");
    let rss = (heading - matrix * &solution).norm_squared();
    (solution[2] > 0.0).then(|| to_deg((rss / observed.len() as f64).sqrt()))
}

/// No first-order response of either stability is nearer to this record than 1.87 deg.
#[test]
fn output_error_finds_the_best_of_all_first_order_responses_to_a_tanker() {
    let Some(trial) = measured::record(TWENTY_TEN) else { return };
    let (rms, inverse_time) = found(&trial);
    assert!(rms <= 1.9, "{rms} deg");
    // T = 2 to 500 s and beyond, either sign, 1 % apart.
    let count = 700;
    let mut least = f64::INFINITY;
    for k in 0..=count {
        for sign in [1.0, -1.0] {
            let t = 1.5 * 1000f64.powf(f64::from(k) / f64::from(count));
            if let Some(here) = least_rms_deg(&trial, sign / t) {
                assert!(here >= rms * (1.0 - 1e-9), "T = {} s gives {here} deg, output error {rms} deg", sign * t);
                least = least.min(here);
            }
        }
    }
    // The search and the grid agree on the depth of the minimum, and exactly at the answer.
    assert!(least < rms * 1.0001, "the grid gets to {least} deg, output error to {rms} deg");
    let same = least_rms_deg(&trial, inverse_time).expect("the answer is a ship");
    assert!((same / rms - 1.0).abs() < 1e-9, "{same} deg and {rms} deg");
}

#[test]
fn every_other_record_gives_a_finite_ship() {
    for name in OTHERS {
        let Some(trial) = measured::record(name) else { return };
        let (rms, inverse_time) = found(&trial);
        assert!(rms.is_finite() && inverse_time.is_finite(), "{name}: {rms} deg, 1/T = {inverse_time}");
        let range = trial.heading().iter().filter(|psi| psi.is_finite()).fold(0.0_f64, |most, psi| most.max(psi.abs()));
        assert!(rms < 0.5 * to_deg(range), "{name}: {rms} deg");
    }
}

/// Real records are noisier and wilder than any simulation: each method gives a ship or says why not.
#[test]
fn every_method_survives_every_record() {
    for name in OTHERS.into_iter().chain([TWENTY_TEN]) {
        let Some(trial) = measured::record(name) else { return };
        for settings in registry::default_settings() {
            let method = settings.build().expect("default settings are valid");
            match method.identify(std::slice::from_ref(&trial)) {
                Ok(estimate) => {
                    let response = estimate.response;
                    let finite = response.inverse_T.is_finite() && response.rudder_bias.is_finite();
                    assert!(finite && response.K_over_T > 0.0, "{} on {name}: {response:?}", method.id());
                }
                Err(error) => assert!(!error.kind().is_empty(), "{} on {name}: {error}", method.id()),
            }
        }
    }
}

/// Effects of which none shows without the others, from a zig-zag and from its mirror image in the same tank. Sway is
/// Sway shows in a zig-zag and in its mirror image in the same tank.
#[test]
fn mirror_images_of_one_hull_tell_the_same_physics() {
    let trials = ["kvlcc2_marin/zigzag_20.csv", "kvlcc2_marin/zigzag_-20.csv"].map(measured::record);
    let [Some(starboard), Some(port)] = trials else { return };
    for (trial, ratio) in [(starboard, 0.5), (port, 0.5)] {
        let settings = trace::Settings { is_thorough: false, ..trace::Settings::default() };
        let analysis = trace::trace(std::slice::from_ref(&trial), &[], &settings).expect("a zig-zag has a base");
        let on = &analysis.identification[0];
        let [before, after] = [&on.base_replay, &on.average_replay].map(|on| on.errors.heading_rmse);
        assert!(after < ratio * before, "{}: {} of before", trial.name(), after / before);
        let named: Vec<&str> = analysis.document.effects.iter().map(|effect| effect.id.as_str()).collect();
        let sway = ["second_order", "sway_coupling_measured"];
        assert!(sway.iter().any(|id| named.contains(id)), "{}: {named:?}", trial.name());
    }
}
