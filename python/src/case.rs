//! A case that Python reads, builds and edits.

use crate::errors::{input, wrong};
use crate::infinity;
use crate::paths;
use crate::search::search_path;
use fretwork::cli;
use fretwork::scene::source::{Names, Tree, nearest, split_path};
use fretwork::scene::{Case as CaseSpec, InputError, LoadedCase, check, load, load_text};
use fretwork::shipped::inputs::{self, InputKind};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use serde_json::Value;
use std::path::PathBuf;

/// A case: its text, and the values read from it. Values are exchanged with Python as JSON.
#[pyclass(module = "fretwork._fretwork", name = "CaseData", from_py_object)]
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) loaded: LoadedCase,
}

/// Label and text of the lines of `fretwork check`.
type Lines = Vec<cli::CheckLine>;

#[pymethods]
impl Case {
    /// Reads a file, or the shipped case of a name.
    #[staticmethod]
    fn load(path: PathBuf, sets: Vec<String>) -> PyResult<Self> {
        let path = inputs::find(InputKind::Case, &path).map_err(|e| wrong(path.display(), e))?;
        let loaded = load(&path, &sets).map_err(|e| input(&e))?;
        Ok(Self { loaded })
    }

    /// Reads a text; files that it names are searched in `folder`.
    #[staticmethod]
    fn from_text(name: &str, text: &str, folder: PathBuf, sets: Vec<String>) -> PyResult<Self> {
        let loaded = load_text(name, text, &folder, &sets).map_err(|e| input(&e))?;
        Ok(Self { loaded })
    }

    /// Makes a case from its fields, as JSON.
    #[staticmethod]
    fn from_json(name: &str, json: &str, folder: PathBuf) -> PyResult<Self> {
        let value = parsed(json)?;
        let case = typed(value, "").map_err(|e| input(&e))?;
        let text = infinity::ron_of(&case).map_err(|e| input(&e))?;
        Self::from_text(name, &text, folder, Vec::new())
    }

    /// The text in use, edits applied.
    #[getter]
    fn text(&self) -> &str {
        self.loaded.source.text()
    }

    #[getter]
    fn path(&self) -> PathBuf {
        self.loaded.path.clone()
    }

    /// Returns the case as text with all values, including defaults.
    fn to_ron(&self) -> PyResult<String> {
        self.loaded.case.to_ron().map_err(|e| input(&e))
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    fn equals(&self, other: &Self) -> bool {
        self.loaded.case == other.loaded.case
    }

    /// Applies `key.path=value` arguments, all or none of them.
    fn set(&mut self, sets: Vec<String>) -> PyResult<()> {
        self.edit(&sets).map_err(|e| input(&e))
    }

    /// Sets the value at a path, given as JSON.
    fn assign(&mut self, path: &str, json: &str) -> PyResult<()> {
        self.put(path, parsed(json)?).map_err(|e| input(&e))
    }

    /// Returns the value at a path, as JSON; `None` for a value that the case omits.
    fn value(&self, path: &str) -> PyResult<Option<String>> {
        let all = infinity::json_of(&self.loaded.case);
        let parts = self.parts(path)?;
        if let Some(found) = paths::find(&all, &parts) {
            return Ok(Some(found.to_string()));
        }
        // The field is omitted because it is empty or has its default.
        if CaseSpec::names(&self.loaded.source, path).is_some()
            && let (above, last) = path.rsplit_once('.').unwrap_or(("", path))
            && let Some(Names::Fields(fields)) = CaseSpec::names(&self.loaded.source, above)
            && fields.iter().any(|f| f == last)
        {
            return Ok(None);
        }
        Err(self.unknown(path))
    }

    /// Returns all values that the case does not omit, as JSON.
    fn value_of_all(&self) -> String {
        infinity::json_of(&self.loaded.case).to_string()
    }

    /// Returns what is allowed at a path: one of `fields`, `entries`, `kinds` and `value`, with the
    /// names.
    fn names(&self, path: &str) -> Option<(&'static str, Vec<String>)> {
        Some(match CaseSpec::names(&self.loaded.source, path)? {
            Names::Fields(names) => ("fields", names),
            Names::Entries(names) => ("entries", names),
            Names::Kinds(names) => ("kinds", names),
            Names::Value => ("value", Vec::new()),
        })
    }

    /// Title, and what `fretwork check` prints below it.
    fn check(
        &self,
        py: Python<'_>,
        plugin_path: Vec<PathBuf>,
        trust_plugins: bool,
        timed: bool,
    ) -> PyResult<(String, Lines)> {
        let path = search_path(&plugin_path, trust_plugins)?;
        let loaded = self.loaded.clone();
        let made = py.detach(move || -> Result<_, InputError> {
            let built = loaded.build(&path)?;
            let mut lines = cli::check_lines(&loaded, &built, timed);
            if timed {
                lines.push(cli::check_run_time(&loaded, built));
            }
            Ok(lines)
        });
        let lines = made.map_err(|e| input(&e))?;
        Ok((self.loaded.case.name.clone(), lines))
    }
}

impl Case {
    fn parts(&self, path: &str) -> PyResult<Vec<String>> {
        split_path(path).ok_or_else(|| self.unknown(path))
    }

