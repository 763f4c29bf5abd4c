//! The linear simplex: a triangle in two dimensions, a tetrahedron in three, of constant strain.

use crate::material::{Elasticity, Symmetric};
use fretwork_core::geometry::space::{MatrixLike, Space, VectorLike};
use nalgebra::Matrix3;

/// Largest number of corners of a simplex.
pub const CORNERS: usize = 4;

/// A simplex of D + 1 corners: its volume and the gradients of its shape functions.
#[derive(Clone, Copy, Debug)]
pub struct Simplex<S: Space> {
    /// Volume (m^3; area in 2D, m^2), positive where the corners are in order.
    pub volume: f64,
    /// Gradients of the shape functions (1/m); only the first D + 1 are used.
    pub gradients: [S::Vector; CORNERS],
}

impl<S: Space> Simplex<S> {
    /// Creates the element from its corners (m); `None` if its volume is zero.
    pub fn new(corners: &[S::Vector]) -> Option<Self> {
        let d = S::D;
        let mut edges = Matrix3::identity();
        for j in 0..d {
            let edge = corners[j + 1] - corners[0];
            for i in 0..d {
                edges[(i, j)] = edge[i];
            }
        }
        let volume = edges.determinant() / if d == 2 { 2.0 } else { 6.0 };
        let inverse = edges.try_inverse()?;
        let mut gradients = [S::Vector::zero(); CORNERS];
        for j in 0..d {
            for i in 0..d {
                gradients[j + 1][i] = inverse[(j, i)];
                gradients[0][i] -= inverse[(j, i)];
            }
        }
        Some(Self { volume, gradients })
    }

    /// The corners' gradients.
    pub fn gradients(&self) -> &[S::Vector] {
        &self.gradients[..=S::D]
    }

    /// Returns the block of the stiffness (N/m) between two corners, V (lambda g_a g_b^T + G (g_a .
    /// g_b) 1 + G g_b g_a^T).
    pub fn stiffness(&self, material: &Elasticity, a: usize, b: usize) -> S::Matrix {
        let (lambda, shear) = (material.lambda(), material.shear());
        let (ga, gb) = (&self.gradients[a], &self.gradients[b]);
        let mut one = S::Vector::zero();
        for k in 0..S::D {
            one[k] = self.volume * shear * ga.dot(gb);
        }
        S::Matrix::diagonal(&one)
            + S::Matrix::dyad(&(*ga * (self.volume * lambda)), gb)
            + S::Matrix::dyad(&(*gb * (self.volume * shear)), ga)
    }

    /// Returns the strain for displacements of the corners (m).
    pub fn strain(&self, displacements: &[S::Vector]) -> Symmetric {
        let mut gradient = Matrix3::<f64>::zeros();
        for (g, u) in self.gradients().iter().zip(displacements) {
            for i in 0..S::D {
                for j in 0..S::D {
                    gradient[(i, j)] += u[i] * g[j];
                }
            }
        }
        let at = |i: usize, j: usize| 0.5 * (gradient[(i, j)] + gradient[(j, i)]);
        [at(0, 0), at(1, 1), at(2, 2), at(1, 2), at(0, 2), at(0, 1)]
    }

    /// Returns the stress (Pa) for displacements of the corners (m); in plane strain including the
    /// stress along the depth.
    pub fn stress(&self, material: &Elasticity, displacements: &[S::Vector]) -> Symmetric {
        material.stress(&self.strain(displacements))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::bodies::von_mises;
    use fretwork_core::geometry::space::{Dim2, Dim3};
    use nalgebra::{Vector2, Vector3};

    const STEEL: Elasticity = Elasticity {
        young: 210e9,
        poisson: 0.3,
        density: 7800.0,
    };

    fn tetrahedron() -> [Vector3<f64>; 4] {
        [
            Vector3::new(0.1, 0.0, 0.2),
            Vector3::new(1.0, 0.1, 0.0),
            Vector3::new(0.2, 1.1, 0.1),
            Vector3::new(0.0, 0.3, 0.9),
        ]
    }

    #[test]
    fn volumes_are_those_of_geometry() {
        let unit = [[0.0, 0.0], [2.0, 0.0], [0.0, 3.0]].map(Vector2::from);
        assert_eq!(Simplex::<Dim2>::new(&unit).unwrap().volume, 3.0);
        let flat = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]].map(Vector2::from);
        assert!(Simplex::<Dim2>::new(&flat).is_none());
        let [a, b, c, d] = tetrahedron();
        let volume = (b - a).cross(&(c - a)).dot(&(d - a)) / 6.0;
        let simplex = Simplex::<Dim3>::new(&[a, b, c, d]).unwrap();
        assert!((simplex.volume / volume - 1.0).abs() < 1e-14);
    }

    /// Neither a translation nor a small rotation stresses an element, and a uniform strain has
    /// Hooke's stress.
    #[test]
    fn stresses_are_hookes() {
        let corners = tetrahedron();
        let simplex = Simplex::<Dim3>::new(&corners).unwrap();
        let spin = Vector3::new(0.3, -0.2, 0.5);
        let rigid = corners.map(|x| Vector3::new(1.0, 2.0, 3.0) + spin.cross(&x));
        for s in simplex.stress(&STEEL, &rigid) {
            assert!(s.abs() < 1e-3, "{s}");
        }
        let pulled = corners.map(|x| Vector3::new(1e-3 * x.x, -0.3e-3 * x.y, -0.3e-3 * x.z));
        let stress = simplex.stress(&STEEL, &pulled);
        assert!((stress[0] / 210e6 - 1.0).abs() < 1e-12);
        assert!(stress[1..].iter().all(|s| s.abs() < 1e-4), "{stress:?}");
        assert!((von_mises(&stress) / 210e6 - 1.0).abs() < 1e-12);
        // Blocks of the stiffness give the same forces: u . K u = V sigma : epsilon.
        let mut energy = 0.0;
        for a in 0..4 {
            for b in 0..4 {
                energy += pulled[a].dot(&(simplex.stiffness(&STEEL, a, b) * pulled[b]));
            }
        }
        assert!((energy / (simplex.volume * 210e6 * 1e-3) - 1.0).abs() < 1e-12);
    }
}
