//! Functions for `fretwork.law` that list, describe, drive and certify laws.
//!
//! Results are JSON, which the Python side converts to its own types.

use crate::search::search_path;
use fretwork::certify::certify_in_child;
use fretwork::laws::search::LawLocation;
use fretwork::laws::{Kind, LawError, LawField, Plugin, SearchPath};
use fretwork::program;
use fretwork::scene::source::nearest;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::io::Read;
use std::path::PathBuf;
use std::process::Stdio;
use std::time::Duration;

/// Adds the functions of this file to the module.
pub(crate) fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(laws, module)?)?;
    module.add_function(wrap_pyfunction!(certify_law, module)?)?;
    module.add_function(wrap_pyfunction!(drive_laws, module)?)
}

/// Interval at which a waiting call checks for Ctrl-C.
const PATIENCE: Duration = Duration::from_millis(50);

fn wrong(e: LawError) -> PyErr {
    PyValueError::new_err(e.to_string())
}

/// Returns the laws with a name or kind/name, or all laws. Each is a JSON object; a library that
/// cannot be used has the key `error` if all were requested.
#[pyfunction]
#[pyo3(signature = (name=None, plugin_path=Vec::new()))]
fn laws(py: Python<'_>, name: Option<&str>, plugin_path: Vec<PathBuf>) -> PyResult<String> {
    let path = search_path(&plugin_path, false)?;
    py.detach(|| {
        let Some(name) = name else {
            let all = path.laws();
            path.test_loading(
                all.iter()
                    .map(|(kind, name, _)| (*kind, name.as_str(), None)),
            );
            let described = all.iter().map(|(kind, name, place)| {
                let opened = path.open_law(*kind, name, place);
                opened.map_or_else(|e| unusable(*kind, name, place, &e), |p| describe(&p))
            });
            return Ok(Value::Array(described.collect()).to_string());
        };
        let found = named(&path, name)?;
        Ok(Value::Array(found.iter().map(describe).collect()).to_string())
    })
}

/// Returns the certificate of a law with these parameters, the others at their defaults, as JSON.
#[pyfunction]
fn certify_law(
    py: Python<'_>,
    name: &str,
    parameters: Vec<(String, f64)>,
    plugin_path: Vec<PathBuf>,
) -> PyResult<String> {
    let path = search_path(&plugin_path, false)?;
    py.detach(|| {
        let found = named(&path, name)?;
        let [law] = found.as_slice() else {
            let kinds: Vec<String> = found.iter().map(|l| format!("{}/{name}", l.kind)).collect();
            let message = format!(
                "laws of several kinds are named `{name}`; use one of {}",
                kinds.join(", ")
            );
            return Err(PyValueError::new_err(message));
        };
        let certificate =
            certify_in_child(law, &values(law, &parameters)?, None, &path).map_err(wrong)?;
        serde_json::to_string(&certificate).map_err(|e| PyRuntimeError::new_err(e.to_string()))
    })
}

/// Runs `fretwork law drive` with these arguments in a separate process, so that a law that crashes
/// or hangs does not affect this one; returns its table as JSON and its remarks.
#[pyfunction]
fn drive_laws(py: Python<'_>, arguments: Vec<String>) -> PyResult<(String, String)> {
    let failed =
        |e: std::io::Error| PyRuntimeError::new_err(format!("the program cannot be started: {e}"));
    let mut command = program::command().map_err(failed)?;
    let started = command
        .args(["law", "drive", "--json"])
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut running = started.map_err(failed)?;
    let read = |from: Option<Box<dyn Read + Send>>| {
        std::thread::spawn(move || {
            let mut text = Vec::new();
            if let Some(mut from) = from {
                // Output before an error is kept; the exit status of the process explains the
                // error.
                let _ = from.read_to_end(&mut text);
            }
            String::from_utf8_lossy(&text).into_owned()
        })
    };
    let table = read(
        running
            .stdout
            .take()
            .map(|o| Box::new(o) as Box<dyn Read + Send>),
    );
    let remarks = read(
        running
            .stderr
            .take()
            .map(|e| Box::new(e) as Box<dyn Read + Send>),
    );
    let status = loop {
        if let Some(status) = running.try_wait().map_err(failed)? {
            break status;
        }
        py.detach(|| std::thread::sleep(PATIENCE));
        if let Err(interrupted) = py.check_signals() {
            let _ = running.kill();
            let _ = running.wait();
            return Err(interrupted);
        }
    };
    let (table, remarks) = py.detach(|| (table.join(), remarks.join()));
    let (table, remarks) = (table.unwrap_or_default(), remarks.unwrap_or_default());
    if status.success() {
        return Ok((table, remarks.trim().to_owned()));
    }
    let said = remarks.trim();
    let said = said.strip_prefix("error: ").unwrap_or(said).to_owned();
    Err(match status.code() {
        Some(2) => PyValueError::new_err(said),
        Some(_) => PyRuntimeError::new_err(said),
        None => PyRuntimeError::new_err(format!(
            "the process that drives the laws ended by a signal ({status}) {said}"
        )),
    })
}

