//! A scenario file as written and read by serde, with degrees, knots and units in the names. Values are unchecked;
//! [`crate::scenario::resolve`] turns them into specifications. The tables of a trial are declared in [`simulate`].

use serde::{Deserialize, Serialize};
use simulate::motion::PlanarCoefficients;
use simulate::{BeforeExecute, Disturbances, Helmsman, Manoeuvre, Recording, Sensors, SteeringGear};

use crate::scenario::draw::DrawWire;
use crate::scenario::effect::{self, EffectWire};
use crate::scenario::method::IdentifierWire;
use crate::scenario::number_table::NamedNumbers;
use crate::scenario::predictions::PredictWire;
use crate::scenario::prose::{Presentation, Published};
use crate::scenario::ship;
use crate::scenario::stop::StopRule;
use crate::scenario::sweep::AxisWire;

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
    #[serde(default = "one_replicate")]
    pub replicates: u64,
    /// When a cell has had enough trials.
    pub stop: Option<StopRule>,
    /// One key: the id of a ship of the registry, `first-order`, `second-order` or `hull`.
    #[schemars(schema_with = "ship::schema")]
    pub ship: NamedNumbers,
    /// What a first-order ship lacks; on response models alone.
    #[serde(default)]
    #[schemars(schema_with = "effect::schema")]
    pub effect: Vec<EffectWire>,
    /// Speed and sway of a response model, whose own equations have none; without dimension, by length and speed of
    /// the ship. A full ship has X_0 0.05, X_vr 1.3, X_dd 0.1, X_dv 0.1, Y_v 0.4, Y_vv 2, Y_r 0.5, Y_d 0.1.
    pub speed_and_sway: Option<PlanarCoefficients>,
    /// What the ship does.
    pub manoeuvre: Manoeuvre,
    /// Further records of the same ship, in the same weather and with the same instruments.
    #[serde(default)]
    pub also: Vec<FurtherWire>,
    /// How the rudder follows its order.
    #[serde(default)]
    pub steering_gear: SteeringGear,
    /// Who gives the orders.
    #[serde(default)]
    pub helmsman: Helmsman,
    /// Approach of the ship to the first execute.
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
    /// A second manoeuvre, which no method sees: answers are replayed on it.
    pub validation: Option<FurtherWire>,
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

fn one_replicate() -> u64 {
    1
}

/// Another manoeuvre of the same ship.
#[derive(Debug, Clone, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct FurtherWire {
    /// What the ship does.
    pub manoeuvre: Manoeuvre,
    /// That of the trial when left out; of a validation from the start of the run.
    pub recording: Option<Recording>,
}
