//! Reports of runs, called from Python.

use crate::errors;
use fretwork::cli::{ReportError, compare_runs, make_report};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

fn raised(error: &ReportError, folder: Option<&Path>) -> PyErr {
    match error {
        ReportError::NoRun { path, reason } => errors::wrong(path.display(), reason.clone()),
        ReportError::Measured { reason } => errors::wrong("measured", reason.clone()),
        ReportError::Unwritable { .. } => errors::run(&error.to_string(), folder),
    }
}

/// Makes the report of the run in a folder, with at most this number of bytes, or with all that was
/// recorded; returns its path.
#[pyfunction]
pub(crate) fn report(py: Python<'_>, folder: PathBuf, bytes: Option<usize>) -> PyResult<PathBuf> {
    let made = py.detach(|| make_report(&folder, bytes, &[]));
    let written = made.map_err(|e| raised(&e, Some(&folder)))?;
    Ok(written.page)
}

/// Makes a page with the runs in these folders side by side.
#[pyfunction]
pub(crate) fn compare(py: Python<'_>, folders: Vec<PathBuf>, to: PathBuf) -> PyResult<()> {
    let made = py.detach(|| compare_runs(&folders, &to, &[]));
    made.map(|_| ()).map_err(|e| raised(&e, None))
}
