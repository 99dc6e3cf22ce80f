//! Disturbances of wind and sea, as a specification. Moments are equivalent rudder angles (same yaw moment at approach
//! speed), rad; waves add to the observed heading. The random paths of one run are generated in `weather` and
//! `wave_path`, on grids that depend on this specification alone.
//!
//! Sources: Fossen (2011), Handbook of Marine Craft Hydrodynamics and Motion Control, for waves and Gauss–Markov
//! moments.
#![expect(non_snake_case, reason = "U is the symbol of the field for the speed of a ship")]

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::narrow_band::NarrowBandProcess;
use trial::degrees::Degrees;

use crate::error::{self, Check};

/// Wind and sea; a missing key means calm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Disturbances {
    /// Steady wind, whose moment depends on the heading.
    pub wind: Option<Wind>,
    /// Gusts as a yaw moment that does not depend on the heading.
    pub gusts: Option<GaussMarkov>,
    /// Linear trend of the moment from the beginning of the run, as rudder angle.
    #[serde(rename = "drift-deg-per-s", with = "Degrees::<f64>")]
    pub moment_drift: f64,
    /// Moment that is present for a part of the run only.
    pub squall: Option<Squall>,
    /// Random walk of the moment: its standard deviation after one second, as rudder angle.
    #[serde(rename = "random-walk-deg-per-root-s", with = "Degrees::<f64>")]
    pub moment_random_walk: f64,
    /// Narrow-band yaw from waves, added to the response in the observed heading.
    pub waves: Option<WaveSpectrum>,
}

/// Steady wind whose yaw moment depends on heading: w sin 2(ψ_w − ψ) (1 + g).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wind {
    /// Maximum moment, as rudder angle.
    #[serde(rename = "moment-deg", with = "Degrees::<f64>")]
    pub moment: f64,
    /// Direction the true wind comes from, clockwise from north.
    #[serde(rename = "from-deg", with = "Degrees::<f64>")]
    pub from_direction: f64,
    /// True wind speed; with it the record has wind channels.
    #[serde(rename = "speed-m-s")]
    pub speed: Option<f64>,
    /// Gusting of this moment.
    pub gusting: Option<Gusting>,
}

/// Gusting g of the wind moment; the wind speed varies with the square root of 1 + g.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gusting {
    /// Standard deviation, as a share of the moment.
    pub sd: f64,
    /// Correlation time.
    #[serde(rename = "correlation-s")]
    pub correlation_time: f64,
}

/// Stationary first-order Gauss–Markov process of an angle: g' = −g/τ + white noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GaussMarkov {
    /// Standard deviation.
    #[serde(rename = "sd-deg", with = "Degrees::<f64>")]
    pub sd: f64,
    /// Correlation time.
    #[serde(rename = "correlation-s")]
    pub correlation_time: f64,
}

/// Moment that is present for a part of the run only, with smooth (raised-cosine) edges.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Squall {
    /// Moment between the edges, as rudder angle.
    #[serde(rename = "moment-deg", with = "Degrees::<f64>")]
    pub moment: f64,
    /// Time of the beginning, from the start of the run.
    #[serde(rename = "start-s")]
    pub start: f64,
    /// Duration, edges included.
    #[serde(rename = "duration-s")]
    pub duration: f64,
    /// Duration of each smooth edge, at most half of the total duration.
    #[serde(rename = "edge-s")]
    pub edge: f64,
}

/// Narrow-band yaw from waves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveSpectrum {
    /// Standard deviation of the heading that waves add.
    #[serde(rename = "sd-deg", with = "Degrees::<f64>")]
    pub sd: f64,
    /// Frequency of encounter.
    #[serde(rename = "frequency-rad-s")]
    pub frequency: f64,
    /// Relative damping; a smaller value gives a narrower band.
    pub damping: f64,
}

impl WaveSpectrum {
    /// Narrow-band process of the heading.
    pub fn process(&self) -> NarrowBandProcess {
        NarrowBandProcess { sd: self.sd, frequency: self.frequency, damping: self.damping }
    }
}

impl Disturbances {
    /// `true` if a moment, or the gust factor of the wind, depends on time alone.
    pub(crate) fn are_time_dependent(&self) -> bool {
        let gusting = self.wind.is_some_and(|wind| wind.gusting.is_some());
        self.gusts.is_some()
            || self.squall.is_some()
            || self.moment_drift != 0.0
            || self.moment_random_walk != 0.0
            || gusting
    }

