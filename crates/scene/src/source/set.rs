//! Application of `--set key.path=value` to an input text.

use std::ops::Range;

use serde::de::DeserializeOwned;

use super::named_values::has_expression;
use super::schema::{self, Level};
use super::tree::{Node, Shape, Tree, ValueKind, join_path, split_path};
use super::{InputError, Source, scan};
use crate::quantity;

/// A parsed `--set` argument; ranges are bytes of the argument.
struct Assignment<'a> {
    argument: &'a str,
    path: Vec<String>,
    key: Range<usize>,
    value: Range<usize>,
}

impl<'a> Assignment<'a> {
    fn parse(argument: &'a str) -> Result<Self, InputError> {
        let wrong = |message: &str| {
            InputError::argument(format!("--set {argument}"), message).expected("key.path=value")
        };
        let Some(equals) = equals_sign(argument) else {
            return Err(wrong("there is no `=` between a key and a value"));
        };
        let trimmed = |range: Range<usize>| {
            let part = &argument[range.clone()];
            let start = range.start + part.len() - part.trim_start().len();
            start..start + part.trim().len()
        };
        let key = trimmed(0..equals);
        let value = trimmed(equals + 1..argument.len());
        if key.is_empty() {
            return Err(wrong("there is no key before the `=`"));
        }
        if value.is_empty() {
            let error = wrong("there is no value after the `=`");
            return Err(error.help("write `\"\"` for an empty text"));
        }
        let Some(path) = split_path(&argument[key.clone()]) else {
            return Err(wrong("a part of the key is empty"));
        };
        Ok(Self {
            argument,
            path,
            key,
            value,
        })
    }

    fn value(&self) -> &'a str {
        &self.argument[self.value.clone()]
    }

    /// Returns whether the value is a name, and may be a text whose quotes the shell removed.
    fn is_word(&self) -> bool {
        let tree = scan::scan(self.value());
        let kind = tree.root.map(|root| root.kind);
        let word = matches!(kind, Some(ValueKind::Word | ValueKind::Quantity(_)));
        word && !matches!(self.value(), "true" | "false")
    }

    /// Returns whether the value is not valid RON, such as a path, and may be a text.
    fn is_bare(&self) -> bool {
        let bare = !self
            .value()
            .contains(['(', ')', '[', ']', '{', '}', '"', ',']);
        self.is_expression() || bare && !is_value(self.value())
    }

    /// Returns whether the value is an expression without its quotes.
    fn is_expression(&self) -> bool {
        self.value().starts_with("${") && self.value().ends_with('}')
    }

    /// Returns the value, if it is one complete RON value; otherwise an error.
    fn complete(&self) -> Result<String, InputError> {
        let value = self.value();
        if is_value(value) {
            return Ok(value.to_owned());
        }
        if let Some(written) = quantity::decimal_comma(value) {
            return Err(self.fail(format!("`{value}` has a decimal comma; write `{written}`")));
        }
        let tree = scan::scan(value);
        let fault = tree.fault.map(|fault| fault.message);
        let why = match tree.too_deep {
            Some(_) => "it is nested too deeply".to_owned(),
            None => fault.unwrap_or_else(|| "it is more than one value".to_owned()),
        };
        let error = self.fail(format!("`{}` is not a value: {why}", shorten(value)));
        Err(error.expected("one number, text, name, list or struct"))
    }

    /// Returns the name of the value to which the first components lead, for messages.
    fn place(&self, depth: usize) -> String {
        if depth == 0 {
            "the file".to_owned()
        } else {
            format!("`{}`", join_path(&self.path[..depth]))
        }
    }

    fn fail(&self, message: impl Into<String>) -> InputError {
        InputError::argument(format!("--set {}", self.argument), message)
    }
}

/// Returns the position of the first `=` outside quotes: a quoted map key may contain one.
fn equals_sign(argument: &str) -> Option<usize> {
    let mut quoted = false;
    argument.bytes().position(|byte| {
        quoted ^= byte == b'"';
        byte == b'=' && !quoted
    })
}

/// Returns whether the text is one complete RON value, with nothing after it.
fn is_value(text: &str) -> bool {
    let tree = scan::scan(text);
    let whole = tree.root.is_some_and(|root| root.span == (0..text.len()));
    whole && tree.fault.is_none() && tree.too_deep.is_none()
}

