//! Writes a value of a JSON or YAML file as RON.
//!
//! RON distinguishes structs, maps and variants, which JSON and YAML write alike. The type that is
//! read says which of them stands where: this is a deserializer that hands each value to the type,
//! and writes it as the type asks for it. Where a value does not fit the type, it and what follows
//! are written by their look; the reader of the RON text then says what is wrong, at its place.

use std::cell::{Cell, RefCell};
use std::ops::Range;

use serde::de::value::{Error, StrDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, MapAccess, SeqAccess,
    VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;

use super::item::{Item, ItemKind, Key, Text, is_word};
use crate::quantity;
use crate::source::source_map::SourceMap;

/// Name by which ron asks for the text of a value as it is written.
const RAW_VALUE: &str = "$ron::private::RawValue";

/// Returns the RON text of a `T`, and where its parts are in the file.
pub(super) fn write<T: DeserializeOwned>(file: &str, item: &Item) -> (String, SourceMap) {
    let out = RefCell::new(Out {
        file,
        text: String::new(),
        map: SourceMap::default(),
    });
    let writer = Writer {
        item,
        out: &out,
        bare: false,
    };
    // Whether the value fits is for the reader of the text to say.
    let _ = T::deserialize(writer);
    let out = out.into_inner();
    (out.text, out.map)
}

/// The text so far.
struct Out<'f> {
    file: &'f str,
    text: String,
    map: SourceMap,
}

impl Out<'_> {
    /// Writes text that stands for bytes of the file.
    fn push(&mut self, text: &str, span: &Range<usize>) {
        self.text += text;
        self.map.push_for(text.len(), span.clone());
    }

    /// Writes a number, which is mostly spelled as in the file.
    fn number(&mut self, number: &str, span: &Range<usize>) {
        match self.file[span.clone()].starts_with(number) {
            true => self.verbatim(number, span.start),
            false => self.push(number, span),
        }
    }

    fn verbatim(&mut self, text: &str, at: usize) {
        self.text += text;
        self.map.push_from(text.len(), at);
    }

    fn quoted(&mut self, text: &Text, span: &Range<usize>) {
        let escaped = text.content.replace('\\', "\\\\").replace('"', "\\\"");
        self.push("\"", span);
        match text.at.filter(|_| escaped.len() == text.content.len()) {
            Some(at) => self.verbatim(&escaped, at),
            None => self.push(&escaped, span),
        }
        self.push("\"", span);
    }

    /// Writes a text that is a number with a unit as that.
    fn quantity(&mut self, text: &Text, span: &Range<usize>) {
        match text.at {
            Some(at) => self.verbatim(&text.content, at),
            None => self.push(&text.content, span),
        }
    }

    fn key(&mut self, key: &Key, quoted: bool) {
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

    /// Writes a value by its look.
    fn guess(&mut self, item: &Item) {
        let span = &item.span;
        match &item.kind {
            ItemKind::Null => self.push("None", span),
            ItemKind::Bool(value) => self.push(if *value { "true" } else { "false" }, span),
            ItemKind::Number(number) => self.number(number, span),
            ItemKind::Text(text) if is_quantity(&text.content) => self.quantity(text, span),
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
                    self.key(key, !fields);
                    self.guess(item);
                    self.push(", ", &item.span);
                }
                self.push(brackets[1], span);
            }
        }
    }
}

/// Whether a text is a number with a unit, which RON writes without quotes.
fn is_quantity(text: &str) -> bool {
    let (number, all) = quantity::parts(text);
    number > 0 && all > number && all == text.len()
}

/// Whether a text stands for a number: with a unit, or as an expression.
fn is_amount(text: &str) -> bool {
    is_quantity(text) || text.contains("${")
}

/// The text of a number that JSON has not.
fn special(text: &str) -> Option<&str> {
    ["inf", "-inf", "NaN"].into_iter().find(|s| *s == text)
}

/// Writes one value as the type asks for it.
struct Writer<'a, 'f> {
    item: &'a Item,
    out: &'a RefCell<Out<'f>>,
    /// Whether the value stands directly in the parentheses of a variant.
    bare: bool,
}

