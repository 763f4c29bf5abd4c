//! Translation of errors from ron to messages about the user's file.

use std::ops::Range;

use ron::error::{Error as RonError, Position, SpannedError};

use super::respell::Step;
use super::scan::starts_word;
use super::set::{one_of, shorten};
use super::tree::{Node, Shape, ValueKind, join_path, plain};
use super::{InputError, MAX_DEPTH, Source, nearest};
use crate::case::TEXT_OR_MATERIAL;
use crate::quantity;

/// Gives the names of the variants of the enum at a path of the schema, if there is one.
pub(super) type Kinds<'a> = &'a dyn Fn(&Source, &[String]) -> Option<Vec<&'static str>>;

impl Source {
    /// Returns the byte offset of a position reported by ron (lines and columns in characters).
    pub(super) fn offset(&self, position: &Position) -> usize {
        let lines = self.text.split_inclusive('\n');
        let before = lines.take(position.line.saturating_sub(1));
        let start: usize = before.map(str::len).sum();
        let mut columns = self.text[start..].char_indices();
        let column = columns.nth(position.col.saturating_sub(1));
        column.map_or(self.text.len(), |(column, _)| start + column)
    }

    /// Converts an error from ron, located at the token that caused it.
    /// `kinds` gives the names of the variants that may stand at a path.
    pub(super) fn explain(&self, error: &SpannedError, kinds: Kinds<'_>) -> InputError {
        let error = self.locate_parse_error(error, kinds);
        // An unclosed bracket makes the text after it look wrong: report it as well.
        match &self.tree.fault {
            Some(fault) if fault.message != error.message => {
                let cause = self.error_in(&fault.span, "");
                let (line, column) = cause.position().unwrap_or_default();
                error.note(format!("{line}:{column}: {}", fault.message))
            }
            _ => error,
        }
    }

    fn locate_parse_error(&self, error: &SpannedError, kinds: Kinds<'_>) -> InputError {
        let start = self.offset(&error.span.start);
        let end = self.offset(&error.span.end).max(start);
        match &error.code {
            RonError::NoSuchStructField {
                expected,
                found,
                outer,
            } => {
                let span = self.word(found, end);
                let place = self.owner(outer.as_deref(), &span);
                let known = if expected.is_empty() {
                    "no field".to_owned()
                } else {
                    one_of(expected)
                };
                self.error_in(&span, format!("unknown field `{found}`{place}"))
                    .expected(known)
                    .did_you_mean(nearest(found, expected.iter().copied()))
            }
            RonError::NoSuchEnumVariant {
                expected,
                found,
                outer,
            } => {
                let span = self.word(found, end);
                let around = self.tree.around(span.start);
                let path = around.and_then(|node| self.path_to(&node.span));
                let place = path.map(|path| format!(" for {path}"));
                let place = place.or_else(|| outer.as_ref().map(|outer| format!(" in {outer}")));
                let message = format!("unknown variant `{found}`{}", place.unwrap_or_default());
                self.error_in(&span, message)
                    .expected(one_of(expected))
                    .did_you_mean(nearest(found, expected.iter().copied()))
            }
            RonError::DuplicateStructField { field, outer } => {
                let span = self.word(field, end);
                let place = self.owner(outer.as_deref(), &span);
                let error =
                    self.error_in(&span, format!("the field `{field}` is given twice{place}"));
                match self.earlier_field(field, &span) {
                    Some(first) => {
                        error.note(format!("first given at {}", self.place_in_words(&first)))
                    }
                    None => error,
                }
            }
            RonError::MissingStructField { field, outer } => {
                self.missing(field, outer.as_deref(), end)
            }
            RonError::InvalidValueForType { expected, found } => {
                let written = self.tree.ending_at(end).or_else(|| self.tree.around(end));
                // ron reads a name as a value of the type of no fields.
                if let Some(node) = written.filter(|n| matches!(n.kind, ValueKind::Word)) {
                    return self.wrong_type(node, expected);
                }
                let message = format!("wrong value: found {}", shorten(found));
                self.error_in(&self.validated_span(start, end), message)
                    .expected(expected.clone())
            }
            RonError::ExpectedDifferentLength { expected, found } => {
                let elements = if *found == 1 { "element" } else { "elements" };
                let around = self.tree.around(end).or_else(|| self.tree.ending_at(end));
                let span = around.map_or(start..end, |node| node.head(&self.text));
                self.error_in(&span, format!("wrong length: found {found} {elements}"))
                    .expected(expected.clone())
            }
            RonError::Message(message) => self.validation_error(message, start, end),
            RonError::ExpectedDifferentStructName { expected, found } => {
                let span = self.word(found, end);
                self.error_in(&span, format!("wrong struct name `{found}`"))
                    .expected(format!("`{expected}(...)` or `(...)`"))
                    .did_you_mean(nearest(found, [*expected]))
            }
            RonError::ExceededRecursionLimit => {
                let message = format!("values are nested more than {MAX_DEPTH} levels deep");
                self.error_in(&(end..end + 1), message)
            }
            other => self.syntax(other, start, end, kinds),
        }
    }

