//! Input text: read, changed by `--set`, parsed, and pointed at when something is wrong.
//!
//! Every error names a file, a line and a column. The place comes from a [`Tree`]
//! of the text, since the position ron reports often stands beside the cause.

mod diagnostic;
mod difference;
mod explain;
mod nearest;
pub mod numbers;
mod pieces;
mod scan;
mod set;
mod tree;

#[cfg(test)]
mod tests;

use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ron::extensions::Extensions;
use serde::de::DeserializeOwned;

pub use diagnostic::InputError;
pub use difference::{Difference, first_difference};
pub use nearest::nearest;
pub use tree::{Entry, Fault as TextFault, Group, Kind, MAX_DEPTH, Node, Shape, Tree};

use pieces::Pieces;

/// The largest input accepted, in bytes.
pub const MAX_BYTES: u64 = 64 << 20;

/// A text and where it came from.
#[derive(Debug, Clone)]
pub struct Source {
    path: PathBuf,
    name: String,
    original: Arc<str>,
    text: String,
    tree: Tree,
    sets: Vec<String>,
    pieces: Pieces,
}

impl Source {
    /// Reads a file.
    ///
    /// # Errors
    /// See [`read_text`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, InputError> {
        let path = path.as_ref();
        Ok(Self::from_text(path, read_text(path)?))
    }

    /// Takes a text under a name, which errors give as the file.
    pub fn from_text(name: impl AsRef<Path>, text: impl Into<String>) -> Self {
        let path = name.as_ref().to_path_buf();
        let mut text = text.into();
        // The byte order mark some editors write is no part of RON.
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        Self {
            name: path.display().to_string(),
            path,
            original: text.as_str().into(),
            tree: Tree::of(&text),
            pieces: Pieces::whole(text.len()),
            sets: Vec::new(),
            text,
        }
    }

    /// The path of the file, or the name given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The text in use, `--set` included.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The tree of the text in use.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// The `key=value` arguments applied so far.
    pub fn sets(&self) -> &[String] {
        &self.sets
    }

    /// Parses the text.
    ///
    /// `Some` may be left out, newtypes are written as their content, and the
    /// fields of a struct in a variant may stand in the variant's own
    /// parentheses, `Sine(frequency: 5)`, or in theirs, `Sine((frequency: 5))`.
    ///
    /// # Errors
    /// What ron or `T` refuses, at the token at fault.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, InputError> {
        if let Some(refusal) = self.refuse_depth() {
            return Err(refusal);
        }
        let plain = Extensions::IMPLICIT_SOME | Extensions::UNWRAP_NEWTYPES;
        let options = |extensions| ron::Options::default().with_default_extension(extensions);
        let unwrapped = options(plain | Extensions::UNWRAP_VARIANT_NEWTYPES);
        let error = match unwrapped.from_str(&self.text) {
            Ok(value) => return Ok(value),
            Err(error) => error,
        };
        // ron takes one spelling of newtype variants or the other, never both.
        let error = match options(plain).from_str(&self.text) {
            Ok(value) => return Ok(value),
            Err(other) if further(&other, &error) => other,
            Err(_) => error,
        };
        // Whether a new field is a text shows only here: quote its value after all.
        if error.code == ron::Error::ExpectedString {
            let offset = self
                .offset(&error.span.start)
                .max(self.offset(&error.span.end));
            let mut quoted = self.clone();
            if quoted.quote_set_at(offset) || quoted.quote_set_at(offset.saturating_sub(1)) {
                return quoted.parse();
            }
        }
        Err(self.explain(&error))
    }

    /// An error at a dotted path; at its nearest parent when the text leaves it out.
    pub fn error_at(&self, path: &str, message: impl Into<String>) -> InputError {
        let parts = tree::split_path(path).unwrap_or_default();
        match self.tree.find(&self.text, &parts) {
            Ok(node) => self.error_in(&node.head(&self.text), message),
            Err(missing) => {
                let head = missing
                    .parent
                    .map_or(0..0, |parent| parent.head(&self.text));
                self.error_in(&head, message).note(format!(
                    "`{path}` is not written in the file: its default stands"
                ))
            }
        }
    }

    /// The line and column of a path in the file, if the text holds it.
    pub fn position_of(&self, path: &str) -> Option<(usize, usize)> {
        let parts = tree::split_path(path)?;
        let node = self.tree.find(&self.text, &parts).ok()?;
        self.error_in(&node.span, "").position()
    }

    /// Finishes an error that knows its path.
    pub fn locate(&self, fault: Fault) -> InputError {
        let mut error = self.error_at(&fault.path, fault.message);
        if let Some(expected) = fault.expected {
            error = error.expected(expected);
        }
        error.did_you_mean(fault.nearest.as_deref())
    }

    /// An error at bytes of the text in use, told in terms of the file.
    fn error_in(&self, span: &Range<usize>, message: impl Into<String>) -> InputError {
        let place = self.pieces.place(span);
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

/// Reads a text file.
///
/// # Errors
/// A file that is missing, unreadable, a folder, too large, empty, or not UTF-8.
pub fn read_text(path: &Path) -> Result<String, InputError> {
    let refused = |message: String| InputError::about(path.display(), message);
    let unreadable = |error: std::io::Error| InputError::file(path, &error);
    let file = std::fs::File::open(path).map_err(unreadable)?;
    if file.metadata().map_err(unreadable)?.is_dir() {
        return Err(refused("cannot be read: it is a folder, not a file".into()));
    }
    // The length a file declares is not to be trusted: a device has none.
    let mut bytes = Vec::new();
    let mut limited = file.take(MAX_BYTES + 1);
    limited.read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MAX_BYTES {
        let most = MAX_BYTES >> 20;
        return Err(refused(format!("is larger than {most} MiB")));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..valid]).into_owned();
        InputError::at(
            &path.display().to_string(),
            &before,
            valid..valid,
            "is not UTF-8 text",
        )
        .help("save the file as UTF-8")
    })?;
    if text.trim_start_matches('\u{feff}').trim().is_empty() {
        return Err(refused("is empty".into()));
    }
    Ok(text)
}

/// Whether `one` was found further into the text than `other`.
fn further(one: &ron::error::SpannedError, other: &ron::error::SpannedError) -> bool {
    let end = |error: &ron::error::SpannedError| (error.span.end.line, error.span.end.col);
    end(one) > end(other)
}

/// A fault found after parsing: where (a dotted path), what, what was expected.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// The dotted path.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// What was expected.
    pub expected: Option<String>,
    /// The nearest valid name.
    pub nearest: Option<String>,
}

impl Fault {
    /// A fault at a path.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            message: message.into(),
            expected: None,
            nearest: None,
        }
    }

    /// Adds what was expected.
    #[must_use]
    pub fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = Some(expected.into());
        self
    }

    /// Adds the nearest valid name.
    #[must_use]
    pub fn nearest(mut self, name: Option<&str>) -> Self {
        self.nearest = name.map(str::to_owned);
        self
    }

    /// Puts a path in front of its own.
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
