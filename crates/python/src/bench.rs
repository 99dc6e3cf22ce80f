//! `bench`: the benchmark on measured and simulated trials.

use std::sync::Arc;

use campaign::failure::OnPath;
use pyo3::prelude::*;
use study::commands::bench::{BenchRequest, run_benchmark, skipped_record_line};

use crate::options::parse_request;
use crate::python_method::{PyIdentifier, PythonMethods};
use crate::run::{WorkObserver, run_observed};

/// JSON document of the benchmark, and messages on skipped records followed by warnings. `options` are options of the
/// command line; `progress` is called with the number of finished trials of a scenario and the maximum number.
#[pyfunction]
pub fn bench(
    py: Python<'_>,
    scenarios: Vec<String>,
    options: Vec<String>,
    functions: PythonMethods,
    seed: Option<u64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Vec<String>)> {
    let observer = Arc::new(WorkObserver::default());
    let shared = Arc::clone(&observer);
    let work = move || {
        let options = options.into_iter().chain([String::from("--")]).chain(scenarios);
        let asked: BenchRequest = parse_request(options.collect())?;
        let entrant = |(label, function): (String, _)| (label, Arc::new(PyIdentifier(function)) as _);
        let entrants = functions.into_iter().map(entrant).collect();
        let results = run_benchmark(&asked, seed, &entrants, None, shared.as_ref())?;
        let text = results.to_json().on("describe", "bench.json".as_ref())?;
        Ok((text, results.skipped.iter().map(skipped_record_line).collect::<Vec<String>>()))
    };
    let (text, skipped) = run_observed(py, &observer, progress.as_ref(), work)?;
    let [_, warnings] = observer.take_messages();
    Ok((text, skipped.into_iter().chain(warnings).collect()))
}
