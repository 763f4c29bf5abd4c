//! Cases from what is known about a test, called from Python.

use crate::errors::wrong;
use fretwork::experiments::new_case::{Geometry, Made, Question};
use fretwork::shipped::search_path;
use pyo3::prelude::*;

/// Makes the file of a test; returns whether it is a case or a patch, and its text.
#[pyfunction]
pub(crate) fn new_case(
    geometry: &str,
    values: Vec<(String, String)>,
) -> PyResult<(String, String)> {
    let refused = |e: String| wrong("new_case", e);
    let geometry = Geometry::named(geometry).map_err(refused)?;
    let known = values.iter();
    let question = known.fold(Question::new(geometry), |q, (key, value)| {
        q.with(key, value)
    });
    let made = question.make(&search_path()).map_err(refused)?;
    let kind = match made.made {
        Made::Case => "case",
        Made::Patch => "patch",
    };
    Ok((kind.to_owned(), made.text))
}
