//! The compiled part of the Python package `fretwork`.

mod law;

use pyo3::prelude::*;

#[pymodule]
fn _fretwork(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    law::add(module)
}
