//! Errors of the library as exceptions of the package; their classes are in `fretwork/_errors.py`.

use fretwork::record::RunError;
use fretwork::scene::InputError;
use fretwork::scene::source::clean_lines;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::fmt::Display;
use std::path::Path;

/// Arguments of an [`InputError`] in Python: text, file, line, column, message, expected, proposal.
type InputArguments = (
    String,
    String,
    Option<usize>,
    Option<usize>,
    String,
    Option<String>,
    Option<String>,
);

/// Makes an exception of a class of `fretwork._errors` with these arguments.
fn raised(
    class: &str,
    arguments: impl for<'py> FnOnce(&Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>>,
) -> PyErr {
    Python::attach(|py| {
        let made = py
            .import("fretwork._errors")
            .and_then(|module| module.getattr(class))
            .and_then(|class| arguments(&class));
        made.map_or_else(|e| e, PyErr::from_value)
    })
}

/// Replaces options of the command line in a text by the corresponding arguments in Python.
fn in_python(text: &str) -> String {
    let text = text.replace("--resume", "resume=True");
    let text = text.replace(
        "choose another folder with --out",
        "choose another folder, out=...,",
    );
    clean_lines(&text)
}

/// Makes a `fretwork.InputError`.
pub(crate) fn input(error: &InputError) -> PyErr {
    let place = error.position();
    let arguments: InputArguments = (
        in_python(&error.render(false)),
        error.file.clone(),
        place.map(|p| p.0),
        place.map(|p| p.1),
        error.message.clone(),
        error.expected.clone(),
        error.help.clone(),
    );
    raised("InputError", move |class| class.call1(arguments))
}

/// Makes a `fretwork.InputError` without a position in a file.
pub(crate) fn wrong(subject: impl Display, message: impl Into<String>) -> PyErr {
    input(&InputError::argument(subject, message))
}

/// Makes a `fretwork.RunError`; `out` is the folder with the results so far.
pub(crate) fn run(message: &str, out: Option<&Path>) -> PyErr {
    let arguments = (in_python(message), out.map(Path::to_owned));
    raised("RunError", move |class| class.call1(arguments))
}

/// Makes the exception of a failed run: an input error if another case or version is resumed.
pub(crate) fn ended(error: &RunError, place: Option<String>, out: &Path) -> PyErr {
    if let RunError::Input(e) = error {
        return input(e);
    }
    if error.is_input() {
        return wrong(out.display(), in_python(&error.to_string()));
    }
    let place = place.map_or_else(String::new, |p| format!("; {p}"));
    run(&format!("{error}{place}"), Some(out))
}

/// A mistake in the use of an object.
pub(crate) fn misused(message: &str) -> PyErr {
    PyRuntimeError::new_err(message.to_owned())
}
