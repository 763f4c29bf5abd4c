//! Dynamical systems without their dimension.

use crate::bodies::{Contactor, DynamicalSystem, Holder, SystemSize};
use crate::geometry::space::Space;

/// A body that is more than rigid, for reading; see [`DynamicalSystem`], whose methods have the
/// same names.
pub trait SystemView {
    /// What a user calls it.
    fn name(&self) -> &str;
    /// Number of its generalised velocities.
    fn freedoms(&self) -> usize;
    /// Whether it is a grain.
    fn is_grain(&self) -> bool;
    /// A length of its size (m).
    fn length(&self) -> f64;
    /// What of it touches.
    fn contactors(&self) -> Vec<Contactor>;
    /// What holds it.
    fn holders(&self) -> Vec<Holder>;
    /// What it keeps in memory, and what its solutions cost.
    fn size(&self) -> Option<SystemSize>;
    /// Numbers of points and elements of its mesh; `None` where it has none.
    fn mesh_size(&self) -> Option<[usize; 2]>;
    /// Number of points of the surface by which it touches; 0 where it has none.
    fn surface_points(&self) -> usize;
}

/// A system in its dimension.
pub(super) struct Seen<'a, S: Space>(pub &'a dyn DynamicalSystem<S>);

impl<S: Space> SystemView for Seen<'_, S> {
    fn name(&self) -> &str {
        self.0.name()
    }
    fn freedoms(&self) -> usize {
        self.0.freedoms()
    }
    fn is_grain(&self) -> bool {
        self.0.is_grain()
    }
    fn length(&self) -> f64 {
        self.0.length()
    }
    fn contactors(&self) -> Vec<Contactor> {
        self.0.contactors()
    }
    fn holders(&self) -> Vec<Holder> {
        self.0.holders()
    }
    fn size(&self) -> Option<SystemSize> {
        self.0.size()
    }
    fn mesh_size(&self) -> Option<[usize; 2]> {
        let mesh = self.0.deformed_mesh()?;
        Some([mesh.points.len(), mesh.elements.len() / (S::D + 1)])
    }
    fn surface_points(&self) -> usize {
        self.0.touching_surface().map_or(0, |s| s.points.len())
    }
}
