//! JSON and YAML texts as trees of values with their places.

use std::collections::HashMap;
use std::ops::Range;

use saphyr_parser::{Event, Parser, ScalarStyle, Span};
use serde::de::IgnoredAny;

use super::Format;
use super::item::{Item, ItemKind, Key, Text};
use crate::quantity;
use crate::source::{InputError, MAX_DEPTH};

/// Reads a text. JSON is read as the YAML that it also is, after a check that it is JSON.
pub(super) fn read(file: &str, text: &str, format: Format) -> Result<Item, InputError> {
    if format == Format::Json {
        check_json(file, text)?;
    }
    let mut places: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
    places.push(text.len());
    let mut reader = Reader {
        file,
        text,
        places,
        open: Vec::new(),
        root: None,
    };
    let mut documents = 0;
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| {
            let at = reader.byte(error.marker().index());
            let name = if format == Format::Json {
                "JSON"
            } else {
                "YAML"
            };
            let message = format!("this is no {name} that can be read: {}", error.info());
            InputError::at(file, text, at..at + 1, message)
        })?;
        if matches!(event, Event::DocumentStart(_)) {
            documents += 1;
            if documents > 1 {
                let span = reader.bytes(span);
                return Err(InputError::at(
                    file,
                    text,
                    span,
                    "a file holds one document",
                ));
            }
        }
        reader.event(event, span)?;
    }
    let empty = || InputError::at(file, text, 0..0, "holds no value");
    reader.root.ok_or_else(empty)
}

/// Refuses what is no JSON, at its place.
fn check_json(file: &str, text: &str) -> Result<(), InputError> {
    let Err(error) = serde_json::from_str::<IgnoredAny>(text) else {
        return Ok(());
    };
    let lines = text.split_inclusive('\n');
    let before: usize = lines
        .take(error.line().saturating_sub(1))
        .map(str::len)
        .sum();
    let mut at = (before + error.column().saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let said = error.to_string();
    let message = said.split(" at line ").next().unwrap_or_default();
    Err(InputError::at(
        file,
        text,
        at..at + 1,
        format!("this is no JSON: {message}"),
    ))
}

/// A group whose end was not read yet.
struct Open {
    span: Range<usize>,
    entries: Vec<Item>,
    /// Keys of an object; none for a list.
    keys: Option<Vec<Key>>,
    /// The bytes at which the keys begin, by their names.
    places: HashMap<String, usize>,
}

struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    /// Byte of each character.
    places: Vec<usize>,
    open: Vec<Open>,
    root: Option<Item>,
}

