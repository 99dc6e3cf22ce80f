//! A definition as it is written: what serde reads. [`crate::benchmark::definition`] checks it.

use serde::Deserialize;
use toml::Spanned;
use trial::Manoeuvre;
use trial::manoeuvre::whole_deg;

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
    pub manoeuvre: Manoeuvre,
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

/// A manoeuvre in words: "zig-zag 20/10, starboard first".
pub fn words(manoeuvre: &Manoeuvre) -> String {
    let rudder = whole_deg(manoeuvre.rudder());
    match manoeuvre {
        Manoeuvre::ZigZag { heading, first, .. } => format!("zig-zag {rudder}/{}, {first} first", whole_deg(*heading)),
        Manoeuvre::TurningCircle { side, .. } => format!("turning circle {rudder}° to {side}"),
        other => other.to_string(),
    }
}
