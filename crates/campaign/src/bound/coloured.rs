//! Cramér–Rao bound for a compass with a white and a coloured error at once, which the likelihood of the methods does
//! not cover. The heading sensitivities are whitened by the innovations filter of the two errors (Kalman 1960).

use identify::likelihood::track::{MotionCoefficients, MotionColumns, TrialSignals, is_backward};
use nalgebra::{Matrix3, Matrix5};
use ship::FirstOrder;
use ship::first_order::YawState;
use simulate::disturbance::GaussMarkov;
use trial::Trial;

/// Compass error (rad): white noise of standard deviation `white`, and a stationary first-order Gauss–Markov process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CompassError {
    pub white: f64,
    pub coloured: GaussMarkov,
}

/// Cramér–Rao bound of 1/T (1/s), K/T (1/s²) and K δ_r/T (rad/s²) for one trial of known truth, with unknown initial
/// state: their block of (JᵀΣ⁻¹J)⁻¹, with the sensitivities J of the heading and the covariance Σ of its errors.
///
/// Σ_jk = σ² 1_{j=k} + σ_w² exp(−|t_j − t_k|/τ)
///
/// σ is the standard deviation of the white error; σ_w and τ are standard deviation and correlation time of the
/// coloured error.
///
/// `initial` is the true heading (rad) and yaw rate (rad/s) at the first observed row. `None` if the record does not
/// determine the parameters. Source: Cramér (1946), Rao (1945).
pub fn cramer_rao(trial: &Trial, truth: &FirstOrder, initial: YawState, error: &CompassError) -> Option<Matrix3<f64>> {
    let track = TrialSignals::new(trial);
    let a = truth.inverse_T;
    let mut coefficients = MotionCoefficients { anchor: initial, ..MotionCoefficients::from_response(truth) };
    if is_backward(a) {
        coefficients.anchor = track.last_state_from(a, &coefficients);
    }
    let (mut columns, mut by_inverse_time) = (MotionColumns::default(), Vec::new());
    track.fill_columns(a, &mut columns);
    track.sensitivity(a, &coefficients, &mut by_inverse_time);
    let MotionColumns { homogeneous, rudder, constant, .. } = columns;
    let mut sensitivities = [by_inverse_time, rudder, constant, vec![1.0; track.len()], homogeneous];
    let times: Vec<f64> = track.heading_rows.iter().map(|&row| track.time[row]).collect();
    whiten(&times, error, &mut sensitivities);
    let product = |i: usize, j: usize| sensitivities[i].iter().zip(&sensitivities[j]).map(|(x, y)| x * y).sum::<f64>();
    // Information in units in which every parameter alone would have a standard deviation of 1.
    let unit: [f64; 5] = std::array::from_fn(|k| product(k, k).sqrt());
    let information = Matrix5::from_fn(|i, j| product(i, j) / (unit[i] * unit[j]));
    let covariance = information.cholesky()?.inverse();
    Some(Matrix3::from_fn(|i, j| covariance[(i, j)] / (unit[i] * unit[j])))
}

