//! Runs of a case in separate processes, each kept under a key of all that determines it, so that none is made twice.
//!
//! [`launcher`] starts them, [`stored`] says how they ended, [`key`] names them, [`quantity`] reads the numbers that they leave,
//! [`offer`] says which a case has, [`randomness`] whether its seed matters, [`perturbation`] tells runs apart where it does not,
//! [`cost`] estimates how long one takes, [`lock`] keeps a folder for one command at a time, [`pool`] makes
//! several at once, [`cells`] guards texts in tables, [`expression`] makes changes that follow from numbers, and [`spec`] has what files of studies and fits share. [`trade`](crate::trade) and [`study`](crate::study) are made of such runs.

pub mod cells;
pub mod cost;
pub mod duration;
pub mod expression;
pub mod key;
pub mod launcher;
pub mod lock;
pub mod offer;
pub mod perturbation;
pub mod pool;
pub mod quantity;
pub mod randomness;
pub mod spec;
pub mod stored;
pub mod unit;

use fretwork_scene::InputError;
use fretwork_store::write_advice;
use std::path::{Path, PathBuf};

/// Reason why runs cannot be made or kept.
#[derive(Debug, thiserror::Error)]
pub enum RunsError {
    /// A value that a run is given is wrong.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The folder or the program is not what is needed.
    #[error("{0}")]
    Usage(String),
    /// A file or folder cannot be written.
    #[error("cannot write {}: {reason}{}", path.display(), write_advice(reason))]
    Write {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
}

impl RunsError {
    /// Error for a file that cannot be written.
    pub fn write(path: &Path, reason: &dyn std::fmt::Display) -> Self {
        Self::Write {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }
}