fn unfit() -> Error {
    Error::custom("the value does not fit the type")
}

impl<'a, 'f> Writer<'a, 'f> {
    fn of(self, item: &'a Item) -> Self {
        Self {
            item,
            bare: false,
            ..self
        }
    }

    fn push(&self, text: &str) {
        self.out.borrow_mut().push(text, &self.item.span);
    }

    /// Writes a value that does not fit.
    fn guess<T>(self) -> Result<T, Error> {
        self.out.borrow_mut().guess(self.item);
        Err(unfit())
    }

    /// Writes a number, or what stands for one, and gives the type any number.
    fn number<'de, V: Visitor<'de>>(self, visitor: V, whole: bool) -> Result<V::Value, Error> {
        let span = &self.item.span;
        match &self.item.kind {
            ItemKind::Number(number) => {
                self.out.borrow_mut().number(number, span);
                visit_number(visitor, number)
            }
            ItemKind::Text(text) if special(&text.content).is_some() => {
                self.out.borrow_mut().push(&text.content, span);
                visitor.visit_f64(1.0)
            }
            ItemKind::Text(text) if is_amount(&text.content) => {
                let mut out = self.out.borrow_mut();
                match is_quantity(&text.content) {
                    true => out.quantity(text, span),
                    false => out.quoted(text, span),
                }
                drop(out);
                match whole {
                    true => visitor.visit_u64(1),
                    false => visitor.visit_f64(1.0),
                }
            }
            _ => self.guess(),
        }
    }

    /// Writes the entries of an object between brackets; `quoted` are the keys of a map.
    fn entries<'de, V: Visitor<'de>>(
        self,
        entries: &'a [(Key, Item)],
        visitor: V,
        brackets: [&str; 2],
        quoted: bool,
    ) -> Result<V::Value, Error> {
        self.push(brackets[0]);
        let state = Cell::new(Progress::default());
        let found = visitor.visit_map(Fields {
            entries,
            out: self.out,
            state: &state,
            quoted,
        });
        // What the type did not take is written too.
        let Progress { next, key_written } = state.get();
        let mut out = self.out.borrow_mut();
        let begun = usize::from(key_written);
        for (k, (key, item)) in entries.iter().enumerate().skip(next - begun) {
            if k >= next {
                out.key(key, quoted);
            }
            out.guess(item);
            out.push(", ", &item.span);
        }
        drop(out);
        self.push(brackets[1]);
        match next - begun == entries.len() {
            true => found,
            false => found.and(Err(unfit())),
        }
    }

    /// Writes the elements of a list between brackets.
    fn elements<'de, V: Visitor<'de>>(
        self,
        items: &'a [Item],
        visitor: V,
        brackets: [&str; 2],
    ) -> Result<V::Value, Error> {
        self.push(brackets[0]);
        let next = Cell::new(0);
        let found = visitor.visit_seq(Elements {
            items,
            out: self.out,
            next: &next,
        });
        let mut out = self.out.borrow_mut();
        for item in &items[next.get()..] {
            out.guess(item);
            out.push(", ", &item.span);
        }
        drop(out);
        self.push(brackets[1]);
        match next.get() == items.len() {
            true => found,
            false => found.and(Err(unfit())),
        }
    }

    /// Brackets of a struct or tuple: those of the variant around it, or its own.
    fn parentheses(&self) -> [&'static str; 2] {
        match self.bare {
            true => ["", ""],
            false => ["(", ")"],
        }
    }

    fn fields<'de, V: Visitor<'de>>(
        self,
        name: &str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let item = self.item;
        // The name of the struct may stand around its fields, as in RON.
        if let Some((key, content)) = item.variant()
            && key.name == name
            && !fields.contains(&name)
        {
            let bare = self.bare;
            return Writer {
                bare,
                ..self.of(content)
            }
            .fields("", fields, visitor);
        }
        match &item.kind {
            ItemKind::Object(entries) => {
                let brackets = self.parentheses();
                self.entries(entries, visitor, brackets, false)
            }
            _ => self.guess(),
        }
    }

