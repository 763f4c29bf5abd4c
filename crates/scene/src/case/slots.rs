//! Values by slot of an interface, that is, by kind of law. The fields in the text are the keywords
//! of the kinds, including registered ones: see [`Kind::register`].

use fretwork_core::laws::Kind;
use serde::de::{DeserializeSeed, Error as _, MapAccess, Visitor};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::marker::PhantomData;
use std::sync::{Mutex, PoisonError};

/// Values by slot; a missing slot has the default.
#[derive(Clone, Debug, PartialEq)]
pub struct BySlot<T>(BTreeMap<Kind, T>);

impl<T> Default for BySlot<T> {
    fn default() -> Self {
        Self(BTreeMap::new())
    }
}

impl<T> BySlot<T> {
    /// Creates values with one slot.
    pub fn of(kind: Kind, value: T) -> Self {
        Self(BTreeMap::from([(kind, value)]))
    }

    /// Sets a slot.
    pub fn set(&mut self, kind: Kind, value: T) {
        self.0.insert(kind, value);
    }

    /// Returns the value of a slot, if there is one.
    pub fn get(&self, kind: Kind) -> Option<&T> {
        self.0.get(&kind)
    }

    /// Iterates over the slots that have a value, in the order of their kinds.
    pub fn iter(&self) -> impl Iterator<Item = (Kind, &T)> {
        self.0.iter().map(|(kind, value)| (*kind, value))
    }
}

/// Returns the names of a struct's fields: its own, with the keywords of all kinds inserted after a
/// number of them.
///
/// # Errors
/// A registered kind has the keyword of one of the struct's own fields, from which it could not be
/// distinguished.
pub(crate) fn with_kinds(
    own: &[&'static str],
    after: usize,
) -> Result<&'static [&'static str], String> {
    static KNOWN: Mutex<BTreeSet<&'static [&'static str]>> = Mutex::new(BTreeSet::new());
    let (before, behind) = own.split_at(after.min(own.len()));
    let kinds = Kind::all();
    if let Some(kind) = kinds.iter().find(|k| own.contains(&k.word())) {
        return Err(format!(
            "the registered kind of law `{kind}` (code {}) has the name of the field `{kind}`; register it with another word",
            kind.code()
        ));
    }
    let words = kinds.iter().map(|k| k.word());
    let names = before.iter().copied().chain(words);
    let names: Vec<&str> = names.chain(behind.iter().copied()).collect();
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(same) = known.get(names.as_slice()) {
        return Ok(same);
    }
    // serde requires static names; one list is leaked for each struct and set of kinds.
    let names: &'static [&'static str] = names.leak();
    known.insert(names);
    Ok(names)
}

/// A field: one of the struct's own, by its name, or a slot.
pub(crate) enum Field {
    Own(&'static str),
    Slot(Kind),
}

/// Reads the name of a field.
pub(crate) struct FieldName(pub &'static [&'static str]);

impl<'de> DeserializeSeed<'de> for FieldName {
    type Value = Field;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Field, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for FieldName {
    type Value = Field;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("field identifier")
    }

    fn visit_str<E: serde::de::Error>(self, name: &str) -> Result<Field, E> {
        let own = self.0.iter().find(|n| **n == name);
        match (Kind::from_word(name), own) {
            (Some(kind), Some(_)) => Ok(Field::Slot(kind)),
            (None, Some(name)) => Ok(Field::Own(name)),
            (_, None) => Err(E::unknown_field(name, self.0)),
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for BySlot<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Slots<T>(&'static [&'static str], PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Slots<T> {
            type Value = BySlot<T>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("values by slot")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<BySlot<T>, A::Error> {
                let mut slots = BTreeMap::new();
                while let Some(field) = map.next_key_seed(FieldName(self.0))? {
                    let Field::Slot(kind) = field else {
                        continue;
                    };
                    if slots.contains_key(&kind) {
                        return Err(A::Error::duplicate_field(kind.word()));
                    }
                    slots.insert(kind, map.next_value()?);
                }
                Ok(BySlot(slots))
            }
        }
        let fields = with_kinds(&[], 0).map_err(D::Error::custom)?;
        deserializer.deserialize_struct("SlotValues", fields, Slots(fields, PhantomData))
    }
}

impl<T: Serialize> Serialize for BySlot<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("SlotValues", self.0.len())?;
        for (kind, value) in &self.0 {
            fields.serialize_field(kind.word(), value)?;
        }
        fields.end()
    }
}
