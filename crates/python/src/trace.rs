//! `trace`: effects that a first-order model lacks.

use campaign::failure::Failure;
use document::{Warning, Warnings};
use pyo3::prelude::*;
use study::documents::{self, curves::TracedRecord};
use study::options::TraceRequest;
use study::records::repetition_warnings;
use study::work;

use crate::curve::{ReplayArrays, replay_arrays};
use crate::earlier::{NamedModel, earlier_models};
use crate::options::parse_request;
use crate::record::{PyRecord, cloned_trials, read_warnings, warning_texts};
use crate::wait::run_in_background;

/// Result of a trace, with the records and replays for its figures.
#[pyclass(frozen, name = "Trace", module = "kempf._kempf")]
pub struct PyTrace {
    /// Document of the trace, JSON.
    #[pyo3(get)]
    text: String,
    /// Warnings of the trace, without those of reading.
    #[pyo3(get)]
    warnings: Vec<String>,
    /// Fitted records, then validation records, at one scale, each with its replays.
    records: Vec<TracedRecord>,
}

#[pymethods]
impl PyTrace {
    /// Record number `place`, from 0, as fitted, at the scale of the first record; `None` beyond the last record.
    fn record(&self, place: usize) -> Option<PyRecord> {
        self.records.get(place).map(|record| PyRecord::from_trial(record.trial.clone()))
    }

    /// Replays of a record by the base, and by the average of the structures; `None` without this record.
    fn replays<'py>(&self, py: Python<'py>, place: usize) -> Option<[ReplayArrays<'py>; 2]> {
        Some(self.records.get(place)?.replays.each_ref().map(|replay| replay_arrays(py, replay)))
    }
}

/// Trace of records; `validate` are validation records, `options` are options of the command line, `priors` are models
/// of earlier trials.
#[pyfunction]
pub fn trace(
    py: Python<'_>,
    records: Vec<Py<PyRecord>>,
    validate: Vec<Py<PyRecord>>,
    options: Vec<String>,
    priors: Vec<NamedModel>,
) -> PyResult<PyTrace> {
    // The document contains the warnings of reading, as on the command line; Python has already issued them.
    let reading: Vec<Warning> = read_warnings(&records).chain(read_warnings(&validate)).collect();
    let (records, validation) = (cloned_trials(&records), cloned_trials(&validate));
    run_in_background(py, move || {
        // The command line requires the name of a record; the records themselves are passed separately.
        let asked: TraceRequest = parse_request([options, vec![String::from("record")]].concat())?;
        let [records, validation] = [records, validation].map(|trials| work::trace::withhold_channels(&asked, trials));
        let mut warnings = Warnings::default();
        warnings.extend(reading.iter().cloned().chain(repetition_warnings(&records, &validation)));
        let traced = work::trace::trace(
            [&records, &validation],
            &work::trace::settings(&asked)?,
            &earlier_models(&priors)?,
            true,
            &mut warnings,
        )?;
        let text = documents::to_json(&traced.document).map_err(Failure::execution)?;
        let records = traced.curves()?.records;
        let warnings = warning_texts(traced.document.warnings.iter().filter(|warning| !reading.contains(warning)));
        Ok(PyTrace { text, warnings, records })
    })
}