    fn tuple<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.item.kind {
            ItemKind::List(items) => {
                let brackets = self.parentheses();
                self.elements(items, visitor, brackets)
            }
            _ => self.guess(),
        }
    }
}

fn visit_number<'de, V: Visitor<'de>>(visitor: V, number: &str) -> Result<V::Value, Error> {
    if let Ok(value) = number.parse() {
        return visitor.visit_u64(value);
    }
    if let Ok(value) = number.parse() {
        return visitor.visit_i64(value);
    }
    visitor.visit_f64(quantity::number(number).unwrap_or(1.0))
}

/// Asks for a number.
macro_rules! numbers {
    ($($method:ident: $whole:literal),*) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            self.number(visitor, $whole)
        })*
    };
}

impl<'de> Deserializer<'de> for Writer<'_, '_> {
    type Error = Error;

    /// A type with several notations.
    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.item.kind {
            ItemKind::Null => {
                self.push("()");
                visitor.visit_unit()
            }
            ItemKind::Bool(_) => self.deserialize_bool(visitor),
            ItemKind::Number(_) => self.number(visitor, false),
            ItemKind::Text(text) if is_amount(&text.content) => self.number(visitor, false),
            ItemKind::Text(_) => self.deserialize_str(visitor),
            ItemKind::List(items) => self.elements(items, visitor, ["(", ")"]),
            ItemKind::Object(entries) => self.entries(entries, visitor, ["(", ")"], false),
        }
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.item.kind {
            ItemKind::Bool(value) => {
                self.out.borrow_mut().guess(self.item);
                visitor.visit_bool(value)
            }
            _ => self.guess(),
        }
    }

    numbers!(
        deserialize_i8: true, deserialize_i16: true, deserialize_i32: true, deserialize_i64: true,
        deserialize_u8: true, deserialize_u16: true, deserialize_u32: true, deserialize_u64: true,
        deserialize_i128: true, deserialize_u128: true, deserialize_f32: false,
        deserialize_f64: false
    );

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.item.kind {
            ItemKind::Text(text) => {
                self.out.borrow_mut().quoted(text, &self.item.span);
                visitor.visit_str(&text.content)
            }
            _ => self.guess(),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }

    fn deserialize_identifier<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.item.kind {
            ItemKind::Null => {
                self.push("None");
                visitor.visit_none()
            }
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_unit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.item.kind {
            ItemKind::Null => {
                self.push("()");
                visitor.visit_unit()
            }
            _ => self.guess(),
        }
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_unit(visitor)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        if name != RAW_VALUE {
            return visitor.visit_newtype_struct(self);
        }
        let start = self.out.borrow().text.len();
        self.out.borrow_mut().guess(self.item);
        let raw = self.out.borrow().text[start..].to_owned();
        visitor.visit_str(&raw)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.item.kind {
            ItemKind::List(items) => self.elements(items, visitor, ["[", "]"]),
            _ => self.guess(),
        }
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.tuple(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.tuple(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match &self.item.kind {
            ItemKind::Object(entries) => self.entries(entries, visitor, ["{", "}"], true),
            _ => self.guess(),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.fields(name, fields, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let number = match &self.item.kind {
            ItemKind::Number(_) => true,
            ItemKind::Text(text) => is_amount(&text.content),
            _ => false,
        };
        if number && variants.contains(&"Constant") {
            self.push("Constant");
            let content = Some(self.item);
            return visitor.visit_enum(Variant {
                name: "Constant",
                content,
                writer: self,
            });
        }
        let item = self.item;
        match &item.kind {
            ItemKind::Text(text) if is_word(&text.content) => {
                self.push(&text.content);
                let content = None;
                visitor.visit_enum(Variant {
                    name: &text.content,
                    content,
                    writer: self,
                })
            }
            _ => match item.variant().filter(|(key, _)| is_word(&key.name)) {
                Some((key, content)) => {
                    self.out.borrow_mut().push(&key.name, &key.span);
                    let name = &key.name;
                    if !variants.contains(&name.as_str()) {
                        self.push("(");
                        self.out.borrow_mut().guess(content);
                        self.push(")");
                        return Err(unfit());
                    }
                    let content = Some(content);
                    visitor.visit_enum(Variant {
                        name,
                        content,
                        writer: self,
                    })
                }
                None => self.guess(),
            },
        }
    }

    fn deserialize_ignored_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.out.borrow_mut().guess(self.item);
        visitor.visit_unit()
    }

    forward_to_deserialize_any! { char bytes byte_buf }
}

/// How many entries the type took, and whether the key of the last one was written without its
/// value.
#[derive(Clone, Copy, Default)]
struct Progress {
    next: usize,
    key_written: bool,
}

/// Entries of an object, as the type asks for them.
struct Fields<'a, 'f> {
    entries: &'a [(Key, Item)],
    out: &'a RefCell<Out<'f>>,
    state: &'a Cell<Progress>,
    quoted: bool,
}

impl<'de> MapAccess<'de> for Fields<'_, '_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Error> {
        let next = self.state.get().next;
        let Some((key, _)) = self.entries.get(next) else {
            return Ok(None);
        };
        self.out.borrow_mut().key(key, self.quoted);
        self.state.set(Progress {
            next: next + 1,
            key_written: true,
        });
        seed.deserialize(StrDeserializer::new(&key.name)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        let next = self.state.get().next;
        let item = next.checked_sub(1).and_then(|k| self.entries.get(k));
        let (_, item) = item.ok_or_else(unfit)?;
        self.state.set(Progress {
            next,
            key_written: false,
        });
        let found = seed.deserialize(Writer {
            item,
            out: self.out,
            bare: false,
        });
        self.out.borrow_mut().push(", ", &item.span);
        found
    }
}

/// Elements of a list, as the type asks for them.
struct Elements<'a, 'f> {
    items: &'a [Item],
    out: &'a RefCell<Out<'f>>,
    next: &'a Cell<usize>,
}

impl<'de> SeqAccess<'de> for Elements<'_, '_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Error> {
        let next = self.next.get();
        let Some(item) = self.items.get(next) else {
            return Ok(None);
        };
        self.next.set(next + 1);
        let found = seed.deserialize(Writer {
            item,
            out: self.out,
            bare: false,
        });
        self.out.borrow_mut().push(", ", &item.span);
        found.map(Some)
    }
}

/// A variant whose name is written, and its content.
struct Variant<'n, 'a, 'f> {
    name: &'n str,
    content: Option<&'a Item>,
    writer: Writer<'a, 'f>,
}

