//! Collision shapes: balls, convex pieces, and surfaces of first bodies.

use super::convex::{ConvexCollider, STEEPEST};
use super::facets::Facet;
use super::periodic::Periodic;
use super::recede::Recede;
use super::space::{Space, VectorLike};
use std::fmt::Debug;

/// A disk or a sphere carried by a body, or a point.
#[derive(Clone, Debug)]
pub struct Ball<S: Space> {
    /// Index of the body.
    pub body: u32,
    /// Radius (m); zero for a point of a surface, see [`Ball::size`].
    pub radius: f64,
    /// Centre in the body's frame (m); zero for a grain.
    pub offset: S::Vector,
    /// Index of the material.
    pub material: u16,
    /// Tributary length (m) or area (m^2) of a vertex of a grain that deforms, along its normals in
    /// the axes of the body; zero for other balls.
    pub area: S::Vector,
}

/// Share of its area that a vertex has at least in a contact: sizes are positive.
const MIN_SHARE: f64 = 1e-6;

impl<S: Space> Ball<S> {
    /// Returns half of the thickness (m): the radius, or for a point of a surface half of its
    /// tributary length, in space the radius of a disk of its tributary area, from the length of
    /// each body in `lengths`.
    pub fn size(&self, lengths: &[f64]) -> f64 {
        if self.radius > 0.0 {
            self.radius
        } else if self.area == S::Vector::zero() {
            lengths[self.body as usize]
        } else {
            match S::D {
                2 => 0.5 * self.area.norm(),
                _ => point_radius(S::D, self.area.norm()),
            }
        }
    }

    /// Returns the radius in contacts (m), from which laws compute their area: that of a ball, or
    /// for a point of a surface the one whose contact has its tributary area.
    pub fn contact_radius(&self, lengths: &[f64]) -> f64 {
        match S::D {
            2 if self.radius == 0.0 => 2.0 * self.size(lengths),
            _ => self.size(lengths),
        }
    }

    /// Returns the radius of [`Self::contact_radius`] (m) in a contact of known normal (towards the
    /// ball, in the axes of its body). The tributary area of a vertex at a corner is on two sides,
    /// of which one touches.
    pub fn radius_towards(&self, normal: &S::Vector, lengths: &[f64]) -> f64 {
        if self.area == S::Vector::zero() {
            return self.contact_radius(lengths);
        }
        let least = MIN_SHARE * self.area.norm();
        point_radius(S::D, least.max(-self.area.dot(normal)))
    }
}

/// Returns the radius of a contact (m) with a tributary length (2D, m) or area (3D, m^2): that
/// length, as for the sides of polygons, or the radius of a disk of that area.
pub fn point_radius(dimension: usize, area: f64) -> f64 {
    match dimension {
        2 => area,
        _ => (area / std::f64::consts::PI).sqrt(),
    }
}

/// Returns the size of the contact of two balls of these radii (m), which are not both zero: half
/// their harmonic mean; for a point (radius zero) its size.
pub fn reduced_radius(radii: [f64; 2], sizes: [f64; 2]) -> f64 {
    match radii {
        [0.0, _] => sizes[0],
        [_, 0.0] => sizes[1],
        [a, b] => a * b / (a + b),
    }
}

/// Nearest point of a surface to a ball, in the surface's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint<V> {
    /// Nearest point on the surface (m).
    pub closest_point: V,
    /// Unit normal, from the surface to the ball's centre.
    pub normal: V,
    /// Distance from the surface to the centre (m), negative if the centre is inside the solid.
    pub distance: f64,
    /// Name of the face, edge or vertex; stable in time.
    pub feature: u32,
}

/// A convex corner of a surface, or any vertex of one that deforms (2D).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<V> {
    /// Position (m).
    pub at: V,
    /// Unit normals of the faces before and after it; the corner is nearest to points in between.
    pub normals: [V; 2],
    /// Name, stable in time.
    pub feature: u32,
}

/// The faces around a place of a surface: their normals, and the vectors from the place to their
/// corners (m).
#[derive(Debug, Default)]
pub struct Fan<V> {
    /// Unit normals, to the open side.
    pub normals: Vec<V>,
    /// Vectors to corners.
    pub spokes: Vec<V>,
}

/// A facet of a surface that deforms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MovingFacet {
    /// D vertices of the facet, as indices into [`Surface::moving_vertices`]. Seen from outside
    /// they are counter-clockwise; in 2D the outside is on their left.
    pub vertices: [u32; 3],
    /// The facets beyond its edges; in 2D the facets before and after it.
    pub beside: [Option<u32>; 3],
}

