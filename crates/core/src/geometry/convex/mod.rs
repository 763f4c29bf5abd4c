//! Convex pieces: a convex core and a rounding about it, carried by a body.
//!
//! Two points with a rounding are a capsule; several pieces on a body are a cluster. Cores are polygons in the
//! plane and polyhedra in space.

mod boundary;
pub mod mass;
pub mod polygon;
pub mod polygon_pair;
pub mod polygon_surface;
pub mod polyhedron;
mod polyhedron_clip;
pub mod polyhedron_mass;
mod polyhedron_outline;
mod polyhedron_pair;
mod polyhedron_surface;
#[cfg(test)]
mod polyhedron_tests;

pub use boundary::Boundary;

use super::shape::Surface;
use super::space::{Space, VectorLike};
use std::fmt::Debug;

/// A convex part of a body: all points within `rounding` of its core.
#[derive(Clone, Debug)]
pub struct ConvexCollider<S: Space> {
    /// Index of the body.
    pub body: u32,
    /// The core, about the piece's centre, in the body's axes.
    pub core: S::Core,
    /// The piece's centre in the body's frame (m).
    pub offset: S::Vector,
    /// Radius of the rounding (m); zero for sharp corners.
    pub rounding: f64,
    /// Radius of a ball about the piece's centre that holds it all (m).
    pub bound: f64,
    /// Radius of the ball of the same volume (m): its size in a contact of one point.
    pub size: f64,
    /// Index of the material.
    pub material: u16,
}

/// How deep a corner may be behind a skin, a profile or facets, and still be pushed out, in parts of the size of its
/// piece: [`ConvexCollider::bound`]. What is deeper may be in front of another part of it.
pub const DEEP: f64 = 0.25;

/// The shape of a piece and its mass properties, before it has a body.
#[derive(Clone, Debug)]
pub struct ConvexPart<S: Space> {
    /// The core, about its centre of mass.
    pub core: S::Core,
    /// The centre of mass (m).
    pub centre: S::Vector,
    /// Radius of the rounding (m).
    pub rounding: f64,
    /// Radius of a ball about the centre of mass that holds it all (m).
    pub bound: f64,
    /// Volume, rounding included (m^3; 2D: area times unit depth).
    pub volume: f64,
    /// Moments of inertia about the centre of mass at unit density (m^5).
    pub inertia: S::Tensor,
}

impl<S: Space> ConvexPart<S> {
    /// A part of a body, its centre of mass at `offset` in the body's frame (m).
    pub fn carried(self, body: u32, offset: S::Vector, material: u16) -> ConvexCollider<S> {
        ConvexCollider {
            body,
            core: self.core,
            offset,
            rounding: self.rounding,
            bound: self.bound,
            size: S::ball_radius(self.volume),
            material,
        }
    }
}

/// Half of the least thickness of points across these normals (m); zero where there is none.
fn half_thickness<S: Space>(points: &[S::Vector], normals: &[S::Vector]) -> f64 {
    let across = |n: &S::Vector| {
        let along = points.iter().map(|p| p.dot(n));
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        0.5 * (high - low)
    };
    let least = normals.iter().map(across).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

/// Where two bodies are near: one point of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint<V> {
    /// Point of the candidate's surface (m).
    pub on_candidate: V,
    /// Point of the antagonist's surface (m).
    pub on_antagonist: V,
    /// Unit normal, from the antagonist to the candidate.
    pub normal: V,
    /// Gap (m), negative where they overlap.
    pub gap: f64,
    /// Name of the corner that is touched; stable while the bodies slide along each other.
    pub feature: u64,
    /// Length of the face that this point stands for (m); in space the radius of a disk of its area; zero for a
    /// corner.
    pub share: f64,
    /// Whether a bond can hold here: sides face each other, or a ball or an end of a capsule touches.
    pub facing: bool,
}

/// How near is near.
#[derive(Clone, Copy, Debug)]
pub struct ContactTolerances {
    /// Meetings with a larger gap are not looked for (m).
    pub reach: f64,
    /// Two corners that are no farther apart along a face are seen as corner on face (m): between corners
    /// that coincide there is no direction.
    pub slack: f64,
    /// Whether a bond holds the pair: its sides are met even where two corners are nearer, so that what is
    /// pulled open aslant keeps its points.
    pub held: bool,
}

/// What the narrow phase asks of a convex core. Vectors are in the world's axes, places relative to the
/// antagonist's centre.
pub trait Core<S: Space>: Clone + Debug + Send + Sync {
    /// The core of a body that turned.
    #[must_use]
    fn turned(&self, rotation: &S::Rotation) -> Self;

    /// Meetings with another core, in the order of their features: this is the candidate and stands at
    /// `apart`; `roundings` are the candidate's and the antagonist's (m).
    fn meet(
        &self,
        other: &Self,
        apart: &S::Vector,
        roundings: [f64; 2],
        gauge: &ContactTolerances,
        out: &mut Vec<ContactPoint<S::Vector>>,
    );

    /// The meeting with a ball whose centre stands at `apart`; the ball is the candidate, the gap that to
    /// the rounded core.
    fn meet_ball(&self, apart: &S::Vector, radius: f64, rounding: f64) -> ContactPoint<S::Vector> {
        let (distance, normal) = self.outward(apart);
        ContactPoint {
            on_candidate: *apart - normal * radius,
            on_antagonist: *apart - normal * (distance - rounding),
            normal,
            gap: distance - radius - rounding,
            feature: 0,
            share: 0.0,
            facing: true,
        }
    }

    /// The name that a feature of a pair of cores has where the antagonist is taken for the candidate.
    fn feature_from_other_side(feature: u64) -> u64;

    /// Signed distance of a point from the core (m, negative inside) and the unit normal at the nearest point of it.
    fn outward(&self, point: &S::Vector) -> (f64, S::Vector);

    /// Half of the least thickness across its faces (m); zero for a segment.
    fn half_thickness(&self) -> f64;

    /// Meetings with a surface of a first body, in the order of their features. The core is in the
    /// surface's frame, its centre at `at`.
    fn meet_surface(
        &self,
        surface: &dyn Surface<S>,
        at: &S::Vector,
        rounding: f64,
        gauge: &ContactTolerances,
        out: &mut Vec<ContactPoint<S::Vector>>,
    );

    /// Corners of the rounded core for pictures and files (m): one closed line without its last point in the
    /// plane, a polygon for every face in space.
    fn outline(&self, rounding: f64) -> Vec<Vec<S::Vector>>;

    /// Its corners and faces.
    fn boundary(&self) -> Boundary<S::Vector>;

    /// The core of these corners and faces.
    ///
    /// # Errors
    /// Why they are those of none.
    fn bounded_by(boundary: Boundary<S::Vector>) -> Result<Self, String>;
}
