//! Convex polyhedra in 3D, and the segments of capsules.

use super::{
    Boundary, ContactPoint, ContactTolerances, ConvexPart, Core, polyhedron_mass, polyhedron_pair,
    polyhedron_surface,
};
use crate::geometry::shape::Surface;
use crate::geometry::space::{Dim3, Space};
use nalgebra::{UnitQuaternion, Vector3};
use parry3d_f64::math::Vector as HullPoint;
use parry3d_f64::shape::ConvexPolyhedron;
use std::sync::Arc;

type V = Vector3<f64>;

/// Corners, faces, and outward unit normals. Two points without faces are a segment.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    points: Vec<V>,
    normals: Vec<V>,
    topology: Arc<Topology>,
}

/// Incidence of corners, edges and faces.
#[derive(Debug, PartialEq, Eq)]
pub struct Topology {
    /// Corners of each face, anticlockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// Edges of each face: side k goes from its corner k to the next.
    pub sides: Vec<Vec<u32>>,
    /// All edges.
    pub edges: Vec<Edge>,
    /// Faces around each corner, anticlockwise seen from outside.
    pub about: Vec<Vec<u32>>,
}

/// An edge: two corners and the faces on both sides; a segment has no faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// From and to.
    pub corners: [u32; 2],
    /// The face oriented along the edge, and the one oriented against it.
    pub faces: Option<[u32; 2]>,
}

/// Reason why points do not form a convex polyhedron.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum PolyhedronError {
    /// Fewer than four points.
    #[error("a polyhedron needs at least four points, got {0}")]
    TooFew(usize),
    /// More edges than names of contact points can distinguish.
    #[error("a polyhedron has at most {MAX_EDGES} edges, got {0}; take fewer points")]
    TooMany(usize),
    /// A coordinate is not finite.
    #[error("point {0} of the polyhedron is not finite")]
    NotFinite(usize),
    /// All points in one plane.
    #[error("the points of the polyhedron lie in one plane, or nearly so")]
    Flat,
    /// Two coincident points.
    #[error("points {0} and {1} of the polyhedron are at the same place; remove one of them")]
    Coincident(usize, usize),
    /// A point inside the hull, or on one of its faces.
    #[error(
        "point {0} of the polyhedron is not a corner of the convex hull of its points; remove it, or divide the body into convex ones (a body may have several shapes)"
    )]
    NotConvex(usize),
    /// The faces do not form a closed surface.
    #[error("the faces of the polyhedron do not form a closed surface")]
    Open,
}

/// Cosine of the largest angle between two faces that count as opposite: about five degrees.
const FACING: f64 = 0.996;

/// Maximum number of edges that the names of contact points can distinguish.
pub const MAX_EDGES: usize = 1 << 14;

impl Polyhedron {
    /// Creates the convex hull of points (m), all of which must be its corners.
    ///
    /// # Errors
    /// Too few or non-finite points, coplanar points, points inside the hull, coincident points.
    pub fn new(points: &[V]) -> Result<Self, PolyhedronError> {
        let hull = Self::hull(points)?;
        let size = hull.farthest();
        let near = |p: &V, q: &V| (p - q).norm() <= 1e-9 * size;
        for (k, p) in points.iter().enumerate() {
            if let Some(other) = points[..k].iter().position(|q| near(p, q)) {
                return Err(PolyhedronError::Coincident(other, k));
            }
            if !hull.points.iter().any(|q| near(p, q)) {
                return Err(PolyhedronError::NotConvex(k));
            }
        }
        Ok(hull)
    }

