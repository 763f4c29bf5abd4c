//! Cases and materials, see [`fretwork_scene`]; in addition, cases can take grains from the results
//! of other runs.

pub use fretwork_scene::*;

use crate::record::results::state;
use std::io::Read;
use std::path::Path;

/// Reads a case and applies the `--set` arguments; grains of another run are read from its
/// `results.h5`.
///
/// # Errors
/// An [`InputError`] with file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<Loaded, InputError> {
    Ok(fretwork_scene::load(path, sets)?.reading_records(state::read))
}

/// Reads a case from a text, see [`fretwork_scene::load_text`].
///
/// # Errors
/// At name, line and column.
pub fn load_text(
    name: &str,
    text: &str,
    folder: &Path,
    sets: &[String],
) -> Result<Loaded, InputError> {
    Ok(fretwork_scene::load_text(name, text, folder, sets)?.reading_records(state::read))
}

/// Reads a case from a stream of bytes, see [`fretwork_scene::load_reader`].
///
/// # Errors
/// As [`load_text`], and what cannot be read.
pub fn load_reader(
    name: &str,
    from: impl Read,
    folder: &Path,
    sets: &[String],
) -> Result<Loaded, InputError> {
    Ok(fretwork_scene::load_reader(name, from, folder, sets)?.reading_records(state::read))
}
