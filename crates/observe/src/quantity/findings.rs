//! List of the results of the observers of a run.

use super::path::matches;
use super::{Described, Estimate, Field, PathStep, Quantity, Role, Schema, Topic, Unit, Wording};
use crate::warning::Warning;
use serde_json::Value;
use std::any::Any;
use std::collections::HashMap;
use std::fmt;
use std::sync::Arc;

/// The group of the numbers of measures.
const MEASURES: &str = "measures";

/// Quantities in the order in which they were added, and warnings. A quantity that is added again
/// replaces the value of the first.
#[derive(Clone, Default)]
pub struct Findings {
    dimension: usize,
    topic: Topic,
    role: Role,
    list: Vec<Quantity>,
    /// Name of the observer that adds results; empty if there is none.
    observer: String,
    /// Names of the observers that added the quantities, in the order of the list.
    observers: Vec<String>,
    places: HashMap<String, usize>,
    warnings: Vec<Warning>,
    /// Fields of results that are not available yet.
    to_come: Vec<Expected>,
    /// Typed results from which the quantities were made, one of each type.
    typed: Vec<Arc<dyn Any + Send + Sync>>,
}

/// Converts a doc comment to an explanation: on one line, without capital and full stop.
fn plain(doc: &str) -> String {
    let words = doc.split_whitespace().collect::<Vec<_>>().join(" ");
    let text = words.strip_suffix('.').unwrap_or(&words);
    let mut letters = text.chars();
    match (letters.next(), letters.next()) {
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain(text.chars().skip(1)).collect()
        }
        _ => text.to_owned(),
    }
}

/// A field of a result that is not available yet.
#[derive(Clone, Debug)]
pub struct Expected {
    /// Path, with `*` for indices in a list.
    pub path: String,
    /// Unit.
    pub unit: Unit,
    /// Explanation.
    pub doc: String,
    /// Prominence.
    pub role: Role,
}

impl fmt::Debug for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut map = f.debug_map();
        for q in &self.list {
            map.entry(&q.name(), &q.value);
        }
        map.finish()
    }
}

impl Findings {
    /// Creates an empty list for a run in a dimension.
    pub fn new(dimension: usize) -> Self {
        Self {
            dimension,
            ..Self::default()
        }
    }

    /// Returns the dimension of the run.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Sets the default topic and role of the quantities that are added next.
    pub fn begin(&mut self, topic: Topic, role: Role) {
        (self.topic, self.role) = (topic, role);
    }

    /// Sets the observer that adds results next, and the default topic and role; an empty name
    /// stands for none. A path to which two observers give values is a reason not to trust the run,
    /// since only the later value is left.
    pub fn begin_observer(&mut self, name: &str) {
        name.clone_into(&mut self.observer);
        self.begin(Topic::default(), Role::default());
    }

    /// Adds a quantity by its path, in which whole numbers are indices in lists.
    pub fn add(
        &mut self,
        path: &str,
        value: impl Into<Value>,
        unit: Unit,
        doc: impl Into<String>,
    ) -> &mut Quantity {
        let steps = path.split('.').map(|part| match part.parse() {
            Ok(place) => PathStep::Place(place),
            Err(_) => PathStep::Key(part.to_owned()),
        });
        self.put(steps.collect(), value.into(), unit, doc.into())
    }

    /// Adds an entry of a group, whose key may be any text.
    pub fn entry(
        &mut self,
        group: &str,
        key: &str,
        value: impl Into<Value>,
        unit: Unit,
        doc: impl Into<String>,
    ) -> &mut Quantity {
        let path = [group, key].map(|k| PathStep::Key(k.to_owned()));
        self.put(path.to_vec(), value.into(), unit, doc.into())
    }

    /// Adds a number of a measure of the case, with its unit. Without a value, or without one yet,
    /// it is only declared.
    pub fn measure(
        &mut self,
        name: &str,
        value: impl Into<Option<f64>>,
        unit: Unit,
        doc: impl Into<String>,
    ) {
        let Some(value) = value.into() else {
            return self.to_come.push(Expected {
                path: format!("{MEASURES}.{name}"),
                unit,
                doc: doc.into(),
                role: Role::Secondary,
            });
        };
        let symbol = unit.heading(self.dimension);
        if !symbol.is_empty() {
            let doc = "unit of the measure of this name";
            let said = self.entry("measure_units", name, symbol, super::unit::WORD, doc);
            said.role = Role::Detail;
        }
        let measure = self.entry(MEASURES, name, value, unit, doc);
        measure.about(Topic::Measures).secondary(name);
    }

