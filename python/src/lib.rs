//! The compiled part of the Python package `fretwork`.

mod law;

use pyo3::prelude::*;

#[pymodule(name = "_fretwork")]
fn module(m: &Bound<'_, PyModule>) -> PyResult<()> {
    m.add("__version__", env!("CARGO_PKG_VERSION"))?;
    law::add(m)
}
