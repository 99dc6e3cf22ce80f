//! A Python function as an identification method.
#![expect(non_snake_case, reason = "K and T are the symbols of the field")]

use identify::{Estimate, Identifier, IdentifyError};
use identify::{OutsideErrors, OutsideFit};
use nalgebra::Matrix3;
use pyo3::prelude::*;
use trial::Trial;

use crate::record::PyRecord;

/// Labelled Python functions. Each takes a list of records and returns K (1/s), T (s), δ_r (rad) and their covariance,
/// row by row, or `None`.
pub type PythonMethods = Vec<(String, Py<PyAny>)>;

/// Return value of a function: K (1/s), T (s), δ_r (rad) and their covariance; `None` if that is unknown.
type Returned = (f64, f64, f64, Option<[[f64; 3]; 3]>);

/// Python function that returns K, T and δ_r.
pub struct PyIdentifier(pub Py<PyAny>);

impl Identifier for PyIdentifier {
    fn id(&self) -> &'static str {
        "python"
    }

    fn summary(&self) -> &'static str {
        "a function of Python, called with the records"
    }

    fn identify(&self, trials: &[Trial]) -> Result<Estimate, IdentifyError> {
        let ask = |py: Python<'_>| -> PyResult<Returned> {
            let records: Vec<PyRecord> = trials.iter().cloned().map(PyRecord::from_trial).collect();
            self.0.bind(py).call1((records,))?.extract()
        };
        let (K, T, rudder_bias, covariance) =
            Python::attach(|py| ask(py).map_err(|raised| IdentifyError::from_outside_message(&raised.to_string())))?;
        let errors = covariance
            .map_or(OutsideErrors::Unknown, |rows| OutsideErrors::Covariance(Matrix3::from_row_slice(&rows.concat())));
        OutsideFit { K, T, rudder_bias, errors }.estimate()
    }
}
