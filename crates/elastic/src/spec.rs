//! Parameters of a deformable body.

use crate::material::Elasticity;
use crate::strain::Strain;
use crate::support::{Rayleigh, Support};

/// Contact surface of a body. Where two surfaces meet one of them must touch by its points: the one
/// with the finer mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Touching<'a> {
    /// The body does not touch.
    #[default]
    Nothing,
    /// The points of a part of the boundary, by its name: they touch balls, pieces and surfaces.
    Points(&'a str),
    /// A part of the boundary as a surface: it touches grains, points, and corners and edges of
    /// pieces.
    Surface(&'a str),
}

/// Parameters of a deformable body. `M` is its mesh, [`crate::Mesh`] or [`crate::AnyMesh`].
#[derive(Clone, Debug)]
pub struct BodySpec<'a, M> {
    /// Name in messages.
    pub name: &'a str,
    /// Mesh.
    pub mesh: M,
    /// Material.
    pub material: Elasticity,
    /// Measure of strain.
    pub strain: Strain,
    /// Damping.
    pub damping: Rayleigh,
    /// Supports with their drives.
    pub supports: &'a [Support],
    /// Contact surface.
    pub touching: Touching<'a>,
    /// Index of the material for interface laws.
    pub surface_material: u16,
    /// Initial velocity (m/s) of all that is not held.
    pub velocity: [f64; 3],
    /// Initial angular velocity about the centre of mass (rad/s), about the third axis in 2D; must
    /// be zero in small strain, and is zero for parts that move as one.
    pub spin: [f64; 3],
}

impl<'a, M> BodySpec<'a, M> {
    /// Returns the parameters with another mesh.
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
