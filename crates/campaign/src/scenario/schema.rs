//! JSON schema of a scenario, for completion and checks in editors. It is generated from the types that read the file,
//! whose comments therefore contain no links. Constraints between values are checked on resolution.

use schemars::Schema;
use schemars::generate::SchemaSettings;

use crate::scenario::records::RecordScenarioWire;
use crate::scenario::wire::ScenarioWire;

/// Scenario of simulated ships or of measured records.
#[derive(schemars::JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "it is described and never made")]
enum AnyScenario {
    Simulated(Box<ScenarioWire>),
    Measured(Box<RecordScenarioWire>),
}

/// JSON schema of a scenario, in draft 7, which TOML editors support.
pub fn schema() -> Schema {
    let mut schema = SchemaSettings::draft07().into_generator().into_root_schema_for::<AnyScenario>();
    schema.insert("title".into(), "Scenario of a study".into());
    schema
}

/// JSON schema of a scenario of simulated ships.
pub(crate) fn simulated_schema() -> Schema {
    SchemaSettings::draft07().into_generator().into_root_schema_for::<ScenarioWire>()
}
