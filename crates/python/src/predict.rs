//! `predict`: predictions of manoeuvres by an identified ship.

use std::path::{Path, PathBuf};

use campaign::failure::Failure;
use document::{Warning, Warnings};
use pyo3::prelude::*;
use study::documents;
use study::options::PredictRequest;
use study::work::predict::{self as work, PredictInput, StoredModel};

use crate::earlier::{NamedModel, earlier_models};
use crate::options::parse_request;
use crate::record::{PyRecord, cloned_trials, read_warnings, warning_texts};
use crate::wait::run_in_background;

/// JSON document of a prediction, and warnings. `models` are file names, or names with a text; `replay` are records to
/// compare with their prediction, `options` are options of the command line, `priors` are models of earlier trials.
#[pyfunction]
pub fn predict(
    py: Python<'_>,
    models: Vec<NamedModel>,
    replay: Vec<Py<PyRecord>>,
    options: Vec<String>,
    priors: Vec<NamedModel>,
) -> PyResult<(String, Vec<String>)> {
    // The document contains the warnings of reading, as on the command line; Python has already issued them.
    let reading: Vec<Warning> = read_warnings(&replay).collect();
    let records = cloned_trials(&replay);
    run_in_background(py, move || {
        let names = models.iter().map(|model| model.name.clone());
        let mut asked: PredictRequest =
            parse_request(options.into_iter().chain([String::from("--")]).chain(names).collect())?;
        asked.replays = records.iter().map(|record| PathBuf::from(record.name())).collect();
        let mut warnings = Warnings::default();
        let read = |NamedModel { name, text }: &NamedModel| match text {
            Some(text) => StoredModel::from_document(name, text, asked.method.as_deref(), asked.calm, &mut warnings),
            None => StoredModel::from_file(Path::new(name), &asked, &mut warnings),
        };
        let models: Vec<StoredModel> = models.iter().map(read).collect::<Result<_, _>>()?;
        warnings.extend(reading.iter().cloned());
        let earlier = earlier_models(&priors)?;
        let input = PredictInput {
            models: &models,
            earlier_models: &earlier,
            ballast_models: &[],
            records,
            current: None,
            declared_conditions: None,
        };
        let predicted = work::predict(&asked, input, true, &mut warnings)?;
        let warnings = warning_texts(predicted.warnings.iter().filter(|warning| !reading.contains(warning)));
        Ok((documents::to_json(&predicted).map_err(Failure::execution)?, warnings))
    })
}