    /// Creates the convex hull of points (m), ignoring interior points.
    ///
    /// # Errors
    /// Too few or non-finite points, coplanar points.
    pub fn hull(points: &[V]) -> Result<Self, PolyhedronError> {
        if points.len() < 4 {
            return Err(PolyhedronError::TooFew(points.len()));
        }
        if let Some(k) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(PolyhedronError::NotFinite(k));
        }
        // The tolerances of the library assume bodies of unit size at the origin.
        let centre = points.iter().sum::<V>() / points.len() as f64;
        let size = points
            .iter()
            .map(|p| (p - centre).norm())
            .fold(0.0, f64::max);
        if !(size > 0.0 && size.is_finite()) {
            return Err(PolyhedronError::Flat);
        }
        let scaled: Vec<HullPoint> = points
            .iter()
            .map(|p| (p - centre) / size)
            .map(|p| HullPoint::new(p.x, p.y, p.z))
            .collect();
        let hull = ConvexPolyhedron::from_convex_hull(&scaled).ok_or(PolyhedronError::Flat)?;
        let corners = hull.vertices_adj_to_face();
        let faces: Vec<Vec<u32>> = hull
            .faces()
            .iter()
            .map(|f| {
                let first = f.first_vertex_or_edge as usize;
                corners[first..first + f.num_vertices_or_edges as usize].to_vec()
            })
            .collect();
        // The given corners, not those transformed back from the unit scale.
        let given = |p: &HullPoint| {
            let p = V::new(p.x, p.y, p.z);
            let scaled = |k: &usize| (V::new(scaled[*k].x, scaled[*k].y, scaled[*k].z) - p).norm();
            (0..points.len())
                .min_by(|a, b| scaled(a).total_cmp(&scaled(b)))
                .map_or(p, |k| points[k])
        };
        let out = Self::from_faces(hull.points().iter().map(given).collect(), faces)?;
        let thin = (0..out.normals.len()).any(|f| {
            let depth =
                |p: &V| (p - out.points[out.topology.faces[f][0] as usize]).dot(&out.normals[f]);
            out.points.iter().map(depth).fold(0.0, f64::min) > -1e-9 * size
        });
        if thin {
            return Err(PolyhedronError::Flat);
        }
        Ok(out)
    }

    /// Creates a polyhedron from corners (m) and faces that are anticlockwise seen from outside and form a
    /// convex body.
    ///
    /// # Errors
    /// The faces are not closed, or there are too many.
    pub fn from_faces(points: Vec<V>, faces: Vec<Vec<u32>>) -> Result<Self, PolyhedronError> {
        let topology = Topology::new(points.len(), faces)?;
        let normals = topology.faces.iter().map(|f| normal(&points, f)).collect();
        Ok(Self {
            points,
            normals,
            topology: Arc::new(topology),
        })
    }

    /// Creates a cuboid about the origin (m).
    pub fn cuboid(size: [f64; 3]) -> Self {
        let [x, y, z] = size.map(|s| 0.5 * s);
        let points = (0..8)
            .map(|k| {
                let side = |bit: usize, half: f64| if k >> bit & 1 == 1 { half } else { -half };
                V::new(side(0, x), side(1, y), side(2, z))
            })
            .collect();
        let faces = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let faces = faces.iter().map(|f| f.to_vec()).collect();
        #[allow(clippy::expect_used, reason = "six faces that are written above")]
        Self::from_faces(points, faces).expect("the faces of a cuboid close")
    }

    /// Creates the segment between two different points (m), the core of a capsule.
    pub fn segment(from: V, to: V) -> Self {
        let edge = Edge {
            corners: [0, 1],
            faces: None,
        };
        Self {
            points: vec![from, to],
            normals: Vec::new(),
            topology: Arc::new(Topology {
                faces: Vec::new(),
                sides: Vec::new(),
                edges: vec![edge],
                about: vec![Vec::new(); 2],
            }),
        }
    }

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

    /// Returns the face at the lowest corner along a direction whose normal is most opposed to it; `None`
    /// for a segment.
    pub fn facing(&self, direction: &V) -> Option<usize> {
        let against = |f: &u32| self.normals[*f as usize].dot(direction);
        self.topology.about[self.lowest(direction)]
            .iter()
            .min_by(|a, b| against(a).total_cmp(&against(b)))
            .map(|f| *f as usize)
    }

    /// Returns whether a face with this outward normal is parallel to the opposite face, within about five
    /// degrees. Always true for a segment.
    pub fn faces(&self, normal: &V) -> bool {
        self.facing(normal)
            .is_none_or(|f| self.normals[f].dot(normal) < -FACING)
    }

    /// Returns the signed distance of a point from the boundary (m, negative inside) and the unit normal at
    /// the nearest point.
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

/// Returns the outward normal of a face from its area vector, an average where the corners are not exactly
/// coplanar.
pub fn normal(points: &[V], face: &[u32]) -> V {
    let origin = points[face[0] as usize];
    let at = |k: usize| points[face[k] as usize] - origin;
    let area: V = (1..face.len() - 1).map(|k| at(k).cross(&at(k + 1))).sum();
    area.normalize()
}

impl Topology {
    /// Builds the incidence from the corners of the faces.
    fn new(corners: usize, faces: Vec<Vec<u32>>) -> Result<Self, PolyhedronError> {
        let mut edges: Vec<Edge> = Vec::new();
        let mut sides = Vec::with_capacity(faces.len());
        let mut known = std::collections::HashMap::new();
        for (f, face) in faces.iter().enumerate() {
            let mut own = Vec::with_capacity(face.len());
            for (k, a) in face.iter().enumerate() {
                let b = face[(k + 1) % face.len()];
                let edge = *known.entry((*a.min(&b), *a.max(&b))).or_insert_with(|| {
                    edges.push(Edge {
                        corners: [*a, b],
                        faces: Some([f as u32; 2]),
                    });
                    edges.len() - 1
                });
                if edges[edge].corners == [b, *a]
                    && let Some(faces) = &mut edges[edge].faces
                {
                    faces[1] = f as u32;
                }
                own.push(edge as u32);
            }
            sides.push(own);
        }
        let closed = |e: &Edge| e.faces.is_some_and(|f| f[0] != f[1]);
        if faces.iter().any(|f| f.len() < 3) || !edges.iter().all(closed) {
            return Err(PolyhedronError::Open);
        }
        if edges.len() > MAX_EDGES {
            return Err(PolyhedronError::TooMany(edges.len()));
        }
        let mut out = Self {
            faces,
            sides,
            edges,
            about: Vec::new(),
        };
        out.about = (0..corners as u32)
            .map(|c| out.around(c))
            .collect::<Result<_, _>>()?;
        Ok(out)
    }

