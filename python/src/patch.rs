//! Contact patches by the laws of an interface, called from Python.

use crate::errors;
use crate::search::search_path;
use fretwork::experiments::Error;
use fretwork::experiments::patch::{OWNER, PatchFile, loads, solve_loads};
use fretwork::shipped::inputs::{self, InputKind};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Solves the patch of a file; returns its answer as JSON, and writes all files into a folder if
/// there is one.
#[pyfunction]
pub(crate) fn patch(
    py: Python<'_>,
    file: PathBuf,
    out: Option<PathBuf>,
    plugin_path: Vec<PathBuf>,
    trust_plugins: bool,
) -> PyResult<String> {
    let search = search_path(&plugin_path, trust_plugins)?;
    let path = inputs::find(InputKind::Patch, &file);
    let file = path.map_err(|e| errors::wrong("patch", e))?;
    let solved = py.detach(|| -> Result<String, Error> {
        let read = PatchFile::read(&file)?;
        let _lock = out.as_deref().map(|out| OWNER.take(out)).transpose()?;
        let outcomes = solve_loads(&read, &search, &mut |_, _| ())?;
        match &out {
            Some(out) => loads::write(&read, &outcomes, out),
            None => loads::json(&read, &outcomes),
        }
    });
    solved.map_err(|e| match e {
        Error::Input(e) => errors::input(&e),
        Error::Usage(text) => errors::wrong("patch", text),
        other => errors::run(&other.to_string(), out.as_deref()),
    })
}
