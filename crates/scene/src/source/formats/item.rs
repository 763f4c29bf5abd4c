//! A value of a JSON or YAML text with its place.

use std::ops::Range;

/// A value and its bytes in the text.
#[derive(Clone, Debug)]
pub(super) struct Item {
    /// The bytes to mark: the value, or the head of one with others inside.
    pub span: Range<usize>,
    pub kind: ItemKind,
}

#[derive(Clone, Debug)]
pub(super) enum ItemKind {
    Null,
    Bool(bool),
    /// A number in the spelling of RON.
    Number(String),
    Text(Text),
    List(Vec<Item>),
    Object(Vec<(Key, Item)>),
}

/// A text; `at` is the byte of its content in the file, unless escapes change it.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub content: String,
    pub at: Option<usize>,
}

/// The name of a value.
#[derive(Clone, Debug)]
pub(super) struct Key {
    pub name: String,
    pub span: Range<usize>,
}

impl Item {
    /// Returns the name and content of a variant, `{"Sine": {...}}`.
    pub fn variant(&self) -> Option<(&Key, &Item)> {
        match &self.kind {
            ItemKind::Object(entries) => match entries.as_slice() {
                [(key, content)] => Some((key, content)),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Whether a text may be the name of a field or variant.
pub(super) fn is_word(text: &str) -> bool {
    crate::expression::is_name(text)
}
