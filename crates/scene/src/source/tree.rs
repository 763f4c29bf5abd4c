//! Syntax tree of a RON text with the location of every value, and lookup by dotted path.

use std::ops::Range;

use super::{nearest::nearest, scan};

/// Largest nesting depth accepted; checked before anything recurses into the text.
pub const MAX_DEPTH: usize = 128;

/// The well-formed part of a text.
#[derive(Debug, Clone, Default)]
pub struct Tree {
    /// The top-level value, if there is one.
    pub root: Option<Node>,
    /// The first malformed position.
    pub fault: Option<SyntaxError>,
    /// Position where the nesting exceeded [`MAX_DEPTH`]; the text is not scanned beyond it.
    pub too_deep: Option<usize>,
}

/// A malformed position in the text.
#[derive(Debug, Clone)]
pub struct SyntaxError {
    /// Position of the scanner when it detected the error.
    pub at: usize,
    /// Range to mark.
    pub span: Range<usize>,
    /// Message.
    pub message: String,
    /// Whether it is the cause of any error that the parser reports.
    pub cause: bool,
}

/// A value and its byte range, including its name and brackets.
#[derive(Debug, Clone)]
pub struct Node {
    /// Byte range of the value.
    pub span: Range<usize>,
    /// Kind of the value.
    pub kind: ValueKind,
}

/// Kind of a value.
#[derive(Debug, Clone)]
pub enum ValueKind {
    /// A number, `inf` and `NaN` included.
    Number,
    /// A number with a unit after it, at this byte range: `10 us`.
    Quantity(Range<usize>),
    /// A string, raw or not.
    Text,
    /// A character.
    Char,
    /// A boolean, a unit variant, `None`.
    Word,
    /// Values in brackets.
    Group(Box<Group>),
    /// Byte strings, and text that could not be scanned.
    Other,
}

/// Values in brackets.
#[derive(Debug, Clone)]
pub struct Group {
    /// The kind of brackets, and whether the entries are named.
    pub shape: Shape,
    /// The name before the bracket.
    pub name: Option<Range<usize>>,
    /// Position of the opening bracket.
    pub open: usize,
    /// The values, in the order of the text.
    pub entries: Vec<Entry>,
}

/// The form of a [`Group`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// `(a: 1)`
    Struct,
    /// `(1, 2)`, `Some(1)`, `()`
    Tuple,
    /// `[1, 2]`
    List,
    /// `{ "k": 1 }`
    Map,
}

/// One value of a [`Group`].
#[derive(Debug, Clone)]
pub struct Entry {
    /// The field name or map key.
    pub key: Option<Range<usize>>,
    /// The value.
    pub value: Node,
}

/// A path that does not exist in the text, and how much of it does.
#[derive(Debug)]
pub struct MissingPath<'t> {
    /// The deepest value that exists.
    pub parent: Option<&'t Node>,
    /// Number of components that exist.
    pub depth: usize,
    /// Valid next components at that value.
    pub choices: Vec<String>,
}

impl MissingPath<'_> {
    /// Returns the path with its first wrong component corrected, if a similar one exists.
    pub fn correction(&self, path: &[String]) -> Option<Vec<String>> {
        let wrong = path.get(self.depth)?;
        let right = nearest(wrong, self.choices.iter().map(String::as_str))?;
        let mut corrected = path.to_vec();
        corrected[self.depth] = right.to_owned();
        Some(corrected)
    }
}

/// Splits `a.b."c.d"` into its components; `None` if one is empty or unclosed.
pub fn split_path(path: &str) -> Option<Vec<String>> {
    let mut parts = Vec::new();
    let mut rest = path.trim();
    loop {
        let (part, after) = if let Some(quoted) = rest.strip_prefix('"') {
            quoted.split_once('"')?
        } else {
            rest.split_at(rest.find('.').unwrap_or(rest.len()))
        };
        if part.trim().is_empty() {
            return None;
        }
        parts.push(part.trim().to_owned());
        if after.is_empty() {
            return Some(parts);
        }
        rest = after.strip_prefix('.')?;
    }
}

/// Joins components, quoted where necessary.
pub fn join_path(parts: &[String]) -> String {
    let quoted: Vec<String> = parts
        .iter()
        .map(|part| {
            if part.contains('.') {
                format!("\"{part}\"")
            } else {
                part.clone()
            }
        })
        .collect();
    quoted.join(".")
}

