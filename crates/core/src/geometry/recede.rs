//! Surfaces that recede: their vertices fall along one axis of the surface's frame, into the solid.
//!
//! With the places across that axis fixed, what is removed is linear in the depths: the area between a chain of
//! segments and the same chain worn is the sum of depth times tributary length, to round-off and for any depth (for
//! triangles the volume, of depth times tributary area). A chain that is single-valued stays so: it cannot come to
//! cross itself. On a flank inclined by a the depth d across the flank is d/cos a along the axis, over a
//! length shorter by the same factor: wear normal to the flank and wear along the axis remove the same.

use super::space::Space;
use serde::{Deserialize, Serialize};

/// A vertex that can recede.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Vertex<V> {
    /// Where it stood at first, in the surface's frame (m).
    pub at: V,
    /// The length (m) or area (m^2), across the axis of wear, over which its depth stands: the integral of the
    /// function that is 1 at this vertex, 0 at all others and linear between.
    pub tributary: f64,
}

/// Up to three vertices and the part of a volume that each takes; the parts add up to 1.
pub type Shares = [(usize, f64); 3];

/// A surface whose vertices recede along the last axis of its frame.
pub trait Recede<S: Space> {
    /// Its vertices, each once: of a periodic surface without the images.
    fn vertices(&self) -> Vec<Vertex<S::Vector>>;
    /// Where the first vertex stands again, at the end of the period of a profile (m).
    fn end(&self) -> Option<S::Vector> {
        None
    }
    /// The vertices about a point of the surface, by the linear functions of its segment or triangle.
    fn shares(&self, closest_point: &S::Vector) -> Shares;
    /// Puts the vertices named at their depths (m) below where they stood at first. The largest step that one took (m).
    fn recede(&mut self, depth: &[f64], named: &[usize]) -> f64;
    /// 1 where the solid is below and heights fall, -1 where it is above and they rise.
    fn sign(&self) -> f64;
}
