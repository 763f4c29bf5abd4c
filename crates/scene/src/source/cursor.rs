//! Places in a text as an editor asks for them.

use std::ops::Range;

use super::tree::{Entry, Group, Node, Shape, plain, unquoted};
use super::{Format, Source};
use crate::quantity;

/// The value or name at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CursorPlace {
    /// Fields, keys, indices of elements, and variants on the way to it.
    pub path: Vec<String>,
    /// Bytes of the file.
    pub span: Range<usize>,
}

/// What may be written at a place of a RON text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CursorSlot {
    /// The path of the struct or map that a name is for, or of the value.
    pub path: Vec<String>,
    /// What is written there.
    pub kind: SlotKind,
    /// Whether quotes are open.
    pub quoted: bool,
    /// Names that the struct or map has.
    pub present: Vec<String>,
}

/// What is written at a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlotKind {
    /// The name of a field.
    Field,
    /// The key of a map.
    Key,
    /// A value.
    Value,
    /// The unit of a number.
    Unit,
}

impl Source {
    /// Returns the value or name at a byte of the file.
    pub fn place_at(&self, byte: usize) -> Option<CursorPlace> {
        let root = self.tree.root.as_ref()?;
        self.place_in(root, byte, &mut Vec::new())
    }

    fn place_in(&self, node: &Node, byte: usize, path: &mut Vec<String>) -> Option<CursorPlace> {
        let at = |span: &Range<usize>, path: &[String]| {
            let span = self.source_map.place(span).span;
            (span.start <= byte && byte <= span.end).then(|| CursorPlace {
                path: path.to_vec(),
                span,
            })
        };
        let Some(group) = node.group() else {
            return at(&node.span, path);
        };
        let before = path.len();
        if let Some(name) = self.name_of(group) {
            path.push(plain(&self.text[name.clone()]).to_owned());
            if let Some(found) = at(name, path) {
                return Some(found);
            }
        }
        for (k, entry) in group.entries.iter().enumerate() {
            let depth = path.len();
            path.extend(self.step_of(group, entry, k));
            let key = entry.key.as_ref().and_then(|key| at(key, path));
            let found = key.or_else(|| self.place_in(&entry.value, byte, path));
            if found.is_some() {
                return found;
            }
            path.truncate(depth);
        }
        path.truncate(before);
        None
    }

    /// The name before the bracket, which is no `Some`.
    fn name_of<'t>(&self, group: &'t Group) -> Option<&'t Range<usize>> {
        group.name.as_ref().filter(|_| !group.is_some(&self.text))
    }

    /// The component of a path that leads to an entry; none for the content of a variant.
    fn step_of(&self, group: &Group, entry: &Entry, k: usize) -> Option<String> {
        let content = group.shape == Shape::Tuple && group.name.is_some();
        match &entry.key {
            Some(key) => Some(unquoted(&self.text[key.clone()])),
            None if content && group.entries.len() == 1 => None,
            None => Some(k.to_string()),
        }
    }

    /// Returns what may be written at a byte; `None` in a comment, or where nothing is to be
    /// named, and for other formats than RON.
    pub fn slot_at(&self, byte: usize) -> Option<CursorSlot> {
        let text = self.text.get(..byte)?;
        if Format::of(&self.path) != Format::Ron || in_comment(text) {
            return None;
        }
        let bracket = |c: char| "(,:[{\"\n".contains(c);
        let begin = text.rfind(bracket).map_or(0, |at| at + 1);
        let written = text[begin..].trim_start();
        let (number, _) = quantity::parts(written);
        let unit = |c: char| c.is_alphabetic() || " %^/\u{b0}".contains(c);
        let rest = &written[number..];
        let unit = number > 0 && !rest.is_empty() && rest.chars().all(unit);
        let word = match unit {
            true => byte - written.len(),
            false => {
                let symbol = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '\u{b0}');
                text.trim_end_matches(symbol).len()
            }
        };
        let before = &text[..word];
        let quoted = before.ends_with('"');
        let before = before.strip_suffix('"').unwrap_or(before).trim_end();
        // A value that is missing, and quotes that stay open, would end the tree here: a word
        // stands for them.
        let after = &self.text[byte..];
        let open = quoted
            && !after
                .trim_start_matches(|c| c != '"' && c != '\n')
                .starts_with('"');
        let missing = before.ends_with([':', '[']) && !quoted && word == byte;
        let group = match (open, missing) {
            (false, false) => self.group_at(word),
            _ => {
                let end = if open { "\"" } else { "" };
                let filled = format!("{}_{end}{after}", &self.text[..word]);
                Source::from_text(&self.path, filled).group_at(word)
            }
        };
        let present = group.present.clone();
        let slot = |path: Vec<String>, kind: SlotKind| {
            Some(CursorSlot {
                path,
                kind: if unit { SlotKind::Unit } else { kind },
                quoted,
                present,
            })
        };
        let below = |name: String| group.path.iter().cloned().chain([name]).collect();
        match (before.chars().next_back(), group.shape) {
            (Some(':'), _) => {
                let key = last_key(before[..before.len() - 1].trim_end());
                slot(below(key), SlotKind::Value)
            }
            (Some('[' | '(' | '{' | ','), Some(Shape::List)) => {
                slot(below(group.index.to_string()), SlotKind::Value)
            }
            (Some('[' | '(' | '{' | ','), Some(Shape::Map)) => slot(group.path, SlotKind::Key),
            // Names of fields have no quotes: this is a text in a tuple.
            (Some('(' | ','), _) if quoted => slot(below(group.index.to_string()), SlotKind::Value),
            (Some('[' | '(' | '{' | ','), _) => slot(group.path, SlotKind::Field),
            _ => None,
        }
    }

    /// The innermost group around a byte.
    fn group_at(&self, byte: usize) -> Around {
        let mut around = Around::default();
        let mut node = self.tree.root.as_ref();
        while let Some(group) = node.and_then(Node::group).filter(|g| g.open < byte) {
            let name = self
                .name_of(group)
                .map(|name| plain(&self.text[name.clone()]));
            around.path.extend(name.map(str::to_owned));
            around.shape = Some(group.shape);
            let keys = group.entries.iter().filter_map(|e| e.key.clone());
            around.present = keys.map(|key| unquoted(&self.text[key])).collect();
            let before = |e: &&Entry| e.value.span.end <= byte;
            around.index = group.entries.iter().filter(before).count();
            let inside = |e: &Entry| {
                let open = e.value.group().is_some_and(|g| g.open < byte);
                open && byte < e.value.span.end
            };
            let found = group.entries.iter().position(inside);
            if let Some(k) = found {
                around
                    .path
                    .extend(self.step_of(group, &group.entries[k], k));
            }
            node = found.map(|k| &group.entries[k].value);
        }
        around
    }
}

