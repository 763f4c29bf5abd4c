//! Cases and materials, see [`fretwork_scene`]; with the feature `results`, cases can take grains
//! from the results of other runs.

pub use fretwork_scene::*;

use std::io::Read;
use std::path::Path;

/// Reads a case and applies the `--set` arguments; grains of another run are read from its
/// `results.h5`.
///
/// # Errors
/// An [`InputError`] with file, line and column.
pub fn load(path: &Path, sets: &[String]) -> Result<LoadedCase, InputError> {
    fretwork_scene::load(path, sets).map(reading_records)
}

/// Reads a case from a text, see [`fretwork_scene::load_text`].
///
/// # Errors
/// The text is invalid; the error gives the name of the case, line and column.
pub fn load_text(
    name: &str,
    text: &str,
    folder: &Path,
    sets: &[String],
) -> Result<LoadedCase, InputError> {
    fretwork_scene::load_text(name, text, folder, sets).map(reading_records)
}

/// Reads a case from a stream of bytes, see [`fretwork_scene::load_reader`].
///
/// # Errors
/// The text is invalid, with the name of the case, line and column, or the stream cannot be read.
pub fn load_reader(
    name: &str,
    from: impl Read,
    folder: &Path,
    sets: &[String],
) -> Result<LoadedCase, InputError> {
    fretwork_scene::load_reader(name, from, folder, sets).map(reading_records)
}

#[cfg(feature = "results")]
fn reading_records(loaded: LoadedCase) -> LoadedCase {
    loaded.reading_records(crate::record::results::state::read)
}

#[cfg(not(feature = "results"))]
fn reading_records(loaded: LoadedCase) -> LoadedCase {
    loaded
}
