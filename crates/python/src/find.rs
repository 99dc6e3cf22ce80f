//! `find`: manoeuvres in long logs.

use document::Warnings;
use pyo3::prelude::*;
use study::commands::find::find_answer;
use study::documents;
use study::options::FindRequest;

use crate::options::parse_request;
use crate::record::warning_texts;
use crate::wait::run_in_background;

/// JSON document of the manoeuvres in logs, and warnings; `options` are options of the command line.
#[pyfunction]
pub fn find(py: Python<'_>, logs: Vec<String>, options: Vec<String>) -> PyResult<(String, Vec<String>)> {
    run_in_background(py, move || {
        let asked: FindRequest = parse_request(options.into_iter().chain([String::from("--")]).chain(logs).collect())?;
        let mut warnings = Warnings::default();
        let answer = find_answer(&asked, &mut warnings)?;
        Ok((documents::answer_text(&answer)?, warning_texts(&warnings.ranked())))
    })
}
