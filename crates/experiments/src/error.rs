//! Reasons why an experiment cannot be made.

use fretwork_scene::InputError;
use fretwork_store::write_advice;
use fretwork_view::DrawError;
use std::path::{Path, PathBuf};

/// Reason why an experiment cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A case, or the file of a study or fit, is invalid at some place.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The request does not fit the case, or a folder or program is unsuitable.
    #[error("{0}")]
    Usage(String),
    /// The experiment ran and has no result.
    #[error("{0}")]
    Failed(String),
    /// A file or folder cannot be written.
    #[error("cannot write {}: {reason}{}", path.display(), write_advice(reason))]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
}

impl Error {
    /// Creates an error for a file that cannot be written.
    pub fn write(path: &Path, reason: &dyn std::fmt::Display) -> Self {
        Self::Write {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}

impl From<DrawError> for Error {
    fn from(e: DrawError) -> Self {
        Self::Failed(e.to_string())
    }
}
