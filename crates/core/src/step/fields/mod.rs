//! Output quantities of grains and contacts; each field is registered once with its name, unit and
//! a line of explanation.
//!
//! The views of `results.h5`, the pictures and the test of the documentation use the list; a
//! program adds its own fields to [`Simulation::fields`] before the first state is written:
//!
//! ```
//! use fretwork_core::contact::Contact;
//! use fretwork_core::fields::Field;
//! use fretwork_core::geometry::space::Dim2;
//! use fretwork_core::step::Simulation;
//!
//! fn watch_age(simulation: &mut Simulation<Dim2>) {
//!     let age = |s: &Simulation<Dim2>, contact: &Contact<Dim2>| s.state.time - contact.formed_at;
//!     let age = Field::number("age", "s", "time since the contact formed", age);
//!     simulation.fields.contacts.add(age);
//! }
//! ```

mod contacts;
mod grains;
mod heat;

pub use contacts::id_fields;
pub use grains::{GrainPart, ORIENTATION, orientation, removed};
pub use heat::{heat_of_contacts, heat_of_grains};

use crate::contact::Contact;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use std::fmt;
use std::sync::Arc;

/// The function behind a field.
type Get<S, T, V> = Arc<dyn Fn(&Simulation<S>, &T) -> V + Send + Sync>;

/// Function that reads a value.
pub enum Value<S: Space, T> {
    /// A number.
    Number(Get<S, T, f64>),
    /// A whole number, such as an identity.
    Whole(Get<S, T, i64>),
    /// A vector in world axes, x, y, z; in 2D z is 0.
    Vector(Get<S, T, [f64; 3]>),
}

/// A quantity of each item of a kind (`T`: [`GrainPart`], [`Contact`]).
pub struct Field<S: Space, T> {
    /// Name: a-z, 0-9 and _.
    pub name: &'static str,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// Description in one line.
    pub doc: &'static str,
    /// The value.
    pub value: Value<S, T>,
}

impl<S: Space, T> Field<S, T> {
    /// A field of numbers.
    pub fn number(
        name: &'static str,
        unit: &'static str,
        doc: &'static str,
        get: impl Fn(&Simulation<S>, &T) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self {
            name,
            unit,
            doc,
            value: Value::Number(Arc::new(get)),
        }
    }

    /// A field of whole numbers.
    pub fn whole(
        name: &'static str,
        doc: &'static str,
        get: impl Fn(&Simulation<S>, &T) -> i64 + Send + Sync + 'static,
    ) -> Self {
        Self {
            name,
            unit: "",
            doc,
            value: Value::Whole(Arc::new(get)),
        }
    }

    /// A field of vectors in world axes.
    pub fn vector<V: VectorLike>(
        name: &'static str,
        unit: &'static str,
        doc: &'static str,
        get: impl Fn(&Simulation<S>, &T) -> V + Send + Sync + 'static,
    ) -> Self {
        Self {
            name,
            unit,
            doc,
            value: Value::Vector(Arc::new(move |s, of| get(s, of).padded())),
        }
    }

    /// Returns the value as a number; for a vector its norm.
    pub fn get(&self, s: &Simulation<S>, of: &T) -> f64 {
        match &self.value {
            Value::Number(get) => get(s, of),
            Value::Whole(get) => get(s, of) as f64,
            Value::Vector(get) => get(s, of).iter().map(|x| x * x).sum::<f64>().sqrt(),
        }
    }

    /// Returns whether the values are whole numbers.
    pub fn is_whole(&self) -> bool {
        matches!(self.value, Value::Whole(_))
    }

    /// Returns the number of components of a value: 3 for a vector, otherwise 1.
    pub fn width(&self) -> usize {
        match self.value {
            Value::Vector(_) => 3,
            Value::Number(_) | Value::Whole(_) => 1,
        }
    }
}

impl<S: Space, T> Clone for Field<S, T> {
    fn clone(&self) -> Self {
        let value = match &self.value {
            Value::Number(get) => Value::Number(get.clone()),
            Value::Whole(get) => Value::Whole(get.clone()),
            Value::Vector(get) => Value::Vector(get.clone()),
        };
        Self { value, ..*self }
    }
}

impl<S: Space, T> fmt::Debug for Field<S, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} [{}]", self.name, self.unit)
    }
}

/// Fields of one kind of items, in the order in which they are written.
#[derive(Clone, Debug)]
pub struct FieldList<S: Space, T>(Vec<Field<S, T>>);

impl<S: Space, T> FieldList<S, T> {
    /// Creates a list; of two fields with the same name the later one is kept.
    pub fn new(fields: impl IntoIterator<Item = Field<S, T>>) -> Self {
        let mut list = Self(Vec::new());
        fields.into_iter().for_each(|f| list.add(f));
        list
    }

    /// Adds a field, replacing the field of the same name if there is one.
    pub fn add(&mut self, field: Field<S, T>) {
        match self.0.iter_mut().find(|f| f.name == field.name) {
            Some(same) => *same = field,
            None => self.0.push(field),
        }
    }

    /// The field of a name.
    pub fn get(&self, name: &str) -> Option<&Field<S, T>> {
        self.0.iter().find(|f| f.name == name)
    }

    /// Iterates over all fields.
    pub fn iter(&self) -> impl Iterator<Item = &Field<S, T>> {
        self.0.iter()
    }
}

/// Fields of grains and contacts; see the [module](self).
#[derive(Clone, Debug)]
pub struct Fields<S: Space> {
    /// Fields of grains, and of the balls and pieces of first bodies.
    pub grains: FieldList<S, GrainPart<S>>,
    /// Fields of contacts.
    pub contacts: FieldList<S, Contact<S>>,
}

impl<S: Space> Default for Fields<S> {
    /// Returns the fields that every simulation has.
    fn default() -> Self {
        Self {
            grains: FieldList::new(grains::standard()),
            contacts: FieldList::new(contacts::standard()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use nalgebra::Vector2;

    /// A number, a whole number and a vector of an item that is a number itself.
    #[test]
    fn a_field_gives_numbers() {
        let s = Simulation::<Dim2>::of_disks(&[]);
        let half = Field::<Dim2, f64>::number("half", "m", "half of it", |_, x| 0.5 * x);
        let whole = Field::<Dim2, f64>::whole("whole", "its floor", |_, x| *x as i64);
        let vector = |_: &Simulation<Dim2>, x: &f64| Vector2::new(3.0 * x, 4.0 * x);
        let vector = Field::<Dim2, f64>::vector("vector", "m", "five of it", vector);
        let of = |field: &Field<Dim2, f64>| (field.width(), field.is_whole(), field.get(&s, &2.5));
        assert_eq!(of(&half), (1, false, 1.25));
        assert_eq!(of(&whole), (1, true, 2.0));
        assert_eq!(of(&vector), (3, false, 12.5));
        // The later of two fields with one name is kept.
        let other = Field::<Dim2, f64>::number("half", "m", "a third", |_, x| x / 3.0);
        let list = FieldList::new([half, vector, other]);
        assert_eq!(list.iter().count(), 2);
        assert_eq!(list.get("half").unwrap().get(&s, &3.0), 1.0);
        assert!(list.get("none").is_none());
    }
}
