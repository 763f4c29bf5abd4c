//! Data of a dynamical system for results, pictures and checks: its contact surface, and its size
//! in memory.

use crate::geometry::space::VectorLike;
use nalgebra::Vector3;

/// A mesh that a system deforms, for results and pictures; `V` is a vector.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeformedMesh<V> {
    /// Points without load (m).
    pub points: Vec<V>,
    /// Displacements of the points (m).
    pub displacement: Vec<V>,
    /// The D + 1 points of each element, one after the other.
    pub elements: Vec<u32>,
    /// The D points of each facet of the boundary.
    pub boundary: Vec<u32>,
    /// Stress in each element (Pa): xx, yy, zz, yz, xz, xy; in plane strain zz is the stress along
    /// the depth.
    pub stress: Vec<[f64; 6]>,
}

impl<V: VectorLike> DeformedMesh<V> {
    /// Returns the mesh with three components; the third is zero in the plane.
    pub fn padded(self) -> DeformedMesh<Vector3<f64>> {
        DeformedMesh {
            points: padded(&self.points),
            displacement: padded(&self.displacement),
            elements: self.elements,
            boundary: self.boundary,
            stress: self.stress,
        }
    }
}

/// The contact surface of a system, as points with facets between them; `V` is a vector.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TouchingSurface<V> {
    /// The node of the system at each point.
    pub nodes: Vec<u32>,
    /// Positions of the points without load (m).
    pub points: Vec<V>,
    /// The D points of each facet, one after the other, by their indices in `points`.
    pub facets: Vec<u32>,
    /// Current tributary area of each point (m^2; tributary length in the plane, m). Their sum is
    /// the area of the surface.
    pub areas: Vec<f64>,
}

impl<V: VectorLike> TouchingSurface<V> {
    /// Returns the surface with three components; the third is zero in the plane.
    pub fn padded(self) -> TouchingSurface<Vector3<f64>> {
        TouchingSurface {
            nodes: self.nodes,
            points: padded(&self.points),
            facets: self.facets,
            areas: self.areas,
        }
    }
}

/// Returns vectors with three components; the third is zero in the plane.
pub(crate) fn padded<V: VectorLike>(all: &[V]) -> Vec<Vector3<f64>> {
    all.iter().map(|v| v.padded().into()).collect()
}

/// Memory of a system for its solutions (bytes), and their cost, as far as known before the first
/// step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SystemSize {
    /// Number of unknowns of a solution.
    pub unknowns: usize,
    /// Memory of the matrix that is assembled once.
    pub matrix: usize,
    /// Memory of the factor of A, with its pattern; zero for systems without a factor.
    pub factor: usize,
    /// Memory of the compliance of the surface once all of it was touched.
    pub surface: usize,
    /// Memory of the compliance of a single point of the surface.
    pub point: usize,
    /// Floating-point operations of a factorisation, and of a solution with the factor or the table
    /// of influences.
    pub operations: [f64; 2],
    /// Whether A is factorised again in every iteration of a step.
    pub refactorised: bool,
}
