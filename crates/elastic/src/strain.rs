//! Measures of strain, and the resulting stress and energy of an element.
//!
//! For large strain both are functions of C = F^T F only, with F the gradient of the motion, so
//! that a rotation causes no stress. C - 1 is stored instead of C, so that small strains are not
//! lost in the rounding of 1.

use crate::corotational::Corotational;
use crate::material::Elasticity;
use crate::neo_hookean::NeoHookean;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// Measure of the strain of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Strain {
    /// The symmetric part of the gradient of the displacement: linear elasticity, for strains and
    /// rotations that are small.
    #[default]
    Small,
    /// Linear elasticity in a frame that rotates with each element: any rotation, small strain.
    Corotational,
    /// The compressible neo-Hookean material W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2: any
    /// rotation, large strain.
    NeoHookean,
}

impl Strain {
    /// Returns whether the measure permits rotations; forces are then not linear in displacements.
    pub fn is_finite(self) -> bool {
        self != Self::Small
    }
}

/// An element at a strain C - 1: its energy, stress and tangent.
///
/// An element that expands freely by lambda = 1 + e has the energy lambda^3 W(C/lambda^2), that of
/// F/lambda per volume before the expansion (M. E. Gurtin, E. Fried, L. Anand, "The Mechanics and
/// Thermodynamics of Continua" (2010), section 60).
#[derive(Clone, Copy, Debug)]
pub struct Response {
    kind: Kind,
    /// Stretch lambda.
    stretch: f64,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Large rotations and small strains, in the frame that rotates with each element.
    Corotational(Corotational),
    /// Large strains of a compressible neo-Hookean material.
    NeoHookean(NeoHookean),
}

impl Response {
    /// Evaluates the measure at C - 1 with a free strain e; `None` for small strain, which does not
    /// depend on C.
    pub fn new(
        strain: Strain,
        material: &Elasticity,
        c_less_one: &Matrix3<f64>,
        free_strain: f64,
    ) -> Option<Self> {
        // lambda^2 - 1, without the rounding of 1.
        let grown = free_strain * (2.0 + free_strain);
        let c = (c_less_one - Matrix3::identity() * grown) / (1.0 + grown);
        let kind = match strain {
            Strain::Small => return None,
            Strain::Corotational => Kind::Corotational(Corotational::new(material, &c)),
            Strain::NeoHookean => Kind::NeoHookean(NeoHookean::new(material, &c)),
        };
        Some(Self {
            kind,
            stretch: 1.0 + free_strain,
        })
    }

    /// Returns the energy per unloaded volume, W (Pa).
    pub fn energy(&self) -> f64 {
        let energy = match &self.kind {
            Kind::Corotational(at) => at.energy(),
            Kind::NeoHookean(at) => at.energy(),
        };
        self.stretch.powi(3) * energy
    }

    /// The second Piola-Kirchhoff stress, S = 2 dW/dC (Pa).
    pub fn stress(&self) -> Matrix3<f64> {
        let stress = match &self.kind {
            Kind::Corotational(at) => at.stress(),
            Kind::NeoHookean(at) => at.stress(),
        };
        stress * self.stretch
    }

    /// The change of S (Pa) by a change of C.
    pub fn change(&self, dc: &Matrix3<f64>) -> Matrix3<f64> {
        let change = match &self.kind {
            Kind::Corotational(at) => at.change(dc),
            Kind::NeoHookean(at) => at.change(dc),
        };
        change / self.stretch
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUBBER: Elasticity = Elasticity {
        young: 1e6,
        poisson: 0.4,
        density: 1000.0,
    };

    fn strained(scale: f64) -> Matrix3<f64> {
        let h = Matrix3::new(0.3, 0.2, -0.1, 0.0, -0.2, 0.15, 0.1, -0.05, 0.1) * scale;
        h + h.transpose() + h.transpose() * h
    }

    /// S = 2 dW/dC and its change, by central differences; small strains of any size have Hooke's
    /// stress and energy.
    #[test]
    fn stress_and_tangent_are_derivatives_of_the_energy() {
        for strain in [Strain::Corotational, Strain::NeoHookean] {
            let at = |c: &Matrix3<f64>| Response::new(strain, &RUBBER, c, 0.0).unwrap();
            let (c, step) = (strained(1.0), 1e-6);
            let here = at(&c);
            for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
                let mut dc = Matrix3::zeros();
                (dc[(i, j)], dc[(j, i)]) = (1.0, 1.0);
                let [low, high] = [-step, step].map(|s| at(&(c + dc * s)));
                let slope = (high.energy() - low.energy()) / (2.0 * step);
                let expected = 0.5 * here.stress().component_mul(&dc).sum();
                assert!(
                    (slope - expected).abs() < 1e-4 * RUBBER.young * 1e-3,
                    "{strain:?}"
                );
                let change = (high.stress() - low.stress()) / (2.0 * step);
                let off = (change - here.change(&dc)).norm();
                assert!(off < 1e-8 * change.norm(), "{strain:?}: {off:e}");
            }
            for scale in [1e-3, 1e-6, 1e-9, 1e-12] {
                let c = strained(scale);
                let e = c * 0.5;
                let (l, g) = (RUBBER.lambda(), RUBBER.shear());
                let hooke = Matrix3::identity() * (l * e.trace()) + e * (2.0 * g);
                let off = (at(&c).stress() - hooke).norm() / hooke.norm();
                assert!(
                    off < 3.0 * scale + 1e-13,
                    "{strain:?} at {scale:e}: {off:e}"
                );
                let energy = 0.5 * hooke.component_mul(&e).sum();
                let off = (at(&c).energy() / energy - 1.0).abs();
                assert!(
                    off < 3.0 * scale + 1e-12,
                    "{strain:?} at {scale:e}: {off:e}"
                );
            }
        }
    }

    /// The displacement of a body that would expand by lambda is zero: the values follow by hand
    /// from (1 + e)^3 W(F/(1 + e)) at F = 1.
    #[test]
    fn what_is_held_has_the_stress_of_its_free_strain() {
        let (l, g) = (RUBBER.lambda(), RUBBER.shear());
        for e in [0.1, -0.05, 1e-3] {
            let n: f64 = 1.0 + e;
            let at = |strain| Response::new(strain, &RUBBER, &Matrix3::zeros(), e).unwrap();
            // C/n^2 = 1/n^2: I1 = 3/n^2, J = n^-3.
            let log = -3.0 * n.ln();
            let energy = 1.5 * g * (n.powi(-2) - 1.0) - g * log + 0.5 * l * log * log;
            let stress = g * (1.0 - n * n) + l * log * n * n;
            let neo = at(Strain::NeoHookean);
            assert!((neo.energy() / (n.powi(3) * energy) - 1.0).abs() < 1e-9);
            assert!((neo.stress()[(0, 0)] / (n * stress) - 1.0).abs() < 1e-9);
            // U = 1/n, strain 1/n - 1 along each axis.
            let strain = 1.0 / n - 1.0;
            let bulk = 3.0 * l + 2.0 * g;
            let hooke = at(Strain::Corotational);
            let energy = 1.5 * bulk * strain * strain;
            assert!((hooke.energy() / (n.powi(3) * energy) - 1.0).abs() < 1e-9);
        }
    }
}
