//! Names of laws, and the folders of their libraries.

/// Environment variable with additional folders.
pub const PATH_VARIABLE: &str = "FRETWORK_PLUGIN_PATH";

/// Returns whether a law's name consists of a-z, 0-9, `-` and `_` and begins with a letter or
/// digit.
pub fn name_is_valid(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    name.chars().next().is_some_and(plain) && name.chars().all(|c| plain(c) || c == '-' || c == '_')
}
