//! The compressible neo-Hookean material
//!
//! ```text
//! W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2,   S = mu (1 - C^-1) + lambda ln J C^-1
//! ```
//!
//! with I1 = tr C and J = det F. Source: J. Bonet and R. D. Wood, "Nonlinear Continuum Mechanics
//! for Finite Element Analysis", 2nd edition (2008), section 6.4.3.

use crate::material::Elasticity;
use nalgebra::Matrix3;

/// An element at a strain.
#[derive(Clone, Copy, Debug)]
pub struct NeoHookean {
    lambda: f64,
    shear: f64,
    c_less_one: Matrix3<f64>,
    /// Inverse of C.
    inverse: Matrix3<f64>,
    /// J^2 - 1.
    swelling: f64,
    /// ln J.
    log: f64,
}

impl NeoHookean {
    /// Evaluates the material at C - 1.
    pub fn new(material: &Elasticity, c_less_one: &Matrix3<f64>) -> Self {
        let c = Matrix3::identity() + c_less_one;
        let swelling = c_less_one.trace() + second(c_less_one) + c_less_one.determinant();
        Self {
            lambda: material.lambda(),
            shear: material.shear(),
            c_less_one: *c_less_one,
            inverse: c
                .try_inverse()
                .unwrap_or_else(|| Matrix3::from_element(f64::NAN)),
            swelling,
            log: 0.5 * swelling.ln_1p(),
        }
    }

    /// Returns W (Pa).
    pub fn energy(&self) -> f64 {
        // (I1 - 3)/2 - ln J = (J^2 - 1 - ln J^2)/2 less the part of J^2 - 1 that is not linear in
        // C: no difference of large numbers occurs.
        let g = &self.c_less_one;
        let shape = 0.5 * (less_log(self.swelling) - second(g) - g.determinant());
        self.shear * shape + 0.5 * self.lambda * self.log * self.log
    }

    /// Returns S (Pa).
    pub fn stress(&self) -> Matrix3<f64> {
        let s =
            self.inverse * self.c_less_one * self.shear + self.inverse * (self.lambda * self.log);
        (s + s.transpose()) * 0.5
    }

    /// Returns the change of S (Pa) by a change of C.
    pub fn change(&self, dc: &Matrix3<f64>) -> Matrix3<f64> {
        let inner = self.inverse * dc;
        let trace = inner.trace();
        inner * self.inverse * (self.shear - self.lambda * self.log)
            + self.inverse * (0.5 * self.lambda * trace)
    }
}

/// The second invariant of a symmetric tensor.
fn second(a: &Matrix3<f64>) -> f64 {
    let minor = |i: usize, j: usize| a[(i, i)] * a[(j, j)] - a[(i, j)] * a[(j, i)];
    minor(0, 1) + minor(0, 2) + minor(1, 2)
}

/// Returns x - ln(1 + x), also where the two are nearly equal.
fn less_log(x: f64) -> f64 {
    if x.abs() > 0.02 {
        return x - x.ln_1p();
    }
    // The series is x^2/2 - x^3/3 + ...
    (2..12)
        .rev()
        .fold(0.0, |sum, k| 1.0 / f64::from(k) - x * sum)
        * x
        * x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_meets_the_logarithm() {
        for x in [0.0199, -0.0199] {
            assert!((less_log(x) / (x - x.ln_1p()) - 1.0).abs() < 1e-12);
        }
        assert!((less_log(1e-9) / 5e-19 - 1.0).abs() < 1e-8);
    }
}
