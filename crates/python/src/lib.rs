//! Kempf for Python: the compiled part of the package `kempf`. It passes records to [`study::work`], as the command
//! line does, and returns the same documents. Texts, tables and figures are made in Python, in `python/kempf`.
//!
//! | to learn about | read |
//! |---|---|
//! | records | `record` |
//! | tasks on records | `find`, `fit`, `trace`, `predict`, `bench` |
//! | models of earlier trials | `earlier` |
//! | functions of Python as methods | `python_method` |
//! | scenarios | `scene`, `simulate`, `run` |
//! | background work, and Ctrl-C | `wait` |
//! | keywords as options of the command line | `options` |
//! | exceptions | `raise` |

mod bench;
mod curve;
mod earlier;
mod find;
mod fit;
mod options;
mod predict;
mod python_method;
mod raise;
mod record;
mod run;
mod scene;
mod simulate;
mod trace;
mod wait;

use pyo3::prelude::*;

#[pymodule]
fn _kempf(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("KempfError", py.get_type::<raise::KempfError>())?;
    module.add("WorkError", py.get_type::<raise::WorkError>())?;
    module.add("KempfWarning", py.get_type::<raise::KempfWarning>())?;
    module.add_class::<record::PyRecord>()?;
    module.add_class::<fit::PyFit>()?;
    module.add_class::<trace::PyTrace>()?;
    module.add_function(wrap_pyfunction!(record::read, module)?)?;
    module.add_function(wrap_pyfunction!(record::record_of, module)?)?;
    module.add_function(wrap_pyfunction!(fit::fit, module)?)?;
    module.add_function(wrap_pyfunction!(find::find, module)?)?;
    module.add_function(wrap_pyfunction!(bench::bench, module)?)?;
    module.add_function(wrap_pyfunction!(trace::trace, module)?)?;
    module.add_function(wrap_pyfunction!(predict::predict, module)?)?;
    module.add_function(wrap_pyfunction!(scene::toml_of, module)?)?;
    module.add_function(wrap_pyfunction!(simulate::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(run::run, module)?)
}
