//! The command line, called from Python.

use fretwork::program::{self, Program};
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;

/// Declares the file of this module, whose SHA-256 identifies the built-in laws, and how Python
/// starts the command line in another process.
#[pyfunction]
pub(crate) fn declare(file: PathBuf, command: Vec<OsString>) {
    program::declare(Program { file, command });
}

/// Runs the command line with the words of a call, of which the first is the name of the program;
/// returns the exit code. It installs signal handlers, so a process may call it only once.
#[pyfunction]
pub(crate) fn command_line(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| fretwork::cli::call(&words))
}
