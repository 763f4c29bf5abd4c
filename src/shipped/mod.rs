//! What is shipped inside the program: the laws, so that it runs without library files, and cases.

#[cfg(feature = "program")]
pub mod inputs;

use crate::laws::{BuiltInLaws, SearchPath};
use std::sync::OnceLock;

/// The shipped laws, for [`crate::laws::SearchPath::with_built_in`].
pub fn built_in() -> BuiltInLaws {
    static LAWS: OnceLock<BuiltInLaws> = OnceLock::new();
    LAWS.get_or_init(|| BuiltInLaws::new(fretwork_laws::plugins()))
        .clone()
}

/// Returns a search path with the shipped laws, for programs that use this library. The folders of
/// the environment variable `FRETWORK_PLUGIN_PATH` come after them; [`SearchPath::new`] takes
/// further folders.
pub fn search_path() -> SearchPath {
    SearchPath::new(&[]).with_built_in(built_in())
}
