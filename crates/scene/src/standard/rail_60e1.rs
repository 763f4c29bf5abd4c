//! Head of the rail 60E1, formerly UIC 60.
//!
//! EN 13674-1 (2011+A1:2017): arcs of radius 300, 80 and 13 mm that meet tangentially at widths of
//! 20.456 and 52.053 mm, then a flank inclined 1:20 to the vertical down to a depth of 35.27 mm,
//! where the lower corner of the head begins. The same construction is in the GENSYS manual
//! ("Creation of a rail profile from a drawing"). y is the lateral axis, about which the rail is
//! symmetric; z > 0 is the depth below the middle of the running surface.

use super::Drawing;

/// Half of the widths at which the arcs meet (mm).
const HALF: [f64; 2] = [20.456 / 2.0, 52.053 / 2.0];
/// Radius of the arc in the middle (mm).
const CROWN: f64 = 300.0;
/// Radius of the arcs next to it (mm).
const SHOULDER: f64 = 80.0;
/// Radius of the arcs at the corners (mm).
const CORNER: f64 = 13.0;
/// Depth at which the flank ends (mm).
const FLANK_END: f64 = 35.27;
/// Slope of the flank: depth over width.
const FLANK: f64 = 20.0;

pub(super) struct Rail60E1 {
    /// Centre (y, z) of the arc of the shoulder at y > 0 (mm).
    shoulder: [f64; 2],
    /// Centre (y, z) of the arc of the corner at y > 0 (mm).
    corner: [f64; 2],
    /// Point (y, z) where the arc of the corner meets the flank (mm).
    tangent: [f64; 2],
}

impl Rail60E1 {
    pub(super) fn new() -> Self {
        let cosine = |sine: f64| (1.0 - sine * sine).sqrt();
        let s = HALF[0] / CROWN;
        let inner = CROWN - SHOULDER;
        let shoulder = [inner * s, CROWN - inner * cosine(s)];
        let s = (HALF[1] - shoulder[0]) / SHOULDER;
        let inner = SHOULDER - CORNER;
        let corner = [shoulder[0] + inner * s, shoulder[1] - inner * cosine(s)];
        // Unit normal of the flank.
        let length = (1.0 + FLANK * FLANK).sqrt();
        let tangent = [
            corner[0] + CORNER * FLANK / length,
            corner[1] - CORNER / length,
        ];
        Self {
            shoulder,
            corner,
            tangent,
        }
    }

    /// Returns half of the width at the end of the flank (mm).
    fn reach(&self) -> f64 {
        self.tangent[0] + (FLANK_END - self.tangent[1]) / FLANK
    }

    /// Returns the highest point of the rail inclined 1:n, in the axes of the upright rail (mm).
    fn apex(&self, n: f64) -> [f64; 2] {
        let (sin, cos) = (1.0 / n).atan().sin_cos();
        if CROWN * sin <= HALF[0] {
            [CROWN * sin, CROWN * (1.0 - cos)]
        } else {
            [
                self.shoulder[0] + SHOULDER * sin,
                self.shoulder[1] - SHOULDER * cos,
            ]
        }
    }

    /// Converts a point (y, z) of the upright rail (mm) to axes in which the rail is inclined 1:n
    /// towards negative y and its highest point is at the origin.
    pub(super) fn inclined(&self, (y, z): (f64, f64), n: f64) -> (f64, f64) {
        let (sin, cos) = (1.0 / n).atan().sin_cos();
        let [ya, za] = self.apex(n);
        let (y, z) = (y - ya, z - za);
        (cos * y + sin * z, cos * z - sin * y)
    }
}

impl Drawing for Rail60E1 {
    fn joints(&self) -> Vec<f64> {
        let right = [HALF[0], HALF[1], self.tangent[0], self.reach()];
        let left = right.iter().rev().map(|y| -y);
        left.chain(right).collect()
    }

    fn height(&self, y: f64) -> f64 {
        let y = y.abs();
        let below = |centre: [f64; 2], radius: f64| {
            let off = y - centre[0];
            centre[1] - (radius * radius - off * off).max(0.0).sqrt()
        };
        if y <= HALF[0] {
            below([0.0, CROWN], CROWN)
        } else if y <= HALF[1] {
            below(self.shoulder, SHOULDER)
        } else if y <= self.tangent[0] {
            below(self.corner, CORNER)
        } else {
            self.tangent[1] + FLANK * (y - self.tangent[0])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The drawing gives the end of the corner arc as 36 mm from the middle and 14.3 mm deep, which
    /// the construction does not use.
    #[test]
    fn the_corner_ends_where_the_drawing_says() {
        let [y, z] = Rail60E1::new().tangent;
        assert!(
            (y - 36.0).abs() < 5e-4 && (z - 14.3).abs() < 5e-4,
            "{y} {z}"
        );
        let rail = Rail60E1::new();
        assert_eq!(rail.height(0.0), 0.0);
        assert_eq!(rail.height(20.0), rail.height(-20.0));
    }

    #[test]
    fn arcs_and_flank_join_in_height_and_slope() {
        let rail = Rail60E1::new();
        let joints = rail.joints();
        for joint in &joints[1..joints.len() - 1] {
            let d = 1e-6;
            let left = (rail.height(joint - d) - rail.height(joint - 2.0 * d)) / d;
            let right = (rail.height(joint + 2.0 * d) - rail.height(joint + d)) / d;
            // Near the flank z changes rapidly with y, so that angles are compared.
            assert!(
                (left.atan() - right.atan()).abs() < 1e-5,
                "{joint} {left} {right}"
            );
            let step = rail.height(joint + 1e-12) - rail.height(joint - 1e-12);
            assert!(step.abs() < 1e-9, "{joint} {step}");
        }
    }

    /// The inclination is a rotation: distances are preserved, and the top is level.
    #[test]
    fn inclining_turns_the_rail() {
        let rail = Rail60E1::new();
        for n in [20.0, 40.0] {
            let at = |y: f64| rail.inclined((y, rail.height(y)), n);
            let far = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).hypot(a.1 - b.1);
            let upright = |y: f64| (y, rail.height(y));
            assert!((far(at(-30.0), at(20.0)) - far(upright(-30.0), upright(20.0))).abs() < 1e-12);
            let [y, _] = rail.apex(n);
            assert!(at(y).0.abs() < 1e-12 && at(y).1.abs() < 1e-12);
            assert!(at(y - 0.1).1 > 0.0 && at(y + 0.1).1 > 0.0);
            // The rail leans to the gauge side, at negative y, and falls towards it.
            assert!(at(-20.0).1 > rail.height(20.0) && at(20.0).1 < rail.height(20.0));
        }
    }
}
