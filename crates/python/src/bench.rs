//! `bench`: the benchmark on measured and simulated trials.

use std::sync::Arc;

use campaign::failure::OnPath;
use pyo3::prelude::*;
use study::commands::bench::{BenchRequest, measure, skipped};

use crate::asked::request;
use crate::own::{OwnMethods, PyIdentifier};
use crate::run::{Watch, watched};

/// The document of the benchmark, and what was left out; `words` are options of the command line. `progress` is called
/// with the fits that are done and that there are.
#[pyfunction]
pub fn bench(
    py: Python<'_>,
    scenarios: Vec<String>,
    words: Vec<String>,
    own: OwnMethods,
    seed: Option<u64>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, Vec<String>)> {
    let watch = Arc::new(Watch::default());
    let observer = Arc::clone(&watch);
    let work = move || {
        let words = words.into_iter().chain([String::from("--")]).chain(scenarios);
        let asked: BenchRequest = request(words.collect())?;
        let entrant = |(label, function): (String, _)| (label, Arc::new(PyIdentifier(function)) as _);
        let entrants = own.into_iter().map(entrant).collect();
        let results = measure(&asked, seed, &entrants, None, observer.as_ref())?;
        let text = results.json().on("describe", "bench.json".as_ref())?;
        Ok((text, results.skipped.iter().map(skipped).collect::<Vec<String>>()))
    };
    let (text, skipped) = watched(py, &watch, progress.as_ref(), work)?;
    let [_, warnings] = watch.told();
    Ok((text, skipped.into_iter().chain(warnings).collect()))
}
