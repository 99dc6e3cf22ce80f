//! The JSON schema of a scenario, by which an editor completes and checks its keys. It comes from the types that read
//! the file, whose comments therefore hold no links; what it cannot say, such as which values go together, is said when
//! a scenario is resolved.

use schemars::Schema;
use schemars::generate::SchemaSettings;

use crate::scenario::records::RecordStudyWire;
use crate::scenario::wire::ScenarioWire;

/// A scenario of either kind.
#[derive(schemars::JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "it is described and never made")]
enum AnyScenario {
    Simulated(Box<ScenarioWire>),
    Measured(Box<RecordStudyWire>),
}

/// The schema of a scenario, in the draft that editors of TOML understand.
pub fn schema() -> Schema {
    let mut schema = SchemaSettings::draft07().into_generator().into_root_schema_for::<AnyScenario>();
    schema.insert("title".into(), "Scenario of a study".into());
    schema
}

/// The schema of a scenario of simulated ships.
pub(crate) fn of_simulated() -> Schema {
    SchemaSettings::draft07().into_generator().into_root_schema_for::<ScenarioWire>()
}
