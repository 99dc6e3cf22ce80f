//! `NAME.truth.json`: what is true of a simulated record, beside it.

use std::collections::BTreeMap;

use campaign::curves::degrees;
use campaign::engine::{self, Truths};
use campaign::task::Task;
use scenario::Scenario;
use serde_json::{Value, json};
use ship::FirstOrder;
use ship::angle::to_deg;
use simulate::Simulated;

/// The truth of one record of a trial: `nearest` is the first-order response nearest to the ship, the ship itself where
/// it is first order; `own` its base, where it has effects beside it; `missing` what a first-order base lacks; `drawn`
/// values are in the units of their keys; `executes_s` are the times of the orders, and `motion` is without the errors
/// of any instrument.
///
/// Fails when the drawn values of the trial make no ship.
pub fn truth(scenario: &Scenario, task: Task, simulated: &Simulated, truths: Truths) -> Result<Value, String> {
    let cell = &scenario.cells[task.cell];
    let specimen = cell.specimen(&engine::key(scenario, task)).map_err(|refusal| refusal.to_string())?;
    let truth = &simulated.truth;
    let indices =
        |own: FirstOrder| json!({ "K_per_s": own.K(), "T_s": own.T(), "delta_r_deg": to_deg(own.rudder_bias) });
    Ok(json!({
        "schema": "truth/1", "scenario": scenario.name, "seed": scenario.seed, "cell": cell.title(),
        "replicate": task.replicate, "nearest": truths.nearest.map(indices), "own": truths.own.map(indices),
        "missing": specimen.specification.missing,
        "drawn": scenario.draws.iter().zip(specimen.drawn.iter()).collect::<BTreeMap<_, _>>(),
        "executes_s": truth.executes.iter().map(|execute| execute.time).collect::<Vec<f64>>(),
        "motion": {
            "t_s": truth.time, "heading_deg": degrees(&truth.heading), "yaw_rate_deg_s": degrees(&truth.yaw_rate),
            "rudder_deg": degrees(&truth.rudder), "speed_m_s": truth.speed,
        },
    }))
}