    /// Returns the first field of this name in the struct that contains the repeated field at
    /// `again`.
    fn earlier_field(&self, field: &str, again: &Range<usize>) -> Option<Range<usize>> {
        let group = self.tree.around(again.start)?.group()?;
        let mut keys = group.entries.iter().filter_map(|entry| entry.key.as_ref());
        keys.find(|key| plain(&self.text[(*key).clone()]) == plain(field))
            .filter(|key| key.start < again.start)
            .cloned()
    }

    /// The last occurrence of a word before `limit`.
    fn word(&self, word: &str, limit: usize) -> Range<usize> {
        let found = self.tree.last_word(&self.text, plain(word), limit);
        found.unwrap_or_else(|| {
            let text = self.text.get(..limit).unwrap_or_default();
            let at = text.rfind(word).filter(|_| !word.is_empty());
            at.map_or(limit..limit, |at| at..at + word.len())
        })
    }

    /// Returns ` in Name`, from the written name, the path or the type of the struct.
    fn owner(&self, outer: Option<&str>, inside: &Range<usize>) -> String {
        let outer = outer.map(str::to_owned);
        let written = || {
            let node = self.tree.around(inside.start)?;
            let name = node.group()?.name.clone()?;
            Some(plain(&self.text[name]).to_owned())
        };
        let path = || {
            let node = self.tree.around(inside.start)?;
            self.path_to(&node.span)
        };
        let place = written().or_else(path).or(outer);
        place
            .map(|place| format!(" in {place}"))
            .unwrap_or_default()
    }

    pub(super) fn path_to(&self, span: &Range<usize>) -> Option<String> {
        let path = self.tree.path_of(&self.text, span);
        (!path.is_empty()).then(|| format!("`{}`", join_path(&path)))
    }

    fn missing(&self, field: &str, outer: Option<&str>, end: usize) -> InputError {
        // ron stopped at the closing bracket; pointing at the head of the struct is clearer.
        let around = self.tree.around(end).filter(|node| node.group().is_some());
        let Some(node) = around.or_else(|| self.tree.ending_at(end)) else {
            let place = outer
                .map(|outer| format!(" in {outer}"))
                .unwrap_or_default();
            return self.error_in(
                &(end..end),
                format!("the field `{field}` is missing{place}"),
            );
        };
        let inside = node.span.end.saturating_sub(1)..node.span.end;
        let place = self.owner(outer, &inside);
        let message = format!("the field `{field}` is missing{place}");
        let error = self.error_in(&node.head(&self.text), message);
        // A misspelt field is reported as missing where unknown fields are accepted.
        let written = node.choices(&self.text);
        let near = nearest(field, written.iter().map(String::as_str));
        match near.filter(|near| *near != field) {
            Some(near) => error.help(format!("is `{near}` meant to be `{field}`?")),
            None => error,
        }
    }

    /// Returns the value that a type has just validated: the one that ends or begins here.
    fn validated_span(&self, start: usize, end: usize) -> Range<usize> {
        let node = self.tree.ending_at(end).or_else(|| self.tree.around(end));
        node.map_or(start..end, |node| node.head(&self.text))
    }

    /// Creates an error reported by a type's validation; its message may continue a sentence that
    /// begins with the field's name.
    fn validation_error(&self, message: &str, start: usize, end: usize) -> InputError {
        let span = self.validated_span(start, end);
        let predicate = ["must ", "is ", "has ", "cannot "];
        let follows = predicate.iter().any(|word| message.starts_with(word));
        let node = self.tree.ending_at(end);
        let path = node
            .filter(|_| follows)
            .and_then(|node| self.path_to(&node.span));
        match path {
            Some(path) => self.error_in(&span, format!("{path} {message}")),
            None => self.error_in(&span, message),
        }
    }

    /// Returns the error of a number with a unit where the parser takes none.
    fn unit_at_fault(&self, code: &RonError, start: usize, end: usize) -> Option<InputError> {
        let at = |offset: usize| {
            let around = self.tree.around(offset);
            let found = around.into_iter().chain(self.tree.ending_at(offset));
            found
                .into_iter()
                .find(|n| matches!(n.kind, ValueKind::Quantity(_)))
        };
        let node = at(end).or_else(|| at(start))?;
        let ValueKind::Quantity(unit) = &node.kind else {
            return None;
        };
        if expects_text(code) {
            return Some(self.wrong_type(node, "a text in quotes"));
        }
        let path = self.path_to(&node.span);
        let place = path.map_or_else(String::new, |path| format!(" for {path}"));
        let message = format!(
            "a unit, `{}`, is not read here{place}",
            &self.text[unit.clone()]
        );
        let error = self.error_in(unit, message);
        Some(error.expected("the number alone, in SI units"))
    }

