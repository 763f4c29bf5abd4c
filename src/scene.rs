//! Cases and materials, see [`fretwork_scene`]; here cases can also take grains from the results of other runs.

pub use fretwork_scene::*;

use crate::record::results::state;
use std::path::Path;

/// Reads a case and applies `--set`s; where it takes grains from another run, they are read of its `results.h5`.
///
/// # Errors
/// At file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, InputError> {
    Ok(fretwork_scene::load(path, sets)?.reading_records(state::read))
}
