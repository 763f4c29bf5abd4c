//! Tries in a child process whether libraries can be opened, which may hang or end the process.

use super::child::{End, enabled, run_request};
use super::linked::LawCode;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// Hidden subcommand that tries to open libraries.
pub const TRY_LIBRARIES: &str = "__try-libraries";

/// A library as it was when it was tried.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(super) struct Library {
    pub path: PathBuf,
    pub sha256: String,
}

/// Results of the trials: `None` for success, otherwise the reason why the library cannot be
/// opened. The path is part of the key, since the same bytes in another folder may load other
/// dependencies.
static FOUND: Mutex<Option<HashMap<Library, Option<String>>>> = Mutex::new(None);

fn cached_result(library: &Library) -> Option<Option<String>> {
    let found = FOUND.lock().unwrap_or_else(|e| e.into_inner());
    found.as_ref()?.get(library).cloned()
}

fn cache_result(library: &Library, reason: Option<String>) {
    let mut found = FOUND.lock().unwrap_or_else(|e| e.into_inner());
    let all = found.get_or_insert_default();
    all.insert(library.clone(), reason);
}

/// Checks in a child process that a library can be opened without hanging or ending the process.
pub(super) fn check_loads(path: &Path, sha256: &str) -> Result<(), String> {
    if !enabled() {
        return Ok(());
    }
    let library = Library {
        path: path.to_owned(),
        sha256: sha256.to_owned(),
    };
    if cached_result(&library).is_none() {
        try_in_order(std::slice::from_ref(&library));
    }
    match cached_result(&library) {
        Some(None) => Ok(()),
        Some(Some(reason)) => Err(reason),
        None => Err(UNANSWERED.to_owned()),
    }
}

/// Tries several libraries in one child process; a library whose SHA-256 differs from its pin is
/// not opened.
pub(super) fn try_loading(libraries: &[(PathBuf, Option<&str>)]) {
    if !enabled() {
        return;
    }
    let mut wanted: Vec<Library> = Vec::new();
    for (path, pin) in libraries {
        let Ok(code) = LawCode::of(path) else {
            continue;
        };
        let library = Library {
            path: path.clone(),
            sha256: code.sha256,
        };
        let pinned = pin.is_none_or(|p| p.eq_ignore_ascii_case(&library.sha256));
        if pinned && cached_result(&library).is_none() && !wanted.contains(&library) {
            wanted.push(library);
        }
    }
    while !wanted.is_empty() {
        let done = try_in_order(&wanted);
        wanted.drain(..done);
    }
}

const UNANSWERED: &str = "it was tried in a separate process, which ended without reporting on it; build or copy it again";

/// Tries libraries in a child process and stores the results; returns the number of libraries with
/// a result, at least one.
fn try_in_order(libraries: &[Library]) -> usize {
    let question = serde_json::to_value(libraries).map_err(|e| e.to_string());
    let output = match question.and_then(|q| run_request(TRY_LIBRARIES, &q)) {
        Ok(output) => output,
        Err(reason) => {
            let text = format!(
                "it must first be tried in a separate process, which could not be started ({reason})"
            );
            cache_result(&libraries[0], Some(text));
            return 1;
        }
    };
    for (library, piece) in libraries.iter().zip(&output.messages) {
        cache_result(library, piece.as_str().map(str::to_owned));
    }
    let answered = output.messages.len().min(libraries.len());
    let Some(library) = libraries.get(answered) else {
        return answered;
    };
    let why = match &output.end {
        End::Early(why) => format!(
            "opening it ended a process that tried it: {why}; the file may be damaged or cut short: build or copy it again"
        ),
        End::NoMemory(why) => format!("it could not be tried: {why}"),
        // A library without an answer was not opened.
        End::Done => UNANSWERED.to_owned(),
    };
    cache_result(library, Some(why));
    answered + 1
}

/// Message for a library that changed after it was first read.
pub(super) const CHANGED: &str =
    "the file changed while it was being opened; wait until it is written and try again";
