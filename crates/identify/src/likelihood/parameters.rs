//! Noise parameters for an optimiser: logarithms, in units of the compass error, so that each may have any value and
//! the size of the compass error is eliminated.

use ship::FirstOrder;

use trial::noise_model::{MomentKind, NoiseModel};

/// Number of entries of a [`NoiseVector`].
pub const NOISE_ENTRIES: usize = 5;

/// Noise vector: logarithms of q/σ, τ, of the rudder error (as yaw acceleration over σ), of the correlation time of the
/// compass error and of σ_r/σ, with flags for the active entries. The default is a white compass error alone.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct NoiseVector {
    /// Kind of yaw moment.
    pub moment: MomentKind,
    /// `true` if the rudder has an error.
    pub has_rudder_error: bool,
    /// `true` if the compass error has a correlation time.
    pub has_coloured_compass: bool,
    /// Logarithms, in the order above; inactive entries are ignored.
    pub log_entries: [f64; NOISE_ENTRIES],
}

/// Index of log(q/σ) in a noise vector.
pub const LEVEL_INDEX: usize = 0;

/// Index of log τ.
pub const CORRELATION_INDEX: usize = 1;

/// Index of the logarithm of the rudder error.
pub const RUDDER_INDEX: usize = 2;

/// Index of the log correlation time of the compass error.
pub const COMPASS_INDEX: usize = 3;

/// Index of log(σ_r/σ).
pub const GYRO_INDEX: usize = 4;

impl NoiseVector {
    /// Noise vector of a noise law for a ship.
    pub fn from_model(noise: &NoiseModel, ship: &FirstOrder) -> Self {
        let unit = noise.heading_sd;
        let log = |value: f64| if value > 0.0 { value.min(f64::MAX).ln() } else { 0.0 };
        Self {
            moment: if noise.moment_level > 0.0 { noise.moment } else { MomentKind::None },
            has_rudder_error: noise.rudder_sd > 0.0,
            has_coloured_compass: noise.heading_correlation_time.is_some(),
            log_entries: [
                log(noise.moment_level / unit),
                log(noise.moment_correlation_time),
                log(ship.K_over_T.abs() * noise.rudder_sd / unit),
                log(noise.heading_correlation_time.unwrap_or(0.0)),
                log(noise.yaw_rate_sd.unwrap_or(0.0) / unit),
            ],
        }
    }

    /// Noise law of this vector, for a ship with this b = K/T (1/s²) and a compass error of `heading_sd`, rad; with
    /// `gyro` it includes the rate-gyro error.
    pub fn to_model(&self, K_over_T: f64, heading_sd: f64, gyro: bool) -> NoiseModel {
        let size = |entry: usize| heading_sd * self.log_entries[entry].exp();
        let has_moment = self.moment != MomentKind::None;
        NoiseModel {
            heading_sd,
            heading_correlation_time: self.has_coloured_compass.then(|| self.log_entries[COMPASS_INDEX].exp()),
            yaw_rate_sd: gyro.then(|| size(GYRO_INDEX)),
            moment: self.moment,
            moment_level: if has_moment { size(LEVEL_INDEX) } else { 0.0 },
            moment_correlation_time: match self.moment {
                MomentKind::OrnsteinUhlenbeck => self.log_entries[CORRELATION_INDEX].exp(),
                MomentKind::White => 0.0,
                MomentKind::None | MomentKind::Walk => f64::INFINITY,
            },
            rudder_sd: if self.has_rudder_error { size(RUDDER_INDEX) / K_over_T.abs() } else { 0.0 },
        }
    }

    /// Indices of the active entries; `gyro` is `true` if the readings include a yaw rate.
    pub fn active_entries(&self, gyro: bool) -> impl Iterator<Item = usize> + use<> {
        let active = [
            self.moment != MomentKind::None,
            self.moment == MomentKind::OrnsteinUhlenbeck,
            self.has_rudder_error,
            self.has_coloured_compass,
            gyro,
        ];
        (0..NOISE_ENTRIES).filter(move |&entry| active[entry])
    }

    /// Noise parameters for this 1/T.
    pub fn parameters(&self, inverse_T: f64) -> NoiseParameters {
        let size = |entry: usize| self.log_entries[entry].exp();
        NoiseParameters {
            inverse_T,
            moment: self.moment,
            moment_level: size(LEVEL_INDEX),
            moment_inverse_time: if self.moment == MomentKind::OrnsteinUhlenbeck {
                (-self.log_entries[CORRELATION_INDEX]).exp()
            } else {
                0.0
            },
            rudder_error_sd: self.has_rudder_error.then(|| size(RUDDER_INDEX)),
            compass_inverse_time: self.has_coloured_compass.then(|| (-self.log_entries[COMPASS_INDEX]).exp()),
            gyro_error_sd: size(GYRO_INDEX),
        }
    }
}

/// Noise parameters, in units of the compass error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseParameters {
    /// a = 1/T, 1/s.
    pub inverse_T: f64,
    /// Kind of yaw moment.
    pub moment: MomentKind,
    /// Level q/σ of the moment.
    pub moment_level: f64,
    /// Inverse correlation time 1/τ of an Ornstein–Uhlenbeck moment, 1/s; 0 for other moments.
    pub moment_inverse_time: f64,
    /// Standard deviation of the rudder error as yaw acceleration over σ, 1/s²; `None` without a rudder error.
    pub rudder_error_sd: Option<f64>,
    /// Inverse correlation time of the compass error, 1/s; `None` for a white error.
    pub compass_inverse_time: Option<f64>,
    /// Rate-gyro error σ_r/σ, 1/s.
    pub gyro_error_sd: f64,
}

impl NoiseParameters {
    /// `true` if the moment is a state.
    pub fn has_moment_state(&self) -> bool {
        matches!(self.moment, MomentKind::OrnsteinUhlenbeck | MomentKind::Walk)
    }

    /// Number of states: heading, yaw rate, moment, rudder error, compass error.
    pub fn states(&self) -> usize {
        2 + usize::from(self.has_moment_state())
            + usize::from(self.rudder_error_sd.is_some())
            + usize::from(self.compass_inverse_time.is_some())
    }

    /// Index of the rudder error among the states; `None` without a rudder error.
    pub fn rudder_state(&self) -> Option<usize> {
        self.rudder_error_sd.map(|_| 2 + usize::from(self.has_moment_state()))
    }

    /// Index of the compass error among the states: the last; `None` for a white error, which is no state.
    pub fn compass_state(&self) -> Option<usize> {
        self.compass_inverse_time.map(|_| self.states() - 1)
    }
}