    /// Returns a `KeyError` with the nearest name.
    fn unknown(&self, path: &str) -> PyErr {
        let (above, last) = path.rsplit_once('.').unwrap_or(("", path));
        let names = match CaseSpec::names(&self.loaded.source, above) {
            Some(Names::Fields(names) | Names::Entries(names)) => names,
            _ => Vec::new(),
        };
        let near = nearest(last, names.iter().map(String::as_str));
        let near = near.map_or_else(String::new, |n| format!("; did you mean `{n}`?"));
        PyKeyError::new_err(format!("the case has no `{path}`{near}"))
    }

    fn edit(&mut self, sets: &[String]) -> Result<(), InputError> {
        let mut source = self.loaded.source.clone();
        for set in sets {
            CaseSpec::set(&mut source, set)?;
        }
        CaseSpec::convert_units(&mut source)?;
        let case = CaseSpec::read(&source)?;
        check::numbers(&case).map_err(|f| source.locate(f))?;
        (self.loaded.source, self.loaded.case) = (source, case);
        Ok(())
    }

    fn put(&mut self, path: &str, value: Value) -> Result<(), InputError> {
        if paths::has_object(&value) {
            let text = self.written(path, value)?;
            return self.edit(&[format!("{path}={text}")]);
        }
        let text = paths::ron(&value);
        // A text may also be the name of a kind, which has no quotes.
        match (value, self.edit(&[format!("{path}={text}")])) {
            (Value::String(word), Err(quoted)) => {
                let plain = word.chars().all(|c| c.is_alphanumeric() || c == '_');
                let digit = word.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
                match CaseSpec::names(&self.loaded.source, path) {
                    Some(Names::Kinds(_)) if plain => self.edit(&[format!("{path}={word}")]),
                    // A number with a unit is a text in Python only.
                    Some(Names::Value) if digit => self.edit(&[format!("{path}={word}")]),
                    _ => Err(quoted),
                }
            }
            (_, done) => done,
        }
    }

    /// Returns the RON text of a value with structs, maps or variants, by way of the case that
    /// contains it at this path.
    fn written(&self, path: &str, value: Value) -> Result<String, InputError> {
        let parts = split_path(path)
            .ok_or_else(|| InputError::argument(path, "a part of the key is empty"))?;
        let mut all = infinity::json_of(&self.loaded.case);
        paths::put(&mut all, &parts, value).map_err(|part| {
            InputError::argument(path, format!("there is no `{part}` in the case"))
        })?;
        let text = infinity::ron_of(&typed(all, path)?)?;
        let tree = Tree::of(&text);
        let found = tree.find(&text, &parts).ok();
        let found = found.map(|node| text[node.span.clone()].to_owned());
        // An empty value is omitted in the text.
        Ok(found.unwrap_or_else(|| "{}".to_owned()))
    }
}

fn parsed(json: &str) -> PyResult<Value> {
    serde_json::from_str(json)
        .map_err(|e| wrong("the value", format!("it cannot be read as JSON: {e}")))
}

/// Reads a case from JSON. A number is accepted for a constant function of time, as in case files.
/// `at` is the path that was set, for messages without a path of the reader.
fn typed(mut value: Value, at: &str) -> Result<CaseSpec, InputError> {
    // A bound on the number of functions of time, each of which takes one attempt.
    const MAX_CONSTANTS: usize = 10_000;
    for _ in 0..MAX_CONSTANTS {
        let error = match serde_path_to_error::deserialize::<_, CaseSpec>(&value) {
            Ok(case) => return Ok(case),
            Err(error) => error,
        };
        let parts = segments(error.path());
        let said = error.inner().to_string();
        let found = pointer(&mut value, &parts);
        match found {
            // This is the message of serde_json for a number where a variant is expected.
            Some(number) if number.is_number() && said.contains("expected string or map") => {
                *number = serde_json::json!({ "Constant": number.take() });
            }
            _ => {
                let place = if parts.is_empty() {
                    at.to_owned()
                } else {
                    parts.join(".")
                };
                return Err(explained(&place, &said));
            }
        }
    }
    Err(InputError::argument(
        at,
        "it has too many functions of time; write them as {\"Constant\": value}",
    ))
}

fn segments(path: &serde_path_to_error::Path) -> Vec<String> {
    use serde_path_to_error::Segment;
    let named = |segment: &Segment| match segment {
        Segment::Seq { index } => Some(index.to_string()),
        Segment::Map { key } => Some(key.clone()),
        Segment::Enum { variant } => Some(variant.clone()),
        Segment::Unknown => None,
    };
    path.iter().filter_map(named).collect()
}

/// Returns the value at a path each part of which, including variants, is a key or an index.
fn pointer<'a>(root: &'a mut Value, parts: &[String]) -> Option<&'a mut Value> {
    parts.iter().try_fold(root, |value, part| match value {
        Value::Array(list) => list.get_mut(part.parse::<usize>().ok()?),
        other => other.get_mut(part),
    })
}

/// The error of a JSON reader, such as "unknown field `stp`, expected one of `step`, `end`", with a
/// proposal.
fn explained(place: &str, said: &str) -> InputError {
    let (message, expected) = match said.split_once(", expected ") {
        Some((message, expected)) => (message, Some(expected)),
        None => (said, None),
    };
    let quoted = |text: &str| -> Vec<String> {
        let parts = text.split('`').skip(1).step_by(2);
        parts.map(str::to_owned).collect()
    };
    let mut error = InputError::argument(place, message);
    if let Some(expected) = expected {
        error = error.expected(expected);
        let names = quoted(expected);
        let given = quoted(message);
        let near = given
            .first()
            .and_then(|given| nearest(given, names.iter().map(String::as_str)));
        error = error.did_you_mean(near);
    }
    error
}
