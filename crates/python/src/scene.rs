//! Scenarios from files, texts and dictionaries.

use std::path::{Path, PathBuf};

use campaign::failure::Failure;
use campaign::scenario::Scenario;
use pyo3::prelude::*;
use serde_json::Value;

use crate::raise::python_error;

/// Scenario as passed from Python.
#[derive(FromPyObject)]
pub struct ScenarioInput {
    /// Path of the file, or name of the text in messages.
    #[pyo3(item)]
    path: PathBuf,
    /// Text; `None` for a file.
    #[pyo3(item)]
    text: Option<String>,
}

impl ScenarioInput {
    /// Resolved scenario; fails if the command line would fail.
    pub fn read(&self, seed: Option<u64>) -> Result<Scenario, Failure> {
        let Some(text) = &self.text else { return Scenario::read(&self.path, seed) };
        let name = self.path.file_stem().unwrap_or(Path::new("scenario").as_os_str());
        Scenario::parse(&self.path, &name.to_string_lossy(), text.clone(), seed)
    }

    /// Path of the file, or name of the text in messages.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// TOML text of a JSON document. Fails if the document has no form in TOML.
#[pyfunction]
pub fn toml_of(json: &str) -> PyResult<String> {
    let value: Value = serde_json::from_str(json).map_err(|error| python_error(Failure::input(error)))?;
    toml::to_string(&value).map_err(|error| {
        python_error(Failure::input(format!(
            "the scenario cannot be written as TOML: {error}; leave out keys that are None"
        )))
    })
}