impl<'de, 'a, 'f> EnumAccess<'de> for Variant<'_, 'a, 'f> {
    type Error = Error;
    type Variant = Content<'a, 'f>;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Content<'a, 'f>), Error> {
        let name = seed.deserialize(StrDeserializer::<Error>::new(self.name))?;
        let content = Content {
            item: self.content,
            writer: self.writer,
        };
        Ok((name, content))
    }
}

/// The content of a variant.
struct Content<'a, 'f> {
    item: Option<&'a Item>,
    writer: Writer<'a, 'f>,
}

impl<'a, 'f> Content<'a, 'f> {
    /// Writes the content in the parentheses of the variant.
    fn within<T>(self, write: impl FnOnce(Writer<'a, 'f>) -> Result<T, Error>) -> Result<T, Error> {
        // A variant without its content is written as that.
        let item = self.item.ok_or_else(unfit)?;
        let (out, span) = (self.writer.out, &self.writer.item.span);
        out.borrow_mut().push("(", span);
        let found = write(Writer {
            bare: true,
            ..self.writer.of(item)
        });
        out.borrow_mut().push(")", span);
        found
    }
}

impl<'de> VariantAccess<'de> for Content<'_, '_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        match self.item.map(|item| &item.kind) {
            None | Some(ItemKind::Null) => Ok(()),
            Some(_) => self.within(Writer::guess),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        self.within(|writer| seed.deserialize(writer))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.within(|writer| writer.tuple(visitor))
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.within(|writer| writer.fields("", fields, visitor))
    }
}
