//! Receding surfaces: their vertices move along one axis of the surface's frame, into the solid.
//!
//! With the coordinates perpendicular to that axis fixed, the removed volume is linear in the
//! depths: the area between a chain of segments and the worn chain is the sum of depth times
//! tributary length, to rounding and for any depth (for triangles the volume, with tributary
//! areas). A single-valued chain stays single-valued and cannot intersect itself. On a flank
//! inclined by a, the depth d normal to the flank is d/cos a along the axis, over a length shorter
//! by the same factor: wear normal to the flank and wear along the axis remove the same volume.

use super::space::Space;
use serde::{Deserialize, Serialize};

/// A vertex that can recede.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Vertex<V> {
    /// Initial position, in the surface's frame (m).
    pub at: V,
    /// Tributary length (m) or area (m^2), perpendicular to the axis of wear: the integral of the
    /// shape function that is 1 at this vertex, 0 at all others and linear between.
    pub tributary: f64,
}

/// Up to three vertices and the fraction of a volume that each takes; the fractions add up to 1.
pub type VertexShares = [(usize, f64); 3];

/// A surface whose vertices recede along the last axis of its frame.
pub trait Recede<S: Space> {
    /// Returns its vertices, each once: without the images of a periodic surface.
    fn vertices(&self) -> Vec<Vertex<S::Vector>>;
    /// Returns the position of the first vertex's image, at the end of the period of a profile (m).
    fn end(&self) -> Option<S::Vector> {
        None
    }
    /// Returns the vertices around a point of the surface, with the linear shape functions of its
    /// segment or triangle.
    fn shares(&self, closest_point: &S::Vector) -> VertexShares;
    /// Moves the given vertices to their depths (m) below their initial positions. Returns the
    /// largest displacement (m).
    fn recede(&mut self, depth: &[f64], named: &[usize]) -> f64;
    /// Returns 1 where the solid is below and heights decrease, -1 where it is above and they
    /// increase.
    fn sign(&self) -> f64;
}
