//! The RON text as it grows, and where its parts are in the file.

use super::super::item::{Item, ItemKind, Key, Text, is_word};
use crate::quantity;
use crate::source::named_values::LET;
use crate::source::source_map::SourceMap;
use std::ops::Range;

/// The text so far.
pub(super) struct Out<'f> {
    pub(super) file: &'f str,
    pub(super) text: String,
    pub(super) map: SourceMap,
}

impl Out<'_> {
    /// Writes text that stands for bytes of the file.
    pub(super) fn push(&mut self, text: &str, span: &Range<usize>) {
        self.text += text;
        self.map.push_for(text.len(), span.clone());
    }

    /// Writes a number, which is mostly spelled as in the file.
    pub(super) fn number(&mut self, number: &str, span: &Range<usize>) {
        match self.file[span.clone()].starts_with(number) {
            true => self.verbatim(number, span.start),
            false => self.push(number, span),
        }
    }

    pub(super) fn verbatim(&mut self, text: &str, at: usize) {
        self.text += text;
        self.map.push_from(text.len(), at);
    }

    pub(super) fn quoted(&mut self, text: &Text, span: &Range<usize>) {
        let escaped = text.content.replace('\\', "\\\\").replace('"', "\\\"");
        self.push("\"", span);
        match text.at.filter(|_| escaped.len() == text.content.len()) {
            Some(at) => self.verbatim(&escaped, at),
            None => self.push(&escaped, span),
        }
        self.push("\"", span);
    }

    /// Writes a text that is a number with a unit as that.
    pub(super) fn quantity(&mut self, text: &Text, span: &Range<usize>) {
        match text.at {
            Some(at) => self.verbatim(&text.content, at),
            None => self.push(&text.content, span),
        }
    }

    pub(super) fn key(&mut self, key: &Key, quoted: bool) {
        match quoted {
            true => {
                let content = key.name.clone();
                self.quoted(&Text { content, at: None }, &key.span);
            }
            // What is no word is no field; the error of the reader is at its place.
            false => {
                let word: String = key
                    .name
                    .chars()
                    .map(|c| match c.is_alphanumeric() {
                        true => c,
                        false => '_',
                    })
                    .collect();
                let word = match word.starts_with(|c: char| c.is_ascii_digit()) || word.is_empty() {
                    true => format!("_{word}"),
                    false => word,
                };
                self.push(&word, &key.span);
            }
        }
        self.push(": ", &key.span);
    }

    /// Writes a field that stands at the root of every file, whatever its type; returns whether
    /// it is one.
    pub(super) fn root_field(&mut self, key: &Key, item: &Item) -> bool {
        match key.name.as_str() {
            // By which editors find the schema.
            "$schema" => true,
            LET => {
                self.key(key, false);
                match &item.kind {
                    ItemKind::Object(entries) => {
                        self.push("{", &item.span);
                        for (name, value) in entries {
                            self.key(name, true);
                            self.guess(value);
                            self.push(", ", &value.span);
                        }
                        self.push("}", &item.span);
                    }
                    _ => self.guess(item),
                }
                self.push(", ", &item.span);
                true
            }
            _ => false,
        }
    }

    /// Writes a value by its look.
    pub(super) fn guess(&mut self, item: &Item) {
        let span = &item.span;
        match &item.kind {
            ItemKind::Null => self.push("None", span),
            ItemKind::Bool(value) => self.push(if *value { "true" } else { "false" }, span),
            ItemKind::Number(number) => self.number(number, span),
            ItemKind::Text(text) if is_quantity(&text.content) || special(&text.content) => {
                self.quantity(text, span);
            }
            ItemKind::Text(text) => self.quoted(text, span),
            ItemKind::List(items) => {
                self.push("[", span);
                for item in items {
                    self.guess(item);
                    self.push(", ", &item.span);
                }
                self.push("]", span);
            }
            ItemKind::Object(entries) => {
                let root = self.text.is_empty();
                let capital = |(key, _): &(&Key, &Item)| {
                    is_word(&key.name) && key.name.starts_with(char::is_uppercase)
                };
                if let Some((key, content)) = item.variant().filter(capital) {
                    self.push(&key.name, &key.span);
                    self.push("(", span);
                    self.guess(content);
                    self.push(")", span);
                    return;
                }
                let fields = entries.iter().all(|(key, _)| is_word(&key.name));
                let brackets = if fields { ["(", ")"] } else { ["{", "}"] };
                self.push(brackets[0], span);
                for (key, item) in entries {
                    if root && self.root_field(key, item) {
                        continue;
                    }
                    self.key(key, !fields);
                    self.guess(item);
                    self.push(", ", &item.span);
                }
                self.push(brackets[1], span);
            }
        }
    }
}

/// Whether a text is a number that JSON has not.
pub(super) fn special(text: &str) -> bool {
    matches!(text, "inf" | "-inf" | "NaN")
}

/// Whether a text is a number with a unit, which RON writes without quotes.
pub(super) fn is_quantity(text: &str) -> bool {
    let (number, all) = quantity::parts(text);
    number > 0 && all > number && all == text.len()
}
