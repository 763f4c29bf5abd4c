//! Input text: read, changed by `--set`, parsed, and pointed at when something in it is wrong.

mod diagnostic;
mod tree;

pub use diagnostic::{InputError, nearest};

use ron::error::{Error as RonError, Position};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
use std::ops::Range;
use std::path::Path;
use tree::{Inside, Node};

/// Largest input file (bytes).
const MOST_BYTES: u64 = 64 << 20;

/// The text of a case or material file.
#[derive(Clone, Debug)]
pub struct Source {
    name: String,
    text: String,
    tree: Node,
}

impl Source {
    /// Reads a file.
    ///
    /// # Errors
    /// A file that is missing, unreadable, too large, not UTF-8 or nested too deeply.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let unreadable = |e: std::io::Error| InputError::unreadable(path, &e);
        let size = std::fs::metadata(path).map_err(unreadable)?.len();
        if size > MOST_BYTES {
            return Err(InputError::about(
                path.display(),
                format!("is too large ({size} bytes); the most is {MOST_BYTES}"),
            ));
        }
        let bytes = std::fs::read(path).map_err(unreadable)?;
        let text = String::from_utf8(bytes).map_err(|e| {
            InputError::about(
                path.display(),
                format!("is not UTF-8 text (byte {})", e.utf8_error().valid_up_to()),
            )
        })?;
        Self::from_text(&path.display().to_string(), text)
    }

    /// Takes a text.
    ///
    /// # Errors
    /// Nested too deeply.
    pub fn from_text(name: &str, text: String) -> Result<Self, InputError> {
        match tree::read(&text) {
            Ok(tree) => Ok(Self {
                name: name.to_owned(),
                text,
                tree,
            }),
            Err(tree::TooDeep(at)) => {
                let message = format!("nested more than {} levels deep", tree::MOST_LEVELS);
                Err(InputError::at(name, &text, at..at + 1, message))
            }
        }
    }

    /// The text as it stands, `--set` included.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Applies `key.path=value`.
    ///
    /// # Errors
    /// No `=`, or a path whose parent is not in the text.
    pub fn set(&mut self, assignment: &str) -> Result<(), InputError> {
        let subject = format!("--set {assignment}");
        let Some((path, value)) = assignment.split_once('=') else {
            return Err(InputError::about(subject, "has no `=`").expected("key.path=value"));
        };
        let (path, value) = (path.trim(), value.trim());
        if path.is_empty() || value.is_empty() {
            return Err(
                InputError::about(subject, "needs a key and a value").expected("key.path=value")
            );
        }
        let parts: Vec<&str> = path.split('.').collect();
        let (node, used) = self.tree.follow(&parts, &self.text);
        if used == parts.len() {
            let old = &self.text[node.span.clone()];
            let word = value
                .chars()
                .all(|c| c.is_alphanumeric() || "-_./ ".contains(c));
            let quoted = old.starts_with('"') && !value.starts_with('"') && word;
            let new = if quoted {
                format!("\"{value}\"")
            } else {
                value.to_owned()
            };
            self.text.replace_range(node.span.clone(), &new);
        } else if let (true, Inside::Members { open, quoted, .. }) =
            (used + 1 == parts.len(), &node.inside)
        {
            // A member with a default: serde refuses it if there is no such.
            let key = parts[used];
            let new = if *quoted {
                format!("\"{key}\": {value},")
            } else {
                format!("{key}: {value},")
            };
            self.text.insert_str(*open, &new);
        } else {
            let names = node.children(&self.text);
            let near = nearest(parts[used], names.iter().map(String::as_str));
            let place = if used == 0 {
                "the case".to_owned()
            } else {
                format!("`{}`", parts[..used].join("."))
            };
            let message = format!("there is no `{}` in {place}", parts[used]);
            let error = InputError::about(subject, message)
                .expected(format!("one of {}", names.join(", ")));
            return Err(error.did_you_mean(near));
        }
        let changed = Self::from_text(&self.name, std::mem::take(&mut self.text))?;
        *self = changed;
        Ok(())
    }

    /// Parses the text.
    ///
    /// # Errors
    /// What ron or the type refuses, at its place.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, InputError> {
        let extensions = Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES;
        let options = ron::Options::default().with_default_extension(extensions);
        options.from_str(&self.text).map_err(|e| self.explain(&e))
    }

    /// An error at a dotted path; where the path is not in the text, at its nearest parent.
    pub fn error_at(&self, path: &str, message: impl Into<String>) -> InputError {
        let parts: Vec<&str> = path.split('.').filter(|p| !p.is_empty()).collect();
        let (node, used) = self.tree.follow(&parts, &self.text);
        let mut span = node.span.clone();
        if used < parts.len() || matches!(node.inside, Inside::Members { .. }) {
            // Point at the head, not at pages of text.
            let head = self.text[span.clone()]
                .find(['\n', '{', '['])
                .unwrap_or(span.len());
            span.end = span.start + head.clamp(1, span.len().max(1));
        }
        InputError::at(&self.name, &self.text, span, message)
    }

    /// Finishes an error that knows its path.
    pub fn locate(&self, fault: Fault) -> InputError {
        let mut error = self.error_at(&fault.path, fault.message);
        if let Some(expected) = fault.expected {
            error = error.expected(expected);
        }
        error.did_you_mean(fault.nearest.as_deref())
    }

    fn offset(&self, position: Position) -> usize {
        let line = position.line.saturating_sub(1);
        let start: usize = self
            .text
            .split_inclusive('\n')
            .take(line)
            .map(str::len)
            .sum();
        let rest = &self.text[start.min(self.text.len())..];
        let column = rest
            .char_indices()
            .nth(position.col.saturating_sub(1))
            .map_or(rest.len(), |c| c.0);
        start + column
    }

    /// The last mention of a word before a place.
    fn token(&self, word: &str, range: &Range<usize>) -> Range<usize> {
        let mut end = (range.end + word.len()).min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        match self.text[..end].rfind(word) {
            Some(at) if !word.is_empty() => at..at + word.len(),
            _ => range.clone(),
        }
    }

    fn explain(&self, error: &ron::error::SpannedError) -> InputError {
        let range = self.offset(error.span.start)..self.offset(error.span.end);
        let at = |span, message: String| InputError::at(&self.name, &self.text, span, message);
        let list = |names: &[&str]| format!("one of {}", names.join(", "));
        match &error.code {
            RonError::NoSuchStructField {
                expected,
                found,
                outer,
            } => {
                let place = outer.as_ref().map_or(String::new(), |o| format!(" in {o}"));
                at(
                    self.token(found, &range),
                    format!("unknown field `{found}`{place}"),
                )
                .expected(list(expected))
                .did_you_mean(nearest(found, expected.iter().copied()))
            }
            RonError::NoSuchEnumVariant {
                expected, found, ..
            } => at(
                self.token(found, &range),
                format!("unknown choice `{found}`"),
            )
            .expected(list(expected))
            .did_you_mean(nearest(found, expected.iter().copied())),
            RonError::MissingStructField { field, outer } => {
                let place = outer.as_ref().map_or(String::new(), |o| format!(" in {o}"));
                at(range, format!("the field `{field}` is missing{place}"))
            }
            RonError::DuplicateStructField { field, .. } => at(
                self.token(field, &range),
                format!("the field `{field}` is given twice"),
            ),
            RonError::InvalidValueForType { expected, found } => at(
                self.value_before(&range),
                format!("wrong value: found {found}"),
            )
            .expected(expected.clone()),
            RonError::Message(message) => at(self.value_before(&range), message.clone()),
            other => {
                let blank =
                    self.text[range.start..].len() - self.text[range.start..].trim_start().len();
                let start = range.start + blank;
                at(start..range.end.max(start), other.to_string())
            }
        }
    }

    /// The innermost scalar that ends at or just before a place: what serde judged.
    fn value_before(&self, range: &Range<usize>) -> Range<usize> {
        fn last(node: &Node, end: usize, best: &mut Option<Range<usize>>) {
            match &node.inside {
                Inside::Scalar => {
                    if node.span.start <= end
                        && best.as_ref().is_none_or(|b| node.span.start > b.start)
                    {
                        *best = Some(node.span.clone());
                    }
                }
                Inside::Members { members, .. } => {
                    members.iter().for_each(|m| last(&m.2, end, best))
                }
                Inside::Items(items) => items.iter().for_each(|n| last(n, end, best)),
            }
        }
        let mut best = None;
        last(&self.tree, range.end.saturating_sub(1), &mut best);
        best.unwrap_or_else(|| range.clone())
    }
}

