//! Stress in a half-space under a traction that is uniform over a rectangle of its surface, in
//! closed form.
//!
//! The axes are x and y along the surface and z into the body, from the surface down. Tractions act
//! on the body: a pressure pushes into it. The stress is that of the potentials of Boussinesq and
//! Cerruti (K. L. Johnson, Contact Mechanics, 1985, 3.2): with W the integral of z ln(r + z) - r
//! over the rectangle, V = W_zz that of 1/r, and H = W_z,
//!
//! ```text
//! pressure     2 pi s_xx = 2 nu V_z - (1 - 2 nu) H_xx - z V_xx     s_zz = V_z - z V_zz
//!              2 pi s_xy = -(1 - 2 nu) H_xy - z V_xy               s_xz = -z V_xz
//! traction x   2 pi s_xx = 2 (1 + nu) V_x + 2 nu W_xxx - z H_xxx   s_zz = -z V_xz
//!              2 pi s_yy = 2 nu V_x + 2 nu W_xyy - z H_xyy         s_xz = V_z - z V_xx
//!              2 pi s_xy = V_y + 2 nu W_xxy - z H_xxy              s_yz = -z V_xy
//! ```
//!
//! Each derivative is a sum over the corners; of pressure they are those of A. E. H. Love, Phil.
//! Trans. R. Soc. A 228 (1929).

use fretwork_elastic::material::Symmetric;
use std::f64::consts::PI;

/// Components xx, yy, zz, yz, xz, xy of a stress (Pa), tension positive.
pub type Stress = Symmetric;

/// Returns the stresses at a place (m, from the middle of the rectangle, the depth last) by unit
/// tractions along x, along y, and a unit pressure, on a rectangle of sides `size` (m). On an edge
/// of the rectangle, at the surface, some are infinite.
pub fn rectangle(poisson: f64, size: [f64; 2], [x, y, z]: [f64; 3]) -> [Stress; 3] {
    let mut sums = [[0.0; 6]; 3];
    for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let at = [x + 0.5 * a * size[0], y + 0.5 * b * size[1], z];
        let turned = along_x(poisson, [at[1], at[0], z]);
        let parts = [
            along_x(poisson, at),
            exchanged(&turned),
            by_pressure(poisson, at),
        ];
        for (sum, part) in sums.iter_mut().zip(parts) {
            (0..6).for_each(|k| sum[k] += a * b * part[k]);
        }
    }
    sums.map(|sum| sum.map(|s| s / (2.0 * PI)))
}

/// Part of a corner in 2 pi times the stress by a unit pressure.
fn by_pressure(nu: f64, [x, y, z]: [f64; 3]) -> Stress {
    let r = length(x, y, z);
    let v_z = -(x * y).atan2(z * r);
    let (v_xx, v_yy) = (second(x, y, z, r), second(y, x, z, r));
    let (h_xx, h_yy) = (bent(x, y, z, r), bent(y, x, z, r));
    let free = 1.0 - 2.0 * nu;
    [
        2.0 * nu * v_z - free * h_xx - z * v_xx,
        2.0 * nu * v_z - free * h_yy - z * v_yy,
        v_z + z * (v_xx + v_yy),
        -z * mixed(y, x, z, r),
        -z * mixed(x, y, z, r),
        -free * (r + z).ln() - z / r,
    ]
}

/// Part of a corner in 2 pi times the stress by a unit traction along x.
fn along_x(nu: f64, [x, y, z]: [f64; 3]) -> Stress {
    let r = length(x, y, z);
    let (v_x, v_y) = (log_of_sum(y, x, z, r), log_of_sum(x, y, z, r));
    let v_z = -(x * y).atan2(z * r);
    let (v_xx, v_xz) = (second(x, y, z, r), mixed(x, y, z, r));
    let below = r + z;
    let (w_xyy, w_xxy) = (-y / below, -x / below);
    let w_xxx = -w_xyy - v_x;
    let (h_xyy, h_xxy) = (y / (r * below), x / (r * below));
    let h_xxx = -h_xyy - v_xz;
    [
        2.0 * (1.0 + nu) * v_x + 2.0 * nu * w_xxx - z * h_xxx,
        2.0 * nu * (v_x + w_xyy) - z * h_xyy,
        -z * v_xz,
        -z / r,
        v_z - z * v_xx,
        v_y + 2.0 * nu * w_xxy - z * h_xxy,
    ]
}

/// Exchanges x and y.
fn exchanged(s: &Stress) -> Stress {
    [s[1], s[0], s[2], s[4], s[3], s[5]]
}

fn length(x: f64, y: f64, z: f64) -> f64 {
    x.hypot(y).hypot(z)
}

/// V_xx, less a function of x and z, whose sum over the corners is zero.
fn second(x: f64, y: f64, z: f64, r: f64) -> f64 {
    -x * y / (r * (x * x + z * z))
}

/// V_xz, less a function of x and z.
fn mixed(x: f64, y: f64, z: f64, r: f64) -> f64 {
    -z * y / (r * (x * x + z * z))
}

/// H_xx, atan(y/x) - atan(z y/(x r)), in one arc that has no jump at x = 0.
fn bent(x: f64, y: f64, z: f64, r: f64) -> f64 {
    (x * y * (r - z)).atan2(x * x * r + y * y * z)
}

/// Returns ln(a + r) with r² = a² + b² + z², without cancellation where a is negative.
fn log_of_sum(a: f64, b: f64, z: f64, r: f64) -> f64 {
    if a >= 0.0 {
        (a + r).ln()
    } else {
        2.0 * b.hypot(z).ln() - (r - a).ln()
    }
}

/// Returns the principal stresses (Pa), the largest first (O. K. Smith, Communications of the ACM
/// 4, 1961).
pub fn principal(stress: &Stress) -> [f64; 3] {
    let mean = hydrostatic(stress);
    let [a, b, c, f, e, d] = deviator(stress);
    let size = (second_invariant(stress) / 3.0).sqrt();
    if size == 0.0 {
        return [mean; 3];
    }
    let determinant = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
    let angle = (0.5 * determinant / size.powi(3)).clamp(-1.0, 1.0).acos() / 3.0;
    let first = mean + 2.0 * size * angle.cos();
    let last = mean + 2.0 * size * (angle + 2.0 * PI / 3.0).cos();
    [first, 3.0 * mean - first - last, last]
}

/// Returns the largest shear stress (Pa): half of the difference of the outer principal stresses.
pub fn largest_shear(stress: &Stress) -> f64 {
    let [first, _, last] = principal(stress);
    0.5 * (first - last)
}

/// Returns the mean of the normal components (Pa).
pub fn hydrostatic(stress: &Stress) -> f64 {
    (stress[0] + stress[1] + stress[2]) / 3.0
}

/// Returns the stress less its mean (Pa).
pub fn deviator(stress: &Stress) -> Stress {
    let mean = hydrostatic(stress);
    let [x, y, z, yz, xz, xy] = *stress;
    [x - mean, y - mean, z - mean, yz, xz, xy]
}

/// Returns the second invariant J2 of the deviator (Pa²), half of its square.
pub fn second_invariant(stress: &Stress) -> f64 {
    let [x, y, z, yz, xz, xy] = deviator(stress);
    0.5 * (x * x + y * y + z * z) + yz * yz + xz * xz + xy * xy
}
