//! Detection of keys that a map gives twice; ron would silently use the last one.

use std::collections::HashMap;
use std::ops::Range;

use super::tree::{Node, Shape, ValueKind};
use super::{InputError, Source};

/// A repeated key of a map.
struct Repeated {
    earlier: Range<usize>,
    again: Range<usize>,
    name: String,
    map: Range<usize>,
}

impl Source {
    /// An error at the first repeated key, if any.
    pub(super) fn repeated_key(&self) -> Option<InputError> {
        let mut found: Option<Repeated> = None;
        let mut stack: Vec<&Node> = self.tree.root.iter().collect();
        while let Some(node) = stack.pop() {
            let ValueKind::Group(group) = &node.kind else {
                continue;
            };
            stack.extend(group.entries.iter().map(|entry| &entry.value));
            if group.shape != Shape::Map {
                continue;
            }
            let mut known: HashMap<String, &Range<usize>> = HashMap::new();
            for key in group.entries.iter().filter_map(|entry| entry.key.as_ref()) {
                let written = &self.text[key.clone()];
                let name = ron::from_str::<String>(written).unwrap_or_else(|_| written.to_owned());
                let earlier = known.insert(name.clone(), key);
                let first = found.as_ref().is_none_or(|f| key.start < f.again.start);
                if let Some(earlier) = earlier.filter(|_| first) {
                    found = Some(Repeated {
                        earlier: earlier.clone(),
                        again: key.clone(),
                        name,
                        map: node.span.clone(),
                    });
                    break;
                }
            }
        }
        let Repeated {
            earlier,
            again,
            name,
            map,
        } = found?;
        let owner = self.path_to(&map);
        let place = owner.map_or_else(String::new, |path| format!(" in {path}"));
        let before = self.place_in_words(&earlier);
        let message = format!("the key `{name}` is given twice{place}, first at {before}");
        Some(self.error_in(&again, message).help("remove one of the two"))
    }

    /// Returns line and column of a range, and the `--set` that contained it.
    pub(super) fn place_in_words(&self, span: &Range<usize>) -> String {
        let error = self.error_in(span, "");
        let (line, column) = error.position().unwrap_or_default();
        match error.set() {
            Some(set) => format!("line {line}, column {column} (from `--set {set}`)"),
            None => format!("line {line}, column {column}"),
        }
    }
}
