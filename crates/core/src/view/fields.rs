//! Fields of grains and contacts as columns.

use crate::contact::Contact;
use crate::geometry::space::Space;
use crate::step::Simulation;
use crate::step::fields::{Field, FieldList, GrainPart, Value, orientation, removed};

/// Type of the values of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FieldKind {
    /// Numbers.
    Number,
    /// Whole numbers.
    Whole,
    /// Vectors in world axes.
    Vector,
}

/// A field without its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldInfo {
    /// Name: a-z, 0-9 and _.
    pub name: &'static str,
    /// SI unit, empty for a pure number.
    pub unit: &'static str,
    /// Description in one line.
    pub doc: &'static str,
    /// Type of the values.
    pub kind: FieldKind,
}

impl FieldInfo {
    fn of<S: Space, T>(field: &Field<S, T>) -> Self {
        Self {
            name: field.name,
            unit: field.unit,
            doc: field.doc,
            kind: match field.value {
                Value::Number(_) => FieldKind::Number,
                Value::Whole(_) => FieldKind::Whole,
                Value::Vector(_) => FieldKind::Vector,
            },
        }
    }

    /// Returns the number of components of a value: 3 for a vector, otherwise 1.
    pub fn width(&self) -> usize {
        match self.kind {
            FieldKind::Vector => 3,
            FieldKind::Number | FieldKind::Whole => 1,
        }
    }
}

/// Values of a field, one for each item that has it.
#[derive(Clone, Debug, PartialEq)]
pub enum FieldValues {
    /// Numbers.
    Number(Vec<f64>),
    /// Whole numbers.
    Whole(Vec<i64>),
    /// Vectors in world axes, three components each, one after the other.
    Vector(Vec<f64>),
}

impl FieldValues {
    fn of<'a, S: Space, T: 'a>(
        field: &Field<S, T>,
        s: &Simulation<S>,
        all: impl Iterator<Item = &'a T>,
    ) -> Self {
        match &field.value {
            Value::Number(get) => Self::Number(all.map(|one| get(s, one)).collect()),
            Value::Whole(get) => Self::Whole(all.map(|one| get(s, one)).collect()),
            Value::Vector(get) => Self::Vector(all.flat_map(|one| get(s, one)).collect()),
        }
    }
}

/// Optional fields of grains, in addition to those that every simulation registers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GrainFields {
    /// Orientations, needed if some grains are not single balls.
    pub orientation: bool,
    /// Whether each grain was removed.
    pub removed: bool,
}

/// Returns the fields of the grains, in the order in which they are written.
fn of_grains<S: Space>(s: &Simulation<S>, with: GrainFields) -> FieldList<S, GrainPart<S>> {
    let mut fields = s.fields.grains.clone();
    let turns = with.orientation.then(orientation).into_iter().flatten();
    let removed = with.removed.then(removed);
    turns.chain(removed).for_each(|field| fields.add(field));
    fields
}

pub(super) fn grain_fields<S: Space>(s: &Simulation<S>, with: GrainFields) -> Vec<FieldInfo> {
    of_grains(s, with).iter().map(FieldInfo::of).collect()
}

pub(super) fn grain_values<S: Space>(s: &Simulation<S>, with: GrainFields) -> Vec<FieldValues> {
    let parts: Vec<GrainPart<S>> = GrainPart::all(s).collect();
    let fields = of_grains(s, with);
    let values = fields.iter().map(|f| FieldValues::of(f, s, parts.iter()));
    values.collect()
}

pub(super) fn grain_field<S: Space>(s: &Simulation<S>, name: &str) -> Option<FieldValues> {
    let field = s.fields.grains.get(name)?;
    let parts: Vec<GrainPart<S>> = GrainPart::all(s).collect();
    Some(FieldValues::of(field, s, parts.iter()))
}

/// Returns the contacts that are shown.
fn shown<S: Space>(s: &Simulation<S>, counted: bool) -> impl Iterator<Item = &Contact<S>> {
    let network = &s.state.network;
    let all = network.contacts.iter().filter(move |_| !counted);
    let only = network.counted_contacts().filter(move |_| counted);
    all.chain(only)
}

pub(super) fn contact_fields<S: Space>(s: &Simulation<S>) -> Vec<FieldInfo> {
    s.fields.contacts.iter().map(FieldInfo::of).collect()
}

pub(super) fn contact_values<S: Space>(s: &Simulation<S>, counted: bool) -> Vec<FieldValues> {
    let fields = s.fields.contacts.iter();
    fields
        .map(|f| FieldValues::of(f, s, shown(s, counted)))
        .collect()
}

pub(super) fn contact_field<S: Space>(
    s: &Simulation<S>,
    name: &str,
    counted: bool,
) -> Option<FieldValues> {
    let field = s.fields.contacts.get(name)?;
    Some(FieldValues::of(field, s, shown(s, counted)))
}