    /// Adds a result in words.
    pub fn finding(
        &mut self,
        name: &str,
        text: impl Into<String>,
        doc: impl Into<String>,
    ) -> &mut Quantity {
        let text: String = text.into();
        let found = self.entry("findings", name, text.clone(), super::unit::WORD, doc);
        found.about(Topic::Measures).secondary(name);
        found.sentence(name, text)
    }

    fn put(&mut self, path: Vec<PathStep>, value: Value, unit: Unit, doc: String) -> &mut Quantity {
        let quantity = Quantity {
            path,
            value,
            unit,
            doc,
            role: self.role,
            topic: self.topic,
            label: String::new(),
            estimate: None,
            wording: Wording::Silent,
            lacks: None,
        };
        let next = self.list.len();
        let place = *self.places.entry(quantity.name()).or_insert(next);
        if place == next {
            self.list.push(quantity);
            self.observers.push(self.observer.clone());
        } else {
            // One observer may give the value that is not known to another.
            let known = !self.list[place].value.is_null();
            let (earlier, later) = (&self.observers[place], &self.observer);
            if known && earlier != later && !earlier.is_empty() && !later.is_empty() {
                let text = format!(
                    "the observers `{earlier}` and `{later}` both report `{}`, and the value is that of `{later}`; give the result of one of them another path",
                    quantity.name()
                );
                self.warnings.push(Warning::serious("REPORTED TWICE", text));
            }
            self.observers[place].clone_from(&self.observer);
            self.list[place] = quantity;
        }
        &mut self.list[place]
    }

    /// Adds all fields of a described result below a path (at the root where it is empty), and
    /// keeps it for [`Findings::get`]. `doc` is the explanation where there are no values, such as
    /// for an empty list.
    ///
    /// # Panics
    /// The result has a field without unit and explanation, or a list where one value is described.
    pub fn part<T: Described>(&mut self, path: &str, result: &T, doc: &str) {
        self.keep(result.clone());
        self.fields(path, result, T::FIELDS, doc);
    }

    /// Adds all fields of a list of described results, or of an optional one, which is null where
    /// there is none.
    ///
    /// # Panics
    /// The panics are those of [`Findings::part`].
    pub fn parts<T: Described>(
        &mut self,
        path: &str,
        results: &(impl serde::Serialize + ?Sized),
        doc: &str,
    ) {
        self.fields(path, results, T::FIELDS, doc);
    }

    /// Adds a result whose fields are described separately.
    ///
    /// # Panics
    /// The panics are those of [`Findings::part`].
    pub fn fields(
        &mut self,
        path: &str,
        result: &(impl serde::Serialize + ?Sized),
        fields: &'static [Field],
        doc: &str,
    ) {
        let value = serde_json::to_value(result).unwrap_or_default();
        let steps = path.split('.').filter(|p| !p.is_empty());
        let steps = steps.map(|p| PathStep::Key(p.to_owned())).collect();
        self.walk(steps, value, Schema::Part(fields), doc);
    }

    fn walk(&mut self, path: Vec<PathStep>, value: Value, schema: Schema, doc: &str) {
        let below = |step: PathStep| {
            let mut path = path.clone();
            path.push(step);
            path
        };
        match (value, schema) {
            (Value::Array(list), _) if !list.is_empty() => {
                for (k, value) in list.into_iter().enumerate() {
                    self.walk(below(PathStep::Place(k)), value, schema.of_entries(), doc);
                }
            }
            (Value::Object(mut map), Schema::Part(fields)) => {
                for field in fields {
                    if let Some(value) = map.remove(field.name) {
                        let one = match field.schema {
                            Schema::Values(unit) => unit != super::unit::WORD,
                            schema => matches!(schema, Schema::Part(_)),
                        };
                        assert!(!(one && value.is_array()), "{} is a list", field.name);
                        let path = below(PathStep::Key(field.name.to_owned()));
                        self.walk(path, value, field.schema, field.doc);
                    }
                }
                let left: Vec<&String> = map.keys().collect();
                assert!(left.is_empty(), "no unit and no explanation of {left:?}");
            }
            (Value::Object(map), Schema::Values(_)) if !map.is_empty() => {
                for (key, value) in map {
                    self.walk(below(PathStep::Key(key)), value, schema, doc);
                }
            }
            (leaf, schema) => {
                let unit = match schema {
                    Schema::Values(unit) | Schema::ListOfValues(unit) => unit,
                    Schema::Part(_) | Schema::ListOfParts(_) | Schema::Hidden => super::unit::WORD,
                };
                // A list of results by itself has the schema of one of them.
                let schema = match (schema, &leaf) {
                    (Schema::Part(fields), Value::Array(_)) => Schema::ListOfParts(fields),
                    _ => schema,
                };
                let name = self.put(path, leaf, unit, plain(doc)).pattern();
                if !matches!(schema, Schema::Values(_)) {
                    self.expect(&name, schema, doc);
                }
            }
        }
    }

