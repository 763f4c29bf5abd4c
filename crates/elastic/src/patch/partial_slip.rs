//! Partial slip under a tangential force (C. Cattaneo 1938, R. D. Mindlin 1949): onset of gross
//! slip, and the stick area before it.

use super::PointPatch;
use super::Solid;
use super::ellipse::integrals;
use std::f64::consts::PI;

/// A point contact under a tangential force along `along`, up to gross slip.
///
/// Q is below mu P as long as distant points of the bodies are displaced by less than
/// `displacement` relative to each other. Different materials, tractions perpendicular to the
/// force, and their coupling with the pressure are neglected, as in Mindlin's theory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartialSlip {
    /// Displacement of distant points at the onset of gross slip (m).
    pub displacement: f64,
    /// Force at the onset of gross slip (N), mu P.
    pub force: f64,
}

impl PartialSlip {
    /// Computes the partial slip of a patch under `load` (N) with the friction coefficient `mu`.
    ///
    /// A circle: delta* = 3 mu P/(16 a) ((2 - nu1)/G1 + (2 - nu2)/G2), Johnson 7.43. An ellipse:
    /// the displacement of a traction mu p by the integrals of Mindlin (1949), along its long or
    /// short axis.
    pub fn of(patch: &PointPatch, load: f64, mu: f64, bodies: &[Solid; 2]) -> Self {
        let long = patch.along.max(patch.across);
        let (first, d) = integrals(patch.along.min(patch.across) / long);
        // This is the component of the force direction along the long axis.
        let lengthwise = if patch.along >= patch.across {
            d
        } else {
            first - d
        };
        let compliance: f64 = bodies
            .iter()
            .map(|s| ((1.0 - s.poisson) * first + s.poisson * lengthwise) / (2.0 * PI * s.shear()))
            .sum::<f64>()
            / long;
        Self {
            displacement: 1.5 * mu * load * compliance,
            force: mu * load,
        }
    }

    /// Returns the ratio of the axes of the stick area to those of the patch under a force `q` (N);
    /// 0 in gross slip.
    pub fn stuck(&self, q: f64) -> f64 {
        (1.0 - (q / self.force).abs()).max(0.0).cbrt()
    }

    /// Returns the displacement of distant points (m) under a force `q` (N) that rises from zero;
    /// infinite in gross slip.
    pub fn displacement_under(&self, q: f64) -> f64 {
        let share = (q / self.force).abs();
        if share >= 1.0 {
            return f64::INFINITY;
        }
        self.displacement * (1.0 - (1.0 - share).powf(2.0 / 3.0))
    }

    /// Returns the force (N) under a displacement of distant points (m) that rises from zero.
    pub fn force_at(&self, displacement: f64) -> f64 {
        let left = (1.0 - displacement.abs() / self.displacement).max(0.0);
        self.force * (1.0 - left.powf(1.5))
    }
}

/// Returns the half-width of the stick strip over that of a line patch, for the share Q/(mu P)
/// (Johnson, 7.27); 0 in gross slip.
///
/// The displacement at the onset of gross slip depends on the form of the bodies at a distance.
pub fn stuck_strip(share: f64) -> f64 {
    (1.0 - share.abs()).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::effective_modulus;
    use super::super::hertz::point;
    use super::*;

    const STEEL: Solid = Solid {
        young: 210e9,
        poisson: 0.3,
    };
    const RUBBER: Solid = Solid {
        young: 5e6,
        poisson: 0.49,
    };

    fn near(got: f64, expected: f64, relative: f64) {
        assert!((got / expected - 1.0).abs() < relative, "{got} {expected}");
    }

    #[test]
    fn a_circle_begins_to_slip_at_the_displacement_of_mindlin() {
        let bodies = [STEEL, RUBBER];
        let (load, mu) = (200.0, 0.6);
        let patch = point(load, [20.0; 2], effective_modulus(&bodies));
        let got = PartialSlip::of(&patch, load, mu, &bodies);
        let shear: f64 = bodies.iter().map(|s| (2.0 - s.poisson) / s.shear()).sum();
        near(
            got.displacement,
            3.0 * mu * load / (16.0 * patch.along) * shear,
            1e-13,
        );
    }

    /// Returns the displacement under a traction mu p, from Cerruti's solution (Johnson, 3.7.1)
    /// integrated over the ellipse in polar coordinates about its middle.
    #[test]
    fn an_ellipse_begins_to_slip_at_the_displacement_of_its_traction() {
        let bodies = [STEEL, STEEL];
        for curvatures in [[1.0, 6.0], [6.0, 1.0], [1.0, 1.3]] {
            let (load, mu) = (1e4, 0.4);
            let patch = point(load, curvatures, effective_modulus(&bodies));
            let n = 2000;
            let mut sum = 0.0;
            for j in 0..n {
                let t = f64::from(j) * 2.0 * PI / f64::from(n);
                let chord = 1.0
                    / ((t.cos() / patch.along).powi(2) + (t.sin() / patch.across).powi(2)).sqrt();
                // The integral of sqrt(1 - s²/S²) over the chord is pi S/4.
                let kernel = (1.0 - STEEL.poisson) + STEEL.poisson * t.cos().powi(2);
                sum += kernel * PI / 4.0 * chord * 2.0 * PI / f64::from(n);
            }
            let one = mu * patch.pressure * sum / (2.0 * PI * STEEL.shear());
            let got = PartialSlip::of(&patch, load, mu, &bodies).displacement;
            near(got, 2.0 * one, 1e-10);
        }
    }

    #[test]
    fn force_and_displacement_are_inverse() {
        let slip = PartialSlip {
            displacement: 3e-6,
            force: 70.0,
        };
        for share in [0.1, 0.5, 0.99] {
            let q = share * slip.force;
            near(slip.force_at(slip.displacement_under(q)), q, 1e-12);
            near(slip.stuck(q).powi(3), 1.0 - share, 1e-12);
        }
        assert_eq!(slip.force_at(4e-6), slip.force);
        assert_eq!(
            (slip.stuck(80.0), stuck_strip(1.0), stuck_strip(0.75)),
            (0.0, 0.0, 0.5)
        );
    }
}
