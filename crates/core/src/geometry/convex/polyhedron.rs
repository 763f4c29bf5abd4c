//! Convex polyhedra in 3D, and the segments of capsules.

pub use super::polyhedron_hull::{CUBOID_FACES, PolyhedronError, normal};
pub use super::topology::{Edge, MAX_EDGES, Topology};
use super::{
    Boundary, ContactPoint, ContactTolerances, ConvexPart, Core, CorePair, PairFace,
    polyhedron_mass, polyhedron_pair, polyhedron_surface,
};
use crate::geometry::shape::Surface;
use crate::geometry::space::{Dim3, Space};
use nalgebra::{UnitQuaternion, Vector3};
use std::sync::Arc;

type V = Vector3<f64>;

/// Corners, faces, and outward unit normals. Two points without faces are a segment.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    pub(super) points: Vec<V>,
    pub(super) normals: Vec<V>,
    pub(super) topology: Arc<Topology>,
}

/// Cosine of the largest angle between two faces that count as opposite: about five degrees.
const FACING: f64 = 0.996;

impl Polyhedron {
    /// Returns the part of a body with this core and a rounding radius (m).
    pub fn part(&self, rounding: f64) -> ConvexPart<Dim3> {
        let properties = polyhedron_mass::of(self, rounding);
        let core = Self {
            points: self.points.iter().map(|p| p - properties.centre).collect(),
            ..self.clone()
        };
        ConvexPart {
            bound: core.farthest() + rounding,
            core,
            centre: properties.centre,
            rounding,
            volume: properties.volume,
            inertia: properties.inertia,
        }
    }

    /// Returns the corners (m).
    pub fn points(&self) -> &[V] {
        &self.points
    }

    /// Returns the outward unit normals of the faces.
    pub fn normals(&self) -> &[V] {
        &self.normals
    }

    /// Returns the incidence of corners, edges and faces.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Returns the two ends of an edge (m).
    pub fn ends(&self, edge: usize) -> [V; 2] {
        self.topology.edges[edge]
            .corners
            .map(|c| self.points[c as usize])
    }

