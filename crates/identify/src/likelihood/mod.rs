//! Likelihood of a record of a first-order ship with a random yaw moment, rudder error and compass error.
//!
//! States are heading ψ, yaw rate r and their disturbances: ψ' = r, r' = −a r + b (δ + δ_r) + m + w, with a = 1/T and b
//! = K/T. The yaw moment (as acceleration) is absent, white (w of spectral density q²), an Ornstein–Uhlenbeck process
//! m' = −m/τ + white of density 2q²/τ, or a random walk m' = white of density q². The recorded rudder, linear between
//! its rows, may have an independent error in every row. The compass error is white, or of first order in time with a
//! separate correlation time; the rate-gyro error is white.
//!
//! All noise enters linearly, so gains and variances of the Kalman filter do not depend on the readings: the filter is
//! a linear map that whitens residual and sensitivities, and −2 log L = Σ log 2πS + Σ ν²/S with innovations ν and their
//! variances S. This module does not choose parameters.
//!
//! Sources: Åström and Källström (1976), Automatica 12, 9–22, for maximum likelihood on ship records; Van Loan (1978)
//! for exact discretisation; Harvey (1989) for the prediction error decomposition.

mod columns;
pub mod filter;
pub mod parameters;
pub mod schedule;
pub mod tangents;
#[cfg(test)]
mod tests;
pub mod track;
mod transition;

use ship::FirstOrder;
use trial::Trial;
use trial::noise_model::NoiseModel;

pub use filter::whitener;
pub use parameters::{NoiseParameters, NoiseVector};
pub use schedule::Schedule;
pub use track::{MotionColumns, TrialSignals};

/// Log-likelihood of the headings of a trial (and of the yaw rates, if `noise` has a rate-gyro error) for given ship
/// parameters and a given noise law.
///
/// The initial heading (rad) and yaw rate (rad/s) are normal about zero with the standard deviations `initial_sd`; a
/// walk begins at zero, an Ornstein–Uhlenbeck moment in its stationary state. The value is not finite if a response
/// overflows.
pub fn log_likelihood(trial: &Trial, ship: &FirstOrder, noise: &NoiseModel, initial_sd: [f64; 2]) -> f64 {
    let signals = TrialSignals::new(trial).with_rates(noise.yaw_rate_sd.and(trial.yaw_rate()), trial);
    let schedule = Schedule::new(&signals, noise.rudder_sd > 0.0);
    let parameters = NoiseVector::from_model(noise, ship).parameters(ship.inverse_T);
    let unit = noise.heading_sd;
    let filter = whitener(&schedule, &parameters, initial_sd.map(|sd| (sd / unit).powi(2)));
    // The columns start from rest at the first row, where the prior applies.
    let mut columns = MotionColumns::default();
    signals.fill_from(false, ship.inverse_T, &mut columns);
    let offset = ship.K_over_T * ship.rudder_bias;
    let motion = |forced: &[f64], constant_response: &[f64]| -> Vec<f64> {
        forced.iter().zip(constant_response).map(|(g, h)| ship.K_over_T * g + offset * h).collect()
    };
    let heading = motion(&columns.rudder, &columns.constant);
    let rate = motion(&columns.rates.rudder, &columns.rates.constant);
    let mut residual = schedule.stacked(&signals.heading, &signals.yaw_rates);
    let replayed = schedule.stacked(&heading, &rate);
    residual.iter_mut().zip(&replayed).for_each(|(measured, replayed)| *measured -= replayed);
    filter.apply(&mut [&mut residual]);
    let square: f64 = residual.iter().map(|nu| (nu / unit).powi(2)).sum();
    let constant = (2.0 * std::f64::consts::PI * unit * unit).ln();
    -0.5 * (square + filter.log_determinant + residual.len() as f64 * constant)
}
