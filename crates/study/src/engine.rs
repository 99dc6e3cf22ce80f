//! The engine: every cell and replicate simulated once, every method on the same trial, rows in their order.
//!
//! Trials run in parallel and are collected by index, so the rows do not depend on the number of threads.

use identify::replay::replay;
use identify::{Estimate, output_error};
use indicatif::ParallelProgressIterator;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use ship::FirstOrder;
use ship::angle::to_deg;
use ship::first_order::State;
use simulate::{SimulateError, Simulated, StreamKey};
use trial::Trial;

use crate::progress;
use crate::rows::Row;
use crate::scenario::{Cell, Scenario};

/// What is known of a cell without its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellFacts {
    /// Labels of its points, one an axis.
    pub labels: Vec<String>,
    /// Values of its points, where an axis is a number.
    pub values: Vec<Option<f64>>,
    /// Cramér–Rao bound on the sd of K, per cent of the truth.
    pub bound_k_percent: Option<f64>,
    /// Cramér–Rao bound on the sd of T, per cent of the truth.
    pub bound_t_percent: Option<f64>,
}

/// Key of all that is random in one trial.
pub fn key(scenario: &Scenario, cell: usize, replicate: u64) -> StreamKey {
    StreamKey { seed: scenario.seed, cell: cell as u64, replicate }
}

/// Simulates one trial of a cell.
pub fn simulate(scenario: &Scenario, cell: usize, replicate: u64) -> Result<Simulated, SimulateError> {
    scenario.cells[cell].simulation.run(&key(scenario, cell, replicate))
}

/// Runs everything and returns the rows: cell by cell, replicate by replicate, method by method.
pub fn run(scenario: &Scenario, quiet: bool) -> Vec<Row> {
    let replicates = scenario.replicates as usize;
    let tasks = scenario.cells.len() * replicates;
    (0..tasks)
        .into_par_iter()
        .progress_with(progress::bar(tasks as u64, quiet))
        .map(|task| one_trial(scenario, task / replicates, (task % replicates) as u64))
        .collect::<Vec<Vec<Row>>>()
        .into_iter()
        .flatten()
        .collect()
}

fn one_trial(scenario: &Scenario, index: usize, replicate: u64) -> Vec<Row> {
    let cell = &scenario.cells[index];
    let blank = |method: &str| Row {
        cell: index as u64,
        replicate,
        method: method.to_owned(),
        true_k_per_s: cell.truth.map(|truth| truth.K()),
        true_t_s: cell.truth.map(|truth| truth.T()),
        ..Row::default()
    };
    match simulate(scenario, index, replicate) {
        Err(error) => cell
            .methods
            .iter()
            .map(|method| Row { reason: Some(format!("simulation: {error}")), ..blank(&method.label) })
            .collect(),
        Ok(simulated) => cell
            .methods
            .iter()
            .map(|method| match method.identify(&simulated.trial, &key(scenario, index, replicate)) {
                Err(error) => Row { reason: Some(error.kind().to_owned()), ..blank(&method.label) },
                Ok(estimate) => row(blank(&method.label), &simulated.trial, &estimate),
            })
            .collect(),
    }
}

fn row(blank: Row, trial: &Trial, estimate: &Estimate) -> Row {
    let (k, t, bias) = (estimate.K(), estimate.T(), estimate.rudder_bias());
    let finite = |value: f64| value.is_finite().then_some(value);
    Row {
        k_per_s: finite(k.value),
        k_ci95_per_s: k.ci95,
        t_s: finite(t.value),
        t_ci95_s: t.ci95,
        rudder_bias_deg: finite(to_deg(bias.value)),
        rudder_bias_ci95_deg: bias.ci95.map(|ends| ends.map(to_deg)),
        heading_rmse_deg: replay(trial, &estimate.response).map(|replay| replay.heading_rmse_deg),
        evaluations: Some(estimate.evaluations as u64),
        stop: Some(estimate.stop.as_str().to_owned()),
        ..blank
    }
}

/// Facts of every cell, the bound from its first trial.
pub fn facts(scenario: &Scenario) -> Vec<CellFacts> {
    (0..scenario.cells.len())
        .into_par_iter()
        .map(|index| {
            let cell = &scenario.cells[index];
            let bound = cell.truth.and_then(|truth| bound_percent(scenario, index, cell, &truth));
            CellFacts {
                labels: cell.labels.clone(),
                values: cell.values.clone(),
                bound_k_percent: bound.map(|(k, _)| k),
                bound_t_percent: bound.map(|(_, t)| t),
            }
        })
        .collect()
}

/// Cramér–Rao sd of K and T in per cent; `None` without heading noise or without a trial.
fn bound_percent(scenario: &Scenario, index: usize, cell: &Cell, truth: &FirstOrder) -> Option<(f64, f64)> {
    let simulated = simulate(scenario, index, 0).ok()?;
    let sd = cell.simulation.sensors.declared_noise().heading?;
    let initial = State { heading: *simulated.truth.heading.first()?, yaw_rate: *simulated.truth.yaw_rate.first()? };
    let (k, t) = output_error::cramer_rao(&simulated.trial, truth, initial, sd)?.indices(truth);
    Some((100.0 * k.sd? / k.value.abs(), 100.0 * t.sd? / t.value.abs()))
}
