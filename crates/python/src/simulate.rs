//! `simulate`: trials of a scenario, as records with their truth.

use campaign::failure::Failure;
use campaign::outside_estimates::record_name;
use pyo3::prelude::*;
use rayon::prelude::*;
use study::options::{Replicates, SimulateRequest};
use study::work::simulate::{RecordFiles, requested_trials, simulate_record_files};

use crate::options::parse_request;
use crate::record::{PyRecord, record_from_table};
use crate::scene::ScenarioInput;
use crate::wait::run_in_background;

/// Selected trials, each with its truth as JSON; `None` for `cell` or `replicate` selects all. Records pass through the
/// file format, as on the command line.
#[pyfunction]
pub fn simulate(
    py: Python<'_>,
    scene: ScenarioInput,
    cell: Option<String>,
    replicate: Option<u64>,
    seed: Option<u64>,
) -> PyResult<Vec<(PyRecord, String)>> {
    run_in_background(py, move || {
        let scenario = scene.read(seed)?;
        let replicate = replicate.map_or(Replicates::All, Replicates::One);
        let asked = SimulateRequest { scenario: scene.path().to_owned(), cell, replicate };
        let whole = parse_request(Vec::new())?;
        let read = |RecordFiles { name, record_csv, sidecar_toml, truth_json }: RecordFiles| {
            Ok((record_from_table(&name, &record_csv, &whole, sidecar_toml.as_deref())?, truth_json))
        };
        let trials = requested_trials(&scenario, &asked)?.into_par_iter().map(|task| {
            simulate_record_files(&scenario, task, &record_name(&scenario, task))?.into_iter().map(read).collect()
        });
        // Collected in two steps, so that the failure is the first one in the order of the trials.
        let trials: Vec<Result<Vec<(PyRecord, String)>, Failure>> = trials.collect();
        Ok(trials.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().flatten().collect())
    })
}
