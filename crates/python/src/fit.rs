//! `fit`: joint fits of records by several methods.

use campaign::failure::Failure;
use campaign::scenario::name;
use document::{Warning, Warnings};
use identify::Estimate;
use identify::replay::replay;
use pyo3::prelude::*;
use study::documents;
use study::records::repetition_warnings;
use study::work;
use trial::Trial;

use crate::curve::{ReplayArrays, replay_arrays};
use crate::earlier::{NamedModel, earlier_models};
use crate::python_method::{PyIdentifier, PythonMethods};
use crate::record::{PyRecord, cloned_trials, read_warnings, warning_texts};
use crate::wait::run_in_background;

/// Result of a fit, with the records and estimates for its figures.
#[pyclass(frozen, name = "Fit", module = "kempf._kempf")]
pub struct PyFit {
    /// Document of the fit, JSON.
    #[pyo3(get)]
    text: String,
    /// Warnings of the fit, without those of reading.
    #[pyo3(get)]
    warnings: Vec<String>,
    /// Fitted records, then validation records, at one scale.
    trials: Vec<Trial>,
    /// Methods with their estimates; `None` for a method that gives no estimate.
    answers: Vec<(String, Option<Estimate>)>,
}

#[pymethods]
impl PyFit {
    /// Record number `place`, from 0, as fitted, at the scale of the first record; `None` beyond the last record.
    fn record(&self, place: usize) -> Option<PyRecord> {
        self.trials.get(place).cloned().map(PyRecord::from_trial)
    }

    /// Replay of record number `place` (from 0, fitted records first) by the estimate of the method with the identifier
    /// or label `method`; `None` without this record or this method, if the method gives no estimate, or if the replay
    /// is not finite.
    fn replay<'py>(&self, py: Python<'py>, place: usize, method: &str) -> Option<ReplayArrays<'py>> {
        let (_, estimate) = self.answers.iter().find(|(id, _)| id == method)?;
        Some(replay_arrays(py, &replay(self.trials.get(place)?, &estimate.as_ref()?.response)?))
    }
}

/// Fit of records by the named methods (if empty, the default methods) and by functions of the caller; `validate` are
/// validation records, `priors` models of earlier trials.
#[pyfunction]
pub fn fit(
    py: Python<'_>,
    records: Vec<Py<PyRecord>>,
    validate: Vec<Py<PyRecord>>,
    methods: Vec<String>,
    functions: PythonMethods,
    seed: Option<u64>,
    priors: Vec<NamedModel>,
) -> PyResult<PyFit> {
    // The document contains the warnings of reading, as on the command line; Python has already issued them.
    let reading: Vec<Warning> = read_warnings(&records).chain(read_warnings(&validate)).collect();
    let (records, validation) = (cloned_trials(&records), cloned_trials(&validate));
    run_in_background(py, move || {
        let priors = earlier_models(&priors)?;
        let mut methods = work::fit::labelled_methods(&methods, seed)?;
        for (label, function) in functions {
            name::check_label(&label).map_err(|unfit| Failure::input(format!("own: a label is {label:?}; {unfit}")))?;
            if methods.iter().any(|(other, _)| *other == label) {
                return Err(Failure::input(format!(
                    "own: {label:?}: another method has this label; give it one of its own"
                )));
            }
            methods.push((label, Box::new(PyIdentifier(function))));
        }
        let mut warnings = Warnings::default();
        warnings.extend(reading.iter().cloned().chain(repetition_warnings(&records, &validation)));
        let done = work::fit::fit([&records, &validation], &methods, &priors, true, warnings)?.with_predicted_circle();
        let warnings = warning_texts(done.document.verdict_warnings().filter(|warning| !reading.contains(warning)));
        Ok(PyFit {
            text: documents::to_json(&done.document).map_err(Failure::execution)?,
            warnings,
            trials: [done.records.trials, done.records.held_out].concat(),
            answers: done.answers.into_iter().map(|(entry, estimate)| (entry.method, estimate)).collect(),
        })
    })
}