impl Reader<'_> {
    fn byte(&self, character: usize) -> usize {
        self.places
            .get(character)
            .copied()
            .unwrap_or(self.text.len())
    }

    fn bytes(&self, span: Span) -> Range<usize> {
        let start = self.byte(span.start.index());
        start..self.byte(span.end.index()).max(start)
    }

    fn refuse(&self, span: Range<usize>, message: impl Into<String>) -> InputError {
        InputError::at(self.file, self.text, span, message)
    }

    fn event(&mut self, event: Event<'_>, span: Span) -> Result<(), InputError> {
        let span = self.bytes(span);
        match event {
            Event::Alias(_) => {
                let message = "an alias stands here";
                return Err(self.refuse(span, message).expected("the value itself"));
            }
            Event::Scalar(_, _, _, Some(_))
            | Event::SequenceStart(_, Some(_))
            | Event::MappingStart(_, Some(_)) => {
                let message = "a value has a tag (`!...`)";
                return Err(self.refuse(span, message).expected("the value without it"));
            }
            Event::Scalar(content, style, _, None) => self.scalar(&content, style, span)?,
            Event::SequenceStart(..) => self.begin(span, None)?,
            Event::MappingStart(..) => self.begin(span, Some(Vec::new()))?,
            Event::SequenceEnd | Event::MappingEnd => self.end(),
            _ => {}
        }
        Ok(())
    }

    /// Whether the next value is the key of an object.
    fn awaits_key(&self) -> bool {
        let keys = |o: &Open| o.keys.as_ref().is_some_and(|k| k.len() == o.entries.len());
        self.open.last().is_some_and(keys)
    }

    fn begin(&mut self, span: Range<usize>, keys: Option<Vec<Key>>) -> Result<(), InputError> {
        if self.awaits_key() {
            return Err(self.refuse(span, "a key is a text, not a list or an object"));
        }
        if self.open.len() >= MAX_DEPTH {
            let message = format!("values are nested more than {MAX_DEPTH} levels deep");
            return Err(self.refuse(span, message));
        }
        self.open.push(Open {
            span: span.start..span.start + 1,
            entries: Vec::new(),
            keys,
            places: HashMap::new(),
        });
        Ok(())
    }

    fn end(&mut self) {
        let Some(open) = self.open.pop() else { return };
        let kind = match open.keys {
            Some(keys) => ItemKind::Object(keys.into_iter().zip(open.entries).collect()),
            None => ItemKind::List(open.entries),
        };
        // A block has no bracket: its first key or value stands for it.
        let bracket = self.text[open.span.start..].starts_with(['{', '[']);
        let first = match &kind {
            ItemKind::Object(entries) => entries.first().map(|(key, _)| key.span.clone()),
            ItemKind::List(items) => items.first().map(|item| item.span.clone()),
            _ => None,
        };
        let span = first.filter(|_| !bracket).unwrap_or(open.span);
        self.value(Item { span, kind });
    }

    fn scalar(
        &mut self,
        content: &str,
        style: ScalarStyle,
        span: Range<usize>,
    ) -> Result<(), InputError> {
        if self.awaits_key() {
            let first = self.open.last().and_then(|open| open.places.get(content));
            if let Some(first) = first {
                let before = self.text[..*first].matches('\n').count() + 1;
                let message = format!("the key `{content}` is given twice, first in line {before}");
                return Err(self.refuse(span, message).help("remove one of the two"));
            }
            if let Some(open) = self.open.last_mut() {
                let name = content.to_owned();
                open.places.insert(name.clone(), span.start);
                open.keys.get_or_insert_default().push(Key { name, span });
            }
            return Ok(());
        }
        let written = &self.text[span.clone()];
        let before = usize::from(style != ScalarStyle::Plain);
        let same = written
            .get(before..)
            .is_some_and(|w| w.starts_with(content));
        let text = Text {
            content: content.to_owned(),
            at: (same && written.len() == content.len() + 2 * before)
                .then_some(span.start + before),
        };
        let kind = match style {
            ScalarStyle::Plain => plain(text),
            _ => ItemKind::Text(text),
        };
        self.value(Item { span, kind });
        Ok(())
    }

    fn value(&mut self, item: Item) {
        match self.open.last_mut() {
            Some(open) => open.entries.push(item),
            None => self.root = Some(item),
        }
    }
}

/// The value of a scalar without quotes, by the core schema of YAML 1.2.
fn plain(text: Text) -> ItemKind {
    let content = text.content.as_str();
    let (sign, digits) = match content.strip_prefix('-') {
        Some(digits) => ("-", digits),
        None => ("", content.strip_prefix('+').unwrap_or(content)),
    };
    match content {
        "" | "~" | "null" | "Null" | "NULL" => return ItemKind::Null,
        "true" | "True" | "TRUE" => return ItemKind::Bool(true),
        "false" | "False" | "FALSE" => return ItemKind::Bool(false),
        ".nan" | ".NaN" | ".NAN" => return ItemKind::Number("NaN".to_owned()),
        _ => {}
    }
    if matches!(digits, ".inf" | ".Inf" | ".INF") {
        return ItemKind::Number(format!("{sign}inf"));
    }
    let (number, all) = quantity::parts(content);
    match number > 0 && all == number && number == content.len() {
        true => ItemKind::Number(format!("{sign}{digits}")),
        false => ItemKind::Text(text),
    }
}
