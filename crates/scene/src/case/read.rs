//! Cases from their text.

use super::Case;
use crate::source::{InputError, Names, Source};

// These functions are compiled in this crate only: the deserializers of a case are half of its
// code, and a generic call in another crate would compile them again.
impl Case {
    /// Reads the case that a text is, see [`Source::parse`].
    ///
    /// # Errors
    /// The text is no case; the error names file, line and column.
    #[inline(never)]
    pub fn read(source: &Source) -> Result<Self, InputError> {
        source.parse()
    }

    /// Changes a value of the text of a case, see [`Source::set`].
    ///
    /// # Errors
    /// The argument is malformed, or a case has no such key.
    #[inline(never)]
    pub fn set(source: &mut Source, argument: &str) -> Result<(), InputError> {
        source.set::<Self>(argument)
    }

    /// The names that may stand below a path of a case, see [`Source::names`].
    #[inline(never)]
    pub fn names(source: &Source, path: &str) -> Option<Names> {
        source.names::<Self>(path)
    }
}