    /// Records what a path will have that is not available yet.
    fn expect(&mut self, path: &str, schema: Schema, doc: &str) {
        match schema {
            Schema::Values(unit) => self.to_come.push(Expected {
                path: path.to_owned(),
                unit,
                doc: plain(doc),
                role: self.role,
            }),
            Schema::Part(fields) => {
                for field in fields {
                    self.expect(&format!("{path}.{}", field.name), field.schema, field.doc);
                }
            }
            Schema::ListOfValues(_) | Schema::ListOfParts(_) => {
                self.expect(&format!("{path}.*"), schema.of_entries(), doc);
            }
            Schema::Hidden => {}
        }
    }

    /// Returns fields of results, and numbers of measures, that are not available yet.
    pub fn expected(&self) -> &[Expected] {
        &self.to_come
    }

    /// Returns whether there will be a number of this path that is not available yet.
    pub fn expects(&self, path: &str) -> bool {
        let mut numbers = self.to_come.iter().filter(|e| e.unit != super::unit::WORD);
        numbers.any(|e| matches(&e.path, path))
    }

    /// Returns whether there will be values below this path that are not available yet.
    pub fn expects_below(&self, path: &str) -> bool {
        let length = path.split('.').count();
        let above = |e: &Expected| {
            let parts: Vec<&str> = e.path.split('.').collect();
            parts.len() > length && matches(&parts[..length].join("."), path)
        };
        self.to_come.iter().any(above)
    }

    /// Returns the SI unit of a number by its path, `1` for pure numbers, also for a number that is
    /// not available yet or in a longer list; `None` where the path is unknown.
    pub fn unit_of(&self, path: &str) -> Option<&'static str> {
        let own = self.list.iter().find(|q| q.name() == path);
        let alike = || self.list.iter().find(|q| matches(&q.pattern(), path));
        let unit = own.or_else(alike).map(|q| q.unit);
        let later = || self.to_come.iter().find(|e| matches(&e.path, path));
        let unit = unit
            .or_else(|| later().map(|e| e.unit))?
            .symbol(self.dimension);
        (!unit.is_empty()).then_some(unit)
    }

    /// Adds a warning.
    pub fn warn(&mut self, warnings: impl IntoIterator<Item = Warning>) {
        for warning in warnings {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    /// Keeps a result for [`Findings::get`].
    pub fn keep<T: Send + Sync + 'static>(&mut self, result: T) {
        self.typed.retain(|kept| !kept.is::<T>());
        self.typed.push(Arc::new(result));
    }

    /// Returns a result of a type that an observer reported.
    pub fn get<T: 'static>(&self) -> Option<&T> {
        self.typed.iter().find_map(|kept| kept.downcast_ref())
    }

    /// The quantities.
    pub fn all(&self) -> &[Quantity] {
        &self.list
    }

    /// The warnings.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// Returns a quantity by its path.
    pub fn quantity(&self, name: &str) -> Option<&Quantity> {
        self.places.get(name).map(|k| &self.list[*k])
    }

    /// Changes how a quantity is shown.
    pub fn edit(&mut self, name: &str, change: impl FnOnce(&mut Quantity)) {
        if let Some(k) = self.places.get(name) {
            change(&mut self.list[*k]);
        }
    }

    /// Changes the quantities whose path begins with one of these keys.
    pub fn edit_all(&mut self, groups: &[&str], change: impl Fn(&mut Quantity)) {
        let of = |q: &&mut Quantity| {
            let name = q.name();
            groups.iter().any(|group| {
                let rest = name.strip_prefix(group);
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
            })
        };
        self.list.iter_mut().filter(of).for_each(change);
    }

    /// Adds half-widths to a quantity.
    pub fn estimate(&mut self, name: &str, estimate: &Estimate) {
        self.edit(name, |q| q.estimate = Some(estimate.clone().judged()));
    }

    /// Returns the number of a quantity; `None` where it is null, not a number, or not available.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.quantity(name)?.value.as_f64()
    }

    /// The text of a quantity.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.quantity(name)?.value.as_str()
    }

    /// Adds all results of another list.
    pub fn extend(&mut self, other: &Self) {
        for q in &other.list {
            let added = self.put(q.path.clone(), Value::Null, q.unit, String::new());
            added.clone_from(q);
        }
        self.to_come.extend(other.to_come.iter().cloned());
        self.warn(other.warnings.iter().cloned());
    }
}

