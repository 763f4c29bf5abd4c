//! The inside of a cylinder (a drum): a circle in 2D, in 3D an infinite cylinder along an axis of
//! its body.

use super::shape::{ClosestPoint, Surface, about};
use super::space::{Space, VectorLike};
use std::f64::consts::TAU;

/// A cylinder about the origin, open inside and solid outside.
#[derive(Clone, Debug)]
pub struct Drum {
    radius: f64,
    axis: usize,
}

impl Drum {
    /// Creates a drum of this radius (m); `axis` is 0, 1 or 2 in 3D and ignored in 2D.
    pub fn new(radius: f64, axis: usize) -> Self {
        Self { radius, axis }
    }

    /// Returns the part of a vector perpendicular to the axis.
    fn across<S: Space>(&self, v: &S::Vector) -> S::Vector {
        let mut across = *v;
        if S::D == 3 {
            across[self.axis] = 0.0;
        }
        across
    }

    /// Returns the two axes perpendicular to the cylinder's.
    fn plane<S: Space>(&self) -> [usize; 2] {
        if S::D == 2 {
            [0, 1]
        } else {
            [(self.axis + 1) % 3, (self.axis + 2) % 3]
        }
    }
}

impl<S: Space> Surface<S> for Drum {
    fn closest_points(
        &self,
        centre: &S::Vector,
        reach: f64,
        out: &mut Vec<ClosestPoint<S::Vector>>,
    ) {
        let across = self.across::<S>(centre);
        let r = across.norm();
        let distance = self.radius - r;
        if distance >= reach {
            return;
        }
        let normal = if r > 0.0 {
            across * (-1.0 / r)
        } else {
            // On the axis all directions are equally near; one of them is used.
            let mut n = S::Vector::zero();
            n[self.plane::<S>()[0]] = -1.0;
            n
        };
        out.push(ClosestPoint {
            closest_point: *centre - normal * distance,
            normal,
            distance,
            feature: 0,
        });
    }

    fn near(&self, centre: &S::Vector, reach: f64) -> bool {
        self.radius - self.across::<S>(centre).norm() < reach
    }

    fn outline(&self) -> Vec<Vec<S::Vector>> {
        let [i, j] = self.plane::<S>();
        if S::D == 2 {
            let point = |k: usize| {
                let (sin, cos) = (TAU * (k % 180) as f64 / 180.0).sin_cos();
                let mut p = S::Vector::zero();
                (p[i], p[j]) = (self.radius * cos, self.radius * sin);
                p
            };
            // Solid on the right, as with profiles: anticlockwise, closed.
            return vec![(0..=180).map(point).collect()];
        }
        let mut faces = Surface::<S>::faces_within(self, 0.5 * self.radius);
        // Files use the opposite orientation.
        faces.iter_mut().for_each(|f| f.swap(1, 3));
        faces
    }

    fn faces_within(&self, reach: f64) -> Vec<Vec<S::Vector>> {
        if S::D == 2 {
            return Surface::<S>::outline(self);
        }
        let [i, j] = self.plane::<S>();
        let point = |k: usize, along: f64| {
            let (sin, cos) = (TAU * (k % 180) as f64 / 180.0).sin_cos();
            let mut p = S::Vector::zero();
            (p[i], p[j], p[self.axis]) = (self.radius * cos, self.radius * sin, along);
            p
        };
        let face = |k: usize| {
            vec![
                point(k, -reach),
                point(k, reach),
                point(k + 1, reach),
                point(k + 1, -reach),
            ]
        };
        (0..180).map(face).collect()
    }

    fn any_depth(&self) -> bool {
        true
    }

    fn is_hollow(&self) -> bool {
        true
    }

    fn distance_gained(&self, from: &S::Vector, to: &S::Vector) -> f64 {
        self.across::<S>(from).norm() - self.across::<S>(to).norm()
    }

    fn is_unchanged_by(&self, spin: &S::Spin) -> bool {
        let mut axis = S::Vector::zero();
        if S::D == 3 {
            axis[self.axis] = 1.0;
        }
        S::D == 2 || about::<S>(&axis, spin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    fn touch<S: Space>(drum: &Drum, at: S::Vector, reach: f64) -> Vec<ClosestPoint<S::Vector>> {
        let mut out = Vec::new();
        Surface::<S>::closest_points(drum, &at, reach, &mut out);
        out
    }

    #[test]
    fn distances_are_those_of_a_circle() {
        let drum = Drum::new(2.0, 0);
        let found = touch::<Dim2>(&drum, Vector2::new(0.9, -1.2), 0.6)[0];
        assert!((found.distance - 0.5).abs() < 1e-15);
        assert!((found.normal - Vector2::new(-0.6, 0.8)).norm() < 1e-15);
        assert!((found.closest_point - Vector2::new(1.2, -1.6)).norm() < 1e-15);
        assert!(touch::<Dim2>(&drum, Vector2::new(0.9, -1.2), 0.5).is_empty());
        // Behind the wall the distance is negative.
        let behind = touch::<Dim2>(&drum, Vector2::new(0.0, 2.25), 0.1)[0];
        assert!((behind.distance + 0.25).abs() < 1e-15);
        // On the axis a large search distance still gives a unit normal.
        assert_eq!(touch::<Dim2>(&drum, Vector2::zeros(), 3.0)[0].distance, 2.0);
    }

    #[test]
    fn faces_look_inwards_and_reach_as_far_as_asked() {
        for axis in 0..3 {
            let drum = Drum::new(2.0, axis);
            for face in Surface::<Dim3>::faces_within(&drum, 5.0) {
                let middle = face.iter().sum::<Vector3<f64>>() / 4.0;
                let normal = (face[1] - face[0]).cross(&(face[2] - face[1]));
                assert!(normal.dot(&middle) < 0.0 && normal[axis].abs() < 1e-12);
                assert!(face.iter().all(|p| (p[axis].abs() - 5.0).abs() < 1e-12));
            }
        }
    }

    #[test]
    fn a_cylinder_does_not_see_its_axis() {
        for axis in 0..3 {
            let drum = Drum::new(2.0, axis);
            let mut at = Vector3::zeros();
            (at[(axis + 1) % 3], at[(axis + 2) % 3], at[axis]) = (0.9, -1.2, 7.0);
            let found = touch::<Dim3>(&drum, at, 0.6)[0];
            assert!((found.distance - 0.5).abs() < 1e-15);
            assert_eq!(found.normal[axis], 0.0);
            assert_eq!(found.closest_point[axis], 7.0);
            let mut spin = Vector3::zeros();
            spin[axis] = 3.0;
            assert!(Surface::<Dim3>::is_unchanged_by(&drum, &spin));
            spin[(axis + 1) % 3] = 1e-3;
            assert!(!Surface::<Dim3>::is_unchanged_by(&drum, &spin));
        }
    }
}
