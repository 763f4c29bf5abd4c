//! The command line, called from Python.

use fretwork::program::{self, Program};
use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;

/// Declares the file of this module, whose SHA-256 stands for the built-in laws, and how Python
/// starts the command line in another process.
#[pyfunction]
pub(crate) fn declare(file: PathBuf, command: Vec<OsString>) {
    program::declare(Program { file, command });
}

/// Calls the command line with the words of a call, of which the first is the name of the program;
/// returns the exit code. It handles signals from then on, so a process calls it once.
#[pyfunction]
pub(crate) fn command_line(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| fretwork::cli::call(&words))
}
