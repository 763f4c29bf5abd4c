//! Search path of laws.

use crate::errors::wrong;
use fretwork::laws::{SearchPath, child};
use fretwork::shipped::built_in;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::time::Duration;

/// Limit on a call of a law in the process that tries its library (s), as that of the command line.
const LIMIT: Duration = Duration::from_secs(60);

/// Returns the search path with the built-in laws, those of `FRETWORK_PLUGIN_PATH`, and those of
/// further folders. Libraries are tested in another process before they are opened in this one.
pub(crate) fn search_path(folders: &[PathBuf], trust_plugins: bool) -> PyResult<SearchPath> {
    if let Some(missing) = folders.iter().find(|f| !f.is_dir()) {
        let subject = format!("plugin_path {}", missing.display());
        return Err(wrong(subject, "there is no such folder"));
    }
    child::enable(Some(LIMIT));
    let path = SearchPath::new(folders).with_built_in(built_in());
    Ok(if trust_plugins { path.trusting() } else { path })
}
