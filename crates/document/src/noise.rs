//! Heading noise of a record.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kind of a random yaw moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MomentKind {
    /// No random moment.
    #[default]
    None,
    /// White noise: the yaw rate is a random walk.
    White,
    /// Ornstein–Uhlenbeck process: gusts with a correlation time.
    OrnsteinUhlenbeck,
    /// Random walk of the moment.
    Walk,
}

impl MomentKind {
    /// All kinds by number of parameters.
    pub const ALL: [Self; 4] = [Self::None, Self::White, Self::Walk, Self::OrnsteinUhlenbeck];
}

/// Random yaw moment, as the rudder angle with the same moment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum RandomMoment {
    /// No random moment.
    #[default]
    None,
    /// White noise.
    White {
        /// Root of the spectral density, rad √s: standard deviation of the mean over one second.
        rudder_rad_root_s: f64,
    },
    /// Random walk.
    Walk {
        /// Root of the variance per second, rad/√s: standard deviation of the change in one second.
        rudder_rad_per_root_s: f64,
    },
    /// Gusts with a correlation time.
    OrnsteinUhlenbeck {
        /// Standard deviation, rad.
        sd_rudder_rad: f64,
        /// Correlation time, s: the autocorrelation falls to 1/e.
        correlation_s: f64,
    },
}

/// Heading noise of a record.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeadingNoise {
    /// Standard deviation of a heading reading, rad.
    pub heading_sd_rad: f64,
    /// Random yaw moment.
    pub moment: RandomMoment,
}

impl RandomMoment {
    /// Kind of the moment.
    pub fn kind(self) -> MomentKind {
        match self {
            Self::None => MomentKind::None,
            Self::White { .. } => MomentKind::White,
            Self::Walk { .. } => MomentKind::Walk,
            Self::OrnsteinUhlenbeck { .. } => MomentKind::OrnsteinUhlenbeck,
        }
    }

    /// Size in the unit of its kind: rad √s if white, rad/√s for a random walk, rad for gusts; 0 without a moment.
    pub fn size(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::White { rudder_rad_root_s: size }
            | Self::Walk { rudder_rad_per_root_s: size }
            | Self::OrnsteinUhlenbeck { sd_rudder_rad: size, .. } => size,
        }
    }

    /// Moment with its size multiplied by `factor` and its correlation time by `second`.
    fn times(self, factor: f64, second: f64) -> Self {
        match self {
            Self::None => Self::None,
            Self::White { rudder_rad_root_s: size } => Self::White { rudder_rad_root_s: size * factor },
            Self::Walk { rudder_rad_per_root_s: size } => Self::Walk { rudder_rad_per_root_s: size * factor },
            Self::OrnsteinUhlenbeck { sd_rudder_rad: size, correlation_s } => {
                Self::OrnsteinUhlenbeck { sd_rudder_rad: size * factor, correlation_s: correlation_s * second }
            }
        }
    }

    /// `true` if there is no random moment.
    pub fn is_none(self) -> bool {
        self == Self::None
    }

    /// Moment on a ship whose times are multiplied by `second`: the equivalent rudder angle stays the same, so the size
    /// changes with the time in its unit.
    #[must_use]
    pub fn scaled(self, second: f64) -> Self {
        let factor = match self {
            Self::White { .. } => second.sqrt(),
            Self::Walk { .. } => second.sqrt().recip(),
            Self::None | Self::OrnsteinUhlenbeck { .. } => 1.0,
        };
        self.times(factor, second)
    }
}

impl HeadingNoise {
    /// Noise with the mean heading standard deviation and the mean moment size of records whose moments have one kind
    /// and one correlation time; `None` without records.
    pub fn mean(records: &[Self]) -> Option<Self> {
        let first = records.first()?;
        let mean = |value: fn(&Self) -> f64| records.iter().map(value).sum::<f64>() / records.len() as f64;
        let size = mean(|noise| noise.moment.size());
        let first_size = first.moment.size();
        let factor = if first_size > 0.0 { size / first_size } else { 1.0 };
        Some(Self { heading_sd_rad: mean(|noise| noise.heading_sd_rad), moment: first.moment.times(factor, 1.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GUSTS: RandomMoment = RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: 0.01, correlation_s: 20.0 };

    /// With times four times as long, the size of a white moment doubles, and that of a random walk halves.
    #[test]
    fn a_moment_scales_with_the_times_of_its_ship() {
        let white = RandomMoment::White { rudder_rad_root_s: 0.01 }.scaled(4.0);
        assert_eq!(white, RandomMoment::White { rudder_rad_root_s: 0.02 });
        let walk = RandomMoment::Walk { rudder_rad_per_root_s: 0.01 }.scaled(4.0);
        assert_eq!(walk, RandomMoment::Walk { rudder_rad_per_root_s: 0.005 });
        assert_eq!(GUSTS.scaled(4.0), RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: 0.01, correlation_s: 80.0 });
    }

    #[test]
    fn the_mean_of_records_keeps_the_kind() {
        let noise = |heading_sd_rad, moment| HeadingNoise { heading_sd_rad, moment };
        let larger = RandomMoment::OrnsteinUhlenbeck { sd_rudder_rad: 0.03, correlation_s: 20.0 };
        let mean = HeadingNoise::mean(&[noise(1.0, GUSTS), noise(3.0, larger)]).expect("two records");
        assert_eq!(mean.heading_sd_rad, 2.0);
        assert!((mean.moment.size() - 0.02).abs() < 1e-15 && mean.moment.kind() == MomentKind::OrnsteinUhlenbeck);
        assert_eq!(HeadingNoise::mean(&[noise(1.0, RandomMoment::None)]).expect("one").moment, RandomMoment::None);
        assert_eq!(HeadingNoise::mean(&[]), None);
    }

    #[test]
    fn a_moment_is_written_with_its_kind_and_unit() {
        let text = serde_json::to_string(&GUSTS).expect("plain data");
        assert_eq!(text, r#"{"kind":"ornstein-uhlenbeck","sd_rudder_rad":0.01,"correlation_s":20.0}"#);
        assert_eq!(serde_json::from_str::<RandomMoment>(&text).expect("the same"), GUSTS);
    }
}
