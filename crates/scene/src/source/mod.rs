//! Input text: reading, modification by `--set`, parsing, and location of errors.
//!
//! Every error names a file, a line and a column. The location comes from a [`Tree`] of the text,
//! since the position reported by ron is often not that of the cause.

mod cursor;
mod diagnostic;
mod difference;
mod explain;
mod file;
mod formats;
mod named_values;
mod names;
mod nearest;
pub mod numbers;
mod quantities;
mod repeated;
mod respell;
mod scan;
mod schema;
mod set;
mod source_map;
mod terminal;
mod tree;

#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ron::error::SpannedError;
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

pub use cursor::{CursorPlace, CursorSlot, SlotKind};
pub use diagnostic::InputError;
pub use difference::{Difference, first_difference};
pub use file::{MAX_BYTES, open, read_bytes, read_text, read_text_from};
pub use formats::{Format, fields_of};
pub use names::Names;
pub use nearest::nearest;
pub use terminal::{clean, clean_json, clean_lines, commands_a_terminal};
pub(crate) use tree::join_path;
pub use tree::{Entry, Group, MAX_DEPTH, Node, Shape, SyntaxError, Tree, ValueKind, split_path};

pub(crate) use quantities::{Place, Wanted};
pub(crate) use schema::fields_at;
use source_map::SourceMap;

/// An input text and its origin.
#[derive(Debug, Clone)]
pub struct Source {
    path: PathBuf,
    name: String,
    original: Arc<str>,
    /// The text before its units and expressions were replaced by numbers.
    written: Option<Arc<str>>,
    text: String,
    tree: Tree,
    sets: Vec<String>,
    source_map: SourceMap,
}

impl Source {
    /// Reads a file.
    ///
    /// # Errors
    /// The errors of [`read_text`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Ok(Self::from_text(path, read_text(path)?))
    }

    /// Wraps a text under a name, which errors report as the file.
    pub fn from_text(name: impl AsRef<Path>, text: impl Into<String>) -> Self {
        let path = name.as_ref().to_path_buf();
        let mut text = text.into();
        // The byte order mark that some editors write is not part of RON.
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        Self {
            name: path.display().to_string(),
            path,
            original: text.as_str().into(),
            tree: Tree::of(&text),
            source_map: SourceMap::whole(text.len()),
            sets: Vec::new(),
            written: None,
            text,
        }
    }

    /// Returns the path of the file, or the given name.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The text, with `--set` applied, and with numbers in place of units and expressions once
    /// these were replaced.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text with `--set` applied, as it was written: with units, names and expressions.
    pub fn written(&self) -> &str {
        self.written.as_deref().unwrap_or(&self.text)
    }

    /// The syntax tree of the text, with `--set` applied.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Returns the `key=value` arguments applied so far.
    pub fn sets(&self) -> &[String] {
        &self.sets
    }

    /// Parses the text.
    ///
    /// `Some` may be omitted, newtypes are written as their content, and the fields of a struct in
    /// a variant may be written in the parentheses of the variant, `Sine(frequency: 5)`, or in
    /// those of the struct, `Sine((frequency: 5))`. Lists and tuples are interchangeable, and a
    /// number is accepted for `Constant(number)` where an enum has that variant.
    ///
    /// # Errors
    /// Returns an error from ron or from the validation of `T`, at the token that caused it; or an
    /// error for a key that a map gives twice.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, InputError> {
        if let Some(refusal) = self.refuse_depth() {
            return Err(refusal);
        }
        // Keys cannot be determined if brackets do not match.
        if self.tree.fault.is_none()
            && let Some(repeated) = self.repeated_key()
        {
            return Err(repeated);
        }
        let mut error = match self.read_once() {
            Ok(value) => return Ok(value),
            Err(error) => error,
        };
        if let Some(fault) = self.tree.fault.as_ref().filter(|fault| fault.cause) {
            return Err(self.error_in(&fault.span, fault.message.clone()));
        }
        let mut source = Cow::Borrowed(self);
        for _ in 0..MAX_SPELLINGS {
            let Some((other, passed)) = source.respelled(&error) else {
                break;
            };
            match other.read_once() {
                Ok(value) => return Ok(value),
                // Only a spelling with which ron gets past the value is kept.
                Err(next) if passes(&other, &next, passed) => {
                    source = Cow::Owned(other);
                    error = next;
                }
                Err(_) => break,
            }
        }
        // Only the parser knows whether a newly set field is a text: quote its value and try again.
        if explain::expects_text(&error.code) {
            let offset = source
                .offset(&error.span.start)
                .max(source.offset(&error.span.end));
            let mut quoted = source.clone().into_owned();
            if quoted.quote_set_at(offset) || quoted.quote_set_at(offset.saturating_sub(1)) {
                return quoted.parse();
            }
        }
        Err(source.explain(&error, &Source::kinds::<T>))
    }

    /// Returns the names of the variants of the enum at a path of `T`, if there is one.
    fn kinds<T: DeserializeOwned>(&self, path: &[String]) -> Option<Vec<&'static str>> {
        let root = self.tree.root.as_ref();
        match schema::levels::<T>(&self.text, root, path).pop() {
            Some(schema::Level::Enum(variants)) => Some(variants),
            _ => None,
        }
    }

    /// Parses the text as it is written.
    fn read_once<T: DeserializeOwned>(&self) -> Result<T, SpannedError> {
        let plain = Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES;
        let options = |extensions| ron::Options::default().with_default_extension(extensions);
        let unwrapped = options(plain | Extensions::UNWRAP_VARIANT_NEWTYPES);
        let error = match unwrapped.from_str(&self.text) {
            Ok(value) => return Ok(value),
            Err(error) => error,
        };
        // ron accepts one of the two notations of newtype variants at a time.
        match options(plain).from_str(&self.text) {
            Ok(value) => Ok(value),
            Err(other) if further(&other, &error) => Err(other),
            Err(_) => Err(error),
        }
    }

    /// Creates an error at a dotted path, or at its nearest existing parent if the text omits it.
    pub fn error_at(&self, path: &str, message: impl Into<String>) -> InputError {
        let parts = tree::split_path(path).unwrap_or_default();
        match self.tree.find(&self.text, &parts) {
            Ok(node) => self.error_in(&node.head(&self.text), message),
            Err(missing) => {
                let head = missing
                    .parent
                    .map_or(0..0, |parent| parent.head(&self.text));
                self.error_in(&head, message).note(format!(
                    "`{path}` is not written in the file: its default applies"
                ))
            }
        }
    }

    /// Returns line and column of a path in the file, if the text has it.
    pub fn position_of(&self, path: &str) -> Option<(usize, usize)> {
        let parts = tree::split_path(path)?;
        let node = self.tree.find(&self.text, &parts).ok()?;
        self.error_in(&node.span, "").position()
    }

    /// Adds to an error in a file the path of the value that names that file. If the file as a
    /// whole is at fault (missing, empty), the error is located at the value; otherwise it keeps
    /// its location in the file and a note names the value.
    pub fn named_at(&self, path: &str, error: InputError) -> InputError {
        if error.is_about_a_whole_file() {
            let mut found = self.error_at(path, error.in_short());
            found.help = error.help;
            return found;
        }
        let place = self.position_of(path);
        let place = place.map_or_else(String::new, |(l, c)| format!(", {}:{l}:{c}", self.name));
        error.note(format!("the file is read for `{path}`{place}"))
    }

    /// Converts a validation error with a path into an error with a location.
    pub fn locate(&self, fault: ValidationError) -> InputError {
        let mut error = self.error_at(&fault.path, fault.message);
        if let Some(expected) = fault.expected {
            error = error.expected(expected);
        }
        error.did_you_mean(fault.nearest.as_deref())
    }

    /// Makes an error at bytes of the text in use, located in the file.
    fn error_in(&self, span: &Range<usize>, message: impl Into<String>) -> InputError {
        let place = self.source_map.place(span);
        let error = InputError::within(
            &self.name,
            self.original.clone(),
            place.span,
            message.into(),
        );
        match place
            .set
            .and_then(|(set, span)| Some((self.sets.get(set)?, span)))
        {
            Some((argument, span)) => error.brought_by(argument, span),
            None => error,
        }
    }

    fn refuse_depth(&self) -> Option<InputError> {
        let at = self.tree.too_deep?;
        let message = format!("values are nested more than {MAX_DEPTH} levels deep");
        Some(self.error_in(&(at..at + 1), message))
    }
}

