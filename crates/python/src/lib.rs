//! Kempf for Python: the compiled half of the package `kempf`. It hands records to [`study::work`], as the command line
//! does, and gives back the same documents; words, tables and figures are made in Python, in `python/kempf`.
//!
//! | to learn about | read |
//! |---|---|
//! | records | `record` |
//! | what is asked of them | `find`, `fit`, `trace`, `predict`, `bench` |
//! | models of earlier trials | `earlier` |
//! | functions of Python as methods | `own` |
//! | scenarios | `scene`, `simulate`, `run` |
//! | work that is waited for, and Ctrl-C | `wait` |
//! | keywords as options of the command line | `asked` |
//! | exceptions | `raise` |

mod asked;
mod bench;
mod curve;
mod earlier;
mod find;
mod fit;
mod own;
mod predict;
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
