//! Schema of a type along a path, independent of the text.
//!
//! serde's visitors know their fields. A deserializer that answers each of them with the one value
//! on the path descends into the type without any text, and records the types it passes.

use std::marker::PhantomData;

use serde::de::value::{Error, StrDeserializer};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, MapAccess, SeqAccess,
    VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;

use super::tree::{Node, Shape};

/// The kind of a type at a position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Level {
    /// A struct with these fields.
    Struct(Vec<&'static str>),
    /// A map with any keys.
    Map,
    /// A list.
    List,
    /// A tuple.
    Tuple,
    /// An enum with these variants.
    Enum(Vec<&'static str>),
    /// A scalar.
    Value,
}

/// Returns the types of `T` along `path`: first that of the root, then of each component, as far as
/// the type has them. `root` is the value in the text; it determines the variants of enums.
pub(super) fn levels<T: DeserializeOwned>(
    text: &str,
    root: Option<&Node>,
    path: &[String],
) -> Vec<Level> {
    let mut found = Vec::new();
    let probe = Probe {
        text,
        node: root,
        path,
        found: &mut found,
    };
    // The deserializer always ends with an error; the recorded levels are the result.
    let _ = PhantomData::<T>.deserialize(probe);
    found
}

/// Returns the names of the fields of the struct at a path of `T`; empty if there is no struct.
pub(crate) fn fields_at<T: DeserializeOwned>(
    text: &str,
    root: Option<&Node>,
    path: &[String],
) -> Vec<&'static str> {
    match levels::<T>(text, root, path).pop() {
        Some(Level::Struct(fields)) => fields,
        _ => Vec::new(),
    }
}

struct Probe<'a> {
    text: &'a str,
    node: Option<&'a Node>,
    path: &'a [String],
    found: &'a mut Vec<Level>,
}

fn end() -> Error {
    Error::custom("the end of the path")
}

impl<'a> Probe<'a> {
    /// Records the type at the current position.
    fn note(&mut self, level: Level) {
        self.found.push(level);
    }

    /// Returns the next component, and the probe for the value that it names.
    fn deeper(self) -> Option<(&'a str, Probe<'a>)> {
        let (first, rest) = self.path.split_first()?;
        let node = self.node.and_then(|node| node.step(self.text, first));
        let probe = Probe {
            path: rest,
            node,
            ..self
        };
        Some((first, probe))
    }

    /// Descends into a field.
    fn field<'de, V: Visitor<'de>>(
        mut self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.note(Level::Struct(fields.to_vec()));
        let (name, probe) = self.deeper().ok_or_else(end)?;
        if !fields.contains(&name) {
            return Err(end());
        }
        visitor.visit_map(One {
            name: Some(name),
            probe: Some(probe),
        })
    }
}

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = Error;

    /// A type with several notations, of which the text has one.
    fn deserialize_any<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        let written = self.node.map(|node| node.unwrap_some(self.text));
        let group = written.and_then(Node::group);
        if !self.path.is_empty() && group.is_some_and(|group| group.shape == Shape::Struct) {
            return self.deserialize_map(visitor);
        }
        self.note(Level::Value);
        Err(end())
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.field(fields, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        self.note(Level::Map);
        let (name, probe) = self.deeper().ok_or_else(end)?;
        visitor.visit_map(One {
            name: Some(name),
            probe: Some(probe),
        })
    }

    fn deserialize_seq<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        self.note(Level::List);
        let (_, probe) = self.deeper().ok_or_else(end)?;
        visitor.visit_seq(One {
            name: None,
            probe: Some(probe),
        })
    }

    fn deserialize_tuple<V: Visitor<'de>>(mut self, _: usize, _: V) -> Result<V::Value, Error> {
        self.note(Level::Tuple);
        Err(end())
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        length: usize,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.deserialize_tuple(length, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        mut self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let written = self.node.and_then(|node| {
            let node = node.unwrap_some(self.text);
            let span = node.group().map_or(Some(&node.span), |g| g.name.as_ref())?;
            Some(&self.text[span.clone()])
        });
        match written.filter(|name| variants.contains(name)) {
            Some(name) if !self.path.is_empty() => {
                visitor.visit_enum(Variant { name, probe: self })
            }
            _ => {
                self.note(Level::Enum(variants.to_vec()));
                Err(end())
            }
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string
        bytes byte_buf unit unit_struct identifier ignored_any
    }
}