/// Limit on alternative spellings tried in a parse; each attempt changes all values at the same
/// place of the schema.
const MAX_SPELLINGS: usize = 256;

/// Returns whether ron parsed beyond a byte and the white space after it.
fn passes(source: &Source, error: &SpannedError, byte: usize) -> bool {
    source.offset(&error.span.end) > byte
}

/// Returns whether `one` occurred further on in the text than `other`.
fn further(one: &SpannedError, other: &SpannedError) -> bool {
    let end = |error: &SpannedError| (error.span.end.line, error.span.end.col);
    end(one) > end(other)
}

/// A validation error: dotted path of the value, message, and description of valid input.
#[derive(Debug, Clone, PartialEq)]
pub struct ValidationError {
    /// The dotted path.
    pub path: String,
    /// Description of the error.
    pub message: String,
    /// Description of valid input.
    pub expected: Option<String>,
    /// The nearest valid name.
    pub nearest: Option<String>,
}

impl ValidationError {
    /// Makes an error at a path.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            message: message.into(),
            expected: None,
            nearest: None,
        }
    }

    /// Adds a description of valid input.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = Some(expected.into());
        self
    }

    /// Adds the names of `what` (plural) that the case has, or that it has none.
    #[must_use]
    pub fn expected_name<'a>(self, names: impl IntoIterator<Item = &'a str>, what: &str) -> Self {
        let names: Vec<&str> = names.into_iter().collect();
        if names.is_empty() {
            self.expected(format!("a case with {what}: this one has none"))
        } else {
            self.expected(format!("one of {}", names.join(", ")))
        }
    }

    /// Adds the nearest valid name.
    #[must_use]
    pub fn nearest(mut self, name: Option<&str>) -> Self {
        self.nearest = name.map(str::to_owned);
        self
    }

    /// Prepends a prefix to the path.
    #[must_use]
    pub fn under(mut self, parent: &str) -> Self {
        self.path = if self.path.is_empty() {
            parent.to_owned()
        } else {
            format!("{parent}.{}", self.path)
        };
        self
    }
}
