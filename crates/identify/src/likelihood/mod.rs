//! The likelihood of a record of a first-order ship on which more than the compass is random.
//!
//! States are heading ψ, yaw rate r and what disturbs them: ψ' = r, r' = −a r + b (δ + δ_r) + m + w, with a = 1/T and
//! b = K/T. The yaw moment (as acceleration) is absent, white (w of spectral density q²), an Ornstein–Uhlenbeck process
//! m' = −m/τ + white of density 2q²/τ, or a random walk m' = white of density q². The recorded rudder, linear between
//! its rows, may carry an independent error in every row. The compass error is white, or of first order in time with a
//! correlation time of its own; the gyro error is white.
//!
//! Everything that is random enters linearly, so gains and variances of the Kalman filter do not depend on the
//! readings: the filter is a linear map that makes residual and sensitivities white, and −2 log L = Σ log 2πS + Σ ν²/S
//! with innovations ν and their variances S. Nothing here chooses parameters.
//!
//! Sources: Åström and Källström (1976), Automatica 12, 9–22, for maximum likelihood on ship records; Van Loan (1978)
//! for exact discretisation; Harvey (1989) for the prediction error decomposition.

mod filter;
mod law;
mod number;
mod schedule;
#[cfg(test)]
mod tests;
mod transition;

use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use trial::Trial;

pub(crate) use filter::{SIDE_BY_SIDE, Whitener, differentiated};
pub(crate) use law::{COMPASS, CORRELATION, GYRO, LEVEL, Law, Place, RUDDER};
pub(crate) use schedule::Schedule;

use crate::track::{Columns, Track};

/// The random yaw moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Moment {
    /// None.
    #[default]
    None,
    /// White: the yaw rate wanders.
    White,
    /// Ornstein–Uhlenbeck: gusts with a correlation time.
    OrnsteinUhlenbeck,
    /// Random walk: the moment itself wanders.
    Walk,
}

impl Moment {
    /// All of them, from the fewest parameters to the most.
    pub const ALL: [Self; 4] = [Self::None, Self::White, Self::Walk, Self::OrnsteinUhlenbeck];

    /// The word used in tables and JSON.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::White => "white",
            Self::OrnsteinUhlenbeck => "ornstein-uhlenbeck",
            Self::Walk => "walk",
        }
    }
}

/// All that is random in a record, in SI units and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// Standard deviation of the compass error, rad.
    pub heading_sd: f64,
    /// Correlation time of the compass error, s; `None` for white.
    pub heading_correlation: Option<f64>,
    /// Standard deviation of the white gyro error, rad/s; of use where a record has a yaw rate.
    pub yaw_rate_sd: Option<f64>,
    /// Which yaw moment.
    pub moment: Moment,
    /// Its size q as yaw acceleration: (rad/s²)√s for white, the stationary standard deviation in rad/s² for
    /// Ornstein–Uhlenbeck, (rad/s²)/√s for a walk.
    pub moment_level: f64,
    /// Correlation time τ of an Ornstein–Uhlenbeck moment, s.
    pub moment_correlation: f64,
    /// Standard deviation of the white error of the recorded rudder, rad; 0 for none.
    pub rudder_sd: f64,
}

impl Noise {
    /// A white compass error and nothing else.
    pub fn compass(heading_sd: f64) -> Self {
        Self {
            heading_sd,
            heading_correlation: None,
            yaw_rate_sd: None,
            moment: Moment::None,
            moment_level: 0.0,
            moment_correlation: f64::INFINITY,
            rudder_sd: 0.0,
        }
    }
}

/// Log-likelihood of the headings of a trial (and of its yaw rates, where `noise` has a gyro) for a known ship and known
/// noise.
///
/// The initial heading (rad) and yaw rate (rad/s) are normal about zero with the standard deviations `initial_sd`; a
/// walk begins at zero, an Ornstein–Uhlenbeck moment in its stationary state. The value is not finite when a response
/// leaves the range of numbers.
pub fn log_likelihood(trial: &Trial, ship: &FirstOrder, noise: &Noise, initial_sd: [f64; 2]) -> f64 {
    let track = Track::unchecked(trial).with_rates(noise.yaw_rate_sd.and(trial.yaw_rate()), trial);
    let schedule = Schedule::new(&track, noise.rudder_sd > 0.0);
    let law: Law<f64> = Place::of(noise, ship).law(ship.inverse_T, noise.yaw_rate_sd.is_some());
    let unit = noise.heading_sd;
    let filter = Whitener::new(&schedule, &law, initial_sd.map(|sd| (sd / unit).powi(2)));
    // The columns are from rest at the first row, where the prior stands.
    let mut columns = Columns::default();
    track.fill_from_first(ship.inverse_T, &mut columns);
    let offset = ship.K_over_T * ship.rudder_bias;
    let motion = |forced: &[f64], turned: &[f64]| -> Vec<f64> {
        forced.iter().zip(turned).map(|(g, h)| ship.K_over_T * g + offset * h).collect()
    };
    let heading = motion(&columns.rudder, &columns.constant);
    let rate = motion(&columns.rates.rudder, &columns.rates.constant);
    let mut residual = schedule.stacked(&track.heading, &track.rates);
    let replayed = schedule.stacked(&heading, &rate);
    residual.iter_mut().zip(&replayed).for_each(|(measured, replayed)| *measured -= replayed);
    filter.apply([&mut residual]);
    let square: f64 = residual.iter().map(|nu| (nu / unit).powi(2)).sum();
    let constant = (2.0 * std::f64::consts::PI * unit * unit).ln();
    -0.5 * (square + filter.log_variance() + residual.len() as f64 * constant)
}
