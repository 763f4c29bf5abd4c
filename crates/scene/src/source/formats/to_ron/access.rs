//! The parts of a value, handed to the type one after the other: entries, elements, variants.

use super::super::item::{Item, ItemKind, Key};
use super::out::Out;
use super::{Writer, unfit};
use serde::de::value::{Error, StrDeserializer};
use serde::de::{DeserializeSeed, EnumAccess, MapAccess, SeqAccess, VariantAccess, Visitor};
use std::cell::{Cell, RefCell};

/// How many entries the type took, and whether the key of the last one was written without its
/// value.
#[derive(Clone, Copy, Default)]
pub(super) struct Progress {
    pub(super) next: usize,
    pub(super) key_written: bool,
}

/// Entries of an object, as the type asks for them.
pub(super) struct Fields<'a, 'f> {
    pub(super) entries: &'a [(Key, Item)],
    pub(super) out: &'a RefCell<Out<'f>>,
    pub(super) state: &'a Cell<Progress>,
    pub(super) quoted: bool,
    /// Whether these are the fields of the file.
    pub(super) root: bool,
}

impl<'de> MapAccess<'de> for Fields<'_, '_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Error> {
        let mut next = self.state.get().next;
        let key = loop {
            let Some((key, item)) = self.entries.get(next) else {
                return Ok(None);
            };
            if !self.root || !self.out.borrow_mut().root_field(key, item) {
                break key;
            }
            next += 1;
            self.state.set(Progress {
                next,
                key_written: false,
            });
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
pub(super) struct Elements<'a, 'f> {
    pub(super) items: &'a [Item],
    pub(super) out: &'a RefCell<Out<'f>>,
    pub(super) next: &'a Cell<usize>,
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
pub(super) struct Variant<'n, 'a, 'f> {
    pub(super) name: &'n str,
    pub(super) content: Option<&'a Item>,
    /// Whether the content stands alone, without the name and its parentheses.
    pub(super) implied: bool,
    pub(super) writer: Writer<'a, 'f>,
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
            implied: self.implied,
            writer: self.writer,
        };
        Ok((name, content))
    }
}

/// The content of a variant.
pub(super) struct Content<'a, 'f> {
    pub(super) item: Option<&'a Item>,
    pub(super) implied: bool,
    pub(super) writer: Writer<'a, 'f>,
}

impl<'a, 'f> Content<'a, 'f> {
    /// Writes the content in the parentheses of the variant.
    fn within<T>(self, write: impl FnOnce(Writer<'a, 'f>) -> Result<T, Error>) -> Result<T, Error> {
        // A variant without its content is written as that.
        let item = self.item.ok_or_else(unfit)?;
        if self.implied {
            return write(self.writer.of(item));
        }
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
