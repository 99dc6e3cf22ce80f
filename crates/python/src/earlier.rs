//! Models of earlier trials, as passed from Python.

use std::path::PathBuf;

use campaign::failure::Failure;
use study::work::earlier_trials::EarlierModel;

/// Name of a model, with its text unless the model is a file.
pub type ModelText = (String, Option<String>);

/// Models of earlier trials, read from files or texts. Fails if a file or text is not a model.
pub fn earlier(models: &[ModelText]) -> Result<Vec<EarlierModel>, Failure> {
    let read = |(name, text): &ModelText| match text {
        Some(text) => EarlierModel::from_document(name, text).map(|model| vec![model]),
        None => EarlierModel::from_files(&[PathBuf::from(name)]),
    };
    models.iter().map(read).collect::<Result<Vec<_>, _>>().map(|all| all.concat())
}