/// The laws with a name, or with kind/name.
fn named(path: &SearchPath, name: &str) -> PyResult<Vec<Plugin>> {
    let (kind, short) = match name.split_once('/') {
        Some((kind, short)) => {
            let known = Kind::from_word(kind).ok_or_else(|| {
                PyValueError::new_err(format!("there is no kind `{kind}`; use {}", Kind::words()))
            })?;
            (Some(known), short)
        }
        None => (None, name),
    };
    let all = path.laws();
    let found: Vec<_> = all
        .iter()
        .filter(|(k, n, _)| n == short && kind.is_none_or(|kind| kind == *k))
        .collect();
    if found.is_empty() {
        let near = nearest(short, all.iter().map(|l| l.1.as_str()));
        let proposal = near.map_or_else(
            || "; fretwork.law.list() has those that there are".to_owned(),
            |n| format!("; did you mean `{n}`?"),
        );
        let message = format!(
            "there is no law named `{name}` in {}{proposal}",
            path.searched()
        );
        return Err(PyValueError::new_err(message));
    }
    let opened = found
        .into_iter()
        .map(|(kind, name, place)| path.open_law(*kind, name, place));
    opened.collect::<Result<_, _>>().map_err(wrong)
}

/// Returns all parameter values of a law, in the order of its schema.
fn values(law: &Plugin, given: &[(String, f64)]) -> PyResult<Vec<f64>> {
    let mut values: Vec<f64> = law.parameters.iter().map(|p| p.default).collect();
    for (name, value) in given {
        let names = || law.parameters.iter().map(|p| p.name.as_str());
        let Some(place) = names().position(|n| n == name) else {
            let near = nearest(name, names())
                .map_or_else(String::new, |n| format!("; did you mean `{n}`?"));
            let all = names().collect::<Vec<_>>().join(", ");
            let message = format!(
                "the {} law `{}` has no parameter `{name}`{near} It has {all}",
                law.kind, law.name
            );
            return Err(PyValueError::new_err(message));
        };
        values[place] = *value;
    }
    Ok(values)
}

fn describe(law: &Plugin) -> Value {
    let fields = |fields: &[LawField]| -> Vec<Value> {
        let one = |f: &LawField| {
            // JSON has no infinity.
            let finite = |x: f64| x.is_finite().then_some(x);
            json!({
                "name": f.name, "unit": f.unit, "doc": f.doc, "default": f.default,
                "minimum": finite(f.minimum), "maximum": finite(f.maximum),
            })
        };
        fields.iter().map(one).collect()
    };
    json!({
        "kind": law.kind.word(), "name": law.name, "version": law.version, "doc": law.doc, "reference": law.reference,
        "path": law.path, "sha256": law.sha256, "built_in": law.built_in,
        "parameters": fields(&law.parameters), "variables": fields(&law.variables),
    })
}

fn unusable(kind: Kind, name: &str, place: &LawLocation, e: &LawError) -> Value {
    let path = match place {
        LawLocation::Library(path) => path.display().to_string(),
        LawLocation::BuiltIn => String::new(),
    };
    json!({ "kind": kind.word(), "name": name, "path": path, "error": e.to_string() })
}
