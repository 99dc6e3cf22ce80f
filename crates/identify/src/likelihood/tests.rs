use approx::assert_relative_eq;
use estimation::kalman::SensorReading;
use nalgebra::{DMatrix, DVector};
use ship::FirstOrder;
use ship::angle::from_deg;
use ship::first_order::{FirstOrderTransition, YawState};
use trial::Trial;
use trial::noise_model::MomentKind;

use super::parameters::NoiseVector;
use super::*;
use crate::testing::{record, record_with_gyro};

/// Record of the published values: uneven rows, a clipped sine of the rudder, a sine of the heading.
fn published() -> Trial {
    let mut time = Vec::new();
    let mut t = 0.0;
    for row in 0..60 {
        t += if row == 0 {
            0.0
        } else if row % 7 == 3 {
            1.7
        } else {
            1.0
        };
        time.push(t);
    }
    let wave = |t: f64| (std::f64::consts::TAU * t / 40.0).sin();
    let rudder = time.iter().map(|&t| from_deg(10.0) * (3.0 * wave(t)).clamp(-1.0, 1.0)).collect();
    let heading =
        time.iter().map(|&t| from_deg(8.0) * wave(t - 9.0) + from_deg(0.05) * (5.1 * t + 1.0).cos()).collect();
    record("published", time, heading, rudder)
}

const SIGMA_DEG: f64 = 0.1;

fn noise(moment: MomentKind, level: f64, correlation: f64) -> NoiseModel {
    NoiseModel {
        moment,
        moment_level: level,
        moment_correlation_time: correlation,
        ..NoiseModel::compass(from_deg(SIGMA_DEG))
    }
}

/// Record with heading, yaw rate and rudder in every row, for a dense Gaussian.
fn with_gyro() -> Trial {
    let trial = published();
    let rate: Vec<f64> = trial.time().iter().map(|t| 0.012 * (0.157 * (t - 9.0)).cos()).collect();
    // Some rows have no heading, some no yaw rate.
    let missing = |values: &[f64], every: usize| -> Vec<f64> {
        values.iter().enumerate().map(|(row, &x)| if row % every == every - 2 { f64::NAN } else { x }).collect()
    };
    let heading = missing(trial.heading(), 5);
    record_with_gyro(trial.time().to_vec(), heading, trial.rudder().to_vec(), missing(&rate, 4))
}

/// Log-likelihood without a filter: the covariance of all readings from responses to every noise source, with the
/// moment stepped finely, and the determinant and inverse of that matrix.
fn dense(trial: &Trial, ship: &FirstOrder, noise: &NoiseModel, initial_sd: [f64; 2]) -> f64 {
    const FINE: usize = 40;
    let (time, rudder) = (trial.time(), trial.rudder());
    let (a, b) = (ship.inverse_T, ship.K_over_T);
    let rows = time.len();
    // Response of all rows to an input of rows and an initial state.
    let respond = |input: &dyn Fn(usize) -> f64, initial: YawState| -> Vec<YawState> {
        let mut states = vec![initial];
        for row in 1..rows {
            let h = time[row] - time[row - 1];
            let (u0, slope) = (input(row - 1), (input(row) - input(row - 1)) / h);
            states.push(FirstOrderTransition::new(a, h).advance(states[row - 1], u0, slope));
        }
        states
    };
    let readings: Vec<(usize, bool)> = (0..rows)
        .flat_map(|row| {
            let rate = trial.yaw_rate().filter(|rate| noise.yaw_rate_sd.is_some() && rate[row].is_finite());
            let heading = trial.heading()[row].is_finite().then_some((row, true));
            [heading, rate.map(|_| (row, false))].into_iter().flatten()
        })
        .collect();
    let column = |states: &[YawState]| {
        DVector::from_iterator(
            readings.len(),
            readings.iter().map(|&(row, heading)| if heading { states[row].heading } else { states[row].yaw_rate }),
        )
    };
    let mut covariance = DMatrix::zeros(readings.len(), readings.len());
    let mut source = |states: &[YawState], sd: f64| {
        let column = column(states) * sd;
        covariance += &column * column.transpose();
    };
    source(&respond(&|_| 0.0, YawState { heading: 1.0, yaw_rate: 0.0 }), initial_sd[0]);
    source(&respond(&|_| 0.0, YawState { heading: 0.0, yaw_rate: 1.0 }), initial_sd[1]);
    if noise.rudder_sd > 0.0 {
        for row in 0..rows {
            source(&respond(&|other| b * f64::from(u8::from(other == row)), YawState::default()), noise.rudder_sd);
        }
    }
    // An impulse of the moment within every fine step, at its middle.
    for row in 1..rows {
        let step = (time[row] - time[row - 1]) / FINE as f64;
        for part in 0..FINE {
            let at = time[row - 1] + (part as f64 + 0.5) * step;
            let motion = |t: f64| {
                let s = t - at;
                let zero = YawState::default();
                match noise.moment {
                    MomentKind::None => zero,
                    _ if s < 0.0 => zero,
                    MomentKind::White => {
                        FirstOrderTransition::new(a, s).advance(YawState { heading: 0.0, yaw_rate: 1.0 }, 0.0, 0.0)
                    }
                    MomentKind::Walk => FirstOrderTransition::new(a, s).advance(zero, 1.0, 0.0),
                    MomentKind::OrnsteinUhlenbeck => decaying(a, noise.moment_correlation_time, s),
                }
            };
            let density = match noise.moment {
                MomentKind::OrnsteinUhlenbeck => 2.0 / noise.moment_correlation_time,
                _ => 1.0,
            };
            source(&time.iter().map(|&t| motion(t)).collect::<Vec<_>>(), noise.moment_level * (density * step).sqrt());
        }
    }
    if noise.moment == MomentKind::OrnsteinUhlenbeck {
        let states: Vec<YawState> =
            time.iter().map(|t| decaying(a, noise.moment_correlation_time, t - time[0])).collect();
        source(&states, noise.moment_level);
    }
    for (i, &(row, heading)) in readings.iter().enumerate() {
        for (j, &(other, other_heading)) in readings.iter().enumerate() {
            if heading && other_heading {
                let apart = (time[row] - time[other]).abs();
                let alike = match noise.heading_correlation_time {
                    Some(correlation) => (-apart / correlation).exp(),
                    None => f64::from(u8::from(i == j)),
                };
                covariance[(i, j)] += noise.heading_sd.powi(2) * alike;
            } else if i == j {
                covariance[(i, j)] += noise.yaw_rate_sd.expect("a gyro").powi(2);
            }
        }
    }
    let replay = column(&respond(&|row| b * (rudder[row] + ship.rudder_bias), YawState::default()));
    let measured = readings
        .iter()
        .map(|&(row, heading)| if heading { trial.heading()[row] } else { trial.yaw_rate().expect("a gyro")[row] });
    let residual = DVector::from_iterator(readings.len(), measured) - replay;
    let factor = covariance.cholesky().expect("positive definite");
    let determinant: f64 = factor.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum();
    let constant = readings.len() as f64 * std::f64::consts::TAU.ln();
    -0.5 * (residual.dot(&factor.solve(&residual)) + determinant + constant)
}

