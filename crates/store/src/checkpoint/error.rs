//! Why a run cannot go on.

use fretwork_observe::code::CodeError;
use std::path::PathBuf;

/// Why a run cannot go on from what a folder holds.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResumeError {
    /// The file cannot be read.
    #[error("cannot read {}: {reason}; to begin anew leave --resume out", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// No checkpoint in it is whole.
    #[error(
        "the checkpoints in {} are damaged: there is none to go on from; to begin anew leave --resume out",
        path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// It is of another version.
    #[error(
        "{} is of Fretwork {theirs}, this is {ours}, and the bits of two versions may differ: resume with the version \
         that began it, or begin anew without --resume",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// Version of the file, with the form of its checkpoints.
        theirs: String,
        /// Version of the program, likewise.
        ours: String,
    },
    /// It is of another case.
    #[error(
        "{} is of another case: {what}; resume with the same case and --set options, or choose another folder with \
         --out",
        path.display()
    )]
    Other {
        /// The file.
        path: PathBuf,
        /// What differs.
        what: String,
    },
    /// The run cannot go on beyond the end that it was begun with.
    #[error(
        "the run in {} cannot go on beyond its `time.end`: {why}; run it anew without --resume",
        path.display()
    )]
    Longer {
        /// The file.
        path: PathBuf,
        /// What hangs on the end.
        why: &'static str,
    },
    /// A checkpoint that is whole holds something else than the case carries.
    #[error("the checkpoint in {} cannot be taken up: {source}; to begin anew leave --resume out", path.display())]
    State {
        /// The file.
        path: PathBuf,
        /// Why.
        source: CodeError,
    },
}

impl ResumeError {
    /// Whether the user gave something else than the run was begun with; else the file is at fault.
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Version { .. } | Self::Other { .. } | Self::Longer { .. }
        )
    }
}
