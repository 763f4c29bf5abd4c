//! Shipped cases, studies, fits and patches, called from Python.

use crate::errors;
use fretwork::shipped::inputs;
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// Copies the shipped inputs of a name with the files that they name; returns the paths.
#[pyfunction]
pub(crate) fn copy_shipped(name: &str, out: PathBuf) -> PyResult<Vec<PathBuf>> {
    let found = inputs::named(name).map_err(|e| errors::wrong(name, e))?;
    let mut paths = Vec::new();
    for input in found {
        let written = input.copy(Path::new(&out));
        paths.extend(written.map_err(|e| errors::wrong(name, e.to_string()))?);
    }
    Ok(paths)
}
