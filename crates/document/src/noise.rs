//! Noise of the headings of a record, estimated or declared.

use serde::{Deserialize, Serialize};

/// Random yaw moment, as a rudder angle of the same moment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum RandomMoment {
    /// None.
    #[default]
    None,
    /// White noise.
    White {
        /// Square root of its spectral density, rad √s.
        rudder_rad_root_s: f64,
    },
    /// Random walk.
    Walk {
        /// Square root of its growth of variance, rad/√s.
        rudder_rad_per_root_s: f64,
    },
    /// Exponentially correlated gusts (Ornstein–Uhlenbeck).
    OrnsteinUhlenbeck {
        /// Standard deviation, rad.
        sd_rudder_rad: f64,
        /// Correlation time, s.
        correlation_s: f64,
    },
}

/// Exponentially correlated error of the compass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct HeadingWander {
    /// Standard deviation, rad.
    pub sd_rad: f64,
    /// Correlation time, s.
    pub correlation_s: f64,
}

/// Noise of the headings of a record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct HeadingNoise {
    /// Standard deviation of a reading, rad.
    pub heading_sd_rad: f64,
    /// Correlated error of the compass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wander: Option<HeadingWander>,
    /// Standard deviation of the white noise of a recorded rudder, rad.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rudder_sd_rad: Option<f64>,
    /// Random yaw moment.
    pub moment: RandomMoment,
}
