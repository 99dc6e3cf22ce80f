//! A definition as it is written: what serde reads. [`crate::benchmark::definition`] checks it.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;
use trial::Manoeuvre;
use trial::manoeuvre::whole_deg;

/// A name with its place in the file.
pub type Name = Spanned<String>;

/// A whole definition.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DefinitionWire {
    /// What it is called.
    #[schemars(with = "String")]
    pub name: Name,
    /// What it says about itself.
    #[serde(default)]
    pub about: String,
    /// Label of the method that others are compared with.
    pub reference: String,
    /// Sets of measured records.
    #[serde(default)]
    pub measured: Vec<MeasuredWire>,
    /// Sets of simulated records.
    #[serde(default)]
    pub simulated: Vec<SimulatedWire>,
}

/// Records of one ship at one scale, measured.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MeasuredWire {
    /// What the set is called.
    #[schemars(with = "String")]
    pub name: Name,
    /// What it is, in a sentence.
    pub title: String,
    /// Where to download it.
    pub download: String,
    /// Its licence.
    pub licence: String,
    /// What to cite.
    pub cite: String,
    /// What is asked of it.
    #[serde(default)]
    pub tasks: TasksWire,
    /// Its records.
    pub record: Vec<RecordWire>,
}

/// One measured record.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RecordWire {
    /// What it is called.
    #[schemars(with = "String")]
    pub name: Name,
    /// What the ship was asked to do.
    pub manoeuvre: Manoeuvre,
    /// Files that hold it; one of them is enough.
    pub copies: Vec<CopyWire>,
}

/// One file that holds a record.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CopyWire {
    /// Its name.
    pub file: String,
    /// SHA-256 of its bytes.
    #[schemars(with = "String")]
    pub sha256: Name,
    /// The sidecar by which it is read.
    #[schemars(with = "Option<String>")]
    pub sidecar: Option<Name>,
}

/// Trials of the cells of a scenario.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct SimulatedWire {
    /// What the set is called.
    #[schemars(with = "String")]
    pub name: Name,
    /// What it is, in a sentence.
    pub title: String,
    /// The scenario.
    #[schemars(with = "String")]
    pub scenario: Name,
    /// Names of the record of a trial and of its `[[also]]`.
    #[schemars(with = "Vec<String>")]
    pub records: Vec<Name>,
    /// What is asked of it.
    #[serde(default)]
    pub tasks: TasksWire,
}

/// What is asked of a set.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct TasksWire {
    /// Records that are fitted and replayed, one by one.
    #[schemars(with = "Vec<String>")]
    pub identify: Vec<Name>,
    /// Records from which K and T are found, one by one.
    #[schemars(with = "Vec<String>")]
    pub indices: Vec<Name>,
    /// Records in which the missing effect is named, one by one.
    #[schemars(with = "Vec<String>")]
    pub name: Vec<Name>,
    /// Zig-zags that begin to the other side than those that are fitted.
    pub other_side: Vec<PredictionWire>,
    /// Zig-zags of another rudder or heading angle than those that are fitted.
    pub other_amplitude: Vec<PredictionWire>,
    /// Turning circles, where zig-zags are fitted.
    pub circle: Vec<PredictionWire>,
}

/// Which records are fitted together, and which are scored one by one; or, as `pairs`, records of which each is fitted
/// alone and all others are scored.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct PredictionWire {
    /// Records that are fitted together.
    #[schemars(with = "Vec<String>")]
    pub fit: Vec<Name>,
    /// Records that are scored one by one.
    #[schemars(with = "Vec<String>")]
    pub score: Vec<Name>,
    /// Records of which each is fitted alone and all others are scored.
    #[schemars(with = "Vec<String>")]
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
