//! Contact patches in closed form: Hertz' pressure and size, onset of gross slip, and friction as a
//! function of creepage.
//!
//! Two smooth elastic bodies touch over a patch that is small compared with their radii. Source of
//! all but Kalker's coefficients is K. L. Johnson, Contact Mechanics (1985): chapter 4 (Hertz), 7.2
//! (Cattaneo, Mindlin), 8.3 (Carter).

mod ellipse;
mod hertz;
mod kalker;
mod partial_slip;
mod rolling;

pub use hertz::{LinePatch, PointPatch, line, point};
pub use kalker::Kalker;
pub use partial_slip::{PartialSlip, stuck_strip};
pub use rolling::StripCreep;

/// An isotropic elastic body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Young's modulus (Pa).
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Solid {
    /// Returns the shear modulus (Pa).
    pub fn shear(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }
}

/// Returns E* (Pa) of two bodies: 1/E* = (1 - nu1²)/E1 + (1 - nu2²)/E2 (Johnson, 4.19).
pub fn effective_modulus(bodies: &[Solid; 2]) -> f64 {
    1.0 / bodies
        .iter()
        .map(|s| (1.0 - s.poisson * s.poisson) / s.young)
        .sum::<f64>()
}

/// Returns shear modulus (Pa) and Poisson's ratio of two equal bodies with the same compliance in
/// shear as these two: 2/G = 1/G1 + 1/G2, 2 nu/G = nu1/G1 + nu2/G2 (J. J. Kalker, Three-dimensional
/// elastic bodies in rolling contact, 1990, 1.1).
pub fn like_bodies(bodies: &[Solid; 2]) -> Solid {
    let compliance = bodies.iter().map(|s| 1.0 / s.shear()).sum::<f64>() / 2.0;
    let poisson = bodies.iter().map(|s| s.poisson / s.shear()).sum::<f64>() / (2.0 * compliance);
    Solid {
        young: 2.0 * (1.0 + poisson) / compliance,
        poisson,
    }
}

/// Dundurs' second constant of two bodies above which the theories of like bodies are no longer
/// close: pressure alone makes the surfaces slip.
pub const UNLIKE: f64 = 0.05;

/// Returns Dundurs' second constant of two bodies, beta = ((1 - 2 nu1)/G1 - (1 - 2 nu2)/G2)/(2 (1 -
/// nu1)/G1 + 2 (1 - nu2)/G2): displacements along the surfaces by pressures, over those along the
/// normal (Johnson, 5.3). It is 0 for like bodies.
pub fn dundurs([one, other]: &[Solid; 2]) -> f64 {
    let along = |s: &Solid| (1.0 - 2.0 * s.poisson) / s.shear();
    let normal = |s: &Solid| 2.0 * (1.0 - s.poisson) / s.shear();
    (along(one) - along(other)) / (normal(one) + normal(other))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The constant lies between -1/2 and 1/2; a rigid body under an incompressible one has 0, and
    /// under one of no Poisson's ratio 1/2 (J. Dundurs, Journal of Applied Mechanics 36, 1969).
    #[test]
    fn dundurs_constant_has_its_limits() {
        let body = |young, poisson| Solid { young, poisson };
        let rigid = body(1e30, 0.3);
        assert!(dundurs(&[body(1e6, 0.5), rigid]).abs() < 1e-12);
        assert!((dundurs(&[body(1e6, 0.0), rigid]) - 0.5).abs() < 1e-12);
        assert!((dundurs(&[rigid, body(1e6, 0.0)]) + 0.5).abs() < 1e-12);
        assert_eq!(dundurs(&[body(210e9, 0.3); 2]), 0.0);
    }

    #[test]
    fn two_equal_bodies_are_like_themselves() {
        let steel = Solid {
            young: 210e9,
            poisson: 0.3,
        };
        let like = like_bodies(&[steel, steel]);
        assert!((like.young / steel.young - 1.0).abs() < 1e-14);
        assert!((like.poisson - steel.poisson).abs() < 1e-15);
        assert!((effective_modulus(&[steel, steel]) / (105e9 / 0.91) - 1.0).abs() < 1e-14);
    }
}
