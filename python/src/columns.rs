//! The columns of bodies that have the layout of arrays.

use crate::array::Array;
use crate::simulation::Simulation;
use fretwork::bodies::Bodies;
use fretwork::geometry::space::Space;
use fretwork::in_dimension;
use fretwork::{AnySimulation, RunView};
use pyo3::prelude::*;
use std::any::Any;

/// A column of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Column {
    Id,
    Position,
    Velocity,
    Spin,
    Mass,
    Inertia,
    Removed,
}

impl Column {
    pub(crate) const ALL: [Self; 7] = [
        Self::Id,
        Self::Position,
        Self::Velocity,
        Self::Spin,
        Self::Mass,
        Self::Inertia,
        Self::Removed,
    ];

    /// Returns name, unit and explanation.
    pub(crate) fn about(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Id => ("id", "", "identities, the same over time"),
            Self::Position => ("position", "m", "centres of mass"),
            Self::Velocity => ("velocity", "m/s", "velocities of the centres of mass"),
            Self::Spin => (
                "spin",
                "rad/s",
                "angular velocities, one number a body in 2D",
            ),
            Self::Mass => ("mass", "kg", "masses; in 2D of a metre of depth"),
            Self::Inertia => (
                "inertia",
                "kg m^2",
                "moments of inertia, the mean of those that differ by axis; in 2D of a metre of depth",
            ),
            Self::Removed => ("removed", "", "whether a body has been taken out"),
        }
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.about().0 == name)
    }
}

/// Returns an array that shows a column, whose memory has an owner.
pub(crate) fn show(run: &AnySimulation, column: Column, owner: Py<Simulation>) -> Array {
    in_dimension!(run, |s| show_in(&s.state.bodies, column, owner))
}

fn show_in<S: Space>(bodies: &Bodies<S>, column: Column, owner: Py<Simulation>) -> Array {
    match column {
        Column::Id => Array::shown::<_, u64>(&bodies.id, 0, owner),
        Column::Position => Array::shown::<_, f64>(&bodies.position, S::D, owner),
        Column::Velocity => Array::shown::<_, f64>(&bodies.velocity, S::D, owner),
        Column::Spin => Array::shown::<_, f64>(&bodies.spin, spin_width(S::D), owner),
        Column::Mass => Array::shown::<_, f64>(&bodies.mass, 0, owner),
        Column::Inertia => Array::shown::<_, f64>(&bodies.inertia, 0, owner),
        Column::Removed => Array::shown::<_, bool>(&bodies.removed, 0, owner),
    }
}

/// Returns a copy of a column, with the layout of the array of [`show`].
pub(crate) fn copy(run: &dyn RunView, column: Column) -> Array {
    let (bodies, dimension) = (run.bodies(), run.dimension());
    let motions = || (0..bodies.len()).map(|body| run.motion(body));
    match column {
        Column::Id => Array::own(bodies.id.to_vec(), 0),
        Column::Position => vectors(motions().map(|m| m.position), dimension),
        Column::Velocity => vectors(motions().map(|m| m.velocity), dimension),
        Column::Spin if dimension == 2 => Array::own(motions().map(|m| m.spin[2]).collect(), 0),
        Column::Spin => vectors(motions().map(|m| m.spin), 3),
        Column::Mass => Array::own(bodies.mass.to_vec(), 0),
        Column::Inertia => Array::own(bodies.inertia.to_vec(), 0),
        Column::Removed => Array::own(bodies.removed.to_vec(), 0),
    }
}

/// Takes the memory of a column out, and leaves a copy in its place.
pub(crate) fn take(run: &mut AnySimulation, column: Column) -> Box<dyn Any + Send> {
    in_dimension!(run, |s| take_in(&mut s.state.bodies, column))
}

fn take_in<S: Space>(bodies: &mut Bodies<S>, column: Column) -> Box<dyn Any + Send> {
    fn swap<T: Clone + Send + 'static>(column: &mut Vec<T>) -> Box<dyn Any + Send> {
        let copy = column.clone();
        Box::new(std::mem::replace(column, copy))
    }
    match column {
        Column::Id => swap(&mut bodies.id),
        Column::Position => swap(&mut bodies.position),
        Column::Velocity => swap(&mut bodies.velocity),
        Column::Spin => swap(&mut bodies.spin),
        Column::Mass => swap(&mut bodies.mass),
        Column::Inertia => swap(&mut bodies.inertia),
        Column::Removed => swap(&mut bodies.removed),
    }
}

/// Width of an angular velocity: 0 in 2D, which makes a plain column.
fn spin_width(dimension: usize) -> usize {
    if dimension == 2 { 0 } else { 3 }
}

/// Returns vectors as rows with one number per dimension.
pub(crate) fn vectors(all: impl IntoIterator<Item = [f64; 3]>, dimension: usize) -> Array {
    let numbers = all.into_iter().flat_map(|v| v.into_iter().take(dimension));
    Array::own::<f64>(numbers.collect(), dimension)
}
