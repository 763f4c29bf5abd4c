//! Quantities as nested objects and lists, in the order in which they were added.

use super::{Findings, PathStep, Quantity};
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;

/// A value, or the entries below a key.
enum Node<'a> {
    Leaf(&'a Value),
    Map(Vec<(&'a str, Node<'a>)>),
    List(Vec<Node<'a>>),
}

/// Value of an entry that has none.
const NOTHING: &Value = &Value::Null;

impl<'a> Node<'a> {
    fn insert(&mut self, path: &'a [PathStep], value: &'a Value) {
        let Some((step, rest)) = path.split_first() else {
            // A group without entries is replaced by the entry.
            if matches!(self, Self::Leaf(_)) {
                *self = Self::Leaf(value);
            }
            return;
        };
        let below = match step {
            PathStep::Key(key) => {
                if !matches!(self, Self::Map(_)) {
                    *self = Self::Map(Vec::new());
                }
                let Self::Map(map) = self else { return };
                let place = map.iter().position(|(k, _)| k == key);
                let place = place.unwrap_or_else(|| {
                    map.push((key, Self::Leaf(NOTHING)));
                    map.len() - 1
                });
                &mut map[place].1
            }
            PathStep::Place(k) => {
                if !matches!(self, Self::List(_)) {
                    *self = Self::List(Vec::new());
                }
                let Self::List(list) = self else { return };
                while list.len() <= *k {
                    list.push(Self::Leaf(NOTHING));
                }
                &mut list[*k]
            }
        };
        below.insert(rest, value);
    }
}

impl Serialize for Node<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Leaf(value) => value.serialize(to),
            Self::List(list) => to.collect_seq(list),
            Self::Map(map) => {
                let mut out = to.serialize_map(Some(map.len()))?;
                for (key, node) in map {
                    out.serialize_entry(key, node)?;
                }
                out.end()
            }
        }
    }
}

impl Serialize for Findings {
    /// Returns nested objects by the paths, and under `quantities` the catalogue of each path.
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut root = Node::Map(Vec::new());
        for Quantity { path, value, .. } in self.all() {
            root.insert(path, value);
        }
        let Node::Map(map) = &root else {
            return root.serialize(to);
        };
        let mut out = to.serialize_map(None)?;
        for (key, node) in map {
            out.serialize_entry(key, node)?;
        }
        out.serialize_entry(super::Catalogue::KEY, &super::Catalogue::new(self))?;
        out.end()
    }
}
