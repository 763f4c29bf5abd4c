//! Errors of a run.

use crate::record::checkpoint::ResumeError;
use crate::record::code::CodeError;
use crate::record::results::ResultsError;
use crate::report::ReportError;
use crate::step::StepError;
use std::path::{Path, PathBuf};

/// Reason why a run failed. What was computed is on disk.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A file or folder cannot be written.
    #[error("cannot write {}: {reason}; choose another folder with --out or make room", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// A written file cannot be read back.
    #[error("cannot read {} back: {reason}; its results are not summarised or drawn", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// No bond attaches a grain to a first body of the circuit.
    #[error(
        "at t = {time:.6e} s, when the circuit begins, no bond attaches a grain to `{body}`: let bonds form earlier \
         (circuit.start), let them reach it (detection.alert, positions of grains), or leave it out of circuit.bases"
    )]
    NoBonds {
        /// Name of the body.
        body: String,
        /// Time (s).
        time: f64,
    },
    /// The results file failed.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A picture failed.
    #[error(transparent)]
    Picture(#[from] ReportError),
    /// A run cannot be resumed.
    #[error(transparent)]
    Resume(#[from] ResumeError),
    /// A checkpoint failed.
    #[error("cannot make a checkpoint: {0}")]
    Checkpoint(#[from] CodeError),
}

pub(super) fn unwritable(path: &Path, e: &dyn std::fmt::Display) -> RunError {
    RunError::Write {
        path: path.to_owned(),
        reason: e.to_string(),
    }
}

pub(super) fn unreadable(path: &Path, e: &dyn std::fmt::Display) -> RunError {
    RunError::Read {
        path: path.to_owned(),
        reason: e.to_string(),
    }
}
