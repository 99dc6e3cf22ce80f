//! Kalman filter of a noise law on a schedule.

use estimation::kalman::whitener::Whitener;
use estimation::kalman::{KalmanFilter, LinearSystem, StateSensor};
use estimation::with_states;
use trial::noise_model::MomentKind;

use super::parameters::NoiseParameters;
use super::schedule::Schedule;
use super::transition::transition_step;

/// Whitening filter for columns of one record, in units of the compass error, with variances of the initial heading and
/// yaw rate in units of the compass variance.
pub fn whitener(schedule: &Schedule, parameters: &NoiseParameters, initial: [f64; 2]) -> Whitener {
    with_states!(parameters.states(), N => {
        KalmanFilter::<N>::new(system(schedule, parameters, initial)).into_whitener()
    })
}

fn system<const N: usize>(schedule: &Schedule, parameters: &NoiseParameters, initial: [f64; 2]) -> LinearSystem<N> {
    let compass = parameters.compass_state();
    let mut covariance = [[0.0; N]; N];
    for (place, variance) in initial.into_iter().enumerate() {
        covariance[place][place] = variance;
    }
    if parameters.moment == MomentKind::OrnsteinUhlenbeck {
        covariance[2][2] = parameters.moment_level * parameters.moment_level;
    }
    for place in [parameters.rudder_state(), compass].into_iter().flatten() {
        covariance[place][place] = 1.0;
    }
    // A correlated compass error is a separate state.
    let white = if compass.is_some() { 0.0 } else { 1.0 };
    // In the order of the sensors of `schedule`.
    let sensors = vec![
        StateSensor { state: 0, second_state: compass, variance: white },
        StateSensor { state: 1, second_state: None, variance: parameters.gyro_error_sd * parameters.gyro_error_sd },
    ];
    let steps = schedule.intervals.iter().map(|interval| transition_step(parameters, interval)).collect();
    LinearSystem { steps, sensors, readings: schedule.readings.clone(), initial_covariance: covariance }
}
