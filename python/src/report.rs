//! Reports of runs, called from Python.

use crate::errors;
use fretwork::cli::{
    MeasuredColumns, MeasuredCurve, ReportError, compare_runs, make_report, measured_depth,
    read_measured,
};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

fn raised(error: &ReportError, folder: Option<&Path>) -> PyErr {
    match error {
        ReportError::NoRun { path, reason } => errors::wrong(path.display(), reason.clone()),
        ReportError::Measured { reason } => errors::wrong("measured", reason.clone()),
        ReportError::Unwritable { .. } => errors::run(&error.to_string(), folder),
    }
}

/// Reads measured curves: files, columns as `delta=Weg (um)`, and the length by which forces are
/// divided for a run in two dimensions.
fn curves(
    files: &[PathBuf],
    columns: &[String],
    depth: Option<&str>,
) -> PyResult<Vec<MeasuredCurve>> {
    let depth = depth.map(measured_depth).transpose();
    let columns = depth.and_then(|depth| MeasuredColumns::parse(columns, depth));
    let read = columns.and_then(|columns| read_measured(files, &columns));
    read.map_err(|why| errors::wrong("measured", why))
}

/// Makes the report of the run in a folder, with at most this number of bytes, or with all that was
/// recorded, and with measured curves in its figures; returns its path.
#[pyfunction]
pub(crate) fn report(
    py: Python<'_>,
    folder: PathBuf,
    bytes: Option<usize>,
    measured: Vec<PathBuf>,
    columns: Vec<String>,
    depth: Option<String>,
) -> PyResult<PathBuf> {
    let curves = curves(&measured, &columns, depth.as_deref())?;
    let made = py.detach(|| make_report(&folder, bytes, &curves));
    let written = made.map_err(|e| raised(&e, Some(&folder)))?;
    Ok(written.page)
}

/// Makes a page with the runs in these folders side by side, and with measured curves in their
/// figures.
#[pyfunction]
pub(crate) fn compare(
    py: Python<'_>,
    folders: Vec<PathBuf>,
    to: PathBuf,
    measured: Vec<PathBuf>,
    columns: Vec<String>,
    depth: Option<String>,
) -> PyResult<()> {
    let curves = curves(&measured, &columns, depth.as_deref())?;
    let made = py.detach(|| compare_runs(&folders, &to, &curves));
    made.map(|_| ()).map_err(|e| raised(&e, None))
}
