//! Displacement of the surface of an elastic half-space by a uniform load on one cell of it, in
//! closed form.
//!
//! The axes are those of the surface, x and, in space, y, and the inward normal n, last. Entry
//! `[a][b]` of a result is the displacement along a due to a force on the cell along b (m/N; m per
//! N/m in the plane).
//!
//! Sources: K. L. Johnson, "Contact Mechanics" (1985), sections 2.2 to 2.5, 3.2 and 3.6; A. E. H.
//! Love, "The stress produced in a semi-infinite solid by pressure on part of the boundary", Phil.
//! Trans. R. Soc. A 228 (1929); J. J. Kalker, "Three-dimensional elastic bodies in rolling contact"
//! (1990), appendix C.

use crate::material::Elasticity;
use std::f64::consts::PI;

/// Displacements due to forces, by axis; in the plane only two of each are used.
pub type Influence = [[f64; 3]; 3];

/// Returns, for plane strain, the displacement at `x` from the middle of a strip of width `size`
/// (m), relative to the points at `depth` (m) below the strip.
///
/// Far from the strip the displacement along a force P per depth is (2 (1 - nu^2) P/(pi E))
/// (ln(depth/|x|) -+ 1/(2 (1 - nu))), with the minus for the normal and the plus for a direction
/// along the surface (Flamant's solution, with its constant such that it vanishes at that depth).
pub fn strip(material: &Elasticity, size: f64, depth: f64, x: f64) -> Influence {
    let nu = material.poisson;
    let own = 2.0 / (PI * material.plane_strain());
    let constant = 0.5 / (1.0 - nu);
    // This is the mean of ln |x - s| over the strip.
    let [from, to] = [x - 0.5 * size, x + 0.5 * size];
    let integral = |s: f64| {
        if s == 0.0 {
            0.0
        } else {
            s * (s.abs().ln() - 1.0)
        }
    };
    let mean = (integral(to) - integral(from)) / size;
    let far = depth.ln() - mean;
    // A pressure strains only the surface below it, by -(1 - 2 nu)(1 + nu) p/E.
    let inside = (x / (0.5 * size)).clamp(-1.0, 1.0);
    let coupling = 0.5 * (1.0 - 2.0 * nu) * (1.0 + nu) / material.young * inside;
    let mut out = Influence::default();
    out[0][0] = own * (far + constant);
    out[1][1] = own * (far - constant);
    out[0][1] = -coupling;
    out[1][0] = coupling;
    out
}

/// Returns the displacement at (`x`, `y`) from the middle of a rectangle with sides `size` (m).
pub fn rectangle(material: &Elasticity, size: [f64; 2], x: f64, y: f64) -> Influence {
    let nu = material.poisson;
    let sum = |f: fn(f64, f64) -> f64| {
        let [x0, x1] = [x - 0.5 * size[0], x + 0.5 * size[0]];
        let [y0, y1] = [y - 0.5 * size[1], y + 0.5 * size[1]];
        (f(x1, y1) - f(x0, y1) - f(x1, y0) + f(x0, y0)) / (size[0] * size[1])
    };
    // These are the integrals of x^2/r^3, y^2/r^3, x y/r^3, x/r^2 and y/r^2; the sum of the first
    // two is that of 1/r.
    let xx = sum(|x, y| times(y, log_of_sum(x, y)));
    let yy = sum(|x, y| times(x, log_of_sum(y, x)));
    let xy = sum(|x, y| -x.hypot(y));
    fn first(x: f64, y: f64) -> f64 {
        times(y, x.hypot(y).ln()) + times(x, (y / x).atan())
    }
    let along_x = sum(first);
    let along_y = sum(|x, y| first(y, x));
    let own = 1.0 / (2.0 * PI * material.shear());
    let coupling = 0.5 * (1.0 - 2.0 * nu) * own;
    let mut out = Influence::default();
    out[0][0] = own * ((1.0 - nu) * (xx + yy) + nu * xx);
    out[1][1] = own * ((1.0 - nu) * (xx + yy) + nu * yy);
    out[2][2] = own * (1.0 - nu) * (xx + yy);
    out[0][1] = own * nu * xy;
    out[1][0] = out[0][1];
    out[0][2] = -coupling * along_x;
    out[2][0] = coupling * along_x;
    out[1][2] = -coupling * along_y;
    out[2][1] = coupling * along_y;
    out
}

/// Returns a product that is zero where its first factor is: the limit at an edge of a cell.
fn times(zero: f64, other: f64) -> f64 {
    if zero == 0.0 { 0.0 } else { zero * other }
}

/// Returns ln(x + r), without cancellation where x is negative.
fn log_of_sum(x: f64, y: f64) -> f64 {
    let r = x.hypot(y);
    if x >= 0.0 {
        (x + r).ln()
    } else {
        2.0 * y.abs().ln() - (r - x).ln()
    }
}

/// Returns the displacement due to a wave of traction exp(i k x) of unit amplitude (m/Pa): its real
/// part, and the part that is a quarter of a wave ahead (imaginary). `k` has one wave number in the
/// plane and two in space (1/m); not all may be zero.
pub fn wave(material: &Elasticity, k: [f64; 2], dimension: usize) -> [Influence; 2] {
    let nu = material.poisson;
    let (mut real, mut imaginary) = (Influence::default(), Influence::default());
    let n = dimension - 1;
    let size = k[0].hypot(k[1]);
    let own = (1.0 - nu) / (material.shear() * size);
    let coupling = 0.5 * (1.0 - 2.0 * nu) / (material.shear() * size * size);
    for a in 0..n {
        real[a][a] = own;
        imaginary[a][n] = coupling * k[a];
        imaginary[n][a] = -coupling * k[a];
    }
    real[n][n] = own;
    if n == 2 {
        let across = nu / (material.shear() * size.powi(3));
        real[0][0] += across * k[1] * k[1];
        real[1][1] += across * k[0] * k[0];
        real[0][1] = -across * k[0] * k[1];
        real[1][0] = real[0][1];
    }
    [real, imaginary]
}

