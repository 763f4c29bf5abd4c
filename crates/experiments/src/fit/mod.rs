//! Fits: parameters of a case, such as those of a law, for which its runs reproduce measured
//! curves.
//!
//! [`spec`] is the file, [`measured`] reads a measured curve, [`model`] computes the corresponding
//! curve of a run, [`branches`] places the branches of loops, [`evaluate`] runs points of the
//! parameters over their seeds, [`search`] finds the best one, [`outcome`] determines intervals,
//! and [`half_step`] the effect of the time step. [`page`] and [`files`] report it.

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

use crate::folder::Owner;

/// The owner of folders of fits.
pub const OWNER: Owner = Owner {
    command: "fretwork fit",
    lock_file: "fit.lock",
    files: &["fit.json"],
};