#[cfg(test)]
mod tests {
    use super::super::unit::{MASS, MASS_FLOW, SECOND};
    use super::super::{parts, values};
    use super::*;
    use serde::Serialize;

    crate::described! {
        /// An entry.
        #[derive(Clone, Debug, Serialize)]
        struct Entry {
            /// Its mass.
            mass: f64 => MASS,
        }
    }

    crate::described! {
        /// A group.
        #[derive(Clone, Debug, Serialize)]
        struct Group {
            /// Entries.
            entries: Vec<Entry> = parts::<Entry>(),
            /// Start and end.
            window: [f64; 2] = values(SECOND),
        }
    }

    #[test]
    fn one_path_of_two_observers_is_no_result_to_trust() {
        let mut found = Findings::new(2);
        let mut report = |observer: &str, path: &str| {
            found.begin_observer(observer);
            found.add(path, 1.0, MASS, "a mass");
            found.add(path, 2.0, MASS, "a mass");
            found.warnings().len()
        };
        assert_eq!(report("wear", "wear.mass"), 0);
        assert_eq!(report("mine", "mine.mass"), 0);
        assert_eq!(report("mine", "wear.mass"), 1);
        let warning = &found.warnings()[0];
        assert!(warning.serious, "{warning}");
        for name in ["`wear`", "`mine`", "`wear.mass`"] {
            assert!(warning.text.contains(name), "{warning}");
        }
    }

    #[test]
    fn one_observer_gives_the_value_that_another_does_not_know() {
        let mut found = Findings::new(2);
        for (observer, value) in [("wear", None), ("friction test", Some(1.0)), ("mine", None)] {
            found.begin_observer(observer);
            found.add("wear.load_path", value, MASS, "a path");
        }
        let warnings = found.warnings();
        assert_eq!(warnings.len(), 1, "{warnings:?}");
        assert!(
            warnings[0].text.contains("`friction test` and `mine`"),
            "{warnings:?}"
        );
    }

    #[test]
    fn what_has_no_value_yet_has_its_path_and_unit() {
        let mut found = Findings::new(2);
        found.parts::<Group>("group", &None::<Group>, "a group");
        found.measure("flow", None::<f64>, MASS_FLOW, "a flow");
        for (path, unit) in [
            ("group.entries.3.mass", "kg/m"),
            ("group.window.1", "s"),
            ("measures.flow", "kg/(m s)"),
        ] {
            assert_eq!(found.unit_of(path), Some(unit), "{path}");
            assert!(found.expects(path), "{path}");
        }
        for group in ["group", "group.entries", "group.entries.3", "group.window"] {
            assert!(
                found.expects_below(group) && !found.expects(group),
                "{group}"
            );
        }
        for none in ["group.entries.mass", "group.window.1.mass", "measures.flw"] {
            assert!(!found.expects(none) && !found.expects_below(none), "{none}");
        }
        // A list that is there has the paths of its entries, and an empty one those to come.
        let group = |entries: Vec<Entry>| Group {
            entries,
            window: [0.0, 1.0],
        };
        found.part("now", &group(vec![Entry { mass: 2.0 }]), "");
        found.part("empty", &group(Vec::new()), "");
        assert_eq!(found.number("now.entries.0.mass"), Some(2.0));
        assert_eq!(found.unit_of("now.entries.7.mass"), Some("kg/m"));
        assert_eq!(found.unit_of("empty.entries.0.mass"), Some("kg/m"));
        assert_eq!(found.number("measures.flow"), None);
    }
}
