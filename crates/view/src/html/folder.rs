//! The folder of a run: its results and summary, and what is missing.

use crate::html::ReportError;
use fretwork_store::folder_lock::{FolderLock, RUN_LOCK};
use fretwork_store::results::Reader;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A run that can be read.
pub(crate) struct RunFolder {
    /// The folder.
    pub path: PathBuf,
    /// `results.h5`.
    pub reader: Reader,
    /// Content of `summary.json`; null if there is none.
    pub summary: Value,
    /// Text of the case, as it was run.
    pub case_text: String,
    /// Title of the case.
    pub title: String,
    /// Version of the program that ran it.
    pub version: String,
    /// What is missing, in sentences.
    pub gaps: Vec<String>,
    /// Keeps runs from writing into the folder while it is read.
    _lock: FolderLock,
}

impl RunFolder {
    /// Opens the folder of a run that may not have finished.
    ///
    /// # Errors
    /// The folder has no readable results of a run.
    pub fn open(path: &Path) -> Result<Self, ReportError> {
        let no_run = |reason: String| ReportError::NoRun {
            path: path.to_owned(),
            reason,
        };
        if !path.is_dir() {
            let there = if path.exists() {
                "is a file"
            } else {
                "does not exist"
            };
            return Err(no_run(format!(
                "{there}; name the folder that `fretwork run` wrote, such as results/CASE"
            )));
        }
        let file = path.join("results.h5");
        if !file.exists() {
            return Err(no_run(
                "there is no results.h5 in it; name the folder that `fretwork run` wrote, such as results/CASE".to_owned(),
            ));
        }
        let lock = FolderLock::shared(path, RUN_LOCK).map_err(|_| {
            no_run(
                "a run is writing in it; make the page when it has ended, or stop it first (Ctrl-C, and later --resume)"
                    .to_owned(),
            )
        })?;
        let damaged = |reason: String| {
            no_run(format!(
                "its results.h5 cannot be read, {reason}; if it was copied, copy it again, or run the case again"
            ))
        };
        let reader = Reader::open(&file).map_err(damaged)?;
        let case_text = reader.texts("case").into_iter().next();
        let ours = reader.attribute("program").as_deref() == Some("fretwork");
        let Some(case_text) = case_text.filter(|_| ours) else {
            return Err(no_run(
                "its results.h5 is not of `fretwork run`, or was cut short: it does not hold the case".to_owned(),
            ));
        };
        let title = reader.attribute("case").unwrap_or_default();
        let version = reader.attribute("version").unwrap_or_default();
        let mut gaps = Vec::new();
        let summary = summary(path, &title, &mut gaps);
        Ok(Self {
            path: path.to_owned(),
            reader,
            summary,
            case_text,
            title,
            version,
            gaps,
            _lock: lock,
        })
    }

    /// Dimension of the case, 2 or 3.
    pub fn dimension(&self) -> usize {
        let three = self.reader.has("views/grains/PointData/spin_x");
        if three { 3 } else { 2 }
    }

    /// Name of the folder, which distinguishes runs.
    pub fn name(&self) -> String {
        let full = std::path::absolute(&self.path).unwrap_or_else(|_| self.path.clone());
        let name = full.file_name().unwrap_or(full.as_os_str());
        name.to_string_lossy().into_owned()
    }
}

/// Returns the summary of the run, if it exists and belongs to this case.
fn summary(folder: &Path, title: &str, gaps: &mut Vec<String>) -> Value {
    let Ok(text) = std::fs::read_to_string(folder.join("summary.json")) else {
        gaps.push(
            "There is no summary.json: the run was killed before its end, or is still going on. The page shows what was \
             recorded up to the last flush of results.h5; `fretwork run CASE --resume` continues from the last checkpoint."
                .to_owned(),
        );
        return Value::Null;
    };
    match serde_json::from_str::<Value>(&text) {
        Ok(value) if value["case"].as_str() == Some(title) => value,
        Ok(_) => {
            gaps.push(
                "summary.json is of another run than results.h5, and is left out: results and checks are missing.".to_owned(),
            );
            Value::Null
        }
        Err(e) => {
            gaps.push(format!(
                "summary.json cannot be read ({e}), and is left out: results and checks are missing."
            ));
            Value::Null
        }
    }
}
