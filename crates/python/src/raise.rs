//! Failures as Python exceptions, with the message of the command line.

use campaign::failure::{Failure, FailureKind};
use pyo3::create_exception;
use pyo3::exceptions::{PyRuntimeError, PyUserWarning, PyValueError};
use pyo3::prelude::*;

create_exception!(
    kempf,
    KempfError,
    PyValueError,
    "The input is wrong: a record, a scenario, a model or an option. The message names the place, the problem, what was \
     expected and what to do."
);
create_exception!(kempf, WorkError, PyRuntimeError, "The work could not be done, as when a disk is full.");
create_exception!(kempf, KempfWarning, PyUserWarning, "A remark on a record or a result, which remains valid.");

/// Python exception for a failure.
pub fn python_error(failure: Failure) -> PyErr {
    match failure.kind {
        FailureKind::Input => KempfError::new_err(failure.message),
        FailureKind::Work | FailureKind::Interrupted => WorkError::new_err(failure.message),
    }
}
