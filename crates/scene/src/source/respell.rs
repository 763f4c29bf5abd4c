//! Alternative notations that ron does not accept: a tuple for a list or a list for a tuple, and a
//! number for a constant function of time.
//!
//! ron reports the value at which it stopped. That value is rewritten in the expected notation,
//! together with all values at the same place of the schema (for example the other points of a
//! table), and the text is parsed again.

use ron::error::{Error as RonError, SpannedError};
use std::ops::Range;

use super::Source;
use super::tree::{Node, Shape, Tree, ValueKind};

/// The rewriting of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Change {
    /// `(1, 2)` becomes `[1, 2]`.
    List,
    /// `[1, 2]` becomes `(1, 2)`.
    Tuple,
    /// `0.1` becomes `Constant(0.1)`.
    Constant,
    /// `(value: 3, unit: "1")`, which the expression `"${1 + 2}"` became, is 3 where things are
    /// counted.
    Count,
}

const CONSTANT: &str = "Constant(";

/// A step of the path from a value to one inside it.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// A field of this name.
    Field(String),
    /// An index in a tuple.
    Place(usize),
    /// Any element of a list or a map.
    Any,
}

impl Source {
    /// Returns the text with the value at which ron stopped rewritten, and the byte that ron must
    /// pass for the rewriting to be correct; `None` if no other notation applies.
    pub(super) fn respelled(&self, error: &SpannedError) -> Option<(Source, usize)> {
        let node = self.stopped_at(error)?;
        let change = match (&error.code, &node.kind) {
            (RonError::ExpectedArray, ValueKind::Group(group)) => {
                (group.shape == Shape::Tuple && group.name.is_none()).then_some(Change::List)
            }
            (RonError::ExpectedStructLike, ValueKind::Group(group)) => {
                (group.shape == Shape::List).then_some(Change::Tuple)
            }
            (
                RonError::ExpectedIdentifier
                | RonError::SuggestRawIdentifier(_)
                | RonError::NoSuchEnumVariant { .. },
                ValueKind::Number,
            ) => Some(Change::Constant),
            (RonError::ExpectedInteger, ValueKind::Group(_)) => {
                self.count_of(&node.span).map(|_| Change::Count)
            }
            _ => None,
        }?;
        let mut alike = Vec::new();
        let way = self.steps_to(&node.span);
        let root = self.tree.root.as_ref()?;
        self.collect(root, &way, change, &mut alike);
        let added = if change == Change::Constant {
            CONSTANT.len() + 1
        } else {
            0
        };
        let before = alike.iter().filter(|s| s.start < node.span.start).count();
        // The bracket of a group, or the whole of a number.
        let pass = match change {
            Change::Constant => node.span.end + added * (before + 1) - 1,
            Change::List | Change::Tuple => node.span.start,
            Change::Count => {
                let shorter = |span: &Range<usize>| {
                    let new = self.count_of(span).map_or(0, str::len);
                    span.len() - new
                };
                let before = alike.iter().filter(|s| s.start < node.span.start);
                node.span.start - before.map(shorter).sum::<usize>()
            }
        };
        let mut other = self.clone();
        // Values are rewritten from the last one on, so that the positions of the others stay
        // valid.
        for span in alike.iter().rev() {
            other.write(span, change);
        }
        other.tree = Tree::of(&other.text);
        Some((other, pass))
    }

    /// Returns the value that begins where ron stopped.
    fn stopped_at(&self, error: &SpannedError) -> Option<&Node> {
        let end = self.offset(&error.span.end);
        let rest = self.text.get(end..)?;
        let token = self.text.len() - rest.trim_start().len();
        let start = self.offset(&error.span.start);
        [start, end, token].into_iter().find_map(|at| {
            let node = self.tree.around(at)?;
            (node.span.start == at).then_some(node)
        })
    }

    pub(super) fn steps_to(&self, span: &Range<usize>) -> Vec<(Option<&str>, Step)> {
        let mut way = Vec::new();
        let mut node = self.tree.root.as_ref();
        while let Some((current, group)) = node.and_then(|n| Some((n, n.group()?))) {
            if current.span == *span {
                break;
            }
            let holds = |child: &Range<usize>| child.start <= span.start && span.end <= child.end;
            let entries = &group.entries;
            let Some(index) = entries.iter().position(|e| holds(&e.value.span)) else {
                break;
            };
            let name = group.name.as_ref().map(|name| &self.text[name.clone()]);
            way.push((name, self.step(current, index)));
            node = Some(&entries[index].value);
        }
        way
    }

    fn step(&self, node: &Node, index: usize) -> Step {
        let Some(group) = node.group() else {
            return Step::Any;
        };
        match (group.shape, group.entries.get(index)) {
            (Shape::Struct, Some(entry)) => {
                let key = entry.key.as_ref().map(|key| &self.text[key.clone()]);
                Step::Field(key.unwrap_or_default().to_owned())
            }
            (Shape::Tuple, _) => Step::Place(index),
            _ => Step::Any,
        }
    }

    /// Collects the values at the end of this path to which the change applies, in the order of the
    /// text.
    fn collect(
        &self,
        node: &Node,
        way: &[(Option<&str>, Step)],
        change: Change,
        out: &mut Vec<Range<usize>>,
    ) {
        let Some(((name, step), rest)) = way.split_first() else {
            let fits = match (&node.kind, change) {
                (ValueKind::Group(group), Change::List) => {
                    group.shape == Shape::Tuple && group.name.is_none()
                }
                (ValueKind::Group(group), Change::Tuple) => group.shape == Shape::List,
                (ValueKind::Number, Change::Constant) => true,
                (ValueKind::Group(_), Change::Count) => self.count_of(&node.span).is_some(),
                _ => false,
            };
            if fits {
                out.push(node.span.clone());
            }
            return;
        };
        let Some(group) = node.group() else { return };
        if group.name.as_ref().map(|n| &self.text[n.clone()]) != *name {
            return;
        }
        for (index, entry) in group.entries.iter().enumerate() {
            if self.step(node, index) == *step {
                self.collect(&entry.value, rest, change, out);
            }
        }
    }

    /// The whole number of a pair that an expression without a unit became.
    fn count_of(&self, span: &Range<usize>) -> Option<&str> {
        let inner = self.text[span.clone()].strip_prefix("(value: ")?;
        let number = inner.strip_suffix(", unit: \"1\")")?;
        number.parse::<i64>().is_ok().then_some(number)
    }

    fn write(&mut self, span: &Range<usize>, change: Change) {
        match change {
            Change::Constant => {
                for (at, text) in [(span.end, ")"), (span.start, CONSTANT)] {
                    self.source_map.insert(at, text.len());
                    self.text.insert_str(at, text);
                }
            }
            Change::Count => {
                if let Some(new) = self.count_of(span).map(str::to_owned) {
                    self.source_map.rewrite_all(&[(span.clone(), new.len())]);
                    self.text.replace_range(span.clone(), &new);
                }
            }
            // Both kinds of brackets have one byte, so no position changes.
            Change::List | Change::Tuple => {
                let (open, close) = if change == Change::List {
                    ("[", "]")
                } else {
                    ("(", ")")
                };
                self.text.replace_range(span.end - 1..span.end, close);
                self.text.replace_range(span.start..span.start + 1, open);
            }
        }
    }
}
