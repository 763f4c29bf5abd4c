//! The folder of the user for what the program can make again.

use etcetera::BaseStrategy;
use std::io;
use std::path::PathBuf;

/// Returns the folder, which may not exist yet: `fretwork` in the user's cache folder.
///
/// # Errors
/// Where the system names no folder of the user.
pub fn cache_folder() -> io::Result<PathBuf> {
    let folders = etcetera::choose_base_strategy().map_err(io::Error::other)?;
    Ok(folders.cache_dir().join("fretwork"))
}