/// Whitens columns at increasing `times` (s) by the filter that turns the errors into white noise of unit variance.
fn whiten(times: &[f64], error: &CompassError, columns: &mut [Vec<f64>; 5]) {
    let CompassError { white, coloured } = *error;
    let (white, stationary) = (white * white, coloured.sd * coloured.sd);
    // Conditional variance of the coloured error given the readings so far, and one estimate per column.
    let (mut variance, mut estimates) = (stationary, [0.0; 5]);
    for (row, &t) in times.iter().enumerate() {
        if row > 0 {
            let decay = (-(t - times[row - 1]) / coloured.correlation_time).exp();
            variance = stationary + decay * decay * (variance - stationary);
            estimates = estimates.map(|estimate| decay * estimate);
        }
        let total = variance + white;
        let gain = variance / total;
        for (column, estimate) in columns.iter_mut().zip(&mut estimates) {
            let innovation = column[row] - *estimate;
            *estimate += gain * innovation;
            column[row] = innovation / total.sqrt();
        }
        variance *= 1.0 - gain;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use identify::maximum_likelihood;
    use nalgebra::DMatrix;
    use ship::angle::from_deg;
    use simulate::{Manoeuvre, SimulatedShip, Simulation, SteeringGear, StreamKey};
    use trial::noise_model::NoiseModel;

    fn zig_zag(truth: FirstOrder) -> Trial {
        let angle = from_deg(10.0);
        let manoeuvre = Manoeuvre::zig_zag(angle, angle).lasting(200.0);
        let mut simulation = Simulation::new(SimulatedShip::from_first_order(truth), manoeuvre);
        simulation.gear = SteeringGear::with_rate(from_deg(2.5));
        simulation.sensors.drop_out.probability = 0.2;
        simulation.run(&StreamKey::default()).expect("a zig-zag").trial
    }

    /// Limits: negligible coloured error, nearly white coloured error, negligible white error.
    #[test]
    fn its_limits_are_the_bounds_of_white_and_of_coloured_noise() {
        let stable = FirstOrder::from_indices(0.1, 16.3, 0.0);
        for truth in [stable, FirstOrder { inverse_T: -0.01, ..stable }] {
            let trial = zig_zag(truth);
            let bound = |white_deg: f64, sd_deg: f64, correlation_time: f64| {
                let coloured = GaussMarkov { sd: from_deg(sd_deg), correlation_time };
                let error = CompassError { white: from_deg(white_deg), coloured };
                cramer_rao(&trial, &truth, YawState::default(), &error).expect("a zig-zag determines the ship")
            };
            let white = |sd_deg: f64| {
                let noise = NoiseModel::compass(from_deg(sd_deg));
                maximum_likelihood::cramer_rao(&trial, &truth, YawState::default(), &noise).expect("known").matrix
            };
            let noise = NoiseModel { heading_correlation_time: Some(10.0), ..NoiseModel::compass(from_deg(0.3)) };
            let coloured = maximum_likelihood::cramer_rao(&trial, &truth, YawState::default(), &noise).expect("known");
            let pairs = [
                (bound(0.1, 1e-6, 10.0), white(0.1)),
                (bound(0.3, 0.4, 1e-3), white(0.5)),
                (bound(1e-6, 0.3, 10.0), coloured.matrix),
                (bound(0.0, 0.3, 10.0), coloured.matrix),
            ];
            for (case, (bound, reference)) in pairs.into_iter().enumerate() {
                for (i, j) in [(0, 0), (0, 1), (1, 1)] {
                    let scale = (reference[(i, i)] * reference[(j, j)]).sqrt();
                    let apart = (bound[(i, j)] - reference[(i, j)]).abs() / scale;
                    assert!(apart < 1e-4, "case {case}, {i} {j}: {bound} {reference}");
                }
            }
        }
    }

    /// Products of whitened columns equal products with the inverse of the full covariance.
    #[test]
    fn white_columns_have_the_products_of_the_whole_covariance() {
        let times = [0.0, 1.0, 1.5, 4.0, 10.0, 11.0];
        let error = CompassError { white: 0.2, coloured: GaussMarkov { sd: 0.5, correlation_time: 3.0 } };
        let raw: [Vec<f64>; 5] =
            std::array::from_fn(|k| times.iter().map(|t| (0.7 * t + k as f64).sin()).collect::<Vec<f64>>());
        let covariance = DMatrix::from_fn(times.len(), times.len(), |i, j| {
            let white = if i == j { error.white.powi(2) } else { 0.0 };
            white + error.coloured.sd.powi(2) * (-(times[i] - times[j]).abs() / error.coloured.correlation_time).exp()
        });
        let inverse = covariance.try_inverse().expect("it is positive definite");
        let mut white = raw.clone();
        whiten(&times, &error, &mut white);
        for (i, left) in raw.iter().enumerate() {
            for (j, right) in raw.iter().enumerate() {
                let (row, column) = (DMatrix::from_row_slice(1, 6, left), DMatrix::from_column_slice(6, 1, right));
                let product: f64 = white[i].iter().zip(&white[j]).map(|(x, y)| x * y).sum();
                let expected = (row * &inverse * column)[(0, 0)];
                assert!((product - expected).abs() < 1e-10 * expected.abs().max(1.0), "{product} {expected}");
            }
        }
    }
}
