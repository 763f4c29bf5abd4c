//! A case written back as text.

use super::Case;
use crate::source::InputError;
use ron::extensions::Extensions;
use ron::ser::PrettyConfig;
use serde::Serialize;

impl Case {
    /// Returns the case as RON, with all numbers, including defaults; empty lists and options are
    /// omitted. Reading it gives an equal case, to the last bit. Comments of a file, `source`s of
    /// numbers and the spelling are lost.
    ///
    /// # Errors
    /// The case has a value that no case file can contain: the error norm `Field`.
    ///
    /// # Examples
    /// ```
    /// use fretwork_scene::{CaseBuilder, load_text};
    ///
    /// let case = CaseBuilder::in_plane("a ball").time(1e-3, 0.1).material("steel", "rail_steel_r260").case();
    /// let again = load_text("again.ron", &case.to_ron()?, "".as_ref(), &[])?.case;
    /// assert_eq!(again, case);
    /// # Ok::<(), fretwork_scene::InputError>(())
    /// ```
    pub fn to_ron(&self) -> Result<String, InputError> {
        write("the case", self)
    }
}

/// A value as RON in the spelling of case files.
pub(crate) fn write(what: &str, value: &impl Serialize) -> Result<String, InputError> {
    // This is the spelling in which case files are read, see `Source::parse`.
    let spelling = Extensions::IMPLICIT_SOME
        | Extensions::UNWRAP_NEWTYPES
        | Extensions::UNWRAP_VARIANT_NEWTYPES;
    let layout = PrettyConfig::new().compact_arrays(true).new_line("\n");
    let text = ron::Options::default()
        .with_default_extension(spelling)
        .to_string_pretty(value, layout)
        .map_err(|e| InputError::about(what, format!("cannot be written as RON: {e}")))?;
    Ok(text + "\n")
}