/// A fault found after parsing: where (a dotted path), what, what was expected.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Dotted path.
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

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, Deserialize, PartialEq)]
    #[serde(deny_unknown_fields)]
    struct Case {
        name: String,
        step: f64,
        drive: Option<Drive>,
        #[serde(default)]
        seed: u64,
    }

    #[derive(Debug, Deserialize, PartialEq)]
    enum Drive {
        Sine { amplitude: f64, frequency: f64 },
        Constant(f64),
    }

    const TEXT: &str = "(\n  name: \"a\", // µ\n  step: 1e-3,\n  drive: Sine(amplitude: 2.0, frequency: 50.0),\n)\n";

    fn source() -> Source {
        Source::from_text("case.ron", TEXT.into()).unwrap()
    }

    #[test]
    fn set_replaces_inserts_and_quotes() {
        let mut s = source();
        for assignment in ["step=2e-3", "name=b c", "drive.amplitude=7", "seed=4"] {
            s.set(assignment).unwrap();
        }
        let case: Case = s.parse().unwrap();
        assert_eq!((case.name.as_str(), case.step, case.seed), ("b c", 2e-3, 4));
        assert_eq!(
            case.drive,
            Some(Drive::Sine {
                amplitude: 7.0,
                frequency: 50.0
            })
        );
        s.set("drive=Constant(3.0)").unwrap();
        assert_eq!(s.parse::<Case>().unwrap().drive, Some(Drive::Constant(3.0)));
    }

    #[test]
    fn set_says_what_is_wrong() {
        assert!(
            source()
                .set("step")
                .unwrap_err()
                .to_string()
                .contains("has no `=`")
        );
        let e = source().set("driv.amplitude=1").unwrap_err().to_string();
        assert!(e.contains("did you mean `drive`?"), "{e}");
    }

    fn refused(text: &str) -> String {
        Source::from_text("case.ron", text.into())
            .unwrap()
            .parse::<Case>()
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn errors_stand_at_their_token() {
        let e = refused(&TEXT.replace("step:", "stepp:"));
        assert!(
            e.starts_with("case.ron:3:3: error: unknown field `stepp`"),
            "{e}"
        );
        assert!(e.contains("did you mean `step`?"), "{e}");
        let e = refused(&TEXT.replace("Sine", "Sin"));
        assert!(
            e.starts_with("case.ron:4:10: error: unknown choice `Sin`"),
            "{e}"
        );
        let e = refused(&TEXT.replace("1e-3", "\"x\""));
        assert!(e.starts_with("case.ron:3:9: "), "{e}");
        let e = refused(&TEXT.replace("  step: 1e-3,\n", ""));
        assert!(e.contains("the field `step` is missing"), "{e}");
        assert!(refused("(name: ").starts_with("case.ron:1:"));
        let deep = Source::from_text("d", "[".repeat(1000))
            .unwrap_err()
            .to_string();
        assert!(deep.contains("levels deep"), "{deep}");
    }

    #[test]
    fn faults_point_at_paths() {
        let e = source()
            .locate(Fault::new("drive.frequency", "must not be 50").expected("less"))
            .to_string();
        assert!(
            e.starts_with("case.ron:4:42: error: must not be 50; expected less"),
            "{e}"
        );
        let e = source().error_at("drive.phase.deep", "x").to_string();
        assert!(e.starts_with("case.ron:4:10"), "{e}");
    }
}