/// A struct or map with one entry, or a list with one element.
struct One<'a> {
    name: Option<&'a str>,
    probe: Option<Probe<'a>>,
}

impl<'de> MapAccess<'de> for One<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Error> {
        let name = self.name.take();
        name.map(|name| seed.deserialize(StrDeserializer::new(name)))
            .transpose()
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        seed.deserialize(self.probe.take().ok_or_else(end)?)
    }
}

impl<'de> SeqAccess<'de> for One<'_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Error> {
        self.probe.take().map(|p| seed.deserialize(p)).transpose()
    }
}

/// The variant present in the text.
struct Variant<'a> {
    name: &'a str,
    probe: Probe<'a>,
}

impl<'de, 'a> EnumAccess<'de> for Variant<'a> {
    type Error = Error;
    type Variant = Probe<'a>;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Probe<'a>), Error> {
        let name = seed.deserialize(StrDeserializer::<Error>::new(self.name))?;
        Ok((name, self.probe))
    }
}

impl<'de> VariantAccess<'de> for Probe<'_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        Err(end())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(mut self, seed: T) -> Result<T::Value, Error> {
        // The content has the variant's own components; the index `0` may precede them.
        let wraps = self.path.first().is_some_and(|first| first == "0");
        if wraps {
            self.note(Level::Tuple);
        }
        let content = self.node.and_then(|node| {
            let group = node.unwrap_some(self.text).group()?;
            let own = group.entries.len() == 1 && group.entries[0].key.is_none();
            own.then(|| &group.entries[0].value)
        });
        seed.deserialize(Probe {
            path: if wraps { &self.path[1..] } else { self.path },
            node: content.or(self.node),
            ..self
        })
    }

    fn tuple_variant<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_tuple(length, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.field(fields, visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::tree::{Tree, split_path};
    use serde::Deserialize;
    use std::collections::BTreeMap;

    #[derive(Deserialize)]
    #[allow(dead_code)]
    struct Outer {
        inner: Option<Inner>,
        map: BTreeMap<String, Inner>,
        list: Vec<Kind>,
        place: (f64, f64),
    }

    #[derive(Deserialize)]
    #[allow(dead_code)]
    struct Inner {
        depth: f64,
    }

    #[derive(Deserialize)]
    #[allow(dead_code)]
    enum Kind {
        Plain,
        Wave { amplitude: f64 },
        Held(Inner),
    }

    fn along(text: &str, path: &str) -> Vec<Level> {
        let tree = Tree::of(text);
        let path = split_path(path).unwrap();
        levels::<Outer>(text, tree.root.as_ref(), &path)
    }

    #[test]
    fn a_type_is_walked_without_its_text() {
        let outer = Level::Struct(vec!["inner", "map", "list", "place"]);
        let inner = Level::Struct(vec!["depth"]);
        assert_eq!(
            along("()", "inner.depth"),
            [outer.clone(), inner.clone(), Level::Value]
        );
        assert_eq!(
            along("()", "map.a.depth"),
            [outer.clone(), Level::Map, inner.clone(), Level::Value]
        );
        assert_eq!(along("()", "inner.dept"), [outer.clone(), inner.clone()]);
        assert_eq!(along("()", "place.0"), [outer.clone(), Level::Tuple]);
        assert_eq!(
            along("()", "list.0.amplitude"),
            [
                outer.clone(),
                Level::List,
                Level::Enum(vec!["Plain", "Wave", "Held"])
            ]
        );
        assert_eq!(
            along("(list: [Wave(amplitude: 1)])", "list.0.phase"),
            [outer.clone(), Level::List, Level::Struct(vec!["amplitude"])]
        );
        for text in ["(list: [Held((depth: 1))])", "(list: [Held(depth: 1)])"] {
            assert_eq!(
                along(text, "list.0.depth"),
                [outer.clone(), Level::List, inner.clone(), Level::Value]
            );
        }
        assert_eq!(along("()", "else"), [outer]);
    }
}
