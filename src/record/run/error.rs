//! Errors of a run.

use crate::record::checkpoint::{Occupied, ResumeError};
use crate::record::encoding::EncodingError;
use crate::record::results::ResultsError;
use crate::scene::source::InputError;
use crate::step::{RepeatError, StepError};
use fretwork_observe::accuracy::PartError;
use fretwork_observe::observer::RowError;
use fretwork_store::folder_lock::LockError;
use fretwork_store::write_advice;
use std::path::{Path, PathBuf};

/// Reason why a run failed. What was computed is on disk.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A step failed.
    #[error(transparent)]
    Step(#[from] StepError),
    /// A file or folder cannot be written.
    #[error("cannot write {}: {reason}{}", path.display(), write_advice(reason))]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// Another run is writing in the folder, or it cannot be owned.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// The folder has results that the run would replace, see [`Run::keeping`].
    ///
    /// [`Run::keeping`]: super::Run::keeping
    #[error(transparent)]
    Occupied(Box<Occupied>),
    /// A written file cannot be read back.
    #[error("cannot read {} back: {reason}; its results are not summarised or drawn", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// The state before repeated steps cannot be restored.
    #[error(transparent)]
    Repeat(#[from] RepeatError),
    /// The case is wrong.
    #[error(transparent)]
    Input(Box<InputError>),
    /// Two columns of the statistics, two files or two tables of events have one name, but no line
    /// of the case gives this name.
    #[error(
        "two {} are named `{name}`; give a measure or an observer another name",
        plural(what)
    )]
    NameTwice {
        /// Kind of the named items.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// An observer returned another number of values than it has columns.
    #[error(transparent)]
    Row(#[from] RowError),
    /// A law did not return from a call in time, and the watch over laws has written what was
    /// recorded. The handler given to [`crate::laws::watch::watch`] decides how the program ends.
    #[error("a law did not come back in time; what was recorded until then is on disk")]
    TakenOver,
    /// The results file.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A picture failed.
    #[cfg(feature = "view")]
    #[error(transparent)]
    Picture(#[from] crate::view::DrawError),
    /// A run cannot be resumed.
    #[error(transparent)]
    Resume(#[from] ResumeError),
    /// A checkpoint failed.
    #[error("cannot make a checkpoint: {0}")]
    Checkpoint(#[from] EncodingError),
}

impl RunError {
    /// Whether nothing more may be written after this error: the watch wrote the results, or the
    /// folder no longer belongs to the run.
    pub(super) fn is_last(&self) -> bool {
        let lost = |e: &LockError| matches!(e, LockError::Lost { .. });
        match self {
            Self::TakenOver => true,
            Self::Lock(e) | Self::Results(ResultsError::Lock(e)) => lost(e),
            _ => false,
        }
    }

    /// Whether the user's input is invalid, so that nothing was run.
    pub fn is_input(&self) -> bool {
        match self {
            Self::Resume(e) => e.is_input(),
            Self::Input(_) | Self::Occupied(_) | Self::Lock(LockError::Held { .. }) => true,
            _ => false,
        }
    }
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

impl From<PartError> for RunError {
    fn from(error: PartError) -> Self {
        match error {
            PartError::Step(error) => Self::Step(error),
            PartError::Repeat(error) => Self::Repeat(error),
        }
    }
}

/// Returns the plural of a kind of item: `files in the folder`.
fn plural(what: &str) -> String {
    match what.split_once(' ') {
        Some((first, rest)) => format!("{first}s {rest}"),
        None => format!("{what}s"),
    }
}
