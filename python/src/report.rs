//! Reports of runs, called from Python.

use crate::errors;
use fretwork::cli::{ReportError, compare_runs, make_report};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

fn raised(error: &ReportError, folder: Option<&Path>) -> PyErr {
    match error {
        ReportError::NoRun { path, reason } => errors::wrong(path.display(), reason.clone()),
        ReportError::Unwritable { .. } => errors::run(&error.to_string(), folder),
    }
}

/// Makes the report of the run in a folder, of at most so many bytes, or of all that was recorded;
/// gives its path.
#[pyfunction]
pub(crate) fn report(py: Python<'_>, folder: PathBuf, bytes: Option<usize>) -> PyResult<PathBuf> {
    let made = py.detach(|| make_report(&folder, bytes));
    let (path, _) = made.map_err(|e| raised(&e, Some(&folder)))?;
    Ok(path)
}

/// Puts the runs in folders side by side, in a page.
#[pyfunction]
pub(crate) fn compare(py: Python<'_>, folders: Vec<PathBuf>, to: PathBuf) -> PyResult<()> {
    let made = py.detach(|| compare_runs(&folders, &to));
    made.map(|_| ()).map_err(|e| raised(&e, None))
}
