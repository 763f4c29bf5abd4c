//! Convex pieces: a convex core with a rounding radius, carried by a body.
//!
//! Two points with a rounding are a capsule; several pieces on a body are a cluster. Cores are
//! polygons in 2D and polyhedra in 3D.

mod boundary;
pub mod mass;
pub mod passing;
pub mod polygon;
mod polygon_line;
pub mod polygon_pair;
pub mod polygon_surface;
pub mod polyhedron;
mod polyhedron_clip;
mod polyhedron_hull;
pub mod polyhedron_mass;
mod polyhedron_outline;
mod polyhedron_pair;
mod polyhedron_surface;
#[cfg(test)]
mod polyhedron_tests;
pub mod seam;
mod topology;

pub use boundary::Boundary;
pub use passing::PairFace;

use super::shape::Surface;
use super::space::{Space, VectorLike};
use std::fmt::Debug;

/// A convex part of a body: all points within the distance `rounding` of its core.
#[derive(Clone, Debug)]
pub struct ConvexCollider<S: Space> {
    /// Index of the body.
    pub body: u32,
    /// The core relative to the piece's centre, in the body's axes.
    pub core: S::Core,
    /// Position of the piece's centre in the body's frame (m).
    pub offset: S::Vector,
    /// Rounding radius (m); zero for sharp corners.
    pub rounding: f64,
    /// Radius of the bounding ball about the piece's centre (m).
    pub bound: f64,
    /// Radius of the ball of equal volume (m): the size of the piece in a single-point contact.
    pub size: f64,
    /// Index of the material.
    pub material: u16,
}

/// Depth up to which a corner behind a skin, a profile or facets is still pushed out, relative to
/// the size of its piece, [`ConvexCollider::bound`]. A deeper corner may be in front of another
/// part of the surface.
pub const MAX_CORNER_DEPTH: f64 = 0.25;

/// Least cosine of the angle between a side and a surface that deforms for the side to touch its
/// vertices; a steeper side touches by its corners.
pub(super) const STEEPEST: f64 = 0.5;

/// Shape and mass properties of a piece that is not yet part of a body.
#[derive(Clone, Debug)]
pub struct ConvexPart<S: Space> {
    /// The core relative to its centre of mass.
    pub core: S::Core,
    /// Centre of mass (m).
    pub centre: S::Vector,
    /// Rounding radius (m).
    pub rounding: f64,
    /// Radius of the bounding ball about the centre of mass (m).
    pub bound: f64,
    /// Volume including the rounding (m^3; in 2D area times unit depth).
    pub volume: f64,
    /// Inertia tensor about the centre of mass at unit density (m^5).
    pub inertia: S::Tensor,
}

impl<S: Space> ConvexPart<S> {
    /// Places the part on a body, with its centre of mass at `offset` in the body's frame (m).
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

/// Returns half of the smallest width of points along these normals (m); zero without normals.
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

/// A contact point between two bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint<V> {
    /// Point on the candidate's surface (m).
    pub on_candidate: V,
    /// Point on the antagonist's surface (m).
    pub on_antagonist: V,
    /// Unit normal, from the antagonist to the candidate.
    pub normal: V,
    /// Gap (m), negative for penetration.
    pub gap: f64,
    /// Key of the corner in contact; stable while the bodies slide along each other.
    pub feature: u64,
    /// Length of the face represented by this point (m); in 3D the radius of a disk of equal area;
    /// zero for a corner.
    pub share: f64,
    /// Whether a bond can form here: two opposite faces, a ball, or the end of a capsule.
    pub facing: bool,
}

impl<V: VectorLike> ContactPoint<V> {
    /// Transforms it from the frame of a body or surface to world axes.
    #[must_use]
    pub fn rotated<S: Space<Vector = V>>(&self, rotation: &S::Rotation) -> Self {
        Self {
            on_candidate: S::rotate(rotation, &self.on_candidate),
            on_antagonist: S::rotate(rotation, &self.on_antagonist),
            normal: S::rotate(rotation, &self.normal),
            ..*self
        }
    }
}

