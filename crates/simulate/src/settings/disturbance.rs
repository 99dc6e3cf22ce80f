//! What the sea does to the ship, as a person writes it: moments as the rudder angle that has the same yaw moment.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::angle::from_deg;
use ship::narrow_band::NarrowBand;

use crate::disturbance::{Disturbances, GaussMarkov, Squall, Wind};
use crate::settings::refusal::SettingError;

/// Wind and sea; a calm in all that is left out.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct DisturbanceSettings {
    /// Steady wind, whose moment depends on the heading.
    pub wind: Option<WindSettings>,
    /// Gusts that act as a moment of their own, whatever the heading.
    pub gusts: Option<GustSettings>,
    /// Linear trend of the moment from the beginning of the run, as rudder angle.
    pub drift_deg_per_s: f64,
    /// A moment that is present for a part of the run only.
    pub squall: Option<SquallSettings>,
    /// Random walk of the moment: its standard deviation after one second, as rudder angle.
    pub random_walk_deg_per_root_s: f64,
    /// Narrow-band yaw from waves, seen on top of the response.
    pub waves: Option<WavesSettings>,
}

/// Steady wind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WindSettings {
    /// Largest moment, as rudder angle.
    pub moment_deg: f64,
    /// Direction the true wind comes from, clockwise from north.
    pub from_deg: f64,
    /// True wind speed; with it the record has wind channels.
    pub speed_m_s: Option<f64>,
    /// Gusting of this moment.
    pub gusting: Option<GustingSettings>,
}

/// Gusting of the moment of the wind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GustingSettings {
    /// Standard deviation, as a share of the moment.
    pub sd: f64,
    /// Correlation time.
    pub correlation_s: f64,
}

/// Gusts that act as a moment of their own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GustSettings {
    /// Standard deviation, as rudder angle.
    pub sd_deg: f64,
    /// Correlation time.
    pub correlation_s: f64,
}

/// A moment that is present for a part of the run only.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SquallSettings {
    /// Moment between the edges, as rudder angle.
    pub moment_deg: f64,
    /// Beginning, from the beginning of the run.
    pub start_s: f64,
    /// Length, edges included.
    pub duration_s: f64,
    /// Length of each smooth edge, at most half the length.
    pub edge_s: f64,
}

/// Narrow-band yaw from waves.
#[derive(Debug, Clone, PartialEq, Copy, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WavesSettings {
    /// Standard deviation of the heading they add.
    pub sd_deg: f64,
    /// Frequency of encounter.
    pub frequency_rad_s: f64,
    /// Relative damping: the smaller, the narrower the band.
    pub damping: f64,
}

impl DisturbanceSettings {
    /// The disturbances. Fails with the first value that makes no sense.
    pub fn build(&self) -> Result<Disturbances, SettingError> {
        let disturbances = Disturbances {
            wind: self.wind.as_ref().map(|wind| Wind {
                moment: from_deg(wind.moment_deg),
                from: from_deg(wind.from_deg),
                speed: wind.speed_m_s,
                gusting: wind.gusting.as_ref().map(|g| GaussMarkov { sd: g.sd, correlation_time: g.correlation_s }),
            }),
            gusts: self
                .gusts
                .as_ref()
                .map(|g| GaussMarkov { sd: from_deg(g.sd_deg), correlation_time: g.correlation_s }),
            drift: from_deg(self.drift_deg_per_s),
            squall: self.squall.as_ref().map(|squall| Squall {
                moment: from_deg(squall.moment_deg),
                start: squall.start_s,
                duration: squall.duration_s,
                edge: squall.edge_s,
            }),
            random_walk: from_deg(self.random_walk_deg_per_root_s),
            waves: self.waves.as_ref().map(|waves| NarrowBand {
                sd: from_deg(waves.sd_deg),
                frequency: waves.frequency_rad_s,
                damping: waves.damping,
            }),
        };
        disturbances.validate()?;
        Ok(disturbances)
    }
}