    /// Check of every value; fails with the first invalid value.
    pub fn check(&self) -> Check {
        if let Some(wind) = &self.wind {
            error::check_finite("disturbance.wind.moment-deg", wind.moment)?;
            error::check_finite("disturbance.wind.from-deg", wind.from_direction)?;
            if let Some(speed) = wind.speed {
                error::check_not_negative("disturbance.wind.speed-m-s", speed)?;
            }
            if let Some(gusting) = &wind.gusting {
                error::check_not_negative("disturbance.wind.gusting.sd", gusting.sd)?;
                error::check_positive_time("disturbance.wind.gusting.correlation-s", gusting.correlation_time)?;
            }
        }
        if let Some(gusts) = &self.gusts {
            error::check_not_negative("disturbance.gusts.sd-deg", gusts.sd)?;
            error::check_positive_time("disturbance.gusts.correlation-s", gusts.correlation_time)?;
        }
        error::check_finite("disturbance.drift-deg-per-s", self.moment_drift)?;
        if let Some(squall) = &self.squall {
            error::check_time("disturbance.squall.start-s", squall.start)?;
            error::check_positive_time("disturbance.squall.duration-s", squall.duration)?;
            error::check_between("disturbance.squall.edge-s", squall.edge, 0.0, 0.5 * squall.duration)?;
            error::check_finite("disturbance.squall.moment-deg", squall.moment)?;
        }
        error::check_not_negative("disturbance.random-walk-deg-per-root-s", self.moment_random_walk)?;
        if let Some(waves) = &self.waves {
            error::check_not_negative("disturbance.waves.sd-deg", waves.sd)?;
            error::check_positive("disturbance.waves.frequency-rad-s", waves.frequency)?;
            error::check_at_most("disturbance.waves.frequency-rad-s", waves.frequency, MAX_FREQUENCY_RAD_S)?;
            error::check_between("disturbance.waves.damping", waves.damping, 0.0, MAX_DAMPING)?;
        }
        Ok(())
    }
}

/// Maximum encounter frequency of waves, rad/s; even a model of 1 m length encounters lower frequencies.
const MAX_FREQUENCY_RAD_S: f64 = 100.0;

/// Maximum relative damping at which [`NarrowBandProcess`] oscillates; at 1 its damped frequency is zero.
const MAX_DAMPING: f64 = 0.999;

impl Squall {
    /// Moment at time `t`, rad: zero outside, raised cosine over the edges.
    pub fn moment(&self, t: f64) -> f64 {
        let inside = (t - self.start).min(self.start + self.duration - t);
        if inside <= 0.0 {
            0.0
        } else if inside < self.edge {
            0.5 * self.moment * (1.0 - (std::f64::consts::PI * inside / self.edge).cos())
        } else {
            self.moment
        }
    }
}

impl Wind {
    /// Yaw moment as equivalent rudder angle, rad, at heading `heading` (rad) and gust factor `gust` = 1 + g.
    #[inline]
    pub fn yaw_moment(&self, heading: f64, gust: f64) -> f64 {
        self.moment * gust * (2.0 * (self.from_direction - heading)).sin()
    }

    /// Relative wind speed (m/s) and direction it comes from (rad from the bow, −π to π), for a true wind of `speed`
    /// (m/s) and a ship with speed `U` (m/s) ahead on `heading` (rad); the drift angle is neglected.
    pub fn relative_wind(&self, speed: f64, U: f64, heading: f64) -> (f64, f64) {
        trial::relative_wind(speed, self.from_direction, U, heading)
    }
}

/// Wind speed, m/s, from its mean and the gust factor `gust` = 1 + g of the moment, which is proportional to the
/// squared speed.
pub(crate) fn gusting_speed(mean: f64, gust: f64) -> f64 {
    mean * gust.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn wind_from_ahead_adds_to_the_speed_and_from_abeam_does_not() {
        let wind = Wind { moment: 0.0, from_direction: 0.5, speed: Some(10.0), gusting: None };
        let (speed, from) = wind.relative_wind(10.0, 5.0, 0.5);
        assert_relative_eq!(speed, 15.0, max_relative = 1e-12);
        assert_relative_eq!(from, 0.0, epsilon = 1e-12);
        // Heading with the wind on the starboard beam.
        let (speed, from) = wind.relative_wind(10.0, 5.0, 0.5 - std::f64::consts::FRAC_PI_2);
        assert_relative_eq!(speed, 125.0_f64.sqrt(), max_relative = 1e-12);
        assert_relative_eq!(from, 2.0_f64.atan(), max_relative = 1e-12);
    }
}
