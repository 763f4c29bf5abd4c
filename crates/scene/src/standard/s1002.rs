//! Wheel profile S1002, flange 28 mm high and 32.5 mm thick.
//!
//! EN 13715 (2006+A1:2010, 2020), UIC 510-2 (2004). The coefficients are those commonly published
//! with credit to H. Netter, DLR (a cone, two polynomials, four arcs, a line); the same profile is
//! tabulated in the GENSYS manual (profiles of KPF) and in the Manchester contact benchmark, P.
//! Shackleton, S. Iwnicki, Veh. Syst. Dyn. 46 (2008) 129-149. y > 0 points to the field side, z > 0
//! away from the axle; the origin is the datum of the tread, 70 mm from the back of the flange.
//! Rounding of the printed coefficients leaves a step of 1.2e-4 mm at y = -35.

use super::Drawing;

/// Polynomial of the tread, y from -26 to 32.15796 mm.
const TREAD: [f64; 9] = [
    0.0,
    -3.358537058e-2,
    1.565681624e-3,
    -2.810427944e-5,
    5.844240864e-8,
    -1.562379023e-8,
    5.309217349e-15,
    -5.957839843e-12,
    2.646656573e-13,
];
/// Polynomial between the tread and the root of the flange, y from -35 to -26 mm.
const THROAT: [f64; 8] = [
    -4.320221063e3,
    -1.038384026e3,
    -1.065501873e2,
    -6.051367875,
    -2.054332446e-1,
    -4.169739389e-3,
    -4.687195829e-5,
    -2.252755540e-7,
];
/// Positions where the segments meet, and the ends (mm).
const JOINTS: [f64; 9] = [
    -70.0,
    -62.764705882,
    -49.662510381,
    -39.764473993,
    -38.426669071,
    -35.0,
    -26.0,
    32.15796,
    60.0,
];

pub(super) struct S1002;

fn polynomial(coefficients: &[f64], y: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * y + c)
}

/// Returns the height of a circle above its centre at a lateral distance from it.
fn arc(radius: f64, off: f64) -> f64 {
    (radius * radius - off * off).max(0.0).sqrt()
}

impl Drawing for S1002 {
    fn joints(&self) -> Vec<f64> {
        JOINTS.to_vec()
    }

    fn height(&self, y: f64) -> f64 {
        let piece = JOINTS[1..8].partition_point(|j| *j < y);
        match piece {
            0 => 9.519259302 + arc(20.5, y + 49.5),
            1 => 16.0 + arc(12.0, y + 55.0),
            2 => 8.834924130 + arc(20.0, y + 58.558326413),
            3 => -93.576667419 - 2.747477419 * y,
            4 => 16.446 - arc(13.0, y + 26.210665),
            5 => polynomial(&THROAT, y),
            6 => polynomial(&TREAD, y),
            _ => 1.364323640 - 0.066666667 * y,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn z(y: f64) -> f64 {
        S1002.height(y)
    }

    /// Returns the slope by central differences (error below 1e-8 for radii of 10 mm and more).
    fn slope(y: f64) -> f64 {
        let d = 1e-4;
        (z(y + d) - z(y - d)) / (2.0 * d)
    }

    #[test]
    fn datum_tip_and_flank_are_those_of_the_standard() {
        assert_eq!(z(0.0), 0.0);
        assert!((z(-55.0) - 28.0).abs() < 1e-12);
        // The flank is inclined at 70 degrees.
        assert!((slope(-39.0) + 70f64.to_radians().tan()).abs() < 1e-6);
        // The field side has a slope of 1 in 15.
        assert!((slope(50.0) + 1.0 / 15.0).abs() < 1e-8);
        // The back of the flange is 70 mm from the datum: 49.5 + 20.5.
        assert!((z(-70.0) - 9.519259302).abs() < 1e-9);
    }

    /// Flange thickness Sd: from the back of the flange to the flank, 10 mm above the datum.
    #[test]
    fn the_flange_is_32_5_mm_thick() {
        let (mut low, mut high) = (-39.0, -35.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if z(middle) > 10.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        assert!((70.0 + low - 32.5).abs() < 1e-6, "{}", 70.0 + low);
    }

    #[test]
    fn pieces_join_in_height_and_slope() {
        for joint in &JOINTS[1..8] {
            let d = 1e-9;
            let step = (z(joint + d) - z(joint - d)).abs();
            // The accuracy is limited by the printed digits of the throat's polynomial.
            let allowed = if *joint == -35.0 { 2e-4 } else { 5e-5 };
            assert!(step < allowed, "{joint}: {step}");
            let d = 1e-5;
            let left = (z(joint - d) - z(joint - 2.0 * d)) / d;
            let right = (z(joint + 2.0 * d) - z(joint + d)) / d;
            assert!((left - right).abs() < 3e-4, "{joint}: {left} {right}");
        }
    }
}
