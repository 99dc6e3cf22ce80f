//! Noise parameters of a record: compass, rate gyro, rudder and random yaw moment.

pub use document::MomentKind;

/// Noise parameters of a record, in SI units and radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseModel {
    /// Standard deviation of the compass error, rad.
    pub heading_sd: f64,
    /// Correlation time of the compass error, s; `None` for a white error.
    pub heading_correlation_time: Option<f64>,
    /// Standard deviation of the white rate-gyro error, rad/s; `None` if the yaw rate is not used.
    pub yaw_rate_sd: Option<f64>,
    /// Noise law of the random yaw moment.
    pub moment: MomentKind,
    /// Size q of the moment as yaw acceleration: (rad/s²)√s for white noise, the stationary standard deviation in
    /// rad/s² for an Ornstein–Uhlenbeck process, (rad/s²)/√s for a random walk.
    pub moment_level: f64,
    /// Correlation time τ of an Ornstein–Uhlenbeck moment, s; infinite for a random walk and without a moment, 0 for
    /// white noise.
    pub moment_correlation_time: f64,
    /// Standard deviation of the white error of the recorded rudder, rad; 0 for an exact rudder.
    pub rudder_sd: f64,
}

impl NoiseModel {
    /// White compass error without any other noise.
    pub fn compass(heading_sd: f64) -> Self {
        Self {
            heading_sd,
            heading_correlation_time: None,
            yaw_rate_sd: None,
            moment: MomentKind::None,
            moment_level: 0.0,
            moment_correlation_time: f64::INFINITY,
            rudder_sd: 0.0,
        }
    }
}