    /// Returns the faces around a corner: each next face leaves along the edge on which the previous one
    /// arrives.
    fn around(&self, corner: u32) -> Result<Vec<u32>, PolyhedronError> {
        let place = |f: usize| self.faces[f].iter().position(|c| *c == corner);
        let first = (0..self.faces.len()).find(|f| place(*f).is_some());
        let first = first.ok_or(PolyhedronError::Open)?;
        let (mut out, mut f) = (Vec::new(), first);
        loop {
            out.push(f as u32);
            let n = self.faces[f].len();
            let at = place(f).ok_or(PolyhedronError::Open)?;
            let edge = &self.edges[self.sides[f][(at + n - 1) % n] as usize];
            let [a, b] = edge.faces.ok_or(PolyhedronError::Open)?;
            f = if a as usize == f { b } else { a } as usize;
            if f == first {
                return Ok(out);
            }
            if out.len() > self.faces.len() {
                return Err(PolyhedronError::Open);
            }
        }
    }
}

impl Core<Dim3> for Polyhedron {
    fn turned(&self, rotation: &UnitQuaternion<f64>) -> Self {
        let turn = rotation.to_rotation_matrix();
        Self {
            points: self.points.iter().map(|p| turn * p).collect(),
            normals: self.normals.iter().map(|n| turn * n).collect(),
            topology: Arc::clone(&self.topology),
        }
    }

    fn meet(
        &self,
        other: &Self,
        apart: &V,
        roundings: [f64; 2],
        gauge: &ContactTolerances,
        out: &mut Vec<ContactPoint<V>>,
    ) {
        polyhedron_pair::meet(self, other, apart, roundings, gauge, out);
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

    fn meet_surface(
        &self,
        surface: &dyn Surface<Dim3>,
        at: &V,
        rounding: f64,
        gauge: &ContactTolerances,
        out: &mut Vec<ContactPoint<V>>,
    ) {
        polyhedron_surface::meet(self, surface, at, rounding, gauge, out);
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
    fn hulls_have_the_faces_of_the_books() {
        let golden = 0.5 * (1.0 + 5f64.sqrt());
        let mut points = Vec::new();
        for s in [-1.0, 1.0] {
            for t in [-1.0, 1.0] {
                let (a, b) = (s / golden, t * golden);
                points.extend([V::new(0.0, a, b), V::new(a, b, 0.0), V::new(b, 0.0, a)]);
                points.extend([V::new(s, t, -1.0), V::new(s, t, 1.0)]);
            }
        }
        for size in [1e-9, 1.0, 1e6] {
            let points: Vec<V> = points.iter().map(|p| p * size).collect();
            let dodecahedron = Polyhedron::new(&points).unwrap();
            let t = dodecahedron.topology();
            assert_eq!((t.faces.len(), t.edges.len(), t.about.len()), (12, 30, 20));
            assert!(t.faces.iter().all(|f| f.len() == 5) && t.about.iter().all(|f| f.len() == 3));
            // Inradius of the dodecahedron of circumradius sqrt(3): 1.113516364 of the edge 2/phi.
            let inradius = 0.5 * (2.5 + 1.1 * 5f64.sqrt()).sqrt() * 2.0 / golden * size;
            for f in 0..12 {
                for p in dodecahedron.face(f) {
                    let height = p.dot(&dodecahedron.normals()[f]);
                    assert!(
                        (height - inradius).abs() < 1e-14 * size,
                        "{height} {inradius}"
                    );
                }
            }
        }
    }

    #[test]
    fn points_that_make_no_polyhedron_are_told() {
        let mut points = Polyhedron::cuboid([1.0, 2.0, 3.0]).points().to_vec();
        assert!(Polyhedron::new(&points).is_ok());
        let with = |p: V| {
            let mut more = points.clone();
            more.push(p);
            Polyhedron::new(&more).unwrap_err()
        };
        assert_eq!(with(V::zeros()), PolyhedronError::NotConvex(8));
        assert_eq!(with(V::new(0.5, 0.0, 0.0)), PolyhedronError::NotConvex(8));
        assert_eq!(with(points[3]), PolyhedronError::Coincident(3, 8));
        assert_eq!(
            with(V::new(0.0, f64::NAN, 0.0)),
            PolyhedronError::NotFinite(8)
        );
        points.iter_mut().for_each(|p| p.z = 1e-3 * p.x);
        assert_eq!(
            Polyhedron::hull(&points).unwrap_err(),
            PolyhedronError::Flat
        );
        assert_eq!(
            Polyhedron::hull(&points[..3]).unwrap_err(),
            PolyhedronError::TooFew(3)
        );
        let same = [V::new(1.0, 2.0, 3.0); 5];
        assert_eq!(Polyhedron::hull(&same).unwrap_err(), PolyhedronError::Flat);
    }

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