/// State s seconds after a unit moment begins to decay.
fn decaying(a: f64, correlation: f64, s: f64) -> YawState {
    let pieces = 400;
    let h = s / f64::from(pieces);
    let moment = |k: i32| (-f64::from(k) * h / correlation).exp();
    (0..pieces).fold(YawState::default(), |state, k| {
        FirstOrderTransition::new(a, h).advance(
            state,
            moment(k),
            if h > 0.0 { (moment(k + 1) - moment(k)) / h } else { 0.0 },
        )
    })
}

/// Every kind of noise, for a stable and a course-unstable ship, against the dense Gaussian.
#[test]
fn the_filter_is_the_dense_gaussian() {
    let (plain, gyro) = (published(), with_gyro());
    let coloured = |noise: NoiseModel| NoiseModel { heading_correlation_time: Some(3.0), ..noise };
    let steered = |noise: NoiseModel| NoiseModel { rudder_sd: from_deg(0.7), ..noise };
    let rated = |noise: NoiseModel| NoiseModel { yaw_rate_sd: Some(2e-3), ..noise };
    let white = noise(MomentKind::White, 3e-4, 1.0);
    let gusts = noise(MomentKind::OrnsteinUhlenbeck, 4e-4, 12.0);
    let walk = noise(MomentKind::Walk, 9e-5, 1.0);
    let none = NoiseModel::compass(from_deg(SIGMA_DEG));
    for (trial, noise) in [
        (&plain, white),
        (&plain, steered(none)),
        (&plain, coloured(walk)),
        (&gyro, rated(none)),
        (&gyro, rated(steered(gusts))),
        (&gyro, rated(coloured(steered(walk)))),
    ] {
        for ship in [FirstOrder::from_indices(0.1, 16.3, 0.007), FirstOrder::from_indices(-0.05, -40.0, 0.007)] {
            let initial = [from_deg(5.0), from_deg(1.0)];
            let filtered = log_likelihood(trial, &ship, &noise, initial);
            let expected = dense(trial, &ship, &noise, initial);
            // The remaining error is the step of the dense computation.
            assert_relative_eq!(filtered, expected, max_relative = 2e-4);
        }
    }
}

/// A gain kept as stationary equals the computed gain.
#[test]
fn even_rows_settle() {
    let time: Vec<f64> = (0..400).map(f64::from).collect();
    let heading = time.iter().map(|t| 0.2 * (0.1 * t).sin()).collect();
    let rudder = time.iter().map(|t| 0.2 * (0.1 * t).cos()).collect();
    let trial = record("even", time, heading, rudder);
    let signals = TrialSignals::new(&trial);
    let schedule = Schedule::new(&signals, false);
    let log = [-3.0, 0.0, 0.0, 0.0, 0.0];
    let place = NoiseVector { moment: MomentKind::Walk, log_entries: log, ..NoiseVector::default() };
    let parameters = place.parameters(0.06);
    let filter = whitener(&schedule, &parameters, [0.0; 2]);
    assert_eq!(schedule.intervals.len(), 1);
    let mut settled = signals.heading.clone();
    filter.apply(&mut [&mut settled]);
    // Steps that count as different kinds are computed one by one.
    let mut apart = schedule.clone();
    for (k, reading) in apart.readings.iter_mut().enumerate().skip(1) {
        apart.intervals.push(schedule.intervals[0].clone());
        *reading = SensorReading::new(Some(k), reading.sensor());
    }
    let mut stepwise = signals.heading.clone();
    whitener(&apart, &parameters, [0.0; 2]).apply(&mut [&mut stepwise]);
    for (settled, stepwise) in settled.iter().zip(&stepwise) {
        assert_relative_eq!(settled, stepwise, max_relative = 1e-8, epsilon = 1e-12);
    }
}
