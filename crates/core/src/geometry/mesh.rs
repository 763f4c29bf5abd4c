//! A triangulated surface in 3D, solid behind it: a first body from a file, or a body that deforms.

use super::facets::{self, Facet};
use super::recede::Recede;
use super::shape::{ClosestPoint, Fan, MovingFacet, Surface, at_vertex};
use super::space::Dim3;
use super::worn_mesh::MeshWear;
use nalgebra::Vector3;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::HashMap;

type V = Vector3<f64>;
pub(super) type TriangleBox = GeomWithData<Rectangle<[f64; 3]>, u32>;

/// Triangles with shared corners, anticlockwise seen from the open side.
#[derive(Debug)]
pub struct Mesh {
    pub(super) points: Vec<V>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) tree: RTree<TriangleBox>,
    /// Triangles adjacent to each triangle at its edges, starting at its first corner.
    beside: Vec<[Option<u32>; 3]>,
    /// Whether the points move.
    pub(super) deforms: bool,
    /// Whether the surface encloses a grain.
    closed: bool,
    /// Wear data, if the surface can recede.
    pub(super) worn: Option<MeshWear>,
}

/// Fraction of an edge of a grain within which a position counts as its end.
const AT_CORNER: f64 = 1e-11;

/// Reason why triangles do not form a surface.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum MeshError {
    /// No triangles.
    #[error("the mesh has no triangles")]
    Empty,
    /// The mesh has more triangles than names can distinguish.
    #[error(
        "the mesh has {0} triangles, more than the limit of {MAX_TRIANGLES}; use a coarser one"
    )]
    TooMany(usize),
    /// A coordinate is not finite.
    #[error("point {0} of the mesh is not finite")]
    NotFinite(usize),
    /// A corner that does not exist.
    #[error("triangle {0} of the mesh refers to a point that does not exist")]
    NoPoint(usize),
    /// A triangle without area.
    #[error("triangle {0} of the mesh has no area; remove it")]
    Flat(usize),
    /// An edge used twice in the same direction.
    #[error(
        "triangles {0} and {1} of the mesh have their common edge in the same direction: one of them has the wrong orientation, or more than two meet there; repair the mesh"
    )]
    Turned(usize, usize),
}

/// Maximum number of triangles that the names of contacts can distinguish.
pub const MAX_TRIANGLES: usize = 1 << 28;

/// Bounding boxes of the triangles.
fn boxes(points: &[V], triangles: &[[u32; 3]]) -> RTree<TriangleBox> {
    let placed = triangles.iter().enumerate().map(|(k, t)| {
        let corners = t.map(|c| <[f64; 3]>::from(points[c as usize]));
        let bounds = AABB::from_points(&corners);
        TriangleBox::new(Rectangle::from_aabb(bounds), k as u32)
    });
    RTree::bulk_load(placed.collect())
}

impl Mesh {
    /// Creates a mesh from points (m) and triangles of point indices.
    ///
    /// # Errors
    /// No triangles, points that are not finite, triangles without area, inconsistent orientation,
    /// or more than two triangles at an edge.
    pub fn new(points: Vec<V>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        if triangles.len() > MAX_TRIANGLES {
            return Err(MeshError::TooMany(triangles.len()));
        }
        if let Some(k) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(MeshError::NotFinite(k));
        }
        let there = |t: &[u32; 3]| t.iter().all(|c| (*c as usize) < points.len());
        if let Some(k) = triangles.iter().position(|t| !there(t)) {
            return Err(MeshError::NoPoint(k));
        }
        let flat = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|c| points[c as usize]);
            let long = (b - a).norm().max((c - a).norm()).max((c - b).norm());
            (b - a).cross(&(c - a)).norm() <= 1e-12 * long * long
        };
        if let Some(k) = triangles.iter().position(flat) {
            return Err(MeshError::Flat(k));
        }
        let mut known = HashMap::new();
        for (k, t) in triangles.iter().enumerate() {
            for side in 0..3 {
                if let Some(other) = known.insert((t[side], t[(side + 1) % 3]), k) {
                    return Err(MeshError::Turned(other, k));
                }
            }
        }
        let tree = boxes(&points, &triangles);
        let across = |t: &[u32; 3], side: usize| known.get(&(t[(side + 1) % 3], t[side]));
        let beside = triangles
            .iter()
            .map(|t| [0, 1, 2].map(|side| across(t, side).map(|k| *k as u32)))
            .collect();
        Ok(Self {
            beside,
            points,
            triangles,
            tree,
            deforms: false,
            closed: false,
            worn: None,
        })
    }

    /// Creates a mesh without border, around a grain; otherwise as [`Self::new`].
    ///
    /// # Errors
    /// The errors of [`Self::new`].
    pub fn closed(points: Vec<V>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        let mesh = Self::new(points, triangles)?;
        // A closed mesh deforms from the start.
        Ok(Self {
            closed: true,
            deforms: true,
            ..mesh
        })
    }

    /// Permits the surface to recede along z, if all of its triangles face up, or all down.
    #[must_use]
    pub fn with_wear(mut self) -> Self {
        self.worn = MeshWear::new(&self.points, &self.triangles);
        self
    }

    /// Builds the bounding boxes of the triangles at their current positions.
    pub(super) fn build_boxes(&mut self) {
        self.tree = boxes(&self.points, &self.triangles);
    }

    /// Returns the number of triangles.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Returns whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Returns the facets at a vertex on the border, given one of them; `None` for a vertex inside.
    fn around(&self, known: u32, vertex: u32) -> Option<Vec<u32>> {
        let (mut found, mut next, mut border) = (vec![known], 0, false);
        while next < found.len() {
            let k = found[next] as usize;
            next += 1;
            for side in 0..3 {
                let edge = [self.triangles[k][side], self.triangles[k][(side + 1) % 3]];
                match self.beside[k][side] {
                    _ if !edge.contains(&vertex) => {}
                    None => border = true,
                    Some(other) if !found.contains(&other) => found.push(other),
                    Some(_) => {}
                }
            }
        }
        border.then_some(found)
    }

    pub(super) fn facet(&self, k: u32) -> Facet<V> {
        let t = self.triangles[k as usize];
        Facet {
            corners: t.map(|c| self.points[c as usize]),
            names: t.map(u64::from),
            name: k,
        }
    }
}

