//! Linear elasticity in a frame that rotates with the element: F = R U, with the rotation R and the
//! stretch U, and
//!
//! ```text
//! W = mu |U - 1|^2 + lambda/2 (tr(U - 1))^2
//! ```
//!
//! On simplices of constant strain its forces are those of the stiffness in the rotated frame, R K
//! (R^T x - X); its tangent, derived from W, contains the terms that R K R^T omits. U follows from
//! the eigenvalues of C = U^2, so that no rotation is computed.
//!
//! Sources: C. A. Felippa and B. Haugen, "A unified formulation of small-strain corotational finite
//! elements: I. Theory", Comput. Methods Appl. Mech. Eng. 194 (2005); I. Chao, U. Pinkall, P. Sanan
//! and P. Schröder, "A simple geometric model for elastic deformations", ACM Trans. Graph. 29
//! (2010).

use crate::material::Elasticity;
use nalgebra::{Matrix3, Vector3};

/// An element at a strain.
#[derive(Clone, Copy, Debug)]
pub struct Corotational {
    lambda: f64,
    shear: f64,
    /// Principal directions.
    directions: Matrix3<f64>,
    /// Principal stretches, and the same less 1.
    stretch: Vector3<f64>,
    strain: Vector3<f64>,
}

impl Corotational {
    /// Evaluates the material at C - 1.
    pub fn new(material: &Elasticity, c_less_one: &Matrix3<f64>) -> Self {
        let principal = c_less_one.symmetric_eigen();
        // A C that is not positive, in an iterate far from the solution, is not evaluated further.
        let stretch = principal.eigenvalues.map(|g| (1.0 + g).max(0.0).sqrt());
        let strain = principal
            .eigenvalues
            .zip_map(&stretch, |g, u| g / (1.0 + u));
        Self {
            lambda: material.lambda(),
            shear: material.shear(),
            directions: principal.eigenvectors,
            stretch,
            strain,
        }
    }

    /// Returns W (Pa).
    pub fn energy(&self) -> f64 {
        let trace = self.strain.sum();
        self.shear * self.strain.norm_squared() + 0.5 * self.lambda * trace * trace
    }

    /// Returns S (Pa).
    pub fn stress(&self) -> Matrix3<f64> {
        let pressure = self.lambda * self.strain.sum();
        let principal = self
            .strain
            .zip_map(&self.stretch, |e, u| (2.0 * self.shear * e + pressure) / u);
        self.turned(&Matrix3::from_diagonal(&principal))
    }

    /// Returns the change of S (Pa) by a change of C: U dU + dU U = dC.
    pub fn change(&self, dc: &Matrix3<f64>) -> Matrix3<f64> {
        let own = self.directions.transpose() * dc * self.directions;
        let u = &self.stretch;
        let mut du = own;
        let mut out = Matrix3::zeros();
        let scale = 2.0 * self.shear - self.lambda * self.strain.sum();
        for i in 0..3 {
            for j in 0..3 {
                du[(i, j)] /= u[i] + u[j];
                out[(i, j)] = scale * du[(i, j)] / (u[i] * u[j]);
            }
        }
        let trace = self.lambda * du.trace();
        for i in 0..3 {
            out[(i, i)] += trace / u[i];
        }
        self.turned(&out)
    }

    /// Rotates from the principal axes to those of the element.
    fn turned(&self, own: &Matrix3<f64>) -> Matrix3<f64> {
        self.directions * own * self.directions.transpose()
    }
}
