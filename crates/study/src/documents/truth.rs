//! `NAME.truth.json`: what is true of a simulated record, beside it.

use std::collections::BTreeMap;

use campaign::engine::{self, Truths};
use campaign::task::Task;
use scenario::Scenario;
use serde::Serialize;
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::Simulated;

/// The truth of one simulated record.
#[derive(Debug, Serialize)]
pub struct TruthFile {
    schema: &'static str,
    scenario: String,
    seed: u64,
    cell: String,
    replicate: u64,
    /// K, T and δ_r of the first-order response nearest to the ship; of the ship itself where it is first order.
    nearest: Option<TrueIndices>,
    /// Those of the ship's own base, where it has effects beside it.
    own: Option<TrueIndices>,
    /// What a first-order base lacks in this record.
    missing: Vec<String>,
    /// Drawn values in the units of their keys.
    drawn: BTreeMap<String, f64>,
    /// Times of the orders.
    executes_s: Vec<f64>,
    motion: TrueMotion,
}

#[derive(Debug, Serialize)]
struct TrueIndices {
    #[serde(rename = "K_per_s")]
    k_per_s: f64,
    #[serde(rename = "T_s")]
    t_s: f64,
    delta_r_deg: f64,
}

/// The motion without the errors of any instrument.
#[derive(Debug, Serialize)]
struct TrueMotion {
    t_s: Vec<f64>,
    heading_deg: Vec<f64>,
    yaw_rate_deg_s: Vec<f64>,
    rudder_deg: Vec<f64>,
    speed_m_s: Option<Vec<f64>>,
}

impl From<FirstOrder> for TrueIndices {
    fn from(response: FirstOrder) -> Self {
        Self { k_per_s: response.K(), t_s: response.T(), delta_r_deg: to_deg(response.rudder_bias) }
    }
}

impl TruthFile {
    /// The truth of a trial of a scenario. Fails when its drawn values make no ship.
    pub fn of(scenario: &Scenario, task: Task, simulated: &Simulated, truths: Truths) -> Result<Self, String> {
        let cell = &scenario.cells[task.cell];
        let specimen = cell.specimen(&engine::key(scenario, task)).map_err(|refusal| refusal.to_string())?;
        let truth = &simulated.truth;
        let degrees = |angles: &[f64]| angles.iter().map(|&angle| to_deg(angle)).collect();
        Ok(Self {
            schema: "truth/1",
            scenario: scenario.name.clone(),
            seed: scenario.seed,
            cell: cell.title(),
            replicate: task.replicate,
            nearest: truths.nearest.map(TrueIndices::from),
            own: truths.own.map(TrueIndices::from),
            missing: specimen.specification.missing.clone(),
            drawn: scenario.draws.iter().cloned().zip(specimen.drawn.iter().copied()).collect(),
            executes_s: truth.executes.iter().map(|execute| execute.time).collect(),
            motion: TrueMotion {
                t_s: truth.time.clone(),
                heading_deg: degrees(&truth.heading),
                yaw_rate_deg_s: degrees(&truth.yaw_rate),
                rudder_deg: degrees(&truth.rudder),
                speed_m_s: truth.speed.clone(),
            },
        })
    }
}
