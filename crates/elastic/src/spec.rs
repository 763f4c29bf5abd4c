//! What a body is made of: the input of its constructor.

use crate::material::Elasticity;
use crate::strain::Strain;
use crate::support::{Rayleigh, Support};

/// What of a body touches. Where two surfaces meet one of them must touch by its points: the one
/// with the finer mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Touching<'a> {
    /// Nothing.
    #[default]
    Nothing,
    /// The points of a part of the boundary, by its name: they touch balls, pieces and surfaces.
    Points(&'a str),
    /// A part of the boundary as a surface: it touches grains, points, and corners and edges of
    /// pieces.
    Surface(&'a str),
}

/// What a body is made of. `M` is its mesh, [`crate::Mesh`] or [`crate::AnyMesh`].
#[derive(Clone, Debug)]
pub struct BodySpec<'a, M> {
    /// What a user calls it.
    pub name: &'a str,
    /// Its mesh.
    pub mesh: M,
    /// Its material.
    pub material: Elasticity,
    /// How its strain is measured.
    pub strain: Strain,
    /// Its damping.
    pub damping: Rayleigh,
    /// What holds and drives it.
    pub supports: &'a [Support],
    /// What of it touches.
    pub touching: Touching<'a>,
    /// Index of the material for interface laws.
    pub surface_material: u16,
    /// Its velocity at the start (m/s), of all that is not held.
    pub velocity: [f64; 3],
    /// Its angular velocity at the start about its centre of mass (rad/s), about the third axis in
    /// 2D; none in small strain, and of parts that move as one.
    pub spin: [f64; 3],
}

impl<'a, M> BodySpec<'a, M> {
    /// The description with another mesh.
    pub(crate) fn of<N>(self, mesh: N) -> BodySpec<'a, N> {
        BodySpec {
            name: self.name,
            mesh,
            material: self.material,
            strain: self.strain,
            damping: self.damping,
            supports: self.supports,
            touching: self.touching,
            surface_material: self.surface_material,
            velocity: self.velocity,
            spin: self.spin,
        }
    }
}
