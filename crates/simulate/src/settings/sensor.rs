//! Instruments, as a person writes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::angle::from_deg;

use crate::disturbance::GaussMarkov;
use crate::sensor::{Bursts, Clock, DropOut, HeadingSensor, Loses, RudderSensor, Sensors, Spikes, YawRateSensor};
use crate::settings::refusal::SettingError;

/// Instruments, perfect in all that is left out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct SensorSettings {
    /// Standard deviation of white heading noise.
    pub heading_noise_deg: f64,
    /// Step of the heading display.
    pub heading_quantum_deg: f64,
    /// Follow-up lag of the gyrocompass.
    pub heading_lag_s: f64,
    /// Constant heading error.
    pub heading_bias_deg: f64,
    /// Coloured compass error, on top of the white noise; a helmsman who reads the display sees it too.
    pub heading_wander: Option<HeadingWanderSettings>,
    /// Rows whose recorded heading is off by a spike.
    pub heading_spikes: Option<HeadingSpikesSettings>,
    /// The heading stands in the first row and in every n-th after it, the rudder in all; 1 when left out.
    pub heading_every_rows: Option<usize>,
    /// Standard deviation of white yaw-rate noise; any yaw-rate key adds a rate-of-turn indicator.
    pub yaw_rate_noise_deg_s: Option<f64>,
    /// Constant yaw-rate error.
    pub yaw_rate_bias_deg_s: Option<f64>,
    /// Scale error of the yaw rate, as a share.
    pub yaw_rate_scale_error: Option<f64>,
    /// Standard deviation of white noise of the rudder feedback.
    pub rudder_noise_deg: f64,
    /// Step of the rudder feedback.
    pub rudder_quantum_deg: f64,
    /// Standard deviation of the sampling instants about their stamps.
    pub jitter_s: f64,
    /// Age of the heading against the rudder in the same row.
    pub heading_delay_s: f64,
    /// Rows that are lost.
    pub drop_out: DropOutSettings,
}

/// Coloured compass error: first-order Gauss–Markov, stationary.
#[derive(Debug, Clone, PartialEq, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct HeadingWanderSettings {
    /// Standard deviation.
    pub sd_deg: f64,
    /// Correlation time.
    pub correlation_s: f64,
}

/// Rows whose recorded heading is off.
#[derive(Debug, Clone, PartialEq, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct HeadingSpikesSettings {
    /// Probability per row, independently of the others.
    pub probability: f64,
    /// Size of a spike, to either side.
    pub size_deg: f64,
}

/// Rows that are lost.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct DropOutSettings {
    /// Probability that a row is lost, independently of the others.
    pub probability: f64,
    /// Probability per row that a burst of lost rows begins with the next one; with `burst-mean-rows`.
    pub burst_probability: Option<f64>,
    /// Mean length of a burst; with `burst-probability`.
    pub burst_mean_rows: Option<f64>,
    /// Whether a lost row is lost whole, or only its heading.
    pub whole_row: bool,
}

impl SensorSettings {
    /// The instruments. Fails with the first value that makes no sense, or that lacks another.
    pub fn build(&self) -> Result<Sensors, SettingError> {
        let gyro = [self.yaw_rate_noise_deg_s, self.yaw_rate_bias_deg_s, self.yaw_rate_scale_error];
        let yaw_rate = gyro.iter().any(Option::is_some).then(|| YawRateSensor {
            noise: from_deg(gyro[0].unwrap_or(0.0)),
            bias: from_deg(gyro[1].unwrap_or(0.0)),
            scale_error: gyro[2].unwrap_or(0.0),
        });
        let sensors = Sensors {
            heading: HeadingSensor {
                noise: from_deg(self.heading_noise_deg),
                quantum: from_deg(self.heading_quantum_deg),
                lag: self.heading_lag_s,
                bias: from_deg(self.heading_bias_deg),
                wander: self
                    .heading_wander
                    .map(|wander| GaussMarkov { sd: from_deg(wander.sd_deg), correlation_time: wander.correlation_s }),
                spikes: self
                    .heading_spikes
                    .map(|spikes| Spikes { probability: spikes.probability, size: from_deg(spikes.size_deg) }),
                every_rows: self.heading_every_rows.unwrap_or(1),
            },
            yaw_rate,
            rudder: RudderSensor { noise: from_deg(self.rudder_noise_deg), quantum: from_deg(self.rudder_quantum_deg) },
            clock: Clock { jitter: self.jitter_s, heading_delay: self.heading_delay_s },
            drop_out: self.drop_out.build()?,
        };
        sensors.validate()?;
        Ok(sensors)
    }
}

impl DropOutSettings {
    fn build(&self) -> Result<DropOut, SettingError> {
        let bursts = match (self.burst_probability, self.burst_mean_rows) {
            (Some(probability), Some(mean_rows)) => Some(Bursts { probability, mean_rows }),
            (None, None) => None,
            _ => {
                return Err(SettingError::name(
                    "sensor.drop-out",
                    "`sensor.drop-out` has only one of `burst-probability` and `burst-mean-rows`",
                    "the two belong together",
                    "give both, or leave both out",
                ));
            }
        };
        let loses = if self.whole_row { Loses::Row } else { Loses::Heading };
        Ok(DropOut { probability: self.probability, bursts, loses })
    }
}
