//! `find`: manoeuvres in long logs.

use document::Warnings;
use pyo3::prelude::*;
use study::commands::find::find_answer;
use study::documents;
use study::options::FindRequest;

use crate::options::parse_request;
use crate::record::sentences;
use crate::wait::patiently;

/// Document of the manoeuvres found, and warnings; `options` are options of the command line.
#[pyfunction]
pub fn find(py: Python<'_>, logs: Vec<String>, options: Vec<String>) -> PyResult<(String, Vec<String>)> {
    patiently(py, move || {
        let asked: FindRequest = parse_request(options.into_iter().chain([String::from("--")]).chain(logs).collect())?;
        let mut warnings = Warnings::default();
        let answer = find_answer(&asked, &mut warnings)?;
        Ok((documents::answer_text(&answer)?, sentences(&warnings.ranked())))
    })
}
