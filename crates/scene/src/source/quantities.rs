//! Numbers with units in a text, `step: 10 us`: each is replaced by what ron and the schema read,
//! before the text is parsed.

use std::ops::Range;

use super::tree::{Entry, Node, Shape, ValueKind, join_path, plain};
use super::{InputError, Source, Tree};
use crate::{quantity, units};

/// What a number with a unit becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// A number in this unit of the schema; empty for pure numbers.
    In(&'static str),
    /// The pair `(value: 10, unit: "us")`, whose unit is checked where its meaning is known.
    Pair,
    /// The text stays as it is: the schema has no number here, or one of unknown unit.
    AsWritten,
}

/// Position of a number in a text.
#[derive(Debug)]
pub(crate) struct Place<'a> {
    /// Names of the fields and keys on the path to the number, and of the variants between them.
    pub names: &'a [String],
    /// Index of the number in a group without names, if it is in one.
    pub index: Option<usize>,
}

/// A number with a unit, and its position.
struct Found {
    number: Range<usize>,
    unit: Range<usize>,
    names: Vec<String>,
    index: Option<usize>,
    /// The `unit` beside it, if the number is the `value` of a group.
    beside: Option<Beside>,
}

/// Whether the group of a `value` has a `unit` too.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    Nothing,
    Unit,
}

impl Source {
    /// Whether a number of the text has a unit.
    pub(crate) fn has_quantities(&self) -> bool {
        let mut stack: Vec<&Node> = self.tree.root.iter().collect();
        while let Some(node) = stack.pop() {
            match &node.kind {
                ValueKind::Quantity(_) => return true,
                ValueKind::Group(group) => stack.extend(group.entries.iter().map(|e| &e.value)),
                _ => {}
            }
        }
        false
    }

    /// Replaces each number with a unit, `5 um`, by `(value: 5, unit: "um")`, for a schema that
    /// takes such pairs.
    ///
    /// # Errors
    /// A unit is unknown, or given twice.
    pub fn pair_quantities(&mut self) -> Result<(), InputError> {
        self.replace_quantities(|_| Wanted::Pair)
    }

