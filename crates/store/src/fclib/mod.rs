//! Reader and writer of FCLIB problem files (HDF5).
//!
//! The layout is that of `fclib.h` (github.com/FrictionalContactLibrary/fclib) and of the existing
//! files; where the header's comments and the files disagree, the files are followed. It is
//! described in `docs/fclib.md`. The solver's side, with the meaning of the symbols, is
//! [`fretwork_core::solve::local`].
//!
//! Files are untrusted: for any content, [`read`] returns a problem or an error, and uses no more
//! memory than a small multiple of the file's size.

mod matrix;
mod read;
mod solution;
mod source;
mod target;
mod write;

pub use read::read;
pub use solution::{Solution, read_solution, write_with_solution};
pub(super) use source::guard;
pub use write::{write, write_global, write_local};

use fretwork_core::solve::local::{GlobalProblem, LocalProblem, Multipliers};
use std::path::{Path, PathBuf};

/// Descriptive texts of a file; invalid UTF-8 is replaced.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Info {
    /// `info/title`.
    pub title: Option<String>,
    /// `info/description`.
    pub description: Option<String>,
    /// `info/math_info`.
    pub math_info: Option<String>,
}

/// The problem of a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// `/fclib_local`.
    Local(Local),
    /// `/fclib_global`.
    Global(Global),
}

/// A local problem with its multipliers and descriptive texts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Local {
    /// W, q, mu.
    pub problem: LocalProblem,
    /// V, R, s.
    pub multipliers: Option<Multipliers>,
    /// Title and description.
    pub info: Info,
}

/// A global problem with its descriptive texts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Global {
    /// M, H, f, w, mu, and G, b.
    pub problem: GlobalProblem,
    /// Title and description.
    pub info: Info,
}

impl Problem {
    /// Components per contact: 2 or 3.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Local(l) => l.problem.dimension,
            Self::Global(g) => g.problem.dimension,
        }
    }

    /// Number of contacts.
    pub fn contacts(&self) -> usize {
        match self {
            Self::Local(l) => l.problem.mu.len(),
            Self::Global(g) => g.problem.mu.len(),
        }
    }

    /// Title and description.
    pub fn info(&self) -> &Info {
        match self {
            Self::Local(l) => &l.info,
            Self::Global(g) => &g.info,
        }
    }
}

/// Error in reading or writing a file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FclibError {
    /// The file cannot be opened.
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Message of the operating system.
        reason: String,
    },
    /// The file is not HDF5.
    #[error("{} is not an HDF5 file; `fretwork solve` reads FCLIB problems in HDF5", path.display())]
    NotHdf5 {
        /// The file.
        path: PathBuf,
    },
    /// An HDF5 file without an FCLIB group.
    #[error(
        "{} is an HDF5 file without an FCLIB problem: it has neither /fclib_local nor /fclib_global",
        path.display()
    )]
    NoProblem {
        /// The file.
        path: PathBuf,
    },
    /// The content violates the HDF5 format.
    #[error("{}: {place} cannot be read: {reason}; the file is damaged or cut short", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Group or dataset.
        place: String,
        /// Reason.
        reason: String,
    },
    /// Valid HDF5 of a kind that is not supported.
    #[error("{}: {place}: {reason}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Group or dataset.
        place: String,
        /// What the file contains instead, and what to do.
        reason: String,
    },
    /// A required group or dataset is missing.
    #[error("{}: {place} is missing; {reason}", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// Group or dataset.
        place: String,
        /// Description of the missing item.
        reason: String,
    },
    /// Sizes, indices or values are inconsistent.
    #[error("{}: {place}: {reason}", path.display())]
    Wrong {
        /// The file.
        path: PathBuf,
        /// Group or dataset.
        place: String,
        /// What was found and what was expected.
        reason: String,
    },
    /// The file cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    Unwritable {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
}

impl FclibError {
    fn wrong(path: &Path, place: &str, reason: impl Into<String>) -> Self {
        Self::Wrong {
            path: path.to_owned(),
            place: place.to_owned(),
            reason: reason.into(),
        }
    }

    fn missing(path: &Path, place: &str, reason: &str) -> Self {
        Self::Missing {
            path: path.to_owned(),
            place: place.to_owned(),
            reason: reason.to_owned(),
        }
    }
}

#[cfg(test)]
mod storage_tests;
