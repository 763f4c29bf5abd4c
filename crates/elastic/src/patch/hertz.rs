//! Hertz' pressure: half-width or axes of the patch, and the approach of the bodies.

use super::ellipse::integrals;
use std::f64::consts::PI;

/// The patch of two cylinders with parallel axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePatch {
    /// Largest pressure (Pa).
    pub pressure: f64,
    /// Half of the width (m).
    pub half_width: f64,
}

/// Contact patch of two bodies that touch in a point: a circle or an ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointPatch {
    /// Largest pressure (Pa).
    pub pressure: f64,
    /// Semi-axis (m) in the direction of the first curvature.
    pub along: f64,
    /// Semi-axis (m) in the direction of the second curvature.
    pub across: f64,
    /// Approach of distant points of the bodies (m).
    pub approach: f64,
}

impl PointPatch {
    /// Returns the area (m²).
    pub fn area(&self) -> f64 {
        PI * self.along * self.across
    }
}

/// Returns the patch of a line contact from load (N/m), relative curvature 1/R1 + 1/R2 (1/m) and
/// effective modulus (Pa), all positive.
///
/// The approach of the bodies depends on their form at a distance, and is not computed. Source:
/// Johnson, 4.43 to 4.45.
pub fn line(load: f64, curvature: f64, modulus: f64) -> LinePatch {
    let half_width = (4.0 * load / (PI * modulus * curvature)).sqrt();
    LinePatch {
        pressure: 2.0 * load / (PI * half_width),
        half_width,
    }
}

/// Returns the patch of a point contact from load (N), relative curvatures (1/m) in two
/// perpendicular directions and effective modulus (Pa), all positive.
///
/// The result is exact for any ratio of curvatures, which must lie between 1e-12 and 1e12. Source:
/// Johnson, 4.24 to 4.32.
pub fn point(load: f64, [along, across]: [f64; 2], modulus: f64) -> PointPatch {
    let (low, high) = (along.min(across), along.max(across));
    // B/A decreases from infinity to 1 as the axis ratio k rises to 1: bisection over log k.
    let (mut narrow, mut wide) = ((1e-16f64).ln(), 0.0f64);
    let ratio = |k: f64| {
        let (first, d) = integrals(k);
        (first - d) / (k * k * d)
    };
    while wide - narrow > 1e-15 {
        let middle = f64::midpoint(narrow, wide);
        if middle <= narrow || middle >= wide {
            break;
        }
        if ratio(middle.exp()) > high / low {
            narrow = middle;
        } else {
            wide = middle;
        }
    }
    let k = if low == high { 1.0 } else { wide.exp() };
    let (first, d) = integrals(k);
    let long = (3.0 * load * d / (PI * modulus * low)).cbrt();
    let short = k * long;
    let pressure = 3.0 * load / (2.0 * PI * long * short);
    let (along, across) = if along <= across {
        (long, short)
    } else {
        (short, long)
    };
    PointPatch {
        pressure,
        along,
        across,
        approach: pressure * short * first / modulus,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODULUS: f64 = 115e9;

    fn near(got: f64, expected: f64, relative: f64) {
        assert!((got / expected - 1.0).abs() < relative, "{got} {expected}");
    }

    /// Johnson, 4.22 to 4.24: a³ = 3 P R/(4 E*), delta = a²/R, p0³ = 6 P E*²/(pi³ R²).
    #[test]
    fn a_sphere_has_the_closed_form() {
        let (load, radius) = (75e3, 0.371);
        let got = point(load, [1.0 / radius; 2], MODULUS);
        let a = (3.0 * load * radius / (4.0 * MODULUS)).cbrt();
        near(got.along, a, 1e-14);
        near(got.across, a, 1e-14);
        near(got.approach, a * a / radius, 1e-14);
        let p0 = (6.0 * load * MODULUS.powi(2) / (PI.powi(3) * radius * radius)).cbrt();
        near(got.pressure, p0, 1e-14);
    }

    /// The solution is put back: the surface under a semi-ellipsoidal pressure, integrated over
    /// chords through a point (Johnson, 3.7.2), sinks by the approach minus half the relative
    /// curvature times the square of the distance.
    #[test]
    fn an_ellipse_has_the_surface_of_the_bodies() {
        for ratio in [1.01, 1.5, 4.0, 30.0, 1e3] {
            let curvatures = [1.0 / 0.46, ratio / 0.46];
            let got = point(75e3, curvatures, MODULUS);
            let (a, b) = (got.along, got.across);
            assert!(a > b, "the patch is long where the curvature is small");
            let sinks = |x: f64, y: f64| {
                let n = 20_000;
                let chord = |k: i32| {
                    let (sine, cosine) = ((f64::from(k) + 0.5) * PI / f64::from(n)).sin_cos();
                    let inverse = (cosine / a).powi(2) + (sine / b).powi(2);
                    let along = x * cosine / (a * a) + y * sine / (b * b);
                    let left = 1.0 - (x / a).powi(2) - (y / b).powi(2);
                    (left + along * along / inverse) / inverse.sqrt()
                };
                let sum: f64 = (0..n).map(chord).sum();
                got.pressure / (2.0 * MODULUS) * sum * PI / f64::from(n)
            };
            near(sinks(0.0, 0.0), got.approach, 1e-11);
            for (x, y) in [(0.7 * a, 0.0), (0.0, 0.7 * b), (0.3 * a, 0.5 * b)] {
                let gap = (curvatures[0] * x * x + curvatures[1] * y * y) / 2.0;
                near(sinks(x, y) + gap, got.approach, 1e-11);
            }
        }
    }

    /// B. J. Hamrock, D. Dowson, Ball Bearing Lubrication (1981): k = 1.0339 (Ry/Rx)^0.636, with an
    /// error below 5 % for ratios from 1 to 31, as an independent statement of the axes.
    #[test]
    fn axes_agree_with_the_formula_of_hamrock_and_brewe() {
        for ratio in [1.2, 2.0, 5.0, 10.0, 20.0, 31.0] {
            let got = point(1e3, [10.0, 10.0 * ratio], MODULUS);
            near(got.along / got.across, 1.0339 * ratio.powf(0.636), 0.05);
        }
    }

    /// A long ellipse is a line contact in its middle: p0 and half-width belong to the load per
    /// metre at that place, 3 P/(4 a).
    #[test]
    fn a_long_ellipse_becomes_a_line() {
        let got = point(1e3, [1e-5, 10.0], MODULUS);
        let middle = line(3.0 * 1e3 / (4.0 * got.along), 10.0, MODULUS);
        near(got.across, middle.half_width, 1e-5);
        near(got.pressure, middle.pressure, 1e-5);
    }

    /// Exchanging the curvatures rotates the patch.
    #[test]
    fn directions_may_be_exchanged() {
        let (one, other) = (
            point(1e3, [2.0, 3.0], MODULUS),
            point(1e3, [3.0, 2.0], MODULUS),
        );
        assert_eq!((one.along, one.across), (other.across, other.along));
        assert_eq!(one.pressure, other.pressure);
    }

    /// The values are those of Carter's case in the documentation: R 0.5 m, 178.9 N/mm, a = 1 mm.
    #[test]
    fn a_line_has_the_closed_form() {
        let got = line(178.9e3, 2.0, 113.9e9);
        near(got.half_width, 1e-3, 2e-3);
        near(got.pressure, (178.9e3 * 113.9e9 * 2.0 / PI).sqrt(), 1e-14);
    }
}
