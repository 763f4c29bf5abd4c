//! Numbers with units in a text, `step: 10 us`, and expressions that stand for numbers, `mass:
//! "${rho * V}"`: each is replaced by what ron and the schema read, before the text is parsed.

use std::ops::Range;

use super::named_values::{NamedValues, has_expression};
use super::tree::{Entry, Node, Shape, ValueKind, join_path, plain, unquoted};
use super::{InputError, Source, Tree};
use crate::units::{Amount, Measure};
use crate::{quantity, units};

/// What a number with a unit becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// A number in this unit of the schema; empty for pure numbers.
    In(&'static str),
    /// The pair `(value: 10, unit: "us")`, whose unit is checked where its meaning is known.
    Pair,
    /// The schema has no number here, or one of unknown unit: the text stays as it is, for the
    /// parser to refuse, and an expression is refused.
    NoNumber,
}

/// Position of a number in a text.
#[derive(Debug)]
pub(crate) struct Place<'a> {
    /// Names of the fields and keys on the path to the number, and of the variants between them.
    pub names: &'a [String],
    /// Index of the number in a group without names, if it is in one.
    pub index: Option<usize>,
}

/// A number with a unit or an expression, and its position.
struct Found<'t> {
    kind: FoundKind<'t>,
    span: Range<usize>,
    names: Vec<String>,
    index: Option<usize>,
    /// The `unit` beside it, if the number is the `value` of a group.
    beside: Option<Beside>,
}

enum FoundKind<'t> {
    /// A number, and its unit.
    Quantity(Range<usize>, Range<usize>),
    /// A text with an expression.
    Expression(&'t Node),
}

/// Whether the group of a `value` has a `unit` too.
#[derive(Clone, Copy, PartialEq)]
enum Beside {
    Nothing,
    Unit,
}

impl Source {
    /// Whether a number of the text has a unit, or is an expression.
    pub(crate) fn has_quantities(&self) -> bool {
        self.any(|node| matches!(node.kind, ValueKind::Quantity(_))) || self.has_expressions()
    }

    /// Whether the text has names of values, or an expression.
    fn has_expressions(&self) -> bool {
        self.has_named_values() || self.any(|node| has_expression(&self.text, node))
    }

    /// Whether a value of the text is one of these.
    fn any(&self, wanted: impl Fn(&Node) -> bool) -> bool {
        let mut stack: Vec<&Node> = self.tree.root.iter().collect();
        while let Some(node) = stack.pop() {
            if wanted(node) {
                return true;
            }
            let group = node.group().into_iter();
            stack.extend(group.flat_map(|g| &g.entries).map(|e| &e.value));
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
        // Brackets that do not match would lead to wrong keys; the parser reports them, unless
        // names and expressions that were not replaced would keep it from getting there.
        if let Some(fault) = &self.tree.fault {
            return match self.has_expressions() {
                true => Err(self.error_in(&fault.span, fault.message.clone())),
                false => Ok(()),
            };
        }
        if self.tree.too_deep.is_some() {
            return Ok(());
        }
        let names = self.named_values()?;
        let mut all = Vec::new();
        if let Some(root) = &self.tree.root {
            collect(&self.text, root, &mut Vec::new(), &mut all);
        }
        if all.is_empty() && names.whole.is_none() {
            return Ok(());
        }
        // The name of the text's own type is no part of a path.
        let root = self.tree.root.as_ref().and_then(Node::group);
        let typed = |group: &&super::Group| group.name.is_some() && !group.is_some(&self.text);
        let own = usize::from(root.filter(typed).is_some());
        let within = |found: &Found<'_>| {
            let whole = names.whole.as_ref();
            whole
                .is_some_and(|whole| whole.start <= found.span.start && found.span.end <= whole.end)
        };
        let mut edits = Vec::new();
        for found in all.iter().filter(|found| !within(found)) {
            let place = Place {
                names: found.names.get(own..).unwrap_or_default(),
                index: found.index,
            };
            let wanted = wanted(&place);
            let new = match &found.kind {
                FoundKind::Quantity(number, unit) => {
                    self.replacement_of(found, number, unit, wanted)?
                }
                FoundKind::Expression(node) => self.result_of(found, node, &names, wanted)?,
            };
            edits.extend(new.map(|new| (found.span.clone(), new)));
        }
        self.refuse_unused(&names)?;
        edits.extend(names.whole.map(|whole| (whole, String::new())));
        edits.sort_by_key(|(span, _)| span.start);
        if self.written.is_none() {
            self.written = Some(self.text.as_str().into());
        }
        let lengths = edits.iter().map(|(span, new)| (span.clone(), new.len()));
        self.source_map.rewrite_all(&lengths.collect::<Vec<_>>());
        let mut text = String::with_capacity(self.text.len());
        let mut at = 0;
        for (span, new) in edits {
            text += &self.text[at..span.start];
            text += &new;
            at = span.end;
        }
        text += &self.text[at..];
        self.text = text;
        self.tree = Tree::of(&self.text);
        Ok(())
    }