fn bounds(low: &V, high: &V) -> AABB<[f64; 3]> {
    AABB::from_corners((*low).into(), (*high).into())
}

impl Surface<Dim3> for Mesh {
    fn closest_points(&self, centre: &V, reach: f64, out: &mut Vec<ClosestPoint<V>>) {
        let (extent, mut near) = (V::repeat(reach), Vec::new());
        self.facets(&(centre - extent), &(centre + extent), &mut near);
        // Grains may stand on each other with their corners aligned.
        let at_corner = if self.closed { AT_CORNER } else { 0.0 };
        facets::closest_points_within(&near, centre, reach, at_corner, out);
    }

    fn is_closed(&self) -> bool {
        self.closed
    }

    fn move_vertices(&mut self, vertices: &[V]) {
        self.points.copy_from_slice(vertices);
        // The vertices are those of the body without wear.
        if let Some(worn) = &mut self.worn {
            worn.lower(&mut self.points);
        }
        self.deforms = true;
        self.build_boxes();
    }

    fn moving_vertices(&self) -> &[V] {
        if self.deforms { &self.points } else { &[] }
    }

    fn facet_of(&self, feature: u32) -> u32 {
        feature / 8
    }

    fn moving_facet(&self, facet: u32) -> Option<MovingFacet> {
        self.deforms.then(|| MovingFacet {
            vertices: self.triangles[facet as usize],
            beside: self.beside[facet as usize],
        })
    }

    fn border_normal(&self, feature: u32) -> Option<V> {
        let (name, part) = (feature / 8, feature % 8);
        let beside = *self.beside.get(name as usize).filter(|_| self.deforms)?;
        let opposite = match part {
            0 => return None,
            1..=3 => part as usize - 1,
            // A vertex, where facets around it end.
            _ => {
                let around = self.around(name, self.triangles[name as usize][part as usize & 3]);
                let normals = around?.into_iter().map(|k| self.facet(k).normal());
                return normals.sum::<V>().try_normalize(0.0);
            }
        };
        // The edge after the next corner is opposite to this one.
        let ends = beside[(opposite + 1) % 3].is_none();
        ends.then(|| self.facet(name).normal())
    }

    fn vertices_within(&self, centre: &V, reach: f64, out: &mut Vec<ClosestPoint<V>>) {
        if !self.deforms {
            return;
        }
        let (extent, mut near) = (V::repeat(reach), Vec::new());
        self.facets(&(centre - extent), &(centre + extent), &mut near);
        facets::vertices(&near, |vertex, outward, feature| {
            out.extend(at_vertex(vertex, &outward, centre, reach, feature));
        });
    }

    fn facets(&self, low: &V, high: &V, out: &mut Vec<Facet<V>>) {
        let first = out.len();
        let found = self.tree.locate_in_envelope_intersecting(bounds(low, high));
        out.extend(found.map(|p| self.facet(p.data)));
        out[first..].sort_unstable_by_key(|f| f.name);
    }

    fn fan(&self, at: &V, within: f64, out: &mut Fan<V>) {
        let (extent, mut about) = (V::repeat(within), Vec::new());
        self.facets(&(at - extent), &(at + extent), &mut about);
        facets::fan(&about, at, within, out);
    }