impl Tree {
    /// Reads `text`; never fails, see [`Tree::fault`] and [`Tree::too_deep`].
    pub fn of(text: &str) -> Tree {
        scan::scan(text)
    }

    /// Finds the value at a path of components, or how much of the path exists.
    ///
    /// Components are field names, map keys, indices, and in a list also the `name` of an element.
    /// `Some(x)` counts as `x`; the value of a one-tuple is its `.0`, and the components of that
    /// value may follow directly.
    pub fn find(&self, text: &str, path: &[String]) -> Result<&Node, MissingPath<'_>> {
        let mut node = self.root.as_ref().ok_or(MissingPath {
            parent: None,
            depth: 0,
            choices: Vec::new(),
        })?;
        for (depth, part) in path.iter().enumerate() {
            node = node.step(text, part).ok_or_else(|| MissingPath {
                parent: Some(node),
                depth,
                choices: node.choices(text),
            })?;
        }
        Ok(node)
    }

    /// Returns the value that ends exactly at `offset`.
    pub(super) fn ending_at(&self, offset: usize) -> Option<&Node> {
        let mut node = self.root.as_ref()?;
        while node.span.end != offset {
            node = node.child(|child| child.start < offset && offset <= child.end)?;
        }
        Some(node)
    }

    /// The innermost value around `offset`.
    pub(super) fn around(&self, offset: usize) -> Option<&Node> {
        let mut node = self.root.as_ref()?;
        if !node.span.contains(&offset) {
            return None;
        }
        while let Some(child) = node.child(|child| child.contains(&offset)) {
            node = child;
        }
        Some(node)
    }

    /// Returns the dotted path of the value with this span; empty for the root.
    pub(super) fn path_of(&self, text: &str, span: &Range<usize>) -> Vec<String> {
        let mut path = Vec::new();
        let mut node = self.root.as_ref();
        while let Some(ValueKind::Group(group)) = node.map(|node| &node.kind) {
            let holds = |child: &Range<usize>| child.start <= span.start && span.end <= child.end;
            let entries = &group.entries;
            let Some(index) = entries.iter().position(|entry| holds(&entry.value.span)) else {
                break;
            };
            // The content of a variant has the components of the variant.
            let only = group.shape == Shape::Tuple && group.entries.len() == 1;
            if !(only && group.name.is_some()) {
                path.push(group.component(text, index));
            }
            node = Some(&entries[index].value);
        }
        path
    }

    /// The last key or name equal to `word` in the text before `limit`.
    pub(super) fn last_word(&self, text: &str, word: &str, limit: usize) -> Option<Range<usize>> {
        let mut stack: Vec<&Node> = self.root.iter().collect();
        let mut best: Option<Range<usize>> = None;
        let mut offer = |span: &Range<usize>| {
            let later = best.as_ref().is_none_or(|best| best.start < span.start);
            if later && span.start <= limit && plain(&text[span.clone()]) == word {
                best = Some(span.clone());
            }
        };
        while let Some(node) = stack.pop() {
            match &node.kind {
                ValueKind::Group(group) => {
                    group.name.iter().for_each(&mut offer);
                    for entry in &group.entries {
                        entry.key.iter().for_each(&mut offer);
                        stack.push(&entry.value);
                    }
                }
                _ => offer(&node.span),
            }
        }
        best
    }
}

impl Node {
    /// Returns the group, if the value is one.
    pub fn group(&self) -> Option<&Group> {
        match &self.kind {
            ValueKind::Group(group) => Some(group),
            _ => None,
        }
    }

    /// Returns the value inside any number of `Some(...)`.
    pub fn unwrap_some(&self, text: &str) -> &Node {
        let mut node = self;
        while let Some(group) = node.group().filter(|group| group.is_some(text)) {
            node = &group.entries[0].value;
        }
        node
    }

    /// Returns the range to mark: the whole value, or its head if it spans several lines.
    pub fn head(&self, text: &str) -> Range<usize> {
        match self.group() {
            Some(group) if text[self.span.clone()].contains('\n') => {
                self.span.start..group.open + 1
            }
            _ => self.span.clone(),
        }
    }

