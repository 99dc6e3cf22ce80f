//! Likelihood under process noise, and the accuracy of the method that maximises it.

use identify::likelihood::log_likelihood;
use identify::{Identifier, maximum_likelihood, output_error};
use rayon::prelude::*;
use ship::FirstOrder;
use ship::angle::from_deg;
use ship::first_order::YawState;
use simulate::{Simulation, StreamKey};
use trial::noise_model::{MomentKind, NoiseModel};
use trial::{Channel, Columns, RecordOrigin, Trial};

use super::{BOUND, Check, DEFINITION, Section, Tolerance};
use crate::records::Case;

/// Record of the independent values: uneven rows, a clipped sine of the rudder, a sine of the heading.
fn uneven() -> Trial {
    let mut time = vec![0.0];
    for row in 1..60 {
        time.push(time[row - 1] + if row % 7 == 3 { 1.7 } else { 1.0 });
    }
    let wave = |t: f64| (std::f64::consts::TAU * t / 40.0).sin();
    let rudder = time.iter().map(|&t| from_deg(10.0) * (3.0 * wave(t)).clamp(-1.0, 1.0)).collect();
    let heading =
        time.iter().map(|&t| from_deg(8.0) * wave(t - 9.0) + from_deg(0.05) * (5.1 * t + 1.0).cos()).collect();
    let channels = [(Channel::Heading, heading), (Channel::Rudder, rudder)].into();
    let origin = RecordOrigin::Simulated { scenario: String::from("uneven"), cell: 0, replicate: 0 };
    Trial::new("uneven", origin, Columns { time, channels, unknown_columns: Vec::new() }).expect("a valid record")
}

/// Number of trials of one cell.
const TRIALS: u64 = 400;

/// Rms errors of K and T, %, of two methods, the bound, and the share of intervals of the first method that contain the
/// truth, %.
struct Sample {
    own: [f64; 2],
    other: [f64; 2],
    bound: [f64; 2],
    coverage: [f64; 2],
}

fn sample(simulation: &Simulation, truth: &FirstOrder, noise: &NoiseModel) -> Sample {
    let own = maximum_likelihood::Settings::default().build().expect("default settings are valid");
    let other = output_error::Settings::default().build().expect("default settings are valid");
    let rows: Vec<[[f64; 4]; 2]> = (0..TRIALS)
        .into_par_iter()
        .map(|replicate| {
            let run = simulation.run(&StreamKey { seed: 1976, cell: 0, replicate }).expect("a zig-zag");
            let trials = std::slice::from_ref(&run.trial);
            let found = own.identify(trials).expect("a zig-zag is identified");
            let plain = other.identify(trials).expect("a zig-zag is identified");
            let initial = YawState { heading: run.truth.heading[0], yaw_rate: run.truth.yaw_rate[0] };
            let bound = maximum_likelihood::cramer_rao(&run.trial, truth, initial, noise).expect("excited");
            let (k, t) = bound.indices(truth);
            let of = |found: trial::Quantity, plain: f64, bound: f64, truth: f64| {
                let holds = found.ci95.is_some_and(|[lower, upper]| (lower..=upper).contains(&truth));
                let error = |value: f64| (100.0 * (value / truth - 1.0)).powi(2);
                [error(found.value), error(plain), (100.0 * bound / truth).powi(2), f64::from(u8::from(holds))]
            };
            let sd = |quantity: trial::Quantity| quantity.sd.expect("a bound");
            [of(found.K(), plain.K().value, sd(k), truth.K()), of(found.T(), plain.T().value, sd(t), truth.T())]
        })
        .collect();
    let mean = |symbol: usize, column: usize| rows.iter().map(|row| row[symbol][column]).sum::<f64>() / TRIALS as f64;
    let rms = |column: usize| [0, 1].map(|symbol| mean(symbol, column).sqrt());
    Sample { own: rms(0), other: rms(1), bound: rms(2), coverage: [0, 1].map(|symbol| 100.0 * mean(symbol, 3)) }
}

/// Checks of the likelihood and of the errors.
pub fn section() -> Section {
    let mut checks = Vec::new();
    let trial = uneven();
    let ship = FirstOrder::from_indices(0.1, 16.3, from_deg(0.4));
    let compass = NoiseModel::compass(from_deg(0.1));
    let of = |moment, moment_level, moment_correlation_time| NoiseModel {
        moment,
        moment_level,
        moment_correlation_time,
        ..compass
    };
    let gusts = of(MomentKind::OrnsteinUhlenbeck, 3.490658504e-4, 12.0);
    for (noise, published, decimals) in [
        (compass, -84_499.009_4, 4),
        (of(MomentKind::White, 3.490658504e-4, 0.0), -1290.435376891, 6),
        (gusts, -45.967541814, 7),
        (of(MomentKind::Walk, 8.726646260e-5, f64::INFINITY), -365.883210199, 6),
    ] {
        let kind = noise.moment;
        checks.push(Check::new(
            format!("likelihood/{kind}"),
            format!("log-likelihood, moment {kind}"),
            (published, decimals),
            log_likelihood(&trial, &ship, &noise, [from_deg(5.0), from_deg(1.0)]),
            Tolerance::Relative(1e-9),
            "",
        ));
    }
    let case = Case { noise_deg: 0.1, ..Case::default() };
    let truth = case.ship;
    for (name, walk_deg, rudder_deg) in [("walk of 0.1 deg/√s", 0.1, 0.0), ("rudder noise of 0.1 deg", 0.0, 0.1)] {
        let mut simulation = case.simulation();
        simulation.disturbances.moment_random_walk = from_deg(walk_deg);
        simulation.sensors.rudder_noise = from_deg(rudder_deg);
        let moment_level = truth.K_over_T * from_deg(walk_deg);
        let moment = if walk_deg > 0.0 { MomentKind::Walk } else { MomentKind::None };
        let noise = NoiseModel { moment, moment_level, rudder_sd: from_deg(rudder_deg), ..compass };
        let sample = sample(&simulation, &truth, &noise);
        for (i, symbol) in ["K", "T"].into_iter().enumerate() {
            let mut push = |kind: &str, what: String, source, published, ours, tolerance| {
                let id = format!("likelihood/{name}/{kind} {symbol}");
                checks.push(Check::new(id, what, (published, 3), ours, tolerance, "%").from(source));
            };
            let (own, bound) = (sample.own[i], sample.bound[i]);
            let what = format!("{name}: rms error of {symbol} and its bound");
            push("rms", what, BOUND, bound, own, Tolerance::Relative(0.15));
            let what = format!("{name}: quoted 95 % intervals of {symbol} that hold the truth");
            push("coverage", what, DEFINITION, 95.0, sample.coverage[i], Tolerance::Absolute(4.0));
            if walk_deg > 0.0 {
                let what = format!("{name}: rms error of {symbol} of output error, at least 1/0.65 of it");
                push("gain", what, DEFINITION, own / 0.65, sample.other[i], Tolerance::AtLeast);
            }
        }
    }
    Section {
        title: "Likelihood with process noise",
        method: "First lines: log-likelihood of a made-up record of 60 uneven rows under a white compass error of 0.1 deg and a random yaw \
            moment (K = 0.1 1/s, T = 16.3 s, bias 0.4 deg), computed twice by other programs, with a Kalman filter and from the dense \
            Gaussian. Then a 10/10 of the same ship, 271 headings at 1 s, 400 trials a line: `maximum-likelihood` beside the bound \
            under that noise (the rms of a sample of 400 is uncertain by 3.5 %, a share of intervals by 1.1 %) and beside output \
            error on the same trials.",
        checks,
    }
}