/// Returns `text` as a RON string.
fn quote(text: &str) -> String {
    let escaped = text.replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{escaped}\"")
}

impl Source {
    /// Applies `key.path=value` to the text of a `T`: replaces a value, or inserts it if the text
    /// omits it, with the structs and maps around it. The value is RON text; a bare word where a
    /// text is expected is quoted.
    ///
    /// # Errors
    /// The argument is malformed, `T` does not have the key, a list element is not in the text, or
    /// the value is not one complete RON value.
    pub fn set<T: DeserializeOwned>(&mut self, argument: &str) -> Result<(), InputError> {
        let wanted = Assignment::parse(argument)?;
        if let Some(refusal) = self.refuse_depth() {
            return Err(refusal);
        }
        if let Some(fault) = &self.tree.fault {
            let error = self.error_in(&fault.span, fault.message.clone());
            return Err(error.note(format!("`--set {argument}` needs a well formed text")));
        }
        match self.tree.find(&self.text, &wanted.path) {
            Ok(node) => {
                let (span, new) = replacement(&self.text, node, &wanted)?;
                self.edit(&wanted, span, &[(&new, &wanted.value)]);
            }
            Err(missing) => {
                let root = self.tree.root.as_ref();
                let levels = schema::levels::<T>(&self.text, root, &wanted.path);
                let (at, before, after) = match missing.parent {
                    Some(parent) => self
                        .insertion(&wanted, parent, missing.depth, &levels)
                        .map_err(|error| match as_one_value::<T>(&wanted, &levels) {
                            Some(set) => {
                                error.help(format!("write it as one value: --set '{set}'"))
                            }
                            None => error,
                        })?,
                    None => return Err(wanted.fail("the file holds no value to set this in")),
                };
                let new = if wanted.is_bare() {
                    quote(wanted.value())
                } else {
                    wanted.complete()?
                };
                let parts = [
                    (before.as_str(), &wanted.key),
                    (&new, &wanted.value),
                    (after.as_str(), &wanted.value),
                ];
                self.edit(&wanted, at..at, &parts);
            }
        }
        Ok(())
    }

    /// Quotes the value of the `--set` that inserted the text at `offset`, unless it has quotes.
    pub(super) fn quote_set_at(&mut self, offset: usize) -> bool {
        let Some((set, _)) = self.source_map.place(&(offset..offset)).set else {
            return false;
        };
        let node = self.tree.around(offset);
        let Some(node) = node.filter(|node| {
            matches!(
                node.kind,
                ValueKind::Word | ValueKind::Number | ValueKind::Quantity(_)
            )
        }) else {
            return false;
        };
        let span = node.span.clone();
        let Some((_, argument)) = self.source_map.place(&span).set else {
            return false;
        };
        let new = quote(&self.text[span.clone()]);
        self.source_map
            .replace(&span, set, &[(new.len(), argument)]);
        self.text.replace_range(span, &new);
        self.tree = Tree::of(&self.text);
        true
    }

    fn edit(
        &mut self,
        wanted: &Assignment<'_>,
        span: Range<usize>,
        parts: &[(&str, &Range<usize>)],
    ) {
        let new: String = parts.iter().map(|(text, _)| *text).collect();
        let lengths: Vec<(usize, Range<usize>)> = parts
            .iter()
            .filter(|(text, _)| !text.is_empty())
            .map(|(text, range)| (text.len(), (*range).clone()))
            .collect();
        self.source_map.replace(&span, self.sets.len(), &lengths);
        self.text.replace_range(span, &new);
        self.tree = Tree::of(&self.text);
        self.sets.push(wanted.argument.to_owned());
    }

