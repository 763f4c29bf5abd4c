//! Experiments: runs of a case in processes of their own, and the questions that they answer.
//!
//! [`runs`] makes runs and keeps each under a key of all that determines it. [`study`] varies the
//! values of a case, [`fit`] finds those for which it gives measured curves, [`trade`] compares
//! accuracy with cost, [`contact_patch`] goes from a patch in closed form to the runs of a window
//! of it. The mathematics is that of [`fretwork_study`].

#![deny(clippy::print_stdout, clippy::print_stderr)]

pub mod contact_patch;
pub mod fit;
pub mod runs;
pub mod study;
pub mod trade;

use fretwork_scene::{InputError, Loaded, Scene};
use fretwork_store::results::state;
use std::path::Path;

/// Reads a case and applies the `--set` arguments; grains of another run are read from its
/// `results.h5`.
///
/// # Errors
/// At file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, InputError> {
    Ok(fretwork_scene::load(path, sets)?.reading_records(state::read))
}

/// What experiments need of the program that makes their runs.
#[derive(Clone, Debug)]
pub struct Program {
    /// Where laws are looked for.
    pub search: fretwork_core::laws::SearchPath,
    /// Arguments of each run that say the same of its plugins.
    pub plugins: Vec<String>,
    /// Refuses a case whose run has two columns or two files of one name.
    pub check_names: fn(&Loaded, &Scene) -> Result<(), InputError>,
}
