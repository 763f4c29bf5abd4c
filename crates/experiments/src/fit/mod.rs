//! Fits: parameters of a case, such as those of a law, for which its runs give measured curves.
//!
//! [`spec`] is the file, [`measured`] reads a measured curve, [`model`] makes the same curve of a
//! run, [`branches`] lays loops out, [`evaluate`] runs points of the parameters over their seeds,
//! [`search`] looks for the best one, [`outcome`] says how well the measurements determine it, and
//! [`half_step`] how the time step changes it. [`page`] and [`files`] report it.

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
    mark: "fit.lock",
    files: &["fit.json"],
};
