//! Steady rolling with a longitudinal creepage: friction as a function of creepage for line and
//! point contacts.

use super::kalker::Kalker;
use super::{LinePatch, PointPatch, Solid, like_bodies};

/// Increase of the tangential force with the creepage, up to mu P where the whole patch slips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Creep {
    /// Creepage above which the whole patch slips.
    pub saturation: f64,
    /// Exponent in 1 - Q/(mu P) = (1 - creepage/saturation)^power: 2 for a line (F. W. Carter
    /// 1926), 3 for an ellipse (P. J. Vermeulen, K. L. Johnson 1964).
    pub power: i32,
}

impl Creep {
    /// Returns Carter's line contact of equal bodies with the relative curvature 1/R1 + 1/R2 (1/m);
    /// saturation is at mu a/R (Johnson, 8.25).
    pub fn of_line(patch: &LinePatch, curvature: f64, mu: f64) -> Self {
        Self {
            saturation: mu * patch.half_width * curvature,
            power: 2,
        }
    }

    /// Returns an elliptic contact under `load` (N) that rolls along `along`: the cubic of
    /// Vermeulen and Johnson with Kalker's coefficient, 3 mu P/(G a b C11) at saturation (Z. Y.
    /// Shen, J. K. Hedrick, J. A. Elkins 1983). `None` outside Kalker's table.
    pub fn of_point(patch: &PointPatch, load: f64, mu: f64, bodies: &[Solid; 2]) -> Option<Self> {
        let like = like_bodies(bodies);
        let c11 = Kalker::new(patch.along / patch.across, like.poisson)?.c11;
        let stiffness = like.shear() * patch.along * patch.across * c11;
        Some(Self {
            saturation: 3.0 * mu * load / stiffness,
            power: 3,
        })
    }

    /// Returns Q/(mu P) at a creepage, from -1 to 1.
    pub fn share(&self, creepage: f64) -> f64 {
        let left = (1.0 - (creepage / self.saturation).abs()).max(0.0);
        (1.0 - left.powi(self.power)) * creepage.signum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::effective_modulus;
    use super::super::hertz::{line, point};
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
        let creep = Creep::of_line(&patch, curvature, 0.3);
        let small = 1e-6 * creep.saturation;
        let slope = 0.3 * load * creep.share(small) / small;
        let expected = PI * patch.half_width * STEEL.shear() / (1.0 - STEEL.poisson) / 2.0;
        assert!((slope / expected - 1.0).abs() < 1e-5, "{slope} {expected}");
    }

    /// For a circle with nu = 1/4 the table gives 4.12: full slip begins at 3 mu P/(4.12 G a²).
    #[test]
    fn saturation_by_hand() {
        let soft = Solid {
            young: 205e9,
            poisson: 0.25,
        };
        let bodies = [soft, soft];
        let patch = point(75e3, [2.0, 2.0], effective_modulus(&bodies));
        let creep = Creep::of_point(&patch, 75e3, 0.4, &bodies).unwrap();
        let expected = 3.0 * 0.4 * 75e3 / (82e9 * patch.along.powi(2) * 4.12);
        assert!((creep.saturation / expected - 1.0).abs() < 1e-12);
        assert_eq!(creep.share(creep.saturation), 1.0);
        assert!((creep.share(0.5 * creep.saturation) - 0.875).abs() < 1e-12);
        assert_eq!(creep.share(-2.0 * creep.saturation), -1.0);
    }
}
