//! `find`: the manoeuvres inside long logs.

use document::Warnings;
use pyo3::prelude::*;
use study::commands::find::find_answer;
use study::documents;
use study::options::FindRequest;

use crate::asked::request;
use crate::record::sentences;
use crate::wait::patiently;

/// The document of the manoeuvres, and the warnings; `words` are options of the command line.
#[pyfunction]
pub fn find(py: Python<'_>, logs: Vec<String>, words: Vec<String>) -> PyResult<(String, Vec<String>)> {
    patiently(py, move || {
        let asked: FindRequest = request(words.into_iter().chain([String::from("--")]).chain(logs).collect())?;
        let mut warnings = Warnings::default();
        let answer = find_answer(&asked, &mut warnings)?;
        Ok((documents::answer_text(&answer)?, sentences(&warnings.ranked())))
    })
}
