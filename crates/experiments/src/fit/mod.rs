//! Fits: parameters of a case, such as those of a law, for which its runs give measured curves.
//!
//! [`spec`] is the file, [`measured`] reads a measured curve, [`model`] makes the same curve of a run, [`branches`] lays loops out, [`evaluate`] runs points of
//! the parameters over their seeds, [`search`] looks for the best one, [`outcome`] says how well the measurements determine it, and [`half_step`] what the step does to it.
//! [`page`] and [`files`] tell it.

mod branches;
pub mod evaluate;

pub mod files;
pub mod half_step;
pub mod measured;
pub mod model;
pub mod outcome;
pub mod page;
pub mod search;

pub mod spec;

use crate::runs::RunsError;
use crate::runs::lock::Owner;
use fretwork_scene::InputError;

/// The owner of folders of fits.
pub const OWNER: Owner = Owner {
    command: "fretwork fit",
    mark: "fit.lock",
    files: &["fit.json"],
};

/// Reason why a fit cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum FitError {
    /// The fit or a case is wrong, at a place of a file.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A run cannot be made or kept, or a file cannot be written.
    #[error(transparent)]
    Runs(#[from] RunsError),
    /// The measurements or the ranges do not allow it.
    #[error("{0}")]
    Usage(String),
    /// It ran and found nothing.
    #[error("{0}")]
    Failed(String),
}
