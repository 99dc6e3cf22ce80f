//! `trace`: what a first-order ship lacks.

use campaign::failure::Failure;
use document::{Warning, Warnings};
use pyo3::prelude::*;
use study::documents::{self, curves::TracedRecord};
use study::options::TraceRequest;
use study::records::repetitions;
use study::work;

use crate::asked::request;
use crate::curve::{ReplayArrays, curve};
use crate::earlier::{ModelText, earlier};
use crate::record::{PyRecord, read_warnings, sentences, trials};
use crate::wait::patiently;

/// What came out, with what its figures are made from.
#[pyclass(frozen, name = "Trace", module = "kempf._kempf")]
pub struct PyTrace {
    #[pyo3(get)]
    text: String,
    #[pyo3(get)]
    warnings: Vec<String>,
    /// Fitted records, then those of the validation, at one scale; each with its replays.
    records: Vec<TracedRecord>,
}

#[pymethods]
impl PyTrace {
    /// A record as it was fitted: at the scale of the first.
    fn record(&self, place: usize) -> Option<PyRecord> {
        self.records.get(place).map(|one| PyRecord::plain(one.trial.clone()))
    }

    /// The rudder of a record replayed through the base, and through the average of the structures.
    fn replays<'py>(&self, py: Python<'py>, place: usize) -> Option<[ReplayArrays<'py>; 2]> {
        Some(self.records.get(place)?.replays.each_ref().map(|replay| curve(py, replay)))
    }
}

/// Analyses records; `words` are options of the command line, `priors` models of earlier trials.
#[pyfunction]
pub fn trace(
    py: Python<'_>,
    records: Vec<Py<PyRecord>>,
    validate: Vec<Py<PyRecord>>,
    words: Vec<String>,
    priors: Vec<ModelText>,
) -> PyResult<PyTrace> {
    // The document has what reading warned of, as that of the command; Python has been told before.
    let told: Vec<Warning> = read_warnings(&records).chain(read_warnings(&validate)).collect();
    let (records, others) = (trials(&records), trials(&validate));
    patiently(py, move || {
        // The records are here already; the command line asks for the name of one.
        let asked: TraceRequest = request([words, vec![String::from("record")]].concat())?;
        let (records, others) = (work::trace::without(&asked, records), work::trace::without(&asked, others));
        let mut warnings = Warnings::default();
        warnings.extend(told.iter().cloned().chain(repetitions(&records, &others)));
        let traced = work::trace::trace(
            [&records, &others],
            &work::trace::settings(&asked)?,
            &earlier(&priors)?,
            true,
            &mut warnings,
        )?;
        let text = documents::text(&traced.document).map_err(Failure::work)?;
        let records = traced.curves()?.records;
        let warnings = sentences(traced.document.warnings.iter().filter(|warning| !told.contains(warning)));
        Ok(PyTrace { text, warnings, records })
    })
}
