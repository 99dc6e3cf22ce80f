//! A scenario file as written and read by serde, with degrees, knots and units in the names. Values are unchecked;
//! [`crate::scenario::resolve`] turns them into specifications. The tables of a trial are declared in [`simulate`].

use serde::{Deserialize, Serialize};
use simulate::motion::PlanarCoefficients;
use simulate::{Approach, Disturbances, Helmsman, Manoeuvre, Recording, Sensors, SteeringGear};

use crate::scenario::draw::DrawWire;
use crate::scenario::effect::{self, EffectWire};
use crate::scenario::method::IdentifierWire;
use crate::scenario::number_table::NamedNumbers;
use crate::scenario::predictions::PredictWire;
use crate::scenario::prose::{Presentation, Published};
use crate::scenario::ship;
use crate::scenario::stop::StopRule;
use crate::scenario::sweep::AxisWire;

/// Scenario file of simulated ships.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ScenarioWire {
    /// Question of the study, in one sentence.
    pub question: String,
    /// Interpretation of the results, in paragraphs.
    #[serde(default)]
    pub analysis: String,
    /// Result in one sentence.
    #[serde(default)]
    pub finding: String,
    /// Seed of all random numbers; another seed gives other trials.
    pub seed: u64,
    /// Number of trials per cell.
    #[serde(default = "one_replicate")]
    pub replicates: u64,
    /// Condition that ends a cell before `replicates` trials.
    pub stop: Option<StopRule>,
    /// Exactly one key: the id of a ship (`study list ships`), `first-order`, `second-order` or `hull`.
    #[schemars(schema_with = "ship::schema")]
    pub ship: NamedNumbers,
    /// Effects missing from a first-order ship; for response models only.
    #[serde(default)]
    #[schemars(schema_with = "effect::schema")]
    pub effect: Vec<EffectWire>,
    /// Speed and sway of a response model, whose own equations contain none; nondimensional, by length and speed of
    /// the ship. A full ship has X_0 0.05, X_vr 1.3, X_dd 0.1, X_dv 0.1, Y_v 0.4, Y_vv 2, Y_r 0.5, Y_d 0.1.
    pub speed_and_sway: Option<PlanarCoefficients>,
    /// Manoeuvre of the ship.
    pub manoeuvre: Manoeuvre,
    /// Further records of the same ship, in the same weather and with the same instruments.
    #[serde(default)]
    pub also: Vec<FurtherWire>,
    /// Response of the rudder to its order.
    #[serde(default)]
    pub steering_gear: SteeringGear,
    /// Source of the orders.
    #[serde(default)]
    pub helmsman: Helmsman,
    /// Approach of the ship to the first execute.
    #[serde(default)]
    pub approach: Approach,
    /// Recorded channels and times of the logger.
    pub recording: Recording,
    /// Errors of the instruments.
    #[serde(default)]
    pub sensor: Sensors,
    /// Wind, waves and other moments.
    #[serde(default)]
    pub disturbance: Disturbances,
    /// Second manoeuvre outside all fits: estimates are replayed on it.
    pub validation: Option<FurtherWire>,
    /// Predictions required of every estimate.
    pub predict: Option<PredictWire>,
    /// Methods, all on the same trials.
    pub identifier: Vec<IdentifierWire>,
    /// Keys that are sampled anew for every trial.
    #[serde(default)]
    pub draw: Vec<DrawWire>,
    /// Axes of the design.
    #[serde(default)]
    pub sweep: Vec<AxisWire>,
    /// Published values of other authors, shown next to the results.
    #[serde(default)]
    pub published: Published,
    /// Selection of plots.
    #[serde(default)]
    pub output: Presentation,
}

fn one_replicate() -> u64 {
    1
}

/// Further manoeuvre of the same ship.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct FurtherWire {
    /// Manoeuvre of the ship.
    pub manoeuvre: Manoeuvre,
    /// Recording; that of the trial if omitted; of a validation from the start of the run.
    pub recording: Option<Recording>,
}
