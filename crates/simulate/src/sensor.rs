//! Instruments, as a specification; the default has no errors. The measurement of a run is in `measure`, the display of
//! the helmsman in `display`.
//!
//! Order of errors in the heading channel: lag of the gyrocompass, waves, bias, coloured error, white noise,
//! quantisation; in the record alone, spikes, and rows without a heading. Clocks: row k carries the nominal stamp t_k;
//! the rudder is read at t_k + j_k with jitter j_k, and heading and other motion at t_k + j_k − `heading_delay`. Stamps
//! have no error: jitter of the stamp would differ only in the sign of j.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::angle::from_deg;
use trial::SensorNoise;
use trial::degrees::Degrees;

use crate::disturbance::GaussMarkov;
use crate::error::{self, Check, Requirement};
use crate::limits::{MAX_ROWS, MAX_TIME_S};

/// Instruments; a missing key means no error.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Sensors {
    /// Standard deviation of white heading noise.
    #[serde(rename = "heading-noise-deg", with = "Degrees::<f64>")]
    pub heading_noise: f64,
    /// Step of the heading display.
    #[serde(rename = "heading-quantum-deg", with = "Degrees::<f64>")]
    pub heading_quantum: f64,
    // τ ψ_g' + ψ_g = ψ.
    /// Follow-up lag of the gyrocompass.
    #[serde(rename = "heading-lag-s")]
    pub heading_lag: f64,
    /// Constant heading error.
    #[serde(rename = "heading-bias-deg", with = "Degrees::<f64>")]
    pub heading_bias: f64,
    /// Coloured compass error, in addition to the white noise; it is part of the display that the helmsman reads.
    pub heading_wander: Option<GaussMarkov>,
    /// Spikes in the recorded heading.
    pub heading_spikes: Option<Spikes>,
    // Rows are counted before drop-outs.
    /// Heading recorded in the first row and every n-th row after it only, rudder in all rows; 1 if left out.
    pub heading_every_rows: Option<usize>,
    /// Standard deviation of white yaw-rate noise; any yaw-rate key adds a rate-of-turn indicator.
    #[serde(rename = "yaw-rate-noise-deg-s", with = "Degrees::<Option<f64>>")]
    pub yaw_rate_noise: Option<f64>,
    /// Constant yaw-rate error.
    #[serde(rename = "yaw-rate-bias-deg-s", with = "Degrees::<Option<f64>>")]
    pub yaw_rate_bias: Option<f64>,
    /// Scale error of the yaw rate, as a share.
    pub yaw_rate_scale_error: Option<f64>,
    /// Standard deviation of white noise of the rudder feedback.
    #[serde(rename = "rudder-noise-deg", with = "Degrees::<f64>")]
    pub rudder_noise: f64,
    /// Step of the rudder feedback.
    #[serde(rename = "rudder-quantum-deg", with = "Degrees::<f64>")]
    pub rudder_quantum: f64,
    // Truncated at 0.45 periods, so that rows keep their order.
    /// Standard deviation of the sampling instants about their stamps.
    #[serde(rename = "jitter-s")]
    pub sampling_jitter: f64,
    // Yaw rate, speed and wind in a row have the same age; the age is negative if the rudder is late.
    /// Age of the heading relative to the rudder in the same row.
    #[serde(rename = "heading-delay-s")]
    pub heading_delay: f64,
    /// Drop-out of rows.
    pub drop_out: DropOut,
}

/// Spikes in the recorded heading: faults between compass and record, which the helmsman does not see.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spikes {
    /// Probability per row, independent of other rows.
    pub probability: f64,
    /// Size of a spike, to either side.
    #[serde(rename = "size-deg", with = "Degrees::<f64>")]
    pub size: f64,
}

/// Drop-out of rows, singly or in bursts: a two-state Markov chain.
///
/// Source: Gilbert (1960), Bell System Technical Journal 39:1253-1265.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct DropOut {
    /// Probability that a row is lost, independent of other rows.
    pub probability: f64,
    /// Probability per row that a burst of lost rows begins with the next row; with `burst-mean-rows`.
    pub burst_probability: Option<f64>,
    /// Mean length of a burst; with `burst-probability`.
    pub burst_mean_rows: Option<f64>,
    /// `true` if a drop-out removes the whole row, `false` if it removes only the heading.
    pub whole_row: bool,
}

/// Nearest multiple of `quantum`; the value itself if the quantum is zero.
pub(crate) fn quantise(value: f64, quantum: f64) -> f64 {
    if quantum > 0.0 { (value / quantum).round() * quantum } else { value }
}

