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
    /// Two columns of the statistics have one name.
    #[error(
        "two columns of the statistics are named `{name}`; give a measure or an observer another name"
    )]
    ColumnTwice {
        /// The name.
        name: String,
    },
    /// An observer gave another number of values than it has columns.
    #[error(
        "the observers gave {values} values for {columns} columns of the statistics; each must give one value a column"
    )]
    Row {
        /// Number of values.
        values: usize,
        /// Number of columns.
        columns: usize,
    },
    /// A law did not come back in time from a call, and the watch over laws has written what there was. The handler that was given
    /// to [`crate::laws::watch::watch`] decides what becomes of the program.
    #[error("a law did not come back in time; what was recorded until then is on disk")]
    TakenOver,
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
