//! Steady rolling with a longitudinal creepage: friction as a function of creepage for line and
//! point contacts.

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
        let c11 = kalker_c11(patch.along / patch.across, like.poisson)?;
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

/// Kalker's coefficients C11 for nu = 0, 1/4, 1/2 and the ratio 0.1, 0.2, .. 1 of the semi-axes,
/// that along the rolling over the other (J. J. Kalker, On the rolling contact of two elastic
/// bodies in the presence of dry friction, Delft 1967; the same table in his book of 1990).
const SHORT: [[f64; 3]; 10] = [
    [2.51, 3.31, 4.85],
    [2.59, 3.37, 4.81],
    [2.68, 3.44, 4.80],
    [2.78, 3.53, 4.82],
    [2.88, 3.62, 4.83],
    [2.98, 3.72, 4.91],
    [3.09, 3.81, 4.97],
    [3.19, 3.91, 5.05],
    [3.29, 4.01, 5.12],
    [3.40, 4.12, 5.20],
];

/// Kalker's coefficients C11 for the inverse ratio, of patches that are long along the rolling.
const LONG: [[f64; 3]; 10] = [
    [10.7, 11.7, 12.9],
    [6.96, 7.78, 8.82],
    [5.57, 6.34, 7.34],
    [4.84, 5.57, 6.57],
    [4.37, 5.10, 6.11],
    [4.06, 4.78, 5.80],
    [3.82, 4.54, 5.58],
    [3.65, 4.36, 5.42],
    [3.51, 4.22, 5.30],
    [3.40, 4.12, 5.20],
];

/// Returns Kalker's coefficient C11 for the ratio of semi-axes, along over across, from 0.1 to 10,
/// and Poisson's ratio from 0 to 0.5; `None` outside. It is linear between rows, and a parabola of
/// 1/C11 through the three Poisson's ratios.
pub fn kalker_c11(ratio: f64, poisson: f64) -> Option<f64> {
    if !(0.0..=0.5).contains(&poisson) || !(0.1..=10.0).contains(&ratio) {
        return None;
    }
    let (table, short_over_long) = if ratio <= 1.0 {
        (&SHORT, ratio)
    } else {
        (&LONG, 1.0 / ratio)
    };
    let place = (10.0 * short_over_long - 1.0).clamp(0.0, 9.0);
    let row = (place.floor() as usize).min(8);
    let part = place - row as f64;
    let compliance =
        |column: usize| 1.0 / (table[row][column] * (1.0 - part) + table[row + 1][column] * part);
    // These are Lagrange's polynomials of the nodes 0, 1/4, 1/2 in x = 4 nu.
    let x = 4.0 * poisson;
    let weights = [
        (x - 1.0) * (x - 2.0) / 2.0,
        x * (2.0 - x),
        x * (x - 1.0) / 2.0,
    ];
    let sum: f64 = weights
        .iter()
        .enumerate()
        .map(|(k, w)| w * compliance(k))
        .sum();
    Some(1.0 / sum)
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

    /// For a patch that is short along the rolling (a strip) C11 tends to pi²/(4 (1 - nu)),
    /// Kalker's asymptote.
    #[test]
    fn a_short_patch_tends_to_the_strip() {
        for poisson in [0.0, 0.25, 0.5] {
            let limit = PI * PI / (4.0 * (1.0 - poisson));
            let got = [0.2, 0.1].map(|r| kalker_c11(r, poisson).unwrap() / limit - 1.0);
            assert!(got[1].abs() < 0.02, "{poisson}: {got:?}");
        }
        assert!(kalker_c11(0.09, 0.3).is_none() && kalker_c11(11.0, 0.3).is_none());
        assert!(kalker_c11(1.0, 0.51).is_none());
    }

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