/// Minimum lag of a gyrocompass, s; a shorter lag would only reduce the step of the solver.
const MIN_LAG_S: f64 = 0.01;

/// Maximum lag of a gyrocompass, s.
const MAX_LAG_S: f64 = 100.0;

/// Maximum spike, deg, which is the maximum difference of two headings.
const MAX_SPIKE_DEG: f64 = 180.0;

impl Sensors {
    /// `true` if there is a rate-of-turn indicator.
    pub fn has_rate_of_turn_indicator(&self) -> bool {
        [self.yaw_rate_noise, self.yaw_rate_bias, self.yaw_rate_scale_error].iter().any(Option::is_some)
    }

    /// Check of every value; fails with the first value that is invalid or requires another key.
    pub fn check(&self) -> Check {
        error::check_not_negative("sensor.heading-noise-deg", self.heading_noise)?;
        error::check_not_negative("sensor.heading-quantum-deg", self.heading_quantum)?;
        if self.heading_lag != 0.0 {
            error::check_between("sensor.heading-lag-s", self.heading_lag, MIN_LAG_S, MAX_LAG_S)?;
        }
        error::check_finite("sensor.heading-bias-deg", self.heading_bias)?;
        if let Some(wander) = &self.heading_wander {
            error::check_not_negative("sensor.heading-wander.sd-deg", wander.sd)?;
            error::check_positive_time("sensor.heading-wander.correlation-s", wander.correlation_time)?;
        }
        if let Some(spikes) = &self.heading_spikes {
            error::check_between("sensor.heading-spikes.probability", spikes.probability, 0.0, 1.0)?;
            error::check_positive("sensor.heading-spikes.size-deg", spikes.size)?;
            error::check_at_most("sensor.heading-spikes.size-deg", spikes.size, from_deg(MAX_SPIKE_DEG))?;
        }
        error::check_count("sensor.heading-every-rows", self.heading_every_rows.unwrap_or(1), MAX_ROWS)?;
        error::check_not_negative("sensor.yaw-rate-noise-deg-s", self.yaw_rate_noise.unwrap_or(0.0))?;
        error::check_finite("sensor.yaw-rate-bias-deg-s", self.yaw_rate_bias.unwrap_or(0.0))?;
        error::check_finite("sensor.yaw-rate-scale-error", self.yaw_rate_scale_error.unwrap_or(0.0))?;
        error::check_not_negative("sensor.rudder-noise-deg", self.rudder_noise)?;
        error::check_not_negative("sensor.rudder-quantum-deg", self.rudder_quantum)?;
        error::check_time("sensor.jitter-s", self.sampling_jitter)?;
        error::check_between("sensor.heading-delay-s", self.heading_delay, -MAX_TIME_S, MAX_TIME_S)?;
        self.drop_out.check()
    }

    /// Declared noise of every channel, rad or rad/s: the standard deviation of white noise and quantisation (q/√12)
    /// together; `None` if both are zero. Waves, lag, bias, coloured errors and spikes are not declared, because a
    /// standard deviation does not describe them.
    pub fn declared_noise(&self) -> SensorNoise {
        let total = |noise: f64, quantum: f64| {
            let sd = noise.hypot(quantum / 12.0_f64.sqrt());
            (sd > 0.0).then_some(sd)
        };
        SensorNoise {
            heading_sd: total(self.heading_noise, self.heading_quantum),
            yaw_rate_sd: self.yaw_rate_noise.and_then(|noise| total(noise, 0.0)),
            rudder_sd: total(self.rudder_noise, self.rudder_quantum),
        }
    }
}

impl DropOut {
    /// `true` if a row can be lost.
    pub fn can_lose_rows(&self) -> bool {
        self.probability > 0.0 || self.burst_probability.is_some()
    }

    fn check(&self) -> Check {
        error::check_between("sensor.drop-out.probability", self.probability, 0.0, 1.0)?;
        match (self.burst_probability, self.burst_mean_rows) {
            (Some(probability), Some(mean_rows)) => {
                error::check_between("sensor.drop-out.burst-probability", probability, 0.0, 1.0)?;
                error::check_between("sensor.drop-out.burst-mean-rows", mean_rows, 1.0, 1e9)
            }
            (None, None) => Ok(()),
            _ => error::refuse(
                "sensor.drop-out",
                Requirement::OtherKey([
                    "`sensor.drop-out` has only one of `burst-probability` and `burst-mean-rows`",
                    "the two belong together",
                    "give both, or leave both out",
                ]),
            ),
        }
    }
}