/// The surface of a first body: solid on one side, open on the other.
pub trait Surface<S: Space>: Debug + Send + Sync {
    /// Finds all points where the surface is locally nearest to a ball centred at `centre` within
    /// `reach` (m), in the order of their features, without ghost contacts at seams between faces.
    fn closest_points(
        &self,
        centre: &S::Vector,
        reach: f64,
        out: &mut Vec<ClosestPoint<S::Vector>>,
    );
    /// Returns whether a ball may be within `reach` (m): a cheap test that may return true too
    /// often.
    fn near(&self, centre: &S::Vector, reach: f64) -> bool;
    /// Finds corners of the surface in the box from `low` to `high` (m) that a flat side may touch,
    /// in the order of their features; none for a plane, all vertices of a surface that deforms.
    fn corners(&self, _low: &S::Vector, _high: &S::Vector, _out: &mut Vec<Corner<S::Vector>>) {}
    /// Finds triangles of the surface that intersect the box from `low` to `high` (m), and all that
    /// share their corners there (3D); none for surfaces that only corners of a body can touch: a
    /// plane, the inside of a drum.
    fn facets(&self, _low: &S::Vector, _high: &S::Vector, _out: &mut Vec<Facet<S::Vector>>) {}
    /// Finds the faces around a corner or an edge `within` a distance (m) of a place; none within
    /// faces in the plane, nor of planes and of the insides of drums.
    fn fan(&self, _at: &S::Vector, _within: f64, _out: &mut Fan<S::Vector>) {}
    /// Returns the outline for figures and files (m): polylines in 2D, polygons in 3D, in the
    /// surface's frame.
    fn outline(&self) -> Vec<Vec<S::Vector>>;
    /// Returns its faces within `reach` (m) of the origin of its frame for figures, anticlockwise
    /// seen from the open side (3D).
    fn faces_within(&self, _reach: f64) -> Vec<Vec<S::Vector>> {
        self.outline()
    }
    /// Returns whether the outline shows the whole surface.
    fn bounded(&self) -> bool {
        false
    }
    /// Returns the outward normal, if the surface is a plane.
    fn flat(&self) -> Option<S::Vector> {
        None
    }
    /// Returns whether points behind it are detected at any depth: true for planes and the insides
    /// of drums. Behind a profile or facets there may be another part of the surface.
    fn any_depth(&self) -> bool {
        false
    }
    /// Returns whether the surface is concave, such as the inside of a drum.
    fn is_hollow(&self) -> bool {
        false
    }
    /// Returns by how much the second of two positions is farther from a hollow surface than the
    /// first (m).
    fn distance_gained(&self, _from: &S::Vector, _to: &S::Vector) -> f64 {
        0.0
    }
    /// Returns the surface as a receding one; `None` if it cannot wear.
    fn receding(&self) -> Option<&dyn Recede<S>> {
        None
    }
    /// Returns the surface as a receding one, mutably.
    fn receding_mut(&mut self) -> Option<&mut dyn Recede<S>> {
        None
    }
    /// Sets new positions of the vertices of a surface that deforms (m), all in their order; does
    /// nothing for others.
    fn move_vertices(&mut self, _vertices: &[S::Vector]) {}
    /// Returns the vertices of a surface that deforms, in its frame (m): the neighbour list follows
    /// each of them.
    fn moving_vertices(&self) -> &[S::Vector] {
        &[]
    }
    /// Returns the index of the facet with a feature, for surfaces that deform; in the plane the
    /// facets are a chain of segments.
    fn facet_of(&self, feature: u32) -> u32 {
        // The start of the chain has the last name.
        if feature == u32::MAX { 0 } else { feature / 2 }
    }
    /// Returns a facet of a surface that deforms, by its index; `None` for others. In the plane
    /// those of a chain of segments.
    fn moving_facet(&self, facet: u32) -> Option<MovingFacet> {
        let vertices = self.moving_vertices().len() as u32;
        (S::D == 2 && facet.saturating_add(1) < vertices).then(|| MovingFacet {
            vertices: [facet, facet + 1, 0],
            beside: [
                facet.checked_sub(1),
                (facet + 2 < vertices).then_some(facet + 1),
                None,
            ],
        })
    }
    /// Returns the normal of the facets at the border of a surface that deforms where a feature is
    /// on it, their mean at a vertex; `None` of other features and surfaces.
    fn border_normal(&self, _feature: u32) -> Option<S::Vector> {
        None
    }
    /// Returns whether it encloses its body, which is then smaller than half a period: contacts are
    /// searched at the nearest image.
    fn is_closed(&self) -> bool {
        false
    }
    /// Returns the nearest point of a closed surface to a place that it encloses, at any depth;
    /// `None` for places outside and for surfaces that are not closed.
    fn enclosing(&self, place: &S::Vector) -> Option<ClosestPoint<S::Vector>> {
        if !self.is_closed() {
            return None;
        }
        let far = |x: &S::Vector| x.dot(x);
        let size = self.moving_vertices().iter().map(far).fold(0.0, f64::max);
        if far(place) >= size {
            return None;
        }
        let mut found = Vec::new();
        self.closest_points(place, 2.0 * size.sqrt(), &mut found);
        let nearest = found
            .into_iter()
            .min_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()));
        nearest.filter(|touch| touch.distance < 0.0)
    }
    /// Returns whether the surface deforms. Flat sides and balls then touch every vertex within
    /// reach: a vertex is the nearest one only until it is loaded, and if only the nearest one were
    /// in contact, the load would alternate between vertices in each step.
    fn deforms(&self) -> bool {
        !self.moving_vertices().is_empty()
    }
    /// Finds all vertices within `reach` (m) of a ball's centre in front of a surface that deforms,
    /// with the features that [`Surface::closest_points`] gives them; none of others.
    fn vertices_within(
        &self,
        _centre: &S::Vector,
        _reach: f64,
        _out: &mut Vec<ClosestPoint<S::Vector>>,
    ) {
    }
    /// Returns whether a rotation about the body's origin with this spin, in the body's axes,
    /// leaves the surface in place.
    fn is_unchanged_by(&self, spin: &S::Spin) -> bool {
        *spin == S::Spin::zero()
    }
}

