//! Cramér–Rao bound of a record, and the efficiency of methods relative to it.

use identify::estimate::Covariance;
use identify::{Identifier, IdentifierSettings, integral_least_squares, maximum_likelihood, output_error};
use rayon::prelude::*;
use ship::FirstOrder;
use ship::angle::{from_deg, to_deg};
use ship::first_order::YawState;
use simulate::{Manoeuvre, SimulatedTrial, StreamKey};
use trial::noise_model::NoiseModel;

use super::{BOUND, Check, DEFINITION, Section, Tolerance};
use crate::records::{Begin, Case};

/// Rudder and heading (deg), bound on the sd of K and T (%) and of δ_r (deg), correlation of K and T, for 0.1 deg of
/// noise.
const TABLE: [(f64, f64, f64, f64, f64, f64); 6] = [
    (5., 5., 0.156, 0.241, 0.0010, 0.69),
    (10., 5., 0.113, 0.156, 0.0010, 0.75),
    (10., 10., 0.073, 0.113, 0.0010, 0.71),
    (10., 20., 0.042, 0.077, 0.0009, 0.55),
    (20., 10., 0.040, 0.063, 0.0010, 0.69),
    (20., 20., 0.029, 0.048, 0.0010, 0.61),
];

/// Cramér–Rao bound for one record: sd of K and T (%), of δ_r (deg) and the correlation of K and T.
struct Bound {
    k_percent: f64,
    t_percent: f64,
    bias_deg: f64,
    correlation: f64,
}

fn bound_of(simulated: &SimulatedTrial, ship: &FirstOrder, noise_deg: f64) -> Bound {
    let truth = &simulated.truth;
    let initial = YawState { heading: truth.heading[0], yaw_rate: truth.yaw_rate[0] };
    let noise = NoiseModel::compass(from_deg(noise_deg));
    let bound = maximum_likelihood::cramer_rao(&simulated.trial, ship, initial, &noise).expect("an excited record");
    let (k, t) = bound.indices(ship);
    let percent = |sd: Option<f64>, value: f64| 100.0 * sd.expect("a covariance gives a sd") / value;
    Bound {
        k_percent: percent(k.sd, k.value),
        t_percent: percent(t.sd, t.value),
        bias_deg: to_deg(bound.matrix[(2, 2)].sqrt()),
        correlation: correlation(&bound, ship),
    }
}

/// Correlation of K = b/a and T = 1/a.
fn correlation(covariance: &Covariance, ship: &FirstOrder) -> f64 {
    let (a, b, m) = (ship.inverse_T, ship.K_over_T, &covariance.matrix);
    let of_k = [-b / (a * a), 1.0 / a];
    let of_t = [-1.0 / (a * a), 0.0];
    let product = |x: [f64; 2], y: [f64; 2]| {
        (0..2).flat_map(|i| (0..2).map(move |j| (i, j))).map(|(i, j)| x[i] * m[(i, j)] * y[j]).sum::<f64>()
    };
    product(of_k, of_t) / (product(of_k, of_k) * product(of_t, of_t)).sqrt()
}

/// Checks of the bound.
pub fn bound() -> Section {
    let mut checks = Vec::new();
    let mut push = |name: &str, found: &Bound, published: [f64; 4], decimals: [usize; 4], slack: f64| {
        let ours = [found.k_percent, found.t_percent, found.bias_deg, found.correlation];
        for (i, (quantity, unit)) in
            [("sd of K", "%"), ("sd of T", "%"), ("sd of rudder bias", "deg"), ("correlation of K and T", "")]
                .into_iter()
                .enumerate()
        {
            let digit = 0.5 * 10f64.powi(-(decimals[i] as i32));
            let tolerance = Tolerance::Absolute(digit + slack * published[i].abs());
            let id = format!("bound/{name}/{quantity}");
            let numbers = (published[i], decimals[i]);
            checks.push(Check::new(id, format!("{name}: {quantity}"), numbers, ours[i], tolerance, unit));
        }
    };
    for (rudder_deg, heading_deg, k, t, bias, correlation) in TABLE {
        let case = Case { rudder_deg, heading_deg, ..Case::default() };
        let found = bound_of(&case.run(0), &case.ship, 0.1);
        push(&format!("{rudder_deg}/{heading_deg}"), &found, [k, t, bias, correlation], [3, 3, 4, 2], 0.01);
    }
    let case = Case::default();
    let mut turn = case.simulation();
    turn.manoeuvre = Manoeuvre::turning_circle(from_deg(10.0)).lasting(270.0);
    let turn = turn.run(&StreamKey::default()).expect("a first-order ship turns");
    push("turning circle with 10 deg", &bound_of(&turn, &case.ship, 0.1), [69.0, 0.56, 6.9, -0.47], [0, 2, 1, 2], 0.02);
    let case = Case { begin: Begin::Mid, ..Case::default() };
    let found = bound_of(&case.run(0), &case.ship, 1.0);
    for (symbol, published, ours) in [("K", 0.67, found.k_percent), ("T", 1.04, found.t_percent)] {
        let (id, what) = (format!("bound/mid/{symbol}"), format!("10/10 mid-trial, 1 deg of noise: sd of {symbol}"));
        let tolerance = Tolerance::Absolute(0.005 + 0.01 * published);
        checks.push(Check::new(id, what, (published, 2), ours, tolerance, "%"));
    }
    Section {
        title: "Cramér-Rao bound",
        method: "Smallest standard deviation any unbiased method can have: K = 0.1 1/s, T = 16.3 s, rudder at 2.5 deg/s, 271 headings at \
            1 s from rest with white noise of 0.1 deg (last lines: mid-trial, 1 deg); K, T, rudder bias and the initial state unknown. Tolerance half a unit of \
            the last digit and 1 % (the rudder of the independent program reverses on its steps; turning circle: 2 %, because K and \
            bias are nearly collinear). The random binary inputs of the independent table are left out: their sequences are not \
            published.",
        checks,
    }
}