    fn syntax(&self, code: &RonError, start: usize, end: usize, kinds: Kinds<'_>) -> InputError {
        if let Some(fault) = self.tree.fault.as_ref().filter(|fault| fault.at <= end) {
            return self.error_in(&fault.span, fault.message.clone());
        }
        if let Some(found) = self.unit_at_fault(code, start, end) {
            return found;
        }
        let text = &self.text;
        // The white space that ron left before the token is skipped.
        let rest = text[end..].trim_start();
        let token = if rest.is_empty() {
            end
        } else {
            text.len() - rest.len()
        };
        let node = self
            .tree
            .around(end)
            .filter(|node| node.group().is_none() || node.span.start == end);
        let node = node.or_else(|| {
            self.tree
                .around(token)
                .filter(|node| node.span.start == token)
        });
        let spare = matches!(
            code,
            RonError::ExpectedComma
                | RonError::ExpectedArrayEnd
                | RonError::ExpectedStructLikeEnd
                | RonError::ExpectedOptionEnd
                | RonError::ExpectedMapEnd
                | RonError::TrailingCharacters
        );
        if let Some(node) = node {
            let within = node.span.start < end && matches!(node.kind, ValueKind::Number);
            if within && spare {
                return self.wrong_type(node, "an integer");
            }
            let name = matches!(
                code,
                RonError::ExpectedIdentifier
                    | RonError::SuggestRawIdentifier(_)
                    | RonError::InvalidIdentifier(_)
            );
            if name && self.is_time_function(node) {
                return self.wrong_type(node, TIME_FUNCTION);
            }
            let quoted = matches!(node.kind, ValueKind::Text);
            let path = self.tree.path_of(text, &node.span);
            if let Some(variants) = kinds(self, &path).filter(|_| name && !quoted) {
                return self.wrong_type(node, &one_of(&variants));
            }
            if let Some(expected) = expected_type(code) {
                return self.wrong_type(node, &expected);
            }
        }
        if let RonError::IntegerOutOfBounds = code {
            let span = self.validated_span(start, end);
            let written = text[span.clone()].to_owned();
            let negative = written.starts_with('-');
            let error = self.error_in(
                &span,
                format!("the number `{}` is out of range", shorten(&written)),
            );
            return if negative {
                error.expected("a number from 0 up, or closer to 0")
            } else {
                error
            };
        }
        let next = text[token..].chars().next();
        let width = next.map_or(0, char::len_utf8);
        let span = node.map_or(token..token + width, |node| node.head(text));
        if spare && next.is_some() {
            let surplus = "one value too many, or a bracket that closes too late";
            return self.error_in(&span, surplus);
        }
        let word = self.word_at(token);
        match (expected_type(code), next) {
            (Some(expected), Some(_)) if expects_text(code) && !word.is_empty() => {
                let error = self.error_in(
                    &(token..token + word.len()),
                    format!("found the word `{word}`"),
                );
                error.expected(expected).help(format!("write `\"{word}\"`"))
            }
            (Some(expected), Some(')' | ']' | '}' | ',')) => self
                .error_in(&span, "a value is missing")
                .expected(expected),
            (Some(expected), Some(found)) => self
                .error_in(&span, format!("found `{found}`"))
                .expected(expected),
            (Some(expected), None) => self
                .error_in(&span, "the text ends too early")
                .expected(expected),
            (None, _) => self.error_in(&span, sentence(code, word)),
        }
    }

    /// Returns the word that begins at a byte; empty if there is none.
    fn word_at(&self, at: usize) -> &str {
        let rest = self.text.get(at..).unwrap_or_default();
        let end = rest.find(|c: char| c != '_' && !c.is_alphanumeric());
        let word = &rest[..end.unwrap_or(rest.len())];
        if word.starts_with(starts_word) {
            word
        } else {
            ""
        }
    }

    /// Returns whether a function of time is expected at this value.
    fn is_time_function(&self, node: &Node) -> bool {
        let way = self.steps_to(&node.span);
        // The list of `Axes([...])` adds one level to the path.
        way.iter().rev().take(2).any(|step| match step {
            (Some("Velocity" | "Displacement" | "Force" | "Scaled" | "Axes"), _) => true,
            (Some("Pressure"), Step::Field(name)) => name == "value",
            (Some("Turned"), Step::Field(name)) => name == "angle",
            _ => false,
        })
    }

