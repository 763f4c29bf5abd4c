//! Writes a value of a JSON or YAML file as RON.
//!
//! RON distinguishes structs, maps and variants, which JSON and YAML write alike. The type that is
//! read says which of them stands where: this is a deserializer that hands each value to the type,
//! and writes it as the type asks for it. Where a value does not fit the type, it and what follows
//! are written by their look; the reader of the RON text then says what is wrong, at its place.

mod access;
mod out;

use super::item::{Item, ItemKind, Key, is_word};
use crate::quantity;
use crate::source::source_map::SourceMap;
use access::{Elements, Fields, Progress, Variant};
use out::{Out, is_quantity, special};
use serde::de::value::Error;
use serde::de::{DeserializeOwned, Deserializer, Error as _, Visitor};
use serde::forward_to_deserialize_any;
use std::cell::{Cell, RefCell};

/// Name by which ron asks for the text of a value as it is written.
const RAW_VALUE: &str = "$ron::private::RawValue";

/// Returns the RON text of a `T`, and where its parts are in the file.
pub(in crate::source) fn write<T: DeserializeOwned>(
    file: &str,
    item: &Item,
) -> (String, SourceMap) {
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

/// Whether a text stands for a number: with a unit, or as an expression.
fn is_amount(text: &str) -> bool {
    is_quantity(text) || special(text) || text.contains("${")
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
            ItemKind::Text(text) if special(&text.content) => {
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
        let root = self.out.borrow().text.is_empty();
        self.push(brackets[0]);
        let state = Cell::new(Progress::default());
        let found = visitor.visit_map(Fields {
            entries,
            out: self.out,
            state: &state,
            quoted,
            root,
        });
        // What the type did not take is written too.
        let Progress { next, key_written } = state.get();
        let mut out = self.out.borrow_mut();
        let begun = usize::from(key_written);
        for (k, (key, item)) in entries.iter().enumerate().skip(next - begun) {
            if k >= next && root && out.root_field(key, item) {
                continue;
            }
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
        // A constant function of time is written as its number, as in RON.
        if number && variants.contains(&"Constant") {
            let content = Some(self.item);
            return visitor.visit_enum(Variant {
                name: "Constant",
                content,
                implied: true,
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
                    implied: false,
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
                        implied: false,
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
