//! Steady rolling of a line contact with a longitudinal creepage.

use super::LinePatch;

/// Increase of the tangential force of a line contact of equal bodies with the creepage (F. W.
/// Carter 1926), up to mu P where the whole patch slips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripCreep {
    /// Creepage over mu above which the whole patch slips.
    pub saturation: f64,
}

impl StripCreep {
    /// Creates a contact with the relative curvature 1/R1 + 1/R2 (1/m); saturation is at mu a/R
    /// (Johnson, 8.25).
    pub fn new(patch: &LinePatch, curvature: f64) -> Self {
        Self {
            saturation: patch.half_width * curvature,
        }
    }

    /// Returns Q/(mu P) at a creepage over mu, from -1 to 1: 1 - (1 - creepage/saturation)^2.
    pub fn share(&self, creepage: f64) -> f64 {
        let left = (1.0 - (creepage / self.saturation).abs()).max(0.0);
        (1.0 - left * left) * creepage.signum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::hertz::line;
    use super::super::{Solid, effective_modulus};
    use super::*;
    use std::f64::consts::PI;

    const STEEL: Solid = Solid {
        young: 210e9,
        poisson: 0.3,
    };

    /// Carter's slope dQ/dxi per width is pi a G/(2 (1 - nu)), from P = pi a² E*/(4 R) and E* =
    /// G/(1 - nu).
    #[test]
    fn strips_have_carters_slope() {
        let (load, curvature) = (1e6, 2.0);
        let modulus = effective_modulus(&[STEEL, STEEL]);
        let patch = line(load, curvature, modulus);
        let creep = StripCreep::new(&patch, curvature);
        let small = 1e-6 * creep.saturation;
        let slope = load * creep.share(small) / small;
        let expected = PI * patch.half_width * STEEL.shear() / (1.0 - STEEL.poisson) / 2.0;
        assert!((slope / expected - 1.0).abs() < 1e-5, "{slope} {expected}");
        assert_eq!(creep.share(-2.0 * creep.saturation), -1.0);
    }
}