    fn wrong_type(&self, node: &Node, expected: &str) -> InputError {
        let written = shorten(&self.text[node.span.clone()]);
        let found = match &node.kind {
            ValueKind::Number | ValueKind::Quantity(_) => format!("the number `{written}`"),
            ValueKind::Text => format!("the text `{written}`"),
            ValueKind::Char => format!("the character `{written}`"),
            ValueKind::Word => format!("the word `{written}`"),
            ValueKind::Other => format!("`{written}`"),
            ValueKind::Group(group) => match group.shape {
                Shape::List => "a list".to_owned(),
                Shape::Map => "a map".to_owned(),
                Shape::Tuple | Shape::Struct => match &group.name {
                    Some(name) => format!("`{}(...)`", &self.text[name.clone()]),
                    None => "a group in parentheses".to_owned(),
                },
            },
        };
        let path = self.path_to(&node.span);
        let place = path.map(|path| format!(" for {path}")).unwrap_or_default();
        let error = self.error_in(
            &node.head(&self.text),
            format!("wrong type{place}: found {found}"),
        );
        let unquoted_text = matches!(node.kind, ValueKind::Word | ValueKind::Quantity(_));
        let text = expected == "a text in quotes" || expected == TEXT_OR_MATERIAL;
        let quotes = unquoted_text && text;
        let number = matches!(node.kind, ValueKind::Text) && expected.starts_with("a number");
        let inner = written.trim_matches('"');
        let number = number && quantity::parts(inner).1 == inner.len();
        let unquoted = matches!(node.kind, ValueKind::Text) && expected.starts_with("a name");
        let unquoted = unquoted && !inner.contains("${");
        let error = error.expected(expected);
        if quotes {
            error.help(format!("write `\"{written}\"`"))
        } else if number {
            error.help(format!("write `{inner}` without quotes"))
        } else if unquoted {
            error.help(format!("write `{inner}`"))
        } else {
            error
        }
    }
}

/// Accepted notations of a function of time.
const TIME_FUNCTION: &str =
    "a number, or a function of time: `Constant(...)`, `Ramp(...)`, `Sine(...)`, `Table([...])`";

/// Whether the parser wants a text here, alone or beside a struct.
pub(super) fn expects_text(code: &RonError) -> bool {
    match code {
        RonError::ExpectedString => true,
        RonError::InvalidValueForType { expected, .. } => expected == TEXT_OR_MATERIAL,
        _ => false,
    }
}

/// Returns a description of the type expected at this location.
fn expected_type(code: &RonError) -> Option<String> {
    Some(match code {
        RonError::ExpectedBoolean => "`true` or `false`".into(),
        RonError::ExpectedFloat => "a number".into(),
        RonError::ExpectedInteger | RonError::InvalidIntegerDigit { .. } => "an integer".into(),
        RonError::ExpectedChar => "a character in single quotes".into(),
        RonError::ExpectedString => "a text in quotes".into(),
        RonError::ExpectedArray => "a list `[...]`".into(),
        RonError::ExpectedMap => "a map `{...}`".into(),
        RonError::ExpectedStructLike => "`(...)`".into(),
        // Types of the schema, which cases do not write.
        RonError::ExpectedNamedStructLike(name) if name.is_empty() || name.ends_with("Spec") => {
            "`(...)`".into()
        }
        RonError::ExpectedNamedStructLike(name) => format!("`{name}(...)` or `(...)`"),
        RonError::ExpectedOption => "`Some(...)` or `None`".into(),
        RonError::ExpectedUnit => "`()`".into(),
        RonError::ExpectedIdentifier => "a name without quotes".into(),
        RonError::InvalidValueForType { expected, .. } if expected == TEXT_OR_MATERIAL => {
            expected.clone()
        }
        _ => return None,
    })
}

/// Returns what an error of ron that no rule above covers means for the text.
fn sentence(code: &RonError, word: &str) -> String {
    match code {
        RonError::Eof => "the text ends too early".to_owned(),
        RonError::ExpectedMapColon => "a colon is missing between a key and its value".to_owned(),
        RonError::ExpectedComma => "a comma is missing before this".to_owned(),
        RonError::InvalidEscape(_) => {
            "a backslash in a text begins an escape such as `\\n`: write `\\\\` for a backslash"
                .to_owned()
        }
        RonError::FloatUnderscore | RonError::UnderscoreAtBeginning => {
            "this is no number: `_` may only stand between digits".to_owned()
        }
        RonError::UnexpectedChar(c) => format!("unexpected character {c:?}"),
        RonError::NoSuchExtension(name) => format!("there is no extension `{name}`"),
        RonError::SuggestRawIdentifier(found) | RonError::InvalidIdentifier(found) => {
            format!("`{}` is not a name", shorten(found))
        }
        _ if word.is_empty() => "this does not belong here".to_owned(),
        _ => format!("`{}` does not belong here", shorten(word)),
    }
}
