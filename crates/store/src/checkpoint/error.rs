//! Errors in resuming a run.

use crate::folder_lock::LockError;
use fretwork_observe::encoding::EncodingError;
use std::path::PathBuf;

/// Reason why a run cannot be resumed from a folder.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResumeError {
    /// Another run is writing in the folder, or it cannot be owned.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// The file cannot be read.
    #[error("cannot read {}: {reason}; to start again from the beginning write --force in place of --resume", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
    /// All checkpoints in the file are damaged.
    #[error(
        "the checkpoints in {} are damaged, and there is no other state to resume from; nothing was changed; to start again from the beginning write --force in place of --resume",
        path.display()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
    },
    /// A run ended with rows, and without a state.
    #[error(
        "the run in {} ended before it had saved a state to resume from ({why}); nothing was changed; to start again from the beginning, \
         which replaces its rows, write --force in place of --resume",
        path.display()
    )]
    NoState {
        /// The file.
        path: PathBuf,
        /// Reason why the original run ended.
        why: String,
    },
    /// The file was written by another version.
    #[error(
        "{} was written by Fretwork {theirs}, this is {ours}, and results of two versions may differ in their bits: resume with the version \
         that started it, or start again with --force in place of --resume",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// Version of the program that wrote the file, with its checkpoint format.
        theirs: String,
        /// Version of this program, with its checkpoint format.
        ours: String,
    },
    /// The file was written by another build of this version.
    #[error(
        "{} was written by another build of this version of Fretwork, and results of two builds may differ in their bits: resume with the \
         program that started it, or start again with --force in place of --resume",
        path.display()
    )]
    Build {
        /// The file.
        path: PathBuf,
    },
    /// The file belongs to another case.
    #[error(
        "{} belongs to another case: {what}; resume with the same case and --set options, or choose another folder with \
         --out",
        path.display()
    )]
    Other {
        /// The file.
        path: PathBuf,
        /// Description of the difference.
        what: String,
    },
    /// The run cannot be extended beyond its original end.
    #[error(
        "the run in {} cannot be extended beyond its `time.end`: {why}; run it again with --force in place of --resume, or in another folder with --out",
        path.display()
    )]
    Longer {
        /// The file.
        path: PathBuf,
        /// The quantity that depends on the end.
        why: &'static str,
    },
    /// An intact checkpoint does not fit the case.
    #[error("the checkpoint in {} cannot be restored: {source}; to start again from the beginning write --force in place of --resume", path.display())]
    State {
        /// The file.
        path: PathBuf,
        /// Reason.
        source: EncodingError,
    },
}

impl ResumeError {
    /// Whether the user's input differs from that of the original run. Otherwise the file is at
    /// fault.
    pub fn is_input(&self) -> bool {
        matches!(
            self,
            Self::Version { .. }
                | Self::Build { .. }
                | Self::Other { .. }
                | Self::Longer { .. }
                | Self::Lock(LockError::Held { .. })
        )
    }
}