    /// The content of a string without quotes and escapes, or a word.
    pub fn string(&self, text: &str) -> Option<String> {
        let written = &text[self.span.clone()];
        match self.kind {
            ValueKind::Text => ron::from_str(written).ok(),
            ValueKind::Word => Some(plain(written).to_owned()),
            _ => None,
        }
    }

    fn child(&self, wanted: impl Fn(&Range<usize>) -> bool) -> Option<&Node> {
        let values = self.group()?.entries.iter().map(|entry| &entry.value);
        values.into_iter().find(|value| wanted(&value.span))
    }

    pub(super) fn step(&self, text: &str, part: &str) -> Option<&Node> {
        let mut node = self.unwrap_some(text);
        loop {
            let group = node.group()?;
            let at = |index: usize| group.entries.get(index).map(|entry| &entry.value);
            let index = part.parse::<usize>().ok();
            return match group.shape {
                Shape::Struct | Shape::Map => group.position(text, part).and_then(at),
                Shape::List => index
                    .and_then(at)
                    .or_else(|| group.position(text, part).and_then(at)),
                Shape::Tuple => match (index.and_then(at), group.entries.as_slice()) {
                    (Some(found), _) => Some(found),
                    (None, [only]) => {
                        node = only.value.unwrap_some(text);
                        continue;
                    }
                    _ => None,
                },
            };
        }
    }

    /// Returns a field of this struct, or of the struct in this one-tuple.
    fn field(&self, text: &str, name: &str) -> Option<&Node> {
        let mut node = self;
        loop {
            let group = node.group()?;
            node = match (group.shape, group.entries.as_slice()) {
                (Shape::Struct, entries) => {
                    let named = |entry: &&Entry| {
                        entry
                            .key
                            .as_ref()
                            .is_some_and(|key| &text[key.clone()] == name)
                    };
                    return entries.iter().find(named).map(|entry| &entry.value);
                }
                (Shape::Tuple, [only]) => &only.value,
                _ => return None,
            };
        }
    }

    /// Returns valid components after this value in a path.
    pub(super) fn choices(&self, text: &str) -> Vec<String> {
        let node = self.unwrap_some(text);
        let Some(group) = node.group() else {
            return Vec::new();
        };
        let own = (0..group.entries.len()).map(|index| group.component(text, index));
        let mut choices: Vec<String> = own.collect();
        if let (Shape::Tuple, [only]) = (group.shape, group.entries.as_slice()) {
            choices.extend(only.value.choices(text));
        }
        choices
    }
}

impl Group {
    /// Returns whether this is `Some(x)`.
    pub fn is_some(&self, text: &str) -> bool {
        let named = self
            .name
            .as_ref()
            .is_some_and(|name| &text[name.clone()] == "Some");
        named && self.shape == Shape::Tuple && self.entries.len() == 1
    }

    /// Returns the index of the entry with this key, or in a list with this `name`.
    fn position(&self, text: &str, part: &str) -> Option<usize> {
        (0..self.entries.len()).find(|&index| {
            let entry = &self.entries[index];
            let written = entry.key.as_ref().map(|key| &text[key.clone()]);
            written == Some(part) || self.label(text, index).as_deref() == Some(part)
        })
    }

    /// Returns the component that leads to an entry.
    fn component(&self, text: &str, index: usize) -> String {
        self.label(text, index).unwrap_or_else(|| index.to_string())
    }

    /// The key of an entry, or in a list the `name` of the element.
    fn label(&self, text: &str, index: usize) -> Option<String> {
        let entry = self.entries.get(index)?;
        match (&entry.key, self.shape) {
            (Some(key), _) => Some(unquoted(&text[key.clone()])),
            (None, Shape::List) => entry.value.field(text, "name")?.string(text),
            (None, _) => None,
        }
    }
}

/// The name of a field, or the content of a quoted key.
pub(super) fn unquoted(written: &str) -> String {
    match written.contains('"') {
        true => ron::from_str(written).unwrap_or_else(|_| written.to_owned()),
        false => plain(written).to_owned(),
    }
}

/// An identifier without the `r#` of the raw form.
pub(super) fn plain(word: &str) -> &str {
    word.strip_prefix("r#").unwrap_or(word)
}