    /// Returns the position at which to insert the missing keys below `parent`, and the text before
    /// and after the value. The first `depth` components of the key are in the text; `levels` are
    /// the types along the key, as far as the type has them.
    fn insertion(
        &self,
        wanted: &Assignment<'_>,
        parent: &Node,
        depth: usize,
        levels: &[Level],
    ) -> Result<(usize, String, String), InputError> {
        let text = &self.text;
        let parent = parent.inner(text);
        let Some(group) = parent.group() else {
            let (place, next) = (wanted.place(depth), &wanted.path[depth]);
            let held = shorten(&text[parent.span.clone()]);
            let error = wanted.fail(format!("{place} is `{held}`, which has no `{next}` to set"));
            return Err(match levels.get(depth) {
                Some(Level::Enum(variants)) => error
                    .expected(format!("{} as a whole", one_of(variants)))
                    .help(format!(
                        "write it as one value: --set '{}=...'",
                        join_path(&wanted.path[..depth])
                    )),
                _ => error,
            });
        };
        self.refuse_unknown(wanted, parent, depth, levels)?;
        let key = |level: Option<&Level>, part: &String| match level {
            Some(Level::Map) => quote(part),
            _ => part.clone(),
        };
        let first = match group.shape {
            Shape::Struct => wanted.path[depth].clone(),
            Shape::Map => {
                let quoted = |span: &Range<usize>| text[span.clone()].contains('"');
                let mut keys = group.entries.iter().filter_map(|entry| entry.key.as_ref());
                // Unquoted map keys are numbers or identifiers and are used as written.
                let words = !group.entries.is_empty() && !keys.any(quoted);
                if words {
                    wanted.path[depth].clone()
                } else {
                    quote(&wanted.path[depth])
                }
            }
            Shape::Tuple | Shape::List => key(levels.get(depth), &wanted.path[depth]),
        };
        // These are the structs and maps between the parent and the value, which the text omits.
        let (mut before, mut after) = (format!("{first}: "), String::new());
        for (k, part) in wanted.path.iter().enumerate().skip(depth + 1) {
            let level = levels.get(k);
            let (open, close) = match level {
                Some(Level::Map) => ('{', '}'),
                _ => ('(', ')'),
            };
            before.push_str(&format!("{open}{}: ", key(level, part)));
            after.insert(0, close);
        }
        let at = match group.entries.last() {
            Some(entry) => {
                before.insert_str(0, ", ");
                entry.value.span.end
            }
            None => {
                // An empty group may contain a comment before its bracket; a trailing comma is
                // allowed.
                after.push(',');
                group.open + 1
            }
        };
        Ok((at, before, after))
    }

    /// Makes an error for the first component that neither the text nor the type has, with the
    /// nearest existing name.
    fn refuse_unknown(
        &self,
        wanted: &Assignment<'_>,
        parent: &Node,
        depth: usize,
        levels: &[Level],
    ) -> Result<(), InputError> {
        for (k, part) in wanted.path.iter().enumerate().skip(depth) {
            let place = wanted.place(k);
            let shape = parent
                .group()
                .filter(|_| k == depth)
                .map(|g| (g.shape, g.entries.len()));
            let listed = match shape {
                // The parser reports an invalid name, at its position in the file.
                Some((Shape::Struct | Shape::Map, _) | (Shape::Tuple, 0))
                    if k + 1 == wanted.path.len() =>
                {
                    continue;
                }
                Some((Shape::List, count)) => Some(count),
                Some((Shape::Tuple, count)) if count > 0 => Some(count),
                _ => None,
            };
            let written = || shape.map_or_else(Vec::new, |_| parent.choices(&self.text));
            let (message, choices) = match (listed, levels.get(k)) {
                (Some(count), _) => {
                    let message = format!("{place} has {count} elements, and no `{part}`");
                    (message, written())
                }
                (None, Some(Level::Map)) => continue,
                (None, Some(Level::Struct(fields))) if fields.contains(&part.as_str()) => continue,
                (None, Some(Level::Struct(fields))) => {
                    let fields = fields.iter().map(|f| (*f).to_owned());
                    (
                        format!("there is no `{part}` in {place}"),
                        fields.collect::<Vec<_>>(),
                    )
                }
                (None, Some(Level::List | Level::Tuple)) => {
                    let whole = join_path(&wanted.path[..k]);
                    let message = format!("{place} is a list that the file does not write");
                    let error = wanted.fail(message).expected("the list as a whole");
                    return Err(error.help(format!("write --set '{whole}=[...]'")));
                }
                (None, Some(Level::Enum(variants))) => {
                    let whole = join_path(&wanted.path[..k]);
                    let message = format!("{place} is one of several kinds: give it as a whole");
                    let error = wanted.fail(message).expected(one_of(variants));
                    return Err(error.help(format!("write --set '{whole}=...'")));
                }
                (None, Some(Level::Value)) => {
                    let message = format!("{place} is one value, which has no `{part}` to set");
                    (message, written())
                }
                (None, None) => (format!("there is no `{part}` in {place}"), written()),
            };
            let mut error = wanted.fail(message);
            if !choices.is_empty() {
                error = error.expected(one_of(&choices));
            }
            let near = super::nearest(part, choices.iter().map(String::as_str)).map(|near| {
                let mut right = wanted.path.clone();
                near.clone_into(&mut right[k]);
                join_path(&right)
            });
            return Err(match near {
                Some(right) => error.help(format!("did you mean `{right}`?")),
                None if k == 0 => error,
                None => error.help(format!(
                    "the nearest that is there is `{}`",
                    join_path(&wanted.path[..k])
                )),
            });
        }
        Ok(())
    }
}

