//! Models of earlier trials, as passed from Python.

use std::path::PathBuf;

use campaign::failure::Failure;
use pyo3::prelude::*;
use study::work::earlier_trials::EarlierModel;

/// Model passed from Python, as a pair of name and text.
pub struct NamedModel {
    /// Name for messages; the file name if there is no text.
    pub name: String,
    /// Text of the model; `None` if it is in the file.
    pub text: Option<String>,
}

impl<'py> FromPyObject<'_, 'py> for NamedModel {
    type Error = PyErr;

    fn extract(pair: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let (name, text): (String, Option<String>) = pair.extract()?;
        Ok(Self { name, text })
    }
}

/// Models of earlier trials, read from files or texts. Fails if a file or text is not a model.
pub fn earlier_models(models: &[NamedModel]) -> Result<Vec<EarlierModel>, Failure> {
    let read = |NamedModel { name, text }: &NamedModel| match text {
        Some(text) => EarlierModel::from_document(name, text).map(|model| vec![model]),
        None => EarlierModel::from_files(&[PathBuf::from(name)]),
    };
    models.iter().map(read).collect::<Result<Vec<_>, _>>().map(|all| all.concat())
}