/// Returns a vertex as the nearest point to a ball in front of it, where it is within `reach` (m).
pub(super) fn at_vertex<V: VectorLike>(
    vertex: V,
    outward: &V,
    centre: &V,
    reach: f64,
    feature: u32,
) -> Option<ClosestPoint<V>> {
    let arm = *centre - vertex;
    let distance = arm.norm();
    let faces = arm.dot(outward) > STEEPEST * distance * outward.norm();
    (distance < reach && faces).then(|| ClosestPoint {
        closest_point: vertex,
        normal: arm * (1.0 / distance),
        distance,
        feature,
    })
}

/// Returns whether a spin is about an axis, within the rounding of the rotation to body axes.
pub(super) fn about<S: Space>(axis: &S::Vector, spin: &S::Spin) -> bool {
    S::split_spin(axis, spin).1.norm() <= 1e-9 * spin.norm()
}

/// A half-space: solid below the plane through the origin with outward unit normal.
#[derive(Clone, Debug)]
pub struct HalfSpace<S: Space> {
    /// Outward unit normal.
    pub normal: S::Vector,
    /// Half the side of the part shown in figures (m).
    pub shown: f64,
}

impl<S: Space> Surface<S> for HalfSpace<S> {
    fn closest_points(
        &self,
        centre: &S::Vector,
        reach: f64,
        out: &mut Vec<ClosestPoint<S::Vector>>,
    ) {
        let distance = centre.dot(&self.normal);
        if distance < reach {
            out.push(ClosestPoint {
                closest_point: *centre - self.normal * distance,
                normal: self.normal,
                distance,
                feature: 0,
            });
        }
    }

    fn near(&self, centre: &S::Vector, reach: f64) -> bool {
        centre.dot(&self.normal) < reach
    }

    fn flat(&self) -> Option<S::Vector> {
        Some(self.normal)
    }

    fn any_depth(&self) -> bool {
        true
    }

    fn is_unchanged_by(&self, spin: &S::Spin) -> bool {
        *spin == S::Spin::zero() || (S::D == 3 && about::<S>(&self.normal, spin))
    }

    fn outline(&self) -> Vec<Vec<S::Vector>> {
        self.faces_within(self.shown)
    }

    fn faces_within(&self, s: f64) -> Vec<Vec<S::Vector>> {
        let [t1, t2] = S::tangents(&self.normal);
        if S::D == 2 {
            // Solid on the right, as with profiles.
            vec![vec![t1 * s, t1 * -s]]
        } else {
            let corner = |a: f64, b: f64| t1 * (a * s) + t2 * (b * s);
            vec![vec![
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ]]
        }
    }
}

/// A surface and the body that carries it. Its axes are those of the body.
#[derive(Debug)]
pub struct Carried<S: Space> {
    /// Index of the body.
    pub body: u32,
    /// Origin of the surface's frame in the body's frame (m).
    pub offset: S::Vector,
    /// The surface.
    pub shape: Box<dyn Surface<S>>,
    /// Index of the material.
    pub material: u16,
}

/// All collision shapes of a scene.
#[derive(Debug)]
pub struct Shapes<S: Space> {
    /// Disks or spheres.
    pub balls: Vec<Ball<S>>,
    /// Convex pieces.
    pub pieces: Vec<ConvexCollider<S>>,
    /// Surfaces of first bodies.
    pub surfaces: Vec<Carried<S>>,
    /// Periodic boundaries.
    pub periodic: Periodic,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::Dim2;
    use nalgebra::Vector2;

    #[test]
    fn half_space_gives_signed_distance() {
        let floor = HalfSpace::<Dim2> {
            normal: Vector2::new(0.0, 1.0),
            shown: 1.0,
        };
        let mut out = Vec::new();
        floor.closest_points(&Vector2::new(3.0, 0.5), 1.0, &mut out);
        floor.closest_points(&Vector2::new(3.0, -0.5), 1.0, &mut out);
        assert_eq!((out[0].distance, out[1].distance), (0.5, -0.5));
        assert_eq!(out[0].closest_point, Vector2::new(3.0, 0.0));
    }
}