    /// Replaces the numbers with units by those that the schema takes, as `wanted` says for each
    /// position. Errors of the parser keep their positions in the file.
    ///
    /// # Errors
    /// A unit is unknown, or of another dimension than that of its key, or given twice.
    pub(crate) fn replace_quantities(
        &mut self,
        wanted: impl Fn(&Place<'_>) -> Wanted,
    ) -> Result<(), InputError> {
        // Brackets that do not match would lead to wrong keys; the parser reports them.
        if self.tree.fault.is_some() || self.tree.too_deep.is_some() {
            return Ok(());
        }
        let mut all = Vec::new();
        if let Some(root) = &self.tree.root {
            collect(&self.text, root, &mut Vec::new(), &mut all);
        }
        if all.is_empty() {
            return Ok(());
        }
        // The name of the text's own type is no part of a path.
        let typed = self.tree.root.as_ref().and_then(Node::group);
        if typed.is_some_and(|group| group.name.is_some() && !group.is_some(&self.text)) {
            for found in &mut all {
                found.names.remove(0);
            }
        }
        let mut edits: Vec<(Range<usize>, String)> = Vec::new();
        for found in &all {
            let place = Place {
                names: &found.names,
                index: found.index,
            };
            if let Some(new) = self.replacement_of(found, wanted(&place))? {
                edits.push((found.number.start..found.unit.end, new));
            }
        }
        // From the last one on, so that the positions of the others stay valid.
        for (span, new) in edits.into_iter().rev() {
            self.source_map.rewrite(&span, new.len());
            self.text.replace_range(span, &new);
        }
        self.tree = Tree::of(&self.text);
        Ok(())
    }

    /// Returns the text that takes the place of a number with a unit; `None` if it stays.
    fn replacement_of(&self, found: &Found, wanted: Wanted) -> Result<Option<String>, InputError> {
        let number = &self.text[found.number.clone()];
        let unit = &self.text[found.unit.clone()];
        Ok(match (wanted, found.beside) {
            (Wanted::AsWritten, _) => None,
            (Wanted::Pair, Some(Beside::Unit)) => {
                let message = "the number has a unit, and there is a `unit` beside it";
                return Err(self
                    .error_in(&found.unit, message)
                    .expected("one of the two"));
            }
            (Wanted::Pair, Some(Beside::Nothing)) => {
                self.known(found, unit)?;
                Some(format!("{number}, unit: \"{unit}\""))
            }
            (Wanted::Pair, None) => {
                self.known(found, unit)?;
                Some(format!("(value: {number}, unit: \"{unit}\")"))
            }
            (Wanted::In(schema), _) => {
                let value = quantity::number(number).unwrap_or(f64::NAN);
                match units::convert(value, unit, schema) {
                    Ok(value) => Some(format!("{value:?}")),
                    Err(error) => {
                        let key = self.key_of(found);
                        let kind = kind_of(schema);
                        let message = format!("{key} is {kind}, and {}", error.message);
                        return Err(self.of_unit(found, message, error));
                    }
                }
            }
        })
    }

    /// Refuses a unit that no table has, at its place.
    fn known(&self, found: &Found, unit: &str) -> Result<(), InputError> {
        units::known(unit).map_err(|error| self.of_unit(found, error.message.clone(), error))
    }

    fn of_unit(&self, found: &Found, message: String, error: units::UnitError) -> InputError {
        let at = self.error_in(&found.unit, message);
        let at = match error.expected {
            Some(expected) => at.expected(expected),
            None => at,
        };
        at.did_you_mean(error.nearest.as_deref())
    }

    fn key_of(&self, found: &Found) -> String {
        let span = found.number.start..found.unit.end;
        let path = self.tree.path_of(&self.text, &span);
        format!("`{}`", join_path(&path))
    }
}

/// Collects the numbers with units in a value, in the order of the text.
fn collect(text: &str, node: &Node, names: &mut Vec<String>, out: &mut Vec<Found>) {
    match &node.kind {
        ValueKind::Quantity(unit) => out.push(Found {
            number: node.span.start..node.span.start + quantity::parts(&text[node.span.clone()]).0,
            unit: unit.clone(),
            names: names.clone(),
            index: None,
            beside: None,
        }),
        ValueKind::Group(group) => {
            let before = names.len();
            if let Some(name) = group.name.as_ref().filter(|_| !group.is_some(text)) {
                names.push(plain(&text[name.clone()]).to_owned());
            }
            let unit = |entry: &Entry| key(text, entry).as_deref() == Some("unit");
            let beside = match group.entries.iter().any(unit) {
                true => Beside::Unit,
                false => Beside::Nothing,
            };
            for (index, entry) in group.entries.iter().enumerate() {
                let key = key(text, entry);
                let depth = names.len();
                names.extend(key.clone());
                let first = out.len();
                collect(text, &entry.value, names, out);
                names.truncate(depth);
                let own = matches!(entry.value.kind, ValueKind::Quantity(_));
                if let Some(found) = out.get_mut(first).filter(|_| own) {
                    found.index = key.is_none().then_some(index);
                    let value = key.as_deref() == Some("value");
                    found.beside = (value && group.shape == Shape::Struct).then_some(beside);
                }
            }
            names.truncate(before);
        }
        _ => {}
    }
}

/// The name of a field, or the key of a map without its quotes.
fn key(text: &str, entry: &Entry) -> Option<String> {
    let written = &text[entry.key.clone()?];
    Some(match written.starts_with(['"', 'r']) {
        true => ron::from_str(written).unwrap_or_else(|_| plain(written).to_owned()),
        false => written.to_owned(),
    })
}

/// Words for common units of the schema, as the end of a sentence: "a time".
const KINDS: [(&str, &str); 25] = [
    ("", "a pure number"),
    ("m", "a length"),
    ("m^2", "an area"),
    ("s", "a time"),
    ("1/s", "a rate"),
    ("kg", "a mass"),
    ("kg/m", "a mass per depth"),
    ("kg m^2", "a moment of inertia"),
    ("kg m", "a moment of inertia per depth"),
    ("m/s", "a speed"),
    ("m/s^2", "an acceleration"),
    ("rad", "an angle"),
    ("rad/s", "a speed of rotation"),
    ("Hz", "a frequency"),
    ("N", "a force"),
    ("N/m", "a force per depth"),
    ("N m", "a moment"),
    ("N m/m", "a moment per depth"),
    ("J", "an energy"),
    ("J/m", "an energy per depth"),
    ("Pa", "a stress"),
    ("K", "a temperature"),
    ("W", "a power"),
    ("W/m", "a power per depth"),
    ("V", "a voltage"),
];

/// Returns what a unit of the schema measures, as the end of a sentence.
fn kind_of(unit: &str) -> String {
    match KINDS.iter().find(|(known, _)| *known == unit) {
        Some((_, words)) => (*words).to_owned(),
        None => format!("in `{unit}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_with_a_word_is_known_and_others_are_named() {
        for (unit, _) in KINDS {
            assert!(units::known(unit).is_ok(), "{unit}");
        }
        assert_eq!(kind_of("s"), "a time");
        assert_eq!(kind_of("W/m^2"), "in `W/m^2`");
    }
}
