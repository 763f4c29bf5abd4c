//! Rotation of the facets of a contact surface from the velocities of their corners, and the forces
//! on the corners that represent a moment on a facet.
//!
//! With the gradients g_a of the shape functions of a facet along it and its normal n, the curl of
//! the velocity over the facet is c = sum_a g_a x v_a, and the facet rotates with
//!
//! ```text
//! w = c - n (n . c)/2        in the plane w = c
//! ```
//!
//! about axes along it as its normal does, and about its normal by half of the curl, the skew part
//! of the gradient. Forces f_a = (m - n (n . m)/2) x g_a are dual to this spin: their sum is zero,
//! their moment is m, and their power m . w.
//!
//! Source: L. E. Malvern, "Introduction to the Mechanics of a Continuous Medium" (1969), section
//! 4.5, of the vorticity.

use fretwork_core::geometry::space::{Space, VectorLike};

/// A corner of a facet with its contribution to the rotation of a position.
#[derive(Clone, Copy, Debug)]
struct Corner<S: Space> {
    /// Point of the mesh.
    point: u32,
    /// Gradient of the corner's shape function along the facet (1/m), times the share of the facet.
    gradient: S::Vector,
    /// Normal of the facet; zero in the plane.
    normal: S::Vector,
}

/// Rotation at a position of a surface: that of its facet, or, at a point, the mean over its facets
/// weighted by length or area.
#[derive(Clone, Debug)]
pub struct FacetSpin<S: Space> {
    corners: Vec<Corner<S>>,
    /// Length of the facets (m), which converts spins to velocities comparable to those of their
    /// corners.
    pub length: f64,
}

impl<S: Space> FacetSpin<S> {
    /// Creates the rotation from facets given by the points of the mesh at their D corners.
    /// `position` gives the current position of a point (m).
    pub fn new(facets: &[[u32; 3]], position: impl Fn(u32) -> S::Vector) -> Self {
        let mut corners = Vec::with_capacity(S::D * facets.len());
        let mut total = 0.0;
        for facet in facets {
            let at = facet.map(&position);
            let (gradients, normal, size) = gradients::<S>(&at);
            total += size;
            let of_facet = facet.iter().zip(gradients).take(S::D);
            corners.extend(of_facet.map(|(point, gradient)| Corner {
                point: *point,
                gradient: gradient * size,
                normal,
            }));
        }
        for corner in &mut corners {
            corner.gradient = corner.gradient * (1.0 / total);
        }
        let mean = total / facets.len() as f64;
        Self {
            corners,
            length: mean.powf(1.0 / (S::D - 1) as f64),
        }
    }

    /// The middle of the corners (m).
    pub fn middle(&self, position: impl Fn(u32) -> S::Vector) -> S::Vector {
        let places = self.corners.iter().map(|corner| position(corner.point));
        let sum = places.fold(S::Vector::zero(), |sum, x| sum + x);
        sum * (1.0 / self.corners.len() as f64)
    }

    /// Returns the angular velocity (rad/s) from the velocities of the points of the mesh (m/s).
    pub fn spin(&self, velocity: impl Fn(u32) -> S::Vector) -> S::Spin {
        self.corners.iter().fold(S::Spin::zero(), |sum, corner| {
            let curl = S::moment(&corner.gradient, &velocity(corner.point));
            sum + halved::<S>(&corner.normal, &curl)
        })
    }

    /// The points of the mesh at the facets, some several times.
    pub fn points(&self) -> impl Iterator<Item = u32> {
        self.corners.iter().map(|corner| corner.point)
    }

    /// Returns the angular velocity times the length, by axis (m/s): the velocity of the node that
    /// represents rotation.
    pub fn velocity(&self, velocity: impl Fn(u32) -> S::Vector) -> S::Vector {
        let spin = self.spin(velocity);
        let mut out = S::Vector::zero();
        for k in 0..S::Spin::N {
            out[k] = spin[k] * self.length;
        }
        out
    }

    /// Returns the forces on points of the mesh (N) that represent a moment (N m); a point of
    /// several facets occurs several times.
    pub fn forces(&self, moment: S::Spin) -> impl Iterator<Item = (u32, S::Vector)> {
        self.corners.iter().map(move |corner| {
            let moment = halved::<S>(&corner.normal, &moment);
            (corner.point, S::spin_velocity(&moment, &corner.gradient))
        })
    }
}

/// Returns a spin with half of its part about a normal; in the plane the spin itself.
fn halved<S: Space>(normal: &S::Vector, spin: &S::Spin) -> S::Spin {
    let (twist, _) = S::split_spin(normal, spin);
    *spin - S::spin_about(normal, 0.5 * twist)
}