    /// Iterates over the corners of a face (m).
    pub fn face(&self, face: usize) -> impl Iterator<Item = V> + '_ {
        self.topology.faces[face]
            .iter()
            .map(|c| self.points[*c as usize])
    }

    /// Returns the distance of the farthest corner from the origin (m).
    pub fn farthest(&self) -> f64 {
        self.points.iter().map(V::norm).fold(0.0, f64::max)
    }

    /// Returns the corner that is lowest along a direction.
    pub fn lowest(&self, direction: &V) -> usize {
        let height = |k: &usize| self.points[*k].dot(direction);
        (0..self.points.len())
            .min_by(|a, b| height(a).total_cmp(&height(b)))
            .unwrap_or(0)
    }

    /// Returns the face at the lowest corner along a direction whose normal is most opposed to it;
    /// `None` for a segment.
    pub fn facing(&self, direction: &V) -> Option<usize> {
        let against = |f: &u32| self.normals[*f as usize].dot(direction);
        self.topology.about[self.lowest(direction)]
            .iter()
            .min_by(|a, b| against(a).total_cmp(&against(b)))
            .map(|f| *f as usize)
    }

    /// Returns whether a face with this outward normal is parallel to the opposite face, within
    /// about five degrees. Always true for a segment.
    pub fn faces(&self, normal: &V) -> bool {
        self.facing(normal)
            .is_none_or(|f| self.normals[f].dot(normal) < -FACING)
    }

    /// Returns the signed distance of a point from the boundary (m, negative inside) and the unit
    /// normal at the nearest point.
    pub fn distance(&self, point: &V) -> (f64, V) {
        let height = |f: usize| {
            let corner = self.topology.faces[f][0] as usize;
            (point - self.points[corner]).dot(&self.normals[f])
        };
        let best = (0..self.normals.len()).max_by(|a, b| height(*a).total_cmp(&height(*b)));
        if let Some(f) = best
            && (height(f) <= 0.0 || self.over(f, point))
        {
            return (height(f), self.normals[f]);
        }
        // Outside, beyond the sides of that face: the nearest of all faces and edges.
        let mut nearest = (f64::INFINITY, V::x());
        for f in 0..self.normals.len() {
            let h = height(f);
            if h > 0.0 && h < nearest.0 && self.over(f, point) {
                nearest = (h, self.normals[f]);
            }
        }
        for e in 0..self.topology.edges.len() {
            let [a, b] = self.ends(e);
            let along = b - a;
            let s = ((point - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
            let d = point - (a + along * s);
            let length = d.norm();
            if length < nearest.0 {
                let outward = best.map_or_else(|| across(&along), |f| self.normals[f]);
                nearest = (length, if length > 0.0 { d / length } else { outward });
            }
        }
        nearest
    }

    /// Returns whether the projection of a point along a face's normal is on the face.
    fn over(&self, face: usize, point: &V) -> bool {
        let corners = &self.topology.faces[face];
        (0..corners.len()).all(|k| {
            let a = self.points[corners[k] as usize];
            let b = self.points[corners[(k + 1) % corners.len()] as usize];
            (b - a).cross(&(point - a)).dot(&self.normals[face]) >= 0.0
        })
    }
}

/// Returns a unit vector perpendicular to another.
pub fn across(v: &V) -> V {
    Dim3::tangents(&v.normalize())[0]
}

impl Core<Dim3> for Polyhedron {
    fn turned(&self, rotation: &UnitQuaternion<f64>) -> Self {
        let mut out = Self {
            points: Vec::with_capacity(self.points.len()),
            normals: Vec::with_capacity(self.normals.len()),
            topology: Arc::clone(&self.topology),
        };
        self.turn_into(rotation, &mut out);
        out
    }

    fn turn_into(&self, rotation: &UnitQuaternion<f64>, out: &mut Self) {
        let turn = rotation.to_rotation_matrix();
        out.points.clear();
        out.points.extend(self.points.iter().map(|p| turn * p));
        out.normals.clear();
        out.normals.extend(self.normals.iter().map(|n| turn * n));
        if !Arc::ptr_eq(&self.topology, &out.topology) {
            out.topology = Arc::clone(&self.topology);
        }
    }

    fn scale_into(&self, factor: f64, out: &mut Self) {
        out.points.clear();
        out.points.extend(self.points.iter().map(|p| p * factor));
        out.normals.clone_from(&self.normals);
        if !Arc::ptr_eq(&self.topology, &out.topology) {
            out.topology = Arc::clone(&self.topology);
        }
    }

    fn contact_points(pair: &CorePair<Dim3>, out: &mut Vec<ContactPoint<V>>) {
        polyhedron_pair::contact_points(pair, out);
    }

    fn corners(&self) -> &[V] {
        &self.points
    }

    fn normals(&self) -> &[V] {
        &self.normals
    }

    fn corner_of(&self, face: usize) -> V {
        self.points[self.topology.faces[face][0] as usize]
    }

    fn points_on_face(pair: &CorePair<Dim3>, face: PairFace, out: &mut Vec<ContactPoint<V>>) {
        polyhedron_pair::points_on_face(pair, face, out);
    }

    fn feature_from_other_side(feature: u64) -> u64 {
        super::polyhedron_clip::name::from_other_side(feature)
    }

    fn outward(&self, point: &V) -> (f64, V) {
        self.distance(point)
    }

    fn half_thickness(&self) -> f64 {
        super::half_thickness::<Dim3>(&self.points, &self.normals)
    }

    fn contact_points_with_surface(
        &self,
        surface: &dyn Surface<Dim3>,
        at: &V,
        rounding: f64,
        tolerances: &ContactTolerances,
        out: &mut Vec<ContactPoint<V>>,
    ) {
        polyhedron_surface::contact_points(self, surface, at, rounding, tolerances, out);
    }

    fn outline(&self, rounding: f64) -> Vec<Vec<V>> {
        super::polyhedron_outline::of(self, rounding)
    }

    fn boundary(&self) -> Boundary<V> {
        self.as_boundary()
    }

    fn bounded_by(boundary: Boundary<V>) -> Result<Self, String> {
        Self::of_boundary(boundary)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_a_cuboid() {
        let cuboid = Polyhedron::cuboid([2.0, 4.0, 6.0]);
        let known = [
            (V::new(0.5, 0.3, 3.5), 0.5, V::z()),
            (V::new(0.9, 0.0, 0.0), -0.1, V::x()),
            (V::new(1.3, 2.4, 0.0), 0.5, V::new(0.6, 0.8, 0.0)),
            (V::new(2.0, 4.0, 5.0), 3.0, V::new(1.0, 2.0, 2.0) / 3.0),
        ];
        for (point, distance, normal) in known {
            let (d, n) = cuboid.distance(&point);
            assert!(
                (d - distance).abs() < 1e-14 && (n - normal).norm() < 1e-14,
                "{point:?}"
            );
        }
        let segment = Polyhedron::segment(V::zeros(), V::new(2.0, 0.0, 0.0));
        let (d, n) = segment.distance(&V::new(1.0, 3.0, 4.0));
        assert!((d - 5.0).abs() < 1e-14 && (n - V::new(0.0, 0.6, 0.8)).norm() < 1e-14);
        let (d, n) = segment.distance(&V::new(1.0, 0.0, 0.0));
        assert!(d == 0.0 && n.x == 0.0 && (n.norm() - 1.0).abs() < 1e-14);
    }
}