    /// Returns the text that takes the place of a number with a unit; `None` if it stays.
    fn replacement_of(
        &self,
        found: &Found<'_>,
        number: &Range<usize>,
        place: &Range<usize>,
        wanted: Wanted,
    ) -> Result<Option<String>, InputError> {
        let number = &self.text[number.clone()];
        let unit = &self.text[place.clone()];
        Ok(match (wanted, found.beside) {
            (Wanted::NoNumber, _) => None,
            (Wanted::Pair, Some(Beside::Unit)) => {
                let message = "the number has a unit, and there is a `unit` beside it";
                return Err(self.error_in(place, message).expected("one of the two"));
            }
            (Wanted::Pair, Some(Beside::Nothing)) => {
                self.known(place, unit)?;
                Some(format!("{number}, unit: \"{unit}\""))
            }
            (Wanted::Pair, None) => {
                self.known(place, unit)?;
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
                        return Err(self.of_unit(place, message, error));
                    }
                }
            }
        })
    }

    /// Returns the text that takes the place of an expression; `None` if it stays.
    fn result_of(
        &self,
        found: &Found<'_>,
        node: &Node,
        names: &NamedValues,
        wanted: Wanted,
    ) -> Result<Option<String>, InputError> {
        if wanted == Wanted::NoNumber {
            let message = format!("{} takes no expression", self.key_of(found));
            return Err(self.error_in(&node.span, message));
        }
        let Some((Amount { value, measure }, written)) = self.amount_of(node, names)? else {
            names.use_in_text(&self.text[node.span.clone()]);
            return match wanted {
                Wanted::In(_) => {
                    let message = "an expression is the whole text of a number";
                    Err(self.error_in(&node.span, message).expected("`\"${...}\"`"))
                }
                _ => Ok(None),
            };
        };
        // Whole numbers may stand where numbers are counted.
        let number = match measure.equals(&Measure::NUMBER) && value.abs() < 1e15 {
            true if value.fract() == 0.0 => format!("{value:.0}"),
            _ => format!("{value:?}"),
        };
        let pair = |before: &str, after: &str| {
            let unit = measure.symbol().ok_or_else(|| {
                let message = format!("`{written}` is {}, which no unit has", measure.in_words());
                self.error_in(&node.span, message)
            })?;
            // A pure number is said to be one, so that it does not pass in a unit of the law.
            let unit = if unit.is_empty() { "1" } else { &unit };
            Ok(Some(format!("{before}{number}, unit: \"{unit}\"{after}")))
        };
        match (wanted, found.beside) {
            (Wanted::Pair, Some(Beside::Unit)) if measure.is_number() => Ok(Some(number)),
            (Wanted::Pair, Some(Beside::Unit)) => {
                let message = format!(
                    "`{written}` is {}, and there is a `unit` beside it",
                    measure.in_words()
                );
                Err(self
                    .error_in(&node.span, message)
                    .expected("one of the two"))
            }
            (Wanted::Pair, Some(Beside::Nothing)) => pair("", ""),
            (Wanted::Pair, None) => pair("(value: ", ")"),
            (Wanted::In(schema), _) => {
                let fits = Measure::of_unit(schema).is_ok_and(|field| measure.fits(&field));
                if fits {
                    return Ok(Some(number));
                }
                let unit = match schema {
                    "" => String::new(),
                    unit => format!(", in `{unit}`"),
                };
                let message = format!(
                    "{} is {}{unit}, and `{written}` is {}",
                    self.key_of(found),
                    kind_of(schema),
                    measure.in_words()
                );
                Err(self.error_in(&node.span, message))
            }
            (Wanted::NoNumber, _) => Ok(None),
        }
    }

    /// Refuses a unit that no table has, at its place.
    fn known(&self, place: &Range<usize>, unit: &str) -> Result<(), InputError> {
        units::known(unit).map_err(|error| self.of_unit(place, error.message.clone(), error))
    }

    fn of_unit(
        &self,
        place: &Range<usize>,
        message: String,
        error: units::UnitError,
    ) -> InputError {
        let at = self.error_in(place, message);
        let at = match error.expected {
            Some(expected) => at.expected(expected),
            None => at,
        };
        at.did_you_mean(error.nearest.as_deref())
    }

    fn key_of(&self, found: &Found<'_>) -> String {
        let path = self.tree.path_of(&self.text, &found.span);
        format!("`{}`", join_path(&path))
    }
}

/// Collects the numbers with units and the expressions in a value, in the order of the text.
fn collect<'t>(text: &str, node: &'t Node, names: &mut Vec<String>, out: &mut Vec<Found<'t>>) {
    let mut found = |kind| {
        out.push(Found {
            kind,
            span: node.span.clone(),
            names: names.clone(),
            index: None,
            beside: None,
        });
    };
    match &node.kind {
        ValueKind::Quantity(unit) => {
            let length = quantity::parts(&text[node.span.clone()]).0;
            let number = node.span.start..node.span.start + length;
            found(FoundKind::Quantity(number, unit.clone()));
        }
        ValueKind::Text if has_expression(text, node) => found(FoundKind::Expression(node)),
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
                let own = entry.value.group().is_none();
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
    Some(unquoted(&text[entry.key.clone()?]))
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
