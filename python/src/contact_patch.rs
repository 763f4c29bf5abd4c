//! Contact patches in closed form, called from Python.

use crate::errors;
use fretwork::contact_patch::{Question, answer};
use fretwork::shipped::search_path;
use pyo3::prelude::*;

/// Computes the answer to a question; both are JSON.
#[pyfunction]
pub(crate) fn contact_patch(question: &str) -> PyResult<String> {
    let unread = |e: serde_json::Error| errors::wrong("contact_patch", e.to_string());
    let question: Question = serde_json::from_str(question).map_err(unread)?;
    let found = answer(&question, &search_path()).map_err(|e| errors::wrong("contact_patch", e))?;
    serde_json::to_string(&found).map_err(unread)
}
