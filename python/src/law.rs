//! Laws written in Python.

use pyo3::prelude::*;

/// Adds the functions of this file to the module.
pub(crate) fn add(_module: &Bound<'_, PyModule>) -> PyResult<()> {
    Ok(())
}
