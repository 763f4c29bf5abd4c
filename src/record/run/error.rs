//! Why a run failed.

use crate::record::checkpoint::ResumeError;
use crate::record::code::CodeError;
use crate::record::results::ResultsError;
use crate::report::ReportError;
use crate::step::StepError;
use std::path::{Path, PathBuf};

/// Why a run failed. What was computed is on disk.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The step.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A file or folder.
    #[error("cannot write {}: {reason}; choose another folder with --out or make room", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// What was written cannot be read back.
    #[error("cannot read {} back: {reason}; nothing is summed up or drawn from it", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// No bond ties a grain to a first body of the circuit.
    #[error(
        "at t = {time:.6e} s, when the circuit begins, no bond ties a grain to `{body}`: let bonds be made before \
         (circuit.start), let them reach it (detection.alert, the places of grains), or leave it out of circuit.bases"
    )]
    NoBonds {
        /// Name of the body.
        body: String,
        /// Time (s).
        time: f64,
    },
    /// The results file.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A picture.
    #[error(transparent)]
    Picture(#[from] ReportError),
    /// What was to go on cannot.
    #[error(transparent)]
    Resume(#[from] ResumeError),
    /// A checkpoint.
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
