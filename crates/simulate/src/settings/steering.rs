//! Who steers, what moves the rudder and how the ship comes to the first execute, as a person writes it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ship::Ship;
use ship::angle::{from_deg, to_deg};

use crate::error::shown;
use crate::gear::SteeringGear;
use crate::helm::{Helmsman, Watches};
use crate::settings::refusal::SettingError;
use crate::simulation::Approach;

/// What moves the rudder.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct GearSettings {
    /// Rudder rate; that of the ship where its source gives one, and else the rudder moves instantly.
    pub rate_deg_s: Option<f64>,
    /// Time constant of the approach to the order.
    pub lag_s: f64,
    /// Time from order to first movement.
    pub dead_time_s: f64,
    /// Error at which the pump stops, and below which it does not start.
    pub dead_band_deg: f64,
    /// Largest rudder angle to either side; that of the ship where its source gives one, and else 90°.
    pub maximum_deg: Option<f64>,
}

/// Who reads the compass and turns the wheel.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct HelmsmanSettings {
    /// Time between readings of the heading display; left out, he knows the true heading at every instant.
    pub reads_display_every_s: Option<f64>,
    /// Time from seeing the heading waited for to giving the order.
    pub reaction_time_s: f64,
}

/// How the ship comes to the first execute.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct ApproachSettings {
    /// Heading at the beginning of the run: the base course.
    pub heading_deg: f64,
    /// Yaw rate at the beginning of the run.
    pub yaw_rate_deg_s: f64,
    /// Rudder until the first execute.
    pub rudder_deg: f64,
    /// Straight run before the first execute.
    pub lead_in_s: f64,
}

/// No rudder is put further than across the ship, deg.
const LARGEST_RUDDER_DEG: f64 = 90.0;

impl GearSettings {
    /// The gear of a ship; a rate or limit that is left out is that of the ship, where its source gives one.
    ///
    /// Fails with the first value that makes no sense.
    pub fn build(&self, ship: &Ship) -> Result<SteeringGear, SettingError> {
        let gear = SteeringGear {
            rate: self.rate_deg_s.map(from_deg).or(ship.rudder_rate).unwrap_or(f64::INFINITY),
            lag: self.lag_s,
            dead_time: self.dead_time_s,
            dead_band: from_deg(self.dead_band_deg),
            maximum: self.maximum_deg.map(from_deg).or(ship.largest_rudder).unwrap_or(from_deg(LARGEST_RUDDER_DEG)),
        };
        gear.validate()?;
        Ok(gear)
    }

    /// The same with nothing left out: what `gear`, built from it, has.
    pub fn complete(&self, gear: &SteeringGear) -> Self {
        let in_degrees = |angle| shown(to_deg(angle)).0;
        Self {
            rate_deg_s: self.rate_deg_s.or(Some(in_degrees(gear.rate))),
            maximum_deg: self.maximum_deg.or(Some(in_degrees(gear.maximum))),
            ..self.clone()
        }
    }
}

impl HelmsmanSettings {
    /// The helmsman. Fails with the first value that makes no sense.
    pub fn build(&self) -> Result<Helmsman, SettingError> {
        let watches = self.reads_display_every_s.map_or(Watches::TrueHeading, |period| Watches::Display { period });
        let helmsman = Helmsman { watches, reaction_time: self.reaction_time_s };
        helmsman.validate()?;
        Ok(helmsman)
    }
}

impl ApproachSettings {
    /// The approach. Fails with the first value that makes no sense.
    pub fn build(&self) -> Result<Approach, SettingError> {
        let approach = Approach {
            heading: from_deg(self.heading_deg),
            yaw_rate: from_deg(self.yaw_rate_deg_s),
            rudder: from_deg(self.rudder_deg),
            lead_in: self.lead_in_s,
        };
        approach.validate()?;
        Ok(approach)
    }
}