/// Two convex pieces, of which contact points are sought. Vectors are in world axes, positions
/// relative to the antagonist's centre.
#[derive(Clone, Copy, Debug)]
pub struct CorePair<'a, S: Space> {
    /// Cores of candidate and antagonist.
    pub cores: [&'a S::Core; 2],
    /// Centre of the candidate (m).
    pub apart: S::Vector,
    /// Rounding radii of candidate and antagonist (m).
    pub roundings: [f64; 2],
    /// Tolerances of the search.
    pub tolerances: ContactTolerances,
}

impl<S: Space> CorePair<'_, S> {
    /// Returns the sum of the rounding radii (m).
    pub fn thickness(&self) -> f64 {
        self.roundings[0] + self.roundings[1]
    }
}

/// Tolerances for finding contact points.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContactTolerances {
    /// Largest gap that is searched (m).
    pub reach: f64,
    /// Two corners no farther apart than this along a face count as corner on face (m), since
    /// coincident corners define no direction.
    pub slack: f64,
    /// Whether the pair is bonded: face contacts are then kept even if two corners are nearer, so
    /// that a bond that is opened obliquely keeps its points.
    pub held: bool,
}

/// Operations of the narrow phase on a convex core. Vectors are in world axes, positions relative
/// to the antagonist's centre.
pub trait Core<S: Space>: Clone + Debug + Send + Sync {
    /// Returns the core of a rotated body.
    #[must_use]
    fn turned(&self, rotation: &S::Rotation) -> Self;

    /// Writes the core of a rotated body into `out`, whose buffers are used again.
    fn turn_into(&self, rotation: &S::Rotation, out: &mut Self);

    /// Writes the core with all distances from its centre multiplied by `factor` into `out`, a core
    /// of the same corners.
    fn scale_into(&self, factor: f64, out: &mut Self);

    /// Finds the contact points of two cores, in the order of their features.
    fn contact_points(pair: &CorePair<S>, out: &mut Vec<ContactPoint<S::Vector>>);

    /// Returns the contact point with a ball whose centre is at `apart`; the ball is the candidate,
    /// and the gap refers to the rounded core.
    fn contact_point_with_ball(
        &self,
        apart: &S::Vector,
        radius: f64,
        rounding: f64,
    ) -> ContactPoint<S::Vector> {
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

    /// Returns its corners (m).
    fn corners(&self) -> &[S::Vector];

    /// Returns the outward unit normals of its faces.
    fn normals(&self) -> &[S::Vector];

    /// Returns a corner of a face (m).
    fn corner_of(&self, face: usize) -> S::Vector;

    /// Finds the points of a pair, as [`Core::contact_points`] does, that touch the plane of a face
    /// of one of the two.
    fn points_on_face(pair: &CorePair<S>, face: PairFace, out: &mut Vec<ContactPoint<S::Vector>>);

    /// Returns the name of a feature of a pair of cores after candidate and antagonist are swapped.
    fn feature_from_other_side(feature: u64) -> u64;

    /// Returns the signed distance of a point from the core (m, negative inside) and the unit
    /// normal at the nearest point.
    fn outward(&self, point: &S::Vector) -> (f64, S::Vector);

    /// Returns half of the smallest width along its face normals (m); zero for a segment.
    fn half_thickness(&self) -> f64;

    /// Finds contact points with a surface of a first body, in the order of their features. The
    /// core is in the surface's frame, with its centre at `at`.
    fn contact_points_with_surface(
        &self,
        surface: &dyn Surface<S>,
        at: &S::Vector,
        rounding: f64,
        tolerances: &ContactTolerances,
        out: &mut Vec<ContactPoint<S::Vector>>,
    );

    /// Returns the outline of the rounded core for figures and files (m): in 2D one closed line
    /// without its last point, in 3D one polygon per face.
    fn outline(&self, rounding: f64) -> Vec<Vec<S::Vector>>;

    /// Returns its corners and faces.
    fn boundary(&self) -> Boundary<S::Vector>;

    /// Builds a core from corners and faces.
    ///
    /// # Errors
    /// Returns why the boundary is invalid.
    fn bounded_by(boundary: Boundary<S::Vector>) -> Result<Self, String>;
}