    fn near(&self, centre: &V, reach: f64) -> bool {
        let extent = V::repeat(reach);
        let near = bounds(&(centre - extent), &(centre + extent));
        self.tree
            .locate_in_envelope_intersecting(near)
            .next()
            .is_some()
    }

    fn bounded(&self) -> bool {
        true
    }

    fn receding(&self) -> Option<&dyn Recede<Dim3>> {
        self.worn.as_ref().map(|_| self as &dyn Recede<Dim3>)
    }

    fn receding_mut(&mut self) -> Option<&mut dyn Recede<Dim3>> {
        if self.worn.is_some() {
            Some(self)
        } else {
            None
        }
    }

    fn outline(&self) -> Vec<Vec<V>> {
        (0..self.triangles.len() as u32)
            .map(|k| self.facet(k).corners.to_vec())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::convex::polyhedron::CUBOID_FACES;

    /// The cube from -1 to 1.
    fn cube() -> Mesh {
        let at = |k: u32, bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
        let points = (0..8)
            .map(|k| V::new(at(k, 0), at(k, 1), at(k, 2)))
            .collect();
        let triangles = CUBOID_FACES
            .iter()
            .flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]);
        Mesh::new(points, triangles.collect()).unwrap()
    }

    fn closest_points(at: [f64; 3], reach: f64) -> Vec<ClosestPoint<V>> {
        let mut out = Vec::new();
        cube().closest_points(&V::from(at), reach, &mut out);
        out
    }

    #[test]
    fn a_ball_touches_faces_edges_and_corners_once() {
        // The centre is above a face, or above its diagonal seam.
        for at in [[0.3, 0.1, 1.2], [0.25, 0.25, 1.2], [-0.5, 0.5, 1.2]] {
            let t = closest_points(at, 0.5);
            assert_eq!(t.len(), 1, "{t:?}");
            assert!((t[0].normal - V::z()).norm() < 1e-15 && (t[0].distance - 0.2).abs() < 1e-15);
        }
        let t = closest_points([1.3, 0.2, 1.4], 0.6);
        assert_eq!(t.len(), 1);
        assert!((t[0].distance - 0.5).abs() < 1e-15);
        assert!((t[0].normal - V::new(0.6, 0.0, 0.8)).norm() < 1e-14);
        let t = closest_points([2.0, 3.0, 3.0], 3.1);
        assert_eq!(t.len(), 1);
        assert!((t[0].distance - 3.0).abs() < 1e-15);
        // Inside, pushed out by the nearest faces only.
        let t = closest_points([0.9, 0.0, 0.0], 0.2);
        assert!(t.len() == 1 && (t[0].distance + 0.1).abs() < 1e-15 && t[0].normal == V::x());
    }

    #[test]
    fn a_thin_plate_has_one_side_at_a_time() {
        // Two faces 0.1 apart, both within the search distance.
        let points = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let mut all: Vec<V> = points.iter().map(|p| V::new(p.0, p.1, 0.0)).collect();
        all.extend(points.iter().map(|p| V::new(p.0, p.1, -0.1)));
        let mut triangles = vec![[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]];
        for k in 0..4u32 {
            let next = (k + 1) % 4;
            triangles.extend([[k, 4 + k, next], [next, 4 + k, 4 + next]]);
        }
        let plate = Mesh::new(all, triangles).unwrap();
        for (z, side) in [(0.05, 1.0), (-0.15, -1.0)] {
            let mut out = Vec::new();
            plate.closest_points(&V::new(0.1, 0.2, z), 0.5, &mut out);
            assert_eq!(out.len(), 1, "{out:?}");
            assert!((out[0].distance - 0.05).abs() < 1e-15 && out[0].normal == V::z() * side);
        }
    }

    #[test]
    fn features_stay_while_a_ball_slides_on_a_face() {
        let names: Vec<u32> = (0..5)
            .map(|k| closest_points([0.5 - 0.1 * f64::from(k), -0.6, 1.1], 0.3)[0].feature)
            .collect();
        assert!(names.windows(2).all(|w| w[0] == w[1]), "{names:?}");
    }

    #[test]
    fn invalid_triangles_are_refused() {
        let cube = cube();
        let (p, t) = (cube.points, cube.triangles);
        let of = |t: Vec<[u32; 3]>| Mesh::new(p.clone(), t).unwrap_err();
        assert_eq!(of(vec![]), MeshError::Empty);
        assert_eq!(of(vec![[0, 1, 9]]), MeshError::NoPoint(0));
        assert_eq!(of(vec![[0, 1, 1]]), MeshError::Flat(0));
        let mut turned = t.clone();
        turned[0].swap(0, 1);
        assert!(matches!(of(turned), MeshError::Turned(0, _)));
        let mut bad = p.clone();
        bad[2].y = f64::INFINITY;
        assert_eq!(Mesh::new(bad, t).unwrap_err(), MeshError::NotFinite(2));
    }
}
