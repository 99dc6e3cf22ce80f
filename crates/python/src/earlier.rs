//! Models of earlier trials as they come from Python.

use std::path::PathBuf;

use campaign::failure::Failure;
use study::work::earlier::EarlierModel;

/// The name of a model, and its text where it is no file.
pub type ModelText = (String, Option<String>);

/// The models.
pub fn earlier(models: &[ModelText]) -> Result<Vec<EarlierModel>, Failure> {
    let read = |(name, text): &ModelText| match text {
        Some(text) => EarlierModel::of_document(name, text).map(|model| vec![model]),
        None => EarlierModel::of_files(&[PathBuf::from(name)]),
    };
    models.iter().map(read).collect::<Result<Vec<_>, _>>().map(|all| all.concat())
}
