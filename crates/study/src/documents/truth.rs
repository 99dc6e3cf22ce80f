//! `NAME.truth.json`: the true values of a simulated record, stored next to it.

use std::collections::BTreeMap;

use campaign::curves::degrees;
use campaign::engine::{self, TrueResponses};
use campaign::scenario::Scenario;
use campaign::shard::TrialId;
use schemars::JsonSchema;
use serde::Serialize;
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::SimulatedTrial;

/// True values of one record of a trial.
#[derive(Serialize, JsonSchema)]
pub struct TruthDocument {
    /// `truth/1`.
    #[schemars(extend("const" = "truth/1"))]
    pub schema: &'static str,
    /// Name of the scenario.
    pub scenario: String,
    /// Seed of the study.
    pub seed: u64,
    /// Labels of the cell.
    pub cell: String,
    /// Number of the trial in its cell, from 0.
    pub replicate: u64,
    /// First-order response nearest to the ship; the ship itself if it is of first order.
    pub nearest: Option<TrueIndices>,
    /// Base of a ship that has further effects.
    #[serde(rename = "own")]
    pub base: Option<TrueIndices>,
    /// Effects that a first-order base lacks.
    pub missing: Vec<String>,
    /// Sampled values in the units of their keys.
    pub drawn: BTreeMap<String, f64>,
    /// Times of the executes, s.
    pub executes_s: Vec<f64>,
    /// The motion without instrument errors.
    pub motion: TrueMotion,
}

/// K, T and δ_r of a ship.
#[derive(Serialize, JsonSchema)]
#[expect(non_snake_case, reason = "K and T are the symbols of the field")]
pub struct TrueIndices {
    /// K, 1/s.
    pub K_per_s: f64,
    /// T, s.
    pub T_s: f64,
    /// δ_r, deg.
    pub delta_r_deg: f64,
}

/// Motion of a ship.
#[derive(Serialize, JsonSchema)]
pub struct TrueMotion {
    /// Time, s.
    pub t_s: Vec<f64>,
    /// Heading, deg.
    pub heading_deg: Vec<f64>,
    /// Yaw rate, deg/s.
    pub yaw_rate_deg_s: Vec<f64>,
    /// Rudder angle, deg.
    pub rudder_deg: Vec<f64>,
    /// Speed, m/s, if the ship has one.
    pub speed_m_s: Option<Vec<f64>>,
}

impl TrueIndices {
    fn from_response(response: FirstOrder) -> Self {
        Self { K_per_s: response.K(), T_s: response.T(), delta_r_deg: to_deg(response.rudder_bias) }
    }
}

/// True values of one record of a trial.
///
/// Fails if the sampled values of the trial make no ship.
pub fn truth_document(
    scenario: &Scenario,
    task: TrialId,
    simulated: &SimulatedTrial,
    truths: TrueResponses,
) -> Result<TruthDocument, String> {
    let cell = &scenario.cells[task.cell];
    let trial_spec = cell.trial_spec(&engine::stream_key(scenario, task)).map_err(|refusal| refusal.to_string())?;
    let truth = &simulated.truth;
    Ok(TruthDocument {
        schema: "truth/1",
        scenario: scenario.name.clone(),
        seed: scenario.seed,
        cell: cell.title(),
        replicate: task.replicate,
        nearest: truths.nearest.map(TrueIndices::from_response),
        base: truths.base.map(TrueIndices::from_response),
        missing: trial_spec.specification.missing_effects.clone(),
        drawn: scenario.drawn_keys.iter().cloned().zip(trial_spec.drawn.iter().copied()).collect(),
        executes_s: truth.execute_orders.iter().map(|execute| execute.time).collect(),
        motion: TrueMotion {
            t_s: truth.time.clone(),
            heading_deg: degrees(&truth.heading),
            yaw_rate_deg_s: degrees(&truth.yaw_rate),
            rudder_deg: degrees(&truth.rudder),
            speed_m_s: truth.speed.clone(),
        },
    })
}
