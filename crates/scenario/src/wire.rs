//! A scenario file as it is written: what serde reads, with degrees, knots and units in the names. Nothing here is
//! believed yet; [`crate::resolve`] turns it into specifications the engine accepts. How a trial is made is declared in
//! [`simulate::settings`].
#![expect(non_snake_case, reason = "K, T, T1, T2 and T3 are the symbols of the field")]

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use simulate::settings::{
    ApproachSettings, DisturbanceSettings, GearSettings, HelmsmanSettings, ManoeuvreSettings, RecordingSettings,
    SensorSettings, WavesSettings,
};

use crate::draw::DrawWire;
use crate::method::IdentifierWire;
use crate::predictions::PredictWire;
use crate::stop::StopWire;
use crate::sweep::AxisWire;
use crate::words::AxisMark;

/// A whole scenario file.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ScenarioWire {
    pub question: String,
    #[serde(default)]
    pub analysis: String,
    /// The answer in one sentence.
    #[serde(default)]
    pub finding: String,
    pub seed: u64,
    #[serde(default = "one")]
    pub replicates: u64,
    pub stop: Option<StopWire>,
    /// One key: the id of a ship of the registry, `first-order` or `second-order`.
    pub ship: BTreeMap<String, toml::Table>,
    #[serde(default)]
    pub effect: Vec<EffectWire>,
    pub manoeuvre: ManoeuvreSettings,
    #[serde(default)]
    pub also: Vec<AlsoWire>,
    #[serde(default)]
    pub steering_gear: GearSettings,
    #[serde(default)]
    pub helmsman: HelmsmanSettings,
    #[serde(default)]
    pub approach: ApproachSettings,
    pub recording: RecordingSettings,
    #[serde(default)]
    pub sensor: SensorSettings,
    #[serde(default)]
    pub disturbance: DisturbanceSettings,
    pub validation: Option<ValidationWire>,
    pub predict: Option<PredictWire>,
    pub identifier: Vec<IdentifierWire>,
    #[serde(default)]
    pub draw: Vec<DrawWire>,
    #[serde(default)]
    pub sweep: Vec<AxisWire>,
    #[serde(default)]
    pub published: PublishedWire,
    #[serde(default)]
    pub output: OutputWire,
}

fn one() -> u64 {
    1
}

/// A further record of the same ship, in the same weather and with the same instruments.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AlsoWire {
    pub manoeuvre: ManoeuvreSettings,
    /// That of the trial when left out.
    pub recording: Option<RecordingSettings>,
}

/// A second manoeuvre, which no method sees.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ValidationWire {
    pub manoeuvre: ManoeuvreSettings,
    /// That of the trial, from the start of the run, when left out.
    pub recording: Option<RecordingSettings>,
}

/// K and T in SI, or without dimension: K' = K L/U, T' = T U/L.
#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct FirstOrderWire {
    #[serde(rename = "K-per-s")]
    pub K_per_s: Option<f64>,
    #[serde(rename = "T-s")]
    pub T_s: Option<f64>,
    #[serde(rename = "K-prime")]
    pub K_prime: Option<f64>,
    #[serde(rename = "T-prime")]
    pub T_prime: Option<f64>,
    #[serde(default)]
    pub rudder_bias_deg: f64,
    pub length_m: Option<f64>,
    pub speed_kn: Option<f64>,
}

#[derive(Debug, Clone, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SecondOrderWire {
    #[serde(rename = "K-per-s")]
    pub K_per_s: f64,
    #[serde(rename = "T1-s")]
    pub T1_s: f64,
    #[serde(rename = "T2-s")]
    pub T2_s: f64,
    #[serde(rename = "T3-s")]
    pub T3_s: f64,
    #[serde(default)]
    pub rudder_bias_deg: f64,
    pub length_m: Option<f64>,
    pub speed_kn: Option<f64>,
}

/// An effect added to a response ship: one key, the id of the effect.
#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EffectWire {
    SecondOrder(SwayCouplingWire),
    NonlinearDamping(DampingWire),
    WindMoment(WindMomentWire),
    SpeedLoss(SpeedLossWire),
    SteeringLag(LagWire),
    RudderSaturation(SaturationWire),
    RudderDeadband(DeadBandWire),
    PortStarboardAsymmetry(AsymmetryWire),
    MomentDrift(DriftWire),
    TransientDisturbance(TransientWire),
    WaveYaw(WavesSettings),
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SwayCouplingWire {
    #[serde(rename = "T2-s")]
    pub T2_s: f64,
    #[serde(rename = "T3-s")]
    pub T3_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SpeedLossWire {
    /// Rate of loss for a squared yaw rate of 1 deg²/s².
    pub loss_s_per_deg2: f64,
    pub recovery_s: f64,
    #[serde(default = "two")]
    pub gain_exponent: f64,
}

fn two() -> f64 {
    2.0
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct SaturationWire {
    #[serde(rename = "c3-per-deg2")]
    pub c3_per_deg2: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AsymmetryWire {
    pub gain_share: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DriftWire {
    pub rudder_deg_per_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TransientWire {
    pub rudder_deg: f64,
    pub centre_s: f64,
    pub duration_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
pub enum DampingWire {
    #[serde(rename = "n3-s2-per-deg2")]
    Cubic(f64),
    #[serde(rename = "n2-s-per-deg")]
    Quadratic(f64),
    #[serde(rename = "n11-s-per-deg")]
    Square(f64),
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WindMomentWire {
    pub rudder_deg: f64,
    pub from_deg: f64,
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LagWire {
    DeadTimeS(f64),
    FirstOrderS(f64),
}

#[derive(Debug, Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeadBandWire {
    BacklashDeg(f64),
    DeadBandDeg(f64),
}

/// Values of other authors, shown beside the results and never used.
#[derive(Debug, Clone, Copy, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct PublishedWire {
    #[serde(rename = "K-per-s")]
    pub K_per_s: Option<f64>,
    #[serde(rename = "T-s")]
    pub T_s: Option<f64>,
}

#[derive(Debug, Clone, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct OutputWire {
    /// Figures of the first replicate of every cell: trial, fit, derivatives, replays, intervals.
    pub showcase: bool,
    /// Stem of the figure that stands for the study on an overview.
    pub figure: Option<String>,
    /// Title of that figure: what it shows, in a sentence.
    pub title: Option<String>,
    /// Labels of the methods that figure is about; the others are grey.
    pub methods: Vec<String>,
    /// Stems of the figures that are made beside it; all there are when left out.
    pub figures: Option<Vec<String>>,
    /// Values of an axis with a name of their own.
    pub marks: Vec<AxisMark>,
    /// Cells, by the labels of their points joined by commas, whose errors are shown one by one.
    pub detail: Vec<String>,
}
