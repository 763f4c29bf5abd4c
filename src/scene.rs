//! Cases and materials, see [`fretwork_scene`]; in addition, cases can take grains from the results of other
//! runs.

pub use fretwork_scene::*;

use crate::record::results::state;
use std::path::Path;

/// Reads a case and applies the `--set` arguments; grains of another run are read from its `results.h5`.
///
/// # Errors
/// An [`InputError`] with file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, InputError> {
    Ok(fretwork_scene::load(path, sets)?.reading_records(state::read))
}