/// Returns the gradients of the shape functions of a facet along it (1/m), its normal (zero in the
/// plane), and its length (m) or area (m^2).
fn gradients<S: Space>(at: &[S::Vector; 3]) -> ([S::Vector; 3], S::Vector, f64) {
    let [a, b, c] = *at;
    let (u, v) = (b - a, c - a);
    let uu = u.dot(&u);
    if S::D == 2 {
        let along = u * (1.0 / uu);
        return (
            [-along, along, S::Vector::zero()],
            S::Vector::zero(),
            uu.sqrt(),
        );
    }
    let (uv, vv) = (u.dot(&v), v.dot(&v));
    let determinant = uu * vv - uv * uv;
    let second = (u * vv - v * uv) * (1.0 / determinant);
    let third = (v * uu - u * uv) * (1.0 / determinant);
    let cross = S::moment(&u, &v);
    let twice = determinant.sqrt();
    let mut normal = S::Vector::zero();
    for k in 0..S::Spin::N.min(S::D) {
        normal[k] = cross[k] / twice;
    }
    ([-(second + third), second, third], normal, 0.5 * twice)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector1, Vector2, Vector3};

    /// A rigid rotation is found from any facets, and no translation or stretch counts as rotation.
    #[test]
    fn a_rotation_is_found() {
        let at = [
            Vector3::new(0.1, 0.2, -0.3),
            Vector3::new(1.3, -0.1, 0.2),
            Vector3::new(0.4, 0.9, 0.5),
            Vector3::new(1.1, 1.2, -0.4),
        ];
        let facets = [[0, 1, 2], [2, 1, 3]];
        let spin = Vector3::new(0.7, -1.1, 0.4);
        let moves = |p: u32| Vector3::new(3.0, 1.0, -2.0) + spin.cross(&at[p as usize]);
        for part in [&facets[..1], &facets[..]] {
            let found = FacetSpin::<Dim3>::new(part, |p| at[p as usize]);
            assert!((found.spin(moves) - spin).norm() < 1e-14);
        }
        let flat = [
            Vector3::zeros(),
            Vector3::new(1.0, 0.0, 0.0),
            Vector3::new(0.3, 0.8, 0.0),
        ];
        let facet = FacetSpin::<Dim3>::new(&facets[..1], |p| flat[p as usize]);
        let stretch = |p: u32| {
            let x = flat[p as usize];
            Vector3::new(0.3 * x.x + 0.2 * x.y, 0.2 * x.x - 0.5 * x.y, 0.0)
        };
        assert!(facet.spin(stretch).norm() < 1e-15);
        // Simple shear along x rotates by half of its gradient, clockwise; a slope along x about
        // -y.
        let shear = |p: u32| Vector3::new(flat[p as usize].y, 0.0, 0.0);
        assert!((facet.spin(shear) - Vector3::new(0.0, 0.0, -0.5)).norm() < 1e-15);
        let slope = |p: u32| Vector3::new(0.0, 0.0, flat[p as usize].x);
        assert!((facet.spin(slope) - Vector3::new(0.0, -1.0, 0.0)).norm() < 1e-15);

        let line = [Vector2::new(0.2, 0.1), Vector2::new(1.0, 0.7)];
        let facet = FacetSpin::<Dim2>::new(&[[0, 1, 0]], |p| line[p as usize]);
        let moves = |p: u32| {
            Vector2::new(2.0, 1.0) + Vector2::new(-line[p as usize].y, line[p as usize].x) * 0.6
        };
        assert!((facet.spin(moves).x - 0.6).abs() < 1e-15);
        assert!((facet.length - 1.0).abs() < 1e-15);
    }

    /// A moment is represented by forces without a resultant, whose moment about any point is that
    /// moment, and whose power is that of the moment at any velocities.
    #[test]
    fn a_moment_is_a_couple_of_forces() {
        let at = [
            Vector3::new(0.1, 0.2, -0.3),
            Vector3::new(1.3, -0.1, 0.2),
            Vector3::new(0.4, 0.9, 0.5),
            Vector3::new(1.1, 1.2, -0.4),
        ];
        let moment = Vector3::new(-0.4, 2.0, 0.9);
        let facets = FacetSpin::<Dim3>::new(&[[0, 1, 2], [2, 1, 3]], |p| at[p as usize]);
        let velocity =
            |p: u32| Vector3::new(f64::from(p), 0.3 - f64::from(p * p), 0.7).cross(&at[p as usize]);
        let (mut force, mut about, mut power) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        for (p, f) in facets.forces(moment) {
            force += f;
            about += at[p as usize].cross(&f);
            power += f.dot(&velocity(p));
        }
        assert!(force.norm() < 1e-14 && (about - moment).norm() < 1e-14);
        assert!((power - moment.dot(&facets.spin(velocity))).abs() < 1e-14);

        let line = [Vector2::new(0.2, 0.1), Vector2::new(1.0, 0.7)];
        let facet = FacetSpin::<Dim2>::new(&[[0, 1, 0]], |p| line[p as usize]);
        let forces: Vec<_> = facet.forces(Vector1::new(3.0)).collect();
        assert!((forces[0].1 + forces[1].1).norm() < 1e-15);
        let about: f64 = forces.iter().map(|(p, f)| line[*p as usize].perp(f)).sum();
        assert!((about - 3.0).abs() < 1e-14);
    }
}
