//! A definition as it is written: what serde reads. [`crate::benchmark::definition`] checks it.

use serde::{Deserialize, Serialize};
use ship::angle::to_deg;
use simulate::manoeuvre::{Manoeuvre, Side};
use toml::Spanned;

/// A name with its place in the file.
pub type Name = Spanned<String>;

/// A whole definition.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DefinitionWire {
    pub name: Name,
    #[serde(default)]
    pub about: String,
    pub reference: String,
    #[serde(default)]
    pub measured: Vec<MeasuredWire>,
    #[serde(default)]
    pub simulated: Vec<SimulatedWire>,
}

/// Records of one ship at one scale, measured.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MeasuredWire {
    pub name: Name,
    pub title: String,
    pub download: String,
    pub licence: String,
    pub cite: String,
    #[serde(default)]
    pub tasks: TasksWire,
    pub record: Vec<RecordWire>,
}

/// One measured record.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RecordWire {
    pub name: Name,
    pub manoeuvre: ManoeuvreSpecification,
    pub copies: Vec<CopyWire>,
}

/// One file that holds a record.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CopyWire {
    pub file: String,
    pub sha256: Name,
    pub sidecar: Option<Name>,
}

/// Trials of the cells of a scenario.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SimulatedWire {
    pub name: Name,
    pub title: String,
    pub scenario: Name,
    /// Names of the record of a trial and of its `[[also]]`.
    pub records: Vec<Name>,
    #[serde(default)]
    pub tasks: TasksWire,
}

/// What is asked of a set.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct TasksWire {
    pub identify: Vec<Name>,
    pub indices: Vec<Name>,
    pub name: Vec<Name>,
    pub other_side: Vec<PredictionWire>,
    pub other_amplitude: Vec<PredictionWire>,
    pub circle: Vec<PredictionWire>,
}

/// Which records are fitted together, and which are scored one by one; or, as `pairs`, records of which each is fitted
/// alone and all others are scored.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct PredictionWire {
    pub fit: Vec<Name>,
    pub score: Vec<Name>,
    pub pairs: Vec<Name>,
}

/// What the ship was asked to do on a record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", rename_all_fields = "kebab-case", deny_unknown_fields)]
pub enum ManoeuvreSpecification {
    /// Zig-zag.
    ZigZag {
        /// Rudder angle δ.
        rudder_deg: f64,
        /// Heading ψ at which the rudder is reversed.
        heading_deg: f64,
        /// Side of the first execute.
        first: Side,
    },
    /// Turning circle.
    TurningCircle {
        /// Rudder angle δ.
        rudder_deg: f64,
        /// Side of the turn.
        side: Side,
    },
}

impl ManoeuvreSpecification {
    /// What a simulated ship is asked to do; `None` for a manoeuvre that no task knows.
    pub fn of(manoeuvre: &Manoeuvre) -> Option<Self> {
        // A scenario is written in degrees, which come back from radians with an error in the last digit.
        let deg = |angle: f64| (1e6 * to_deg(angle)).round() / 1e6;
        match manoeuvre {
            Manoeuvre::ZigZag(own) => {
                Some(Self::ZigZag { rudder_deg: deg(own.rudder), heading_deg: deg(own.heading), first: own.first })
            }
            Manoeuvre::TurningCircle(own) => Some(Self::TurningCircle { rudder_deg: deg(own.rudder), side: own.side }),
            _ => None,
        }
    }

    /// In words: "zig-zag 20/10, starboard first".
    pub fn words(self) -> String {
        match self {
            Self::ZigZag { rudder_deg, heading_deg, first } => {
                format!("zig-zag {rudder_deg}/{heading_deg}, {} first", side(first))
            }
            Self::TurningCircle { rudder_deg, side: of } => format!("turning circle {rudder_deg}° to {}", side(of)),
        }
    }
}

fn side(side: Side) -> &'static str {
    match side {
        Side::Starboard => "starboard",
        Side::Port => "port",
    }
}
