//! A scenario file as it is written: what serde reads, with degrees, knots and units in the names. Nothing here is
//! believed yet; [`crate::resolve`] turns it into specifications the engine accepts. How a trial is made is declared in
//! [`simulate`] itself.
#![expect(non_snake_case, reason = "K, T, T1, T2 and T3 are the symbols of the field")]

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use simulate::disturbance::WaveSpectrum;
use simulate::{BeforeExecute, Disturbances, Helmsman, Manoeuvre, Recording, Sensors, SteeringGear, numbers};

use crate::draw::DrawWire;
use crate::method::IdentifierWire;
use crate::predictions::PredictWire;
use crate::ship;
use crate::stop::StopWire;
use crate::sweep::AxisWire;
use crate::words::{Presentation, Published};

/// A whole scenario file.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ScenarioWire {
    /// What the study asks, in one sentence.
    pub question: String,
    /// How to read its results, in paragraphs.
    #[serde(default)]
    pub analysis: String,
    /// The answer in one sentence.
    #[serde(default)]
    pub finding: String,
    /// Key of every random draw.
    pub seed: u64,
    /// Trials per cell.
    #[serde(default = "one")]
    pub replicates: u64,
    /// When a cell has had enough trials.
    pub stop: Option<StopWire>,
    /// One key: the id of a ship of the registry, `first-order` or `second-order`.
    #[schemars(schema_with = "ship::schema")]
    pub ship: BTreeMap<String, toml::Table>,
    /// What a first-order ship lacks; on response models alone.
    #[serde(default)]
    pub effect: Vec<EffectWire>,
    /// What the ship does.
    pub manoeuvre: Manoeuvre,
    /// Further records of the same ship.
    #[serde(default)]
    pub also: Vec<AlsoWire>,
    /// How the rudder follows its order.
    #[serde(default)]
    pub steering_gear: SteeringGear,
    /// Who gives the orders.
    #[serde(default)]
    pub helmsman: Helmsman,
    /// How the ship comes to the first execute.
    #[serde(default)]
    pub approach: BeforeExecute,
    /// What the logger writes down, and when.
    pub recording: Recording,
    /// What the instruments add.
    #[serde(default)]
    pub sensor: Sensors,
    /// Wind, waves and other moments.
    #[serde(default)]
    pub disturbance: Disturbances,
    /// A second manoeuvre, on which answers are replayed.
    pub validation: Option<ValidationWire>,
    /// What every answer has to predict.
    pub predict: Option<PredictWire>,
    /// The methods, all on the same trials.
    pub identifier: Vec<IdentifierWire>,
    /// Keys that are drawn anew for every trial.
    #[serde(default)]
    pub draw: Vec<DrawWire>,
    /// Axes of the design.
    #[serde(default)]
    pub sweep: Vec<AxisWire>,
    /// Values of other authors, shown beside the results.
    #[serde(default)]
    pub published: Published,
    /// Which figures are made.
    #[serde(default)]
    pub output: Presentation,
}

fn one() -> u64 {
    1
}

/// A further record of the same ship, in the same weather and with the same instruments.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AlsoWire {
    /// What the ship does.
    pub manoeuvre: Manoeuvre,
    /// That of the trial when left out.
    pub recording: Option<Recording>,
}

/// A second manoeuvre, which no method sees.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ValidationWire {
    /// What the ship does.
    pub manoeuvre: Manoeuvre,
    /// That of the trial, from the start of the run, when left out.
    pub recording: Option<Recording>,
}

