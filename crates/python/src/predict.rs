//! `predict`: what an identified ship will do.

use std::path::{Path, PathBuf};

use campaign::failure::Failure;
use document::{Warning, Warnings};
use pyo3::prelude::*;
use study::documents;
use study::options::PredictRequest;
use study::work::predict::{self as work, PredictInput, StoredModel};

use crate::asked::request;
use crate::earlier::{ModelText, earlier};
use crate::record::{PyRecord, read_warnings, sentences, trials};
use crate::wait::patiently;

/// The document of a prediction and the warnings. `models` are names of files, with the text of those that are none;
/// `words` are options of the command line, `priors` models of earlier trials.
#[pyfunction]
pub fn predict(
    py: Python<'_>,
    models: Vec<(String, Option<String>)>,
    replay: Vec<Py<PyRecord>>,
    words: Vec<String>,
    priors: Vec<ModelText>,
) -> PyResult<(String, Vec<String>)> {
    // The document has what reading warned of, as that of the command; Python has been told before.
    let told: Vec<Warning> = read_warnings(&replay).collect();
    let records = trials(&replay);
    patiently(py, move || {
        let names = models.iter().map(|(name, _)| name.clone());
        let mut asked: PredictRequest = request(words.into_iter().chain([String::from("--")]).chain(names).collect())?;
        asked.replays = records.iter().map(|record| PathBuf::from(record.name())).collect();
        let mut warnings = Warnings::default();
        let read = |(name, text): &(String, Option<String>)| match text {
            Some(text) => StoredModel::of_document(name, text, asked.method.as_deref(), asked.calm, &mut warnings),
            None => StoredModel::of_file(Path::new(name), &asked, &mut warnings),
        };
        let models: Vec<StoredModel> = models.iter().map(read).collect::<Result<_, _>>()?;
        warnings.extend(told.iter().cloned());
        let earlier = earlier(&priors)?;
        let input =
            PredictInput { models: &models, earlier: &earlier, ballast: &[], records, current: None, declared: None };
        let predicted = work::predict(&asked, input, true, &mut warnings)?;
        let warnings = sentences(predicted.warnings.iter().filter(|warning| !told.contains(warning)));
        Ok((documents::text(&predicted).map_err(Failure::work)?, warnings))
    })
}