impl Node {
    /// Returns the value inside nested `Some(...)` and one-tuples.
    fn inner(&self, text: &str) -> &Node {
        let mut node = self.unwrap_some(text);
        while let Some(group) = node.group() {
            match (group.shape, group.entries.as_slice()) {
                (Shape::Tuple, [only]) => node = only.value.unwrap_some(text),
                _ => break,
            }
        }
        node
    }
}

/// The byte range to replace, and the replacement.
fn replacement(
    text: &str,
    node: &Node,
    wanted: &Assignment<'_>,
) -> Result<(Range<usize>, String), InputError> {
    let value = wanted.value();
    let option = value == "None" || value.starts_with("Some(");
    let held = node.unwrap_some(text);
    // An existing `Some` around the old value is kept, unless the new value has its own.
    let target = if option { node } else { held };
    // A text with an expression stands for a number.
    let is_text = matches!(held.kind, ValueKind::Text) && !has_expression(text, held);
    let unquoted = is_text && (wanted.is_word() || wanted.is_bare());
    let new = if (unquoted || wanted.is_expression()) && !option {
        quote(value)
    } else {
        wanted.complete()?
    };
    Ok((target.span.clone(), new))
}

/// Suggests `coupling=Implicit(tolerance: ..., max_iterations: 3)` for `coupling.max_iterations=3`:
/// the parent key as a whole, with the first variant that has such a field.
fn as_one_value<T: DeserializeOwned>(wanted: &Assignment<'_>, levels: &[Level]) -> Option<String> {
    let (last, above) = wanted.path.split_last()?;
    let Some(Level::Enum(variants)) = levels.get(above.len()) else {
        return None;
    };
    let nested = |variant: &str| {
        let opened: String = above.iter().map(|part| format!("({part}: ")).collect();
        opened + variant + "()" + &")".repeat(above.len())
    };
    variants.iter().find_map(|variant| {
        let text = nested(variant);
        let tree = scan::scan(&text);
        let levels = schema::levels::<T>(&text, tree.root.as_ref(), &wanted.path);
        let Some(Level::Struct(fields)) = levels.get(above.len()) else {
            return None;
        };
        let given = |field: &&'static str| match *field == last.as_str() {
            true => format!("{field}: {}", wanted.value()),
            false => format!("{field}: ..."),
        };
        let known = fields.contains(&last.as_str());
        let all: Vec<String> = fields.iter().map(given).collect();
        known.then(|| format!("{}={variant}({})", join_path(above), all.join(", ")))
    })
}

/// Returns `one of `a`, `b``.
pub(super) fn one_of<S: AsRef<str>>(names: &[S]) -> String {
    const MAX_NAMED: usize = 24;
    let quoted: Vec<String> = names
        .iter()
        .take(MAX_NAMED)
        .map(|name| format!("`{}`", name.as_ref()))
        .collect();
    let more = if names.len() > MAX_NAMED { ", ..." } else { "" };
    let lead = if names.len() == 1 { "" } else { "one of " };
    format!("{lead}{}{more}", quoted.join(", "))
}

/// Shortens a text to one line for a message.
pub(super) fn shorten(text: &str) -> String {
    const MAX_LENGTH: usize = 40;
    let line = text.lines().next().unwrap_or_default().trim_end();
    let mut short: String = line
        .chars()
        .take(MAX_LENGTH)
        .map(|c| {
            if super::commands_a_terminal(c) {
                ' '
            } else {
                c
            }
        })
        .collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}