/// An effect added to a response ship: one key, the id of the effect.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EffectWire {
    /// Sway coupling: T1 T2 r'' + (T1 + T2) r' + r = K (δ + δ_r) + K T3 δ'.
    SecondOrder(SwayCouplingWire),
    /// Damping that grows with the yaw rate; one of these.
    NonlinearDamping(DampingWire),
    /// A yaw moment of steady wind, by the heading.
    WindMoment(WindMomentWire),
    /// Speed that falls in the turn: K ~ U, T ~ 1/U.
    SpeedLoss(SpeedLossWire),
    /// A rudder that acts later than the one recorded; one of these.
    SteeringLag(LagWire),
    /// Stall: the rudder acts as δ − c3 δ³.
    RudderSaturation(SaturationWire),
    /// Play between the recorded rudder and the one that acts; one of these.
    RudderDeadband(DeadBandWire),
    /// A ship that turns more readily to one side; one of these.
    PortStarboardAsymmetry(AsymmetryWire),
    /// A slow trend of the yaw moment.
    MomentDrift(DriftWire),
    /// A moment for a part of the record.
    TransientDisturbance(TransientWire),
    /// Narrow-band yaw from waves.
    WaveYaw(WaveSpectrum),
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SwayCouplingWire {
    /// Smaller time constant T2.
    #[serde(rename = "T2-s")]
    pub T2_s: f64,
    /// Time constant T3 of the rudder rate.
    #[serde(rename = "T3-s")]
    pub T3_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SpeedLossWire {
    /// Rate of loss for a squared yaw rate of 1 deg²/s².
    pub loss_s_per_deg2: f64,
    /// Time in which the speed comes back.
    pub recovery_s: f64,
    /// Power of the speed in the gain of the rudder.
    #[serde(default = "two")]
    pub gain_exponent: f64,
}

fn two() -> f64 {
    2.0
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SaturationWire {
    /// Coefficient c3.
    #[serde(rename = "c3-per-deg2")]
    pub c3_per_deg2: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AsymmetryWire {
    /// Share a of K (δ + a |δ|); above 0 the rudder acts more to starboard.
    GainShare(f64),
    /// Time c_r of K (δ + c_r |r|); above 0 the moment is to starboard in any turn.
    MomentByDriftS(f64),
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DriftWire {
    /// Change of the moment, as rudder angle.
    pub rudder_deg_per_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TransientWire {
    /// Largest moment, as rudder angle.
    pub rudder_deg: f64,
    /// Time of its middle.
    pub centre_s: f64,
    /// How long it lasts.
    pub duration_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
pub enum DampingWire {
    /// + n3 r³ on the left (Norrbin, Bech).
    #[serde(rename = "n3-s2-per-deg2")]
    Cubic(f64),
    /// + n2 r|r| on the left.
    #[serde(rename = "n2-s-per-deg")]
    Quadratic(f64),
    /// + n11 r² on the left.
    #[serde(rename = "n11-s-per-deg")]
    Square(f64),
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WindMomentWire {
    /// Largest moment, as rudder angle.
    pub rudder_deg: f64,
    /// Direction the wind comes from, clockwise from north.
    pub from_deg: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LagWire {
    /// Dead time.
    DeadTimeS(f64),
    /// Time constant of a first-order lag.
    FirstOrderS(f64),
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DeadBandWire {
    /// Width of a backlash.
    BacklashDeg(f64),
    /// Width of a dead band.
    DeadBandDeg(f64),
}

numbers! {
    ScenarioWire: "effect" effect, "manoeuvre" manoeuvre, "steering-gear" steering_gear, "helmsman" helmsman,
        "approach" approach, "recording" recording, "sensor" sensor, "disturbance" disturbance;
    EffectWire = SecondOrder NonlinearDamping WindMoment SpeedLoss SteeringLag RudderSaturation RudderDeadband
        PortStarboardAsymmetry MomentDrift TransientDisturbance WaveYaw;
    SwayCouplingWire as written: "T2-s" T2_s, "T3-s" T3_s;
    DampingWire = Cubic Quadratic Square;
    WindMomentWire as written: "rudder-deg" rudder_deg, "from-deg" from_deg;
    SpeedLossWire as written: "loss-s-per-deg2" loss_s_per_deg2, "recovery-s" recovery_s,
        "gain-exponent" gain_exponent;
    LagWire = DeadTimeS FirstOrderS;
    SaturationWire as written: "c3-per-deg2" c3_per_deg2;
    DeadBandWire = BacklashDeg DeadBandDeg;
    AsymmetryWire = GainShare MomentByDriftS;
    DriftWire as written: "rudder-deg-per-s" rudder_deg_per_s;
    TransientWire as written: "rudder-deg" rudder_deg, "centre-s" centre_s, "duration-s" duration_s;
}
