//! The field's shared problem files: FCLIB's HDF5 layout, read and written.
//!
//! The layout is that of `fclib.h` (github.com/FrictionalContactLibrary/fclib) and of the files at hand;
//! where the header's comments and the files disagree, the files are followed. `docs/fclib.md` has it
//! in words. The solver's side, with what the letters mean, is [`fretwork_core::solve::local`].
//!
//! A file comes from somebody else: whatever its bytes, [`read`] answers with a problem or a sentence,
//! and takes no more memory than a small multiple of the file's size.

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

/// What a file says about itself; bytes that are no text are replaced.
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

/// A local problem with what stands around it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Local {
    /// W, q, mu.
    pub problem: LocalProblem,
    /// V, R, s.
    pub multipliers: Option<Multipliers>,
    /// Title and description.
    pub info: Info,
}

/// A global problem with what stands around it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Global {
    /// M, H, f, w, mu, and G, b.
    pub problem: GlobalProblem,
    /// Title and description.
    pub info: Info,
}

impl Problem {
    /// Components of a contact: 2 or 3.
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

/// Why a file cannot be read or written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FclibError {
    /// The system does not give the file.
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: String,
    },
    /// Another kind of file.
    #[error("{} is not an HDF5 file; `fretwork solve` reads FCLIB problems in HDF5", path.display())]
    NotHdf5 {
        /// The file.
        path: PathBuf,
    },
    /// HDF5, but nothing of FCLIB's in it.
    #[error(
        "{} is an HDF5 file without an FCLIB problem: it has neither /fclib_local nor /fclib_global",
        path.display()
    )]
    NoProblem {
        /// The file.
        path: PathBuf,
    },
    /// Bytes that are not what HDF5 promises.
    #[error("{}: {place} cannot be read: {reason}; the file is damaged or cut short", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Group or dataset.
        place: String,
        /// What is wrong.
        reason: String,
    },
    /// Right in HDF5, not read here.
    #[error("{}: {place}: {reason}", path.display())]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// Group or dataset.
        place: String,
        /// What it is and what to do.
        reason: String,
    },
    /// Something the layout demands is not there.
    #[error("{}: {place} is missing; {reason}", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// Group or dataset.
        place: String,
        /// What it is.
        reason: String,
    },
    /// Sizes, indices or values that make no problem.
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
        /// Why.
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