/// The innermost group around a place.
#[derive(Default)]
struct Around {
    path: Vec<String>,
    shape: Option<Shape>,
    /// Its names.
    present: Vec<String>,
    /// Number of values before the place.
    index: usize,
}

/// The name at the end of a text, with quotes or without.
fn last_key(text: &str) -> String {
    if let Some(inner) = text.strip_suffix('"') {
        return inner.rsplit('"').next().unwrap_or_default().to_owned();
    }
    let start = text
        .trim_end_matches(|c: char| c == '_' || c.is_alphanumeric())
        .len();
    text[start..].to_owned()
}

/// Whether the end of a text is in a comment to the end of its line.
fn in_comment(text: &str) -> bool {
    let line = text.rsplit('\n').next().unwrap_or_default();
    let mut quoted = false;
    let mut last = ' ';
    for c in line.chars() {
        quoted ^= c == '"' && last != '\\';
        if !quoted && last == '/' && c == '/' {
            return true;
        }
        last = c;
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slot at the bar of a text.
    fn slot(text: &str) -> Option<(String, SlotKind, bool)> {
        let at = text.find('|').unwrap();
        let source = Source::from_text("a.ron", text.replace('|', ""));
        let slot = source.slot_at(at)?;
        Some((slot.path.join("."), slot.kind, slot.quoted))
    }

    #[test]
    fn what_may_be_written_follows_from_the_brackets_around_it() {
        for (text, path, kind, quoted) in [
            ("(|", "", SlotKind::Field, false),
            ("(name: \"a\", ti|", "", SlotKind::Field, false),
            (
                "(name: \"a\", time: (|), end: 3)",
                "time",
                SlotKind::Field,
                false,
            ),
            ("(time: (step: 10 |", "time.step", SlotKind::Unit, false),
            (
                "(time: (step: 10 u|, end: 1))",
                "time.step",
                SlotKind::Unit,
                false,
            ),
            ("(at: [0, 10 m|])", "at.1", SlotKind::Unit, false),
            (
                "(bodies: [(dofs: (x: |",
                "bodies.0.dofs.x",
                SlotKind::Value,
                false,
            ),
            (
                "(bodies: [(), (dofs: (x: F|))])",
                "bodies.1.dofs.x",
                SlotKind::Value,
                false,
            ),
            ("(x: Force(Sine(am|", "x.Force.Sine", SlotKind::Field, false),
            ("(contact: \"cou|\")", "contact", SlotKind::Value, true),
            ("(contact: \"|", "contact", SlotKind::Value, true),
            ("(p: (contact: {\"|", "p.contact", SlotKind::Key, true),
            (
                "(p: (contact: {\"mu\": 3, |}))",
                "p.contact",
                SlotKind::Key,
                false,
            ),
            ("(m: {\"steel\": \"|\"})", "m.steel", SlotKind::Value, true),
            ("(list: [|", "list.0", SlotKind::Value, false),
            ("(a: (b: |), c: 1)", "a.b", SlotKind::Value, false),
            ("(a: (b: |, d: 2), c: 1)", "a.b", SlotKind::Value, false),
            (
                "(between: (\"a\", \"|\"))",
                "between.1",
                SlotKind::Value,
                true,
            ),
        ] {
            let found = slot(text).unwrap_or_else(|| panic!("{text}"));
            assert_eq!(found, (path.to_owned(), kind, quoted), "{text}");
        }
        assert_eq!(slot("(a: 3, // in |words\n)"), None);
    }

    #[test]
    fn a_place_has_the_path_of_its_value() {
        let text = "(bodies: [(name: \"lid\", dofs: (x: Force(Sine(amplitude: 30 N))))])";
        let source = Source::from_text("a.ron", text);
        for (word, path) in [
            ("bodies", "bodies"),
            ("lid", "bodies.0.name"),
            ("Force", "bodies.0.dofs.x.Force"),
            ("amplitude", "bodies.0.dofs.x.Force.Sine.amplitude"),
            ("30 N", "bodies.0.dofs.x.Force.Sine.amplitude"),
        ] {
            let place = source.place_at(text.find(word).unwrap() + 1).unwrap();
            assert_eq!(place.path.join("."), path, "{word}");
        }
    }
}
