//! Convex cores as corners and faces, the form in which files store them.

use super::Core;
use super::polygon::Polygon;
use super::polyhedron::Polyhedron;
use crate::geometry::space::{Dim2, Dim3, Space, VectorLike};
use nalgebra::{Vector2, Vector3};

/// Corners of a core and, in 3D, its faces. Two corners are the segment of a capsule.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary<V> {
    /// Corners relative to the core's centre (m); anticlockwise in 2D.
    pub corners: Vec<V>,
    /// Corner indices of each face, anticlockwise seen from outside; empty in 2D and for a segment.
    pub faces: Vec<Vec<u32>>,
}

impl Boundary<[f64; 3]> {
    /// Returns the lines of the core in a dimension with a rounding (m), for figures: one around it
    /// in 2D, one around each face in 3D. Empty if corners and faces do not form a valid core.
    pub fn outline(&self, dimension: usize, rounding: f64) -> Vec<Vec<[f64; 3]>> {
        match dimension {
            2 => self.outline_in::<Dim2>(rounding),
            _ => self.outline_in::<Dim3>(rounding),
        }
    }

    fn outline_in<S: Space>(&self, rounding: f64) -> Vec<Vec<[f64; 3]>> {
        let corners = self.corners.iter().map(|c| S::Vector::from_slice(c));
        let boundary = Boundary {
            corners: corners.collect(),
            faces: self.faces.clone(),
        };
        let lines = S::Core::bounded_by(boundary).map(|core| core.outline(rounding));
        let padded = |line: Vec<S::Vector>| line.iter().map(VectorLike::padded).collect();
        lines.unwrap_or_default().into_iter().map(padded).collect()
    }
}

impl Polygon {
    /// Returns the corners of the core.
    pub(super) fn as_boundary(&self) -> Boundary<Vector2<f64>> {
        Boundary {
            corners: self.points().to_vec(),
            faces: Vec::new(),
        }
    }

    /// Builds a polygon or segment from its corners.
    ///
    /// # Errors
    /// Returns why the corners are invalid.
    pub(super) fn of_boundary(boundary: Boundary<Vector2<f64>>) -> Result<Self, String> {
        if let [from, to] = boundary.corners[..] {
            let apart = (to - from).norm();
            return if apart.is_finite() && apart > 0.0 {
                Ok(Self::segment(from, to))
            } else {
                Err("the ends of a capsule are not two distinct points".to_owned())
            };
        }
        Self::new(boundary.corners).map_err(|e| e.to_string())
    }
}

/// Tolerance for corners outside the plane of a face, relative to the size: the corners of a face
/// are coplanar to rounding.
const OUT: f64 = 1e-6;

impl Polyhedron {
    /// Returns corners and faces of the core.
    pub(super) fn as_boundary(&self) -> Boundary<Vector3<f64>> {
        Boundary {
            corners: self.points().to_vec(),
            faces: self.topology().faces.clone(),
        }
    }

    /// Builds a polyhedron or segment from its corners and faces.
    ///
    /// # Errors
    /// Returns why corners and faces are invalid.
    pub(super) fn of_boundary(boundary: Boundary<Vector3<f64>>) -> Result<Self, String> {
        let Boundary { corners, faces } = boundary;
        if corners.iter().flatten().any(|x| !x.is_finite()) {
            return Err("a corner of a polyhedron is not finite".to_owned());
        }
        if let ([from, to], true) = (&corners[..], faces.is_empty()) {
            return if from == to {
                Err("the ends of a capsule are not two distinct points".to_owned())
            } else {
                Ok(Self::segment(*from, *to))
            };
        }
        if faces.iter().flatten().any(|c| *c as usize >= corners.len()) {
            return Err("a face of a polyhedron refers to corners that do not exist".to_owned());
        }
        let core = Self::from_faces(corners, faces).map_err(|e| e.to_string())?;
        let most = OUT * core.farthest();
        for (face, normal) in core.topology().faces.iter().zip(core.normals()) {
            let from = core.points()[face[0] as usize];
            let within = |p: &Vector3<f64>| (p - from).dot(normal) <= most;
            if !core.points().iter().all(within) {
                return Err("the faces of a polyhedron are not those of a convex one".to_owned());
            }
        }
        Ok(core)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::convex::Core;

    #[test]
    fn a_core_comes_back_from_its_boundary() {
        let hexagon = Polygon::regular(6, 0.3);
        assert_eq!(Polygon::bounded_by(hexagon.boundary()).unwrap(), hexagon);
        let needle = Polygon::segment(Vector2::new(-1.0, 0.0), Vector2::new(1.0, 0.5));
        assert_eq!(Polygon::bounded_by(needle.boundary()).unwrap(), needle);
        let block = Polyhedron::cuboid([1.0, 2.0, 3.0]);
        let back = Polyhedron::bounded_by(block.boundary()).unwrap();
        assert_eq!(back.points(), block.points());
        assert_eq!(back.normals(), block.normals());
        assert_eq!(back.topology(), block.topology());
        let needle = Polyhedron::segment(Vector3::zeros(), Vector3::x());
        let back = Polyhedron::bounded_by(needle.boundary()).unwrap();
        assert_eq!(back.points(), needle.points());
    }

    #[test]
    fn what_is_no_core_is_refused() {
        let twice = vec![Vector2::new(1.0, 1.0); 2];
        let plane = |corners| {
            Polygon::bounded_by(Boundary {
                corners,
                faces: Vec::new(),
            })
        };
        assert!(plane(twice).is_err() && plane(Vec::new()).is_err());
        let block = Polyhedron::cuboid([1.0, 2.0, 3.0]).boundary();
        let mut dented = block.clone();
        dented.corners[0] *= -0.5;
        let mut open = block.clone();
        open.faces.pop();
        let mut beyond = block.clone();
        beyond.faces[0][0] = 8;
        let mut not_finite = block;
        not_finite.corners[3].x = f64::NAN;
        for wrong in [dented, open, beyond, not_finite] {
            assert!(Polyhedron::bounded_by(wrong).is_err());
        }
    }
}
