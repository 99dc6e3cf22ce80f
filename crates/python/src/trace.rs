//! `trace`: what a first-order ship lacks.

use ::trace::analysis::Judged;
use pyo3::prelude::*;
use scenario::failure::Failure;
use study::options::TraceRequest;
use study::records::warn_of_repetition;
use study::views::document;
use study::views::trace_file::TraceFile;
use study::work;
use trial::Trial;

use crate::asked::request;
use crate::curve::{Curve, curve};
use crate::record::{Record, trials};
use crate::wait::patiently;

/// What came out, with what its figures are made from.
#[pyclass(frozen, module = "kempf._kempf")]
pub struct Trace {
    #[pyo3(get)]
    text: String,
    #[pyo3(get)]
    warnings: Vec<String>,
    /// Fitted records, then those of the validation, at one scale; each with its replays.
    judged: Vec<(Trial, Judged)>,
}

#[pymethods]
impl Trace {
    /// A record as it was fitted: at the scale of the first.
    fn record(&self, place: usize) -> Option<Record> {
        self.judged.get(place).map(|(trial, _)| Record::plain(trial.clone()))
    }

    /// The rudder of a record replayed through the base, and through the final model.
    fn replays<'py>(&self, py: Python<'py>, place: usize) -> Option<[Curve<'py>; 2]> {
        let (_, judged) = self.judged.get(place)?;
        Some([&judged.before, &judged.after].map(|on| curve(py, &on.replay)))
    }
}

/// Analyses records; `words` are options of the command line.
#[pyfunction]
pub fn trace(
    py: Python<'_>,
    records: Vec<Py<Record>>,
    validate: Vec<Py<Record>>,
    words: Vec<String>,
) -> PyResult<Trace> {
    let (records, others) = (trials(&records), trials(&validate));
    patiently(py, move || {
        // The records are here already; the command line asks for the name of one.
        let asked: TraceRequest = request([words, vec![String::from("record")]].concat())?;
        let (records, others) = (work::trace::without(&asked, records), work::trace::without(&asked, others));
        let mut warnings = Vec::new();
        warn_of_repetition(&records, &others, &mut warnings);
        let report = work::trace::trace(&records, &others, &work::trace::settings(&asked), true, &mut warnings)?;
        let text = document::text(&TraceFile::of(&report)).map_err(Failure::work)?;
        let judged = report.analysis.identification.into_iter().chain(report.analysis.validation);
        let judged = report.trials.into_iter().chain(report.others).zip(judged).collect();
        Ok(Trace { text, warnings, judged })
    })
}
