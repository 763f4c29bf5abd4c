//! Construction of convex polyhedra: hulls of points, closed faces, cuboids, and the segments of
//! capsules.

use super::polyhedron::Polyhedron;
use super::topology::{Edge, MAX_EDGES, Topology};
use nalgebra::Vector3;
use parry3d_f64::math::Vector as HullPoint;
use parry3d_f64::shape::ConvexPolyhedron;
use std::sync::Arc;

type V = Vector3<f64>;

/// Corners of the faces of a cuboid, anticlockwise seen from outside. Bit k of the number of a
/// corner is its side along axis k.
pub const CUBOID_FACES: [[u32; 4]; 6] = [
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 2, 3, 1],
    [4, 5, 7, 6],
];

/// Reason why points do not form a convex polyhedron.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub enum PolyhedronError {
    /// Fewer than four points.
    #[error("a polyhedron needs at least four points, got {0}")]
    TooFew(usize),
    /// The polyhedron has more edges than names of contact points can distinguish.
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

    /// Creates a polyhedron from corners (m) and faces that are anticlockwise seen from outside and
    /// form a convex body.
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
        let faces = CUBOID_FACES.iter().map(|f| f.to_vec()).collect();
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
}

/// Returns the outward normal of a face from its area vector, an average where the corners are not
/// exactly coplanar.
pub fn normal(points: &[V], face: &[u32]) -> V {
    let origin = points[face[0] as usize];
    let at = |k: usize| points[face[k] as usize] - origin;
    let area: V = (1..face.len() - 1).map(|k| at(k).cross(&at(k + 1))).sum();
    area.normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_a_dodecahedron_has_its_faces() {
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
    fn invalid_points_are_refused() {
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
}
