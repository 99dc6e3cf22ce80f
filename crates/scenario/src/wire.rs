//! A scenario file as it is written: what serde reads, with degrees, knots and units in the names. Nothing here is
//! believed yet; [`crate::resolve`] turns it into specifications the engine accepts.
#![expect(non_snake_case, reason = "K, T, T1, T2 and T3 are the symbols of the field")]

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::draw::DrawWire;
use crate::method::IdentifierWire;
use crate::stop::StopWire;
use crate::sweep::AxisWire;

/// A whole scenario file.
#[derive(Debug, Clone, Deserialize)]
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
    pub manoeuvre: ManoeuvreWire,
    #[serde(default)]
    pub steering_gear: GearWire,
    #[serde(default)]
    pub helmsman: HelmsmanWire,
    #[serde(default)]
    pub approach: ApproachWire,
    pub recording: RecordingWire,
    #[serde(default)]
    pub sensor: SensorWire,
    #[serde(default)]
    pub disturbance: DisturbanceWire,
    pub validation: Option<ValidationWire>,
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

/// A second manoeuvre, which no method sees.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ValidationWire {
    pub manoeuvre: ManoeuvreWire,
    /// That of the trial, from the start of the run, when left out.
    pub recording: Option<RecordingWire>,
}

/// K and T in SI, or without dimension: K' = K L/U, T' = T U/L.
#[derive(Debug, Clone, Deserialize)]
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

#[derive(Debug, Clone, Deserialize)]
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
#[derive(Debug, Clone, Copy, Deserialize)]
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
    WaveYaw(WavesWire),
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwayCouplingWire {
    #[serde(rename = "T2-s")]
    pub T2_s: f64,
    #[serde(rename = "T3-s")]
    pub T3_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
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

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SaturationWire {
    #[serde(rename = "c3-per-deg2")]
    pub c3_per_deg2: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AsymmetryWire {
    pub gain_share: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DriftWire {
    pub rudder_deg_per_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TransientWire {
    pub rudder_deg: f64,
    pub centre_s: f64,
    pub duration_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
pub enum DampingWire {
    #[serde(rename = "n3-s2-per-deg2")]
    Cubic(f64),
    #[serde(rename = "n2-s-per-deg")]
    Quadratic(f64),
    #[serde(rename = "n11-s-per-deg")]
    Square(f64),
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WindMomentWire {
    pub rudder_deg: f64,
    pub from_deg: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum LagWire {
    DeadTimeS(f64),
    FirstOrderS(f64),
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum DeadBandWire {
    BacklashDeg(f64),
    DeadBandDeg(f64),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ManoeuvreWire {
    ZigZag(ZigZagWire),
    TurningCircle(TurningCircleWire),
    PullOut(PullOutWire),
    Replay(ReplayWire),
}

#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SideWire {
    #[default]
    Starboard,
    Port,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ZigZagWire {
    pub rudder_deg: f64,
    pub heading_deg: f64,
    #[serde(default)]
    pub first: SideWire,
    pub executes: Option<usize>,
    pub duration_s: Option<f64>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct TurningCircleWire {
    pub rudder_deg: f64,
    #[serde(default)]
    pub side: SideWire,
    pub duration_s: Option<f64>,
    pub heading_change_deg: Option<f64>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct PullOutWire {
    pub rudder_deg: f64,
    #[serde(default)]
    pub side: SideWire,
    pub hold_s: f64,
    pub duration_s: f64,
}

/// The rudder of a recorded trial, followed as it is.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ReplayWire {
    /// Record, relative to the scenario file.
    pub file: String,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct GearWire {
    pub rate_deg_s: Option<f64>,
    pub lag_s: f64,
    pub dead_time_s: f64,
    pub dead_band_deg: f64,
    pub maximum_deg: Option<f64>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct HelmsmanWire {
    /// Time between readings of the display; the true heading at every instant when left out.
    pub reads_display_every_s: Option<f64>,
    pub reaction_time_s: f64,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct ApproachWire {
    pub heading_deg: f64,
    pub yaw_rate_deg_s: f64,
    /// Rudder until the first execute.
    pub rudder_deg: f64,
    /// Straight run before the first execute.
    pub lead_in_s: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RecordingWire {
    pub sampling_s: f64,
    pub duration_s: Option<f64>,
    /// Number of the execute after which the record starts; the beginning of the run when left out.
    pub after_execute: Option<usize>,
    pub offset_s: Option<f64>,
    #[serde(default)]
    pub rudder: RudderWire,
    /// Of a rudder column that is rebuilt from orders.
    pub assumed_rudder_rate_deg_s: Option<f64>,
}

/// What stands in the rudder column.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RudderWire {
    #[default]
    Feedback,
    Orders,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct SensorWire {
    pub heading_noise_deg: f64,
    pub heading_quantum_deg: f64,
    pub heading_lag_s: f64,
    pub heading_bias_deg: f64,
    /// Rate-of-turn indicator; none when all three are left out.
    pub yaw_rate_noise_deg_s: Option<f64>,
    pub yaw_rate_bias_deg_s: Option<f64>,
    pub yaw_rate_scale_error: Option<f64>,
    pub rudder_noise_deg: f64,
    pub rudder_quantum_deg: f64,
    pub jitter_s: f64,
    pub heading_delay_s: f64,
    pub drop_out: DropOutWire,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct DropOutWire {
    pub probability: f64,
    pub burst_probability: Option<f64>,
    pub burst_mean_rows: Option<f64>,
    pub whole_row: bool,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct DisturbanceWire {
    pub wind: Option<WindWire>,
    pub gusts: Option<GustWire>,
    pub drift_deg_per_s: f64,
    pub squall: Option<SquallWire>,
    pub random_walk_deg_per_root_s: f64,
    pub waves: Option<WavesWire>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WindWire {
    pub moment_deg: f64,
    pub from_deg: f64,
    pub speed_m_s: Option<f64>,
    pub gusting: Option<GustingWire>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GustingWire {
    pub sd: f64,
    pub correlation_s: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct GustWire {
    pub sd_deg: f64,
    pub correlation_s: f64,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SquallWire {
    pub moment_deg: f64,
    pub start_s: f64,
    pub duration_s: f64,
    pub edge_s: f64,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct WavesWire {
    pub sd_deg: f64,
    pub frequency_rad_s: f64,
    pub damping: f64,
}

/// Values of other authors, shown beside the results and never used.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct PublishedWire {
    #[serde(rename = "K-per-s")]
    pub K_per_s: Option<f64>,
    #[serde(rename = "T-s")]
    pub T_s: Option<f64>,
}

#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct OutputWire {
    /// Figures of the first replicate of every cell: trial, fit, derivatives, replays, intervals.
    pub showcase: bool,
    /// Stem of the figure that stands for the study on an overview.
    pub figure: Option<String>,
    /// Cells, by the labels of their points joined by commas, whose errors are shown one by one.
    pub detail: Vec<String>,
}