/// Number of trials of one cell: with 5000 the standard error of a sample sd is 1.0 %, so that 5 % is five standard
/// errors; with 500 it would be 3.2 %.
const TRIALS: u64 = 5000;

/// Sample statistics of one method in one cell.
struct Sample {
    /// Standard deviation of K and T, %.
    sd_percent: [f64; 2],
    /// Share of the stated 95 % intervals of K and T that contain the truth, %.
    coverage_percent: [f64; 2],
}

fn sample(method: &dyn Identifier, case: &Case) -> Sample {
    let found: Vec<[(f64, bool); 2]> = (0..TRIALS)
        .into_par_iter()
        .map(|replicate| {
            let estimate = method.identify(&[case.trial(replicate)]).expect("a zig-zag is identified");
            [(estimate.K(), case.ship.K()), (estimate.T(), case.ship.T())].map(|(quantity, truth)| {
                let holds = quantity.ci95.is_some_and(|[lower, upper]| (lower..=upper).contains(&truth));
                (quantity.value / truth, holds)
            })
        })
        .collect();
    let count = TRIALS as f64;
    let of = |i: usize| {
        let mean = found.iter().map(|pair| pair[i].0).sum::<f64>() / count;
        let squares = found.iter().map(|pair| (pair[i].0 - mean).powi(2)).sum::<f64>();
        let covered = found.iter().filter(|pair| pair[i].1).count() as f64;
        (100.0 * (squares / (count - 1.0)).sqrt(), 100.0 * covered / count)
    };
    let (k, t) = (of(0), of(1));
    Sample { sd_percent: [k.0, t.0], coverage_percent: [k.1, t.1] }
}

/// Checks of efficiency and coverage.
pub fn efficiency() -> Section {
    let methods = [
        (IdentifierSettings::OutputError(output_error::Settings::default()), 0.05),
        (IdentifierSettings::IntegralLeastSquares(integral_least_squares::Settings::default()), 0.20),
    ];
    let mut checks = Vec::new();
    for (settings, most) in methods {
        let method = settings.build().expect("default settings are valid");
        for begin in [Begin::Rest, Begin::Mid] {
            for noise_deg in [0.1, 0.5] {
                let case = Case { begin, noise_deg, ..Case::default() };
                let bound = bound_of(&case.run(0), &case.ship, noise_deg);
                let sample = sample(method.as_ref(), &case);
                let from = if begin == Begin::Rest { "from rest" } else { "mid-trial" };
                let name = format!("{}, {from}, {noise_deg} deg", method.id());
                for (i, (symbol, bound)) in [("K", bound.k_percent), ("T", bound.t_percent)].into_iter().enumerate() {
                    let id = format!("efficiency/{name}/sd {symbol}");
                    let what = format!("{name}: sd of {symbol} and its bound");
                    let own = Check::new(id, what, (bound, 3), sample.sd_percent[i], Tolerance::Relative(most), "%");
                    checks.push(own.from(BOUND));
                    let id = format!("efficiency/{name}/coverage {symbol}");
                    let what = format!("{name}: quoted 95 % intervals of {symbol} that hold the truth");
                    let (ours, tolerance) = (sample.coverage_percent[i], Tolerance::Absolute(1.5));
                    checks.push(Check::new(id, what, (95.0, 0), ours, tolerance, "%").from(DEFINITION));
                }
            }
        }
    }
    Section {
        title: "Efficiency and coverage",
        method: "10/10 of K = 0.1 1/s, T = 16.3 s, 271 headings at 1 s, white noise, 5000 trials a line. The sd of a sample of 5000 is \
            itself uncertain by 1.0 %, the share of intervals by 0.3 %. Output error has to be within 5 % of the bound (five \
            standard errors), integral least squares within 20 % (an independent computation found about 15 %), the share of the \
            quoted 95 % intervals that hold the truth within 1.5 % (five standard errors).",
        checks,
    }
}