/// Returns the displacement due to a uniform traction (m/Pa), relative to points at `depth` (m):
/// pure shear, and compression without lateral strain.
pub fn uniform(material: &Elasticity, depth: f64, dimension: usize) -> Influence {
    let mut out = Influence::default();
    let n = dimension - 1;
    for (a, row) in out.iter_mut().enumerate().take(n) {
        row[a] = depth / material.shear();
    }
    out[n][n] = depth / (material.lambda() + 2.0 * material.shear());
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const RUBBER: Elasticity = Elasticity {
        young: 2.6e6,
        poisson: 0.3,
        density: 1000.0,
    };

    fn near(expected: f64, obtained: f64, tolerance: f64) {
        assert!(
            (obtained - expected).abs() <= tolerance * expected.abs(),
            "expected {expected:e}, obtained {obtained:e}"
        );
    }

    /// At large distance a cell acts as a point force (Johnson, equations 3.22 and 3.75).
    #[test]
    fn a_rectangle_is_a_point_from_afar() {
        let (x, y) = (0.8, -0.6);
        let g = RUBBER.shear();
        let found = rectangle(&RUBBER, [2e-3, 1e-3], x, y);
        let of = 1.0 / (4.0 * PI * g);
        let nu = RUBBER.poisson;
        near(of * (2.0 - 2.0 * nu), found[2][2], 1e-5);
        near(of * (2.0 - 2.0 * nu + 2.0 * nu * x * x), found[0][0], 1e-5);
        near(of * (2.0 - 2.0 * nu + 2.0 * nu * y * y), found[1][1], 1e-5);
        near(of * 2.0 * nu * x * y, found[0][1], 1e-5);
        near(-of * (1.0 - 2.0 * nu) * x, found[0][2], 1e-5);
        near(of * (1.0 - 2.0 * nu) * y, found[2][1], 1e-5);
    }

    /// Love: the middle of a square of side 2 a under p sinks by (8/pi) ln(1 + sqrt 2) p a (1 -
    /// nu^2)/E, a corner by half of that (Johnson, equation 3.26).
    #[test]
    fn a_square_sinks_as_loves() {
        let a = 0.5;
        let of = |x, y| rectangle(&RUBBER, [2.0 * a, 2.0 * a], x, y)[2][2] * 4.0 * a * a;
        let middle = 8.0 / PI * (1.0 + 2.0_f64.sqrt()).ln() * a / RUBBER.plane_strain();
        near(middle, of(0.0, 0.0), 1e-12);
        near(0.5 * middle, of(a, -a * (1.0 - 1e-12)), 1e-9);
    }

    /// Forces and displacements at two positions are reciprocal.
    #[test]
    fn influences_are_reciprocal() {
        let [there, back] =
            [(0.3, -0.2), (-0.3, 0.2)].map(|(x, y)| rectangle(&RUBBER, [0.1; 2], x, y));
        let [far, home] = [0.03, -0.03].map(|x| strip(&RUBBER, 0.1, 5.0, x));
        for a in 0..3 {
            for b in 0..3 {
                assert!((there[a][b] - back[b][a]).abs() < 1e-12 / 2.6e6);
                assert!((far[a][b] - home[b][a]).abs() < 1e-12 / 2.6e6);
            }
        }
    }

    /// For the middle of a strip of width 2 a the approach of Johnson's equation 5.55 has the same
    /// constant, -nu/(1 - nu), with the mean of the logarithm over an ellipse in place of that over
    /// a strip.
    #[test]
    fn a_strip_sinks_relative_to_its_depth() {
        let (a, d, nu) = (1e-3, 0.5, RUBBER.poisson);
        let n = 4000;
        let size = 2.0 * a / f64::from(n);
        let at = |k: i32| -a + (f64::from(k) + 0.5) * size;
        let pressure = |x: f64| 2.0 / (PI * a) * (1.0 - (x / a).powi(2)).sqrt();
        let sunk: f64 = (0..n)
            .map(|k| strip(&RUBBER, size, d, at(k))[1][1] * pressure(at(k)) * size)
            .sum();
        let expected = (2.0 * (2.0 * d / a).ln() - nu / (1.0 - nu)) / (PI * RUBBER.plane_strain());
        near(expected, sunk, 1e-5);
    }

    /// The sum of strips under a wave of pressure is the wave of displacement.
    #[test]
    fn strips_make_a_wave() {
        let (size, k) = (0.01, 2.0 * PI / 0.4);
        let half = 40 * 500;
        let mut sum = [0.0; 2];
        for j in -half..=half {
            let x = f64::from(j) * size;
            // The load fades out smoothly instead of ending abruptly.
            let fade = (0.5 * PI * x / (f64::from(half) * size)).cos().powi(4);
            let of = strip(&RUBBER, size, 1.0, x);
            sum[0] += of[1][1] * (k * x).cos() * fade * size;
            sum[1] += of[0][1] * (k * x).sin() * fade * size;
        }
        let [real, imaginary] = wave(&RUBBER, [k, 0.0], 2);
        near(real[1][1], sum[0], 3e-3);
        // u(0) for a load p(x) = sin(k x) is the sum of the influence at -x, which is odd, and
        // equals Re(i imaginary (-i)).
        near(imaginary[0][1], -sum[1], 3e-3);
    }
}
