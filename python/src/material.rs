//! Materials, called from Python.

use crate::errors;
use fretwork::scene::material::{MaterialLibrary, Sheet};
use pyo3::prelude::*;
use std::path::Path;

/// The library of a case in the working folder.
fn library() -> MaterialLibrary {
    MaterialLibrary::beside(Path::new("case.ron"))
}

/// Makes the exception of a sheet that cannot be written.
fn unwritten(error: serde_json::Error) -> PyErr {
    errors::wrong("material", error.to_string())
}

/// Returns the data sheet of a material by its name, or of a file, as JSON.
#[pyfunction]
pub(crate) fn material(name: &str) -> PyResult<String> {
    let sheet = Sheet::find(&library(), name).map_err(|e| errors::input(&e))?;
    serde_json::to_string(&sheet).map_err(unwritten)
}

/// Returns the data sheets of all materials as JSON.
#[pyfunction]
pub(crate) fn materials() -> PyResult<String> {
    let all = library().list();
    let sheets: Result<Vec<_>, _> = all.iter().map(Sheet::listed).collect();
    let sheets = sheets.map_err(|e| errors::input(&e))?;
    serde_json::to_string(&sheets).map_err(unwritten)
}
