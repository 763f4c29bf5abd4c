//! A contact that slides in space, on its full block of W: u_n = 0 and u_t = -lambda p_t with
//! lambda >= 0.
//!
//! Eliminating p_n leaves p_t(lambda) = -(A + lambda I)^-1 b and the scalar equation mu p_n(lambda)
//! = |p_t(lambda)|, which is nearly linear after division by |p_t| (as in trust-region methods,
//! Moré and Sorensen 1983); Newton's method solves it in two or three steps from the last lambda.

use crate::lanes::{Lane, Mask};

/// A = W_tt - W_tn W_nt / W_nn (a number in 2D) and its determinant.
#[inline(always)]
pub fn schur<L: Lane, const D: usize>(w: &[[L; D]; D]) -> ([[L; 2]; 2], L) {
    /// Regularisation of a singular A, as a fraction of W, which defines impulses in its null space
    /// up to the friction bound.
    const MIN_RATIO: f64 = 1e-12;
    let (zero, one) = (L::all(0.0), L::all(1.0));
    let iwnn = L::select(w[0][0].above(zero), one / w[0][0], zero);
    let mut a = [[zero; 2]; 2];
    for i in 1..D {
        for j in 1..D {
            a[i - 1][j - 1] = w[i][j] - w[i][0] * w[0][j] * iwnn;
        }
    }
    let determinant = |a: &[[L; 2]; 2]| {
        if D == 2 {
            a[0][0]
        } else {
            a[0][0] * a[1][1] - a[0][1] * a[1][0]
        }
    };
    let size = (1..D).fold(w[0][0].abs(), |m, k| m.greatest(w[k][k].abs()));
    let least = L::all(MIN_RATIO) * size;
    let bound = if D == 2 { least } else { least * size };
    let singular = determinant(&a).at_most(bound);
    #[allow(clippy::needless_range_loop, reason = "the diagonal of a matrix")]
    for k in 0..2 {
        a[k][k] = L::select(singular, a[k][k] + least, a[k][k]);
    }
    (a, determinant(&a))
}

/// Returns the impulses of the contacts in `slides` for their free velocities `f`, and their
/// multipliers, starting from the last ones; values in other lanes are meaningless.
#[inline(always)]
pub fn slide<L: Lane, const D: usize>(
    w: &[[L; D]; D],
    f: &[L; D],
    mu: L,
    mut lambda: L,
    slides: L::Mask,
) -> ([L; 3], L) {
    const STEPS: usize = 30;
    /// Relative tolerance of |p_t|, at which one more nearly linear step leaves only rounding.
    const CLOSE: f64 = 1e-8;
    /// Relative rounding of a result.
    const EXACT: f64 = 1e-15;
    let (zero, one) = (L::all(0.0), L::all(1.0));
    let (a, _) = schur(w);
    let iwnn = one / w[0][0];
    let b = [f[1] - w[1][0] * f[0] * iwnn, f[2] - w[2][0] * f[0] * iwnn];
    let mut p = [zero; 3];
    let (mut low, mut high) = (zero, L::all(f64::INFINITY));
    let mut active = slides;
    for _ in 0..STEPS {
        let (d0, d1) = (a[0][0] + lambda, a[1][1] + lambda);
        let determinant = d0 * d1 - a[0][1] * a[1][0];
        let over = L::select(determinant.above(zero), one / determinant, zero);
        let t = [
            -(d1 * b[0] - a[0][1] * b[1]) * over,
            -(d0 * b[1] - a[1][0] * b[0]) * over,
        ];
        let n = -(f[0] + w[0][1] * t[0] + w[0][2] * t[1]) * iwnn;
        let squared = t[0] * t[0] + t[1] * t[1];
        let length = squared.sqrt();
        let now = [n, t[0], t[1]];
        p = [0, 1, 2].map(|k| L::select(active, now[k], p[k]));
        let ratio = mu * n - length;
        let singular = determinant.at_most(zero) & lambda.above(zero);
        active = active & !(ratio.abs().at_most(L::all(EXACT) * length) | singular);
        if !active.any() {
            break;
        }
        let short = ratio.below(zero);
        low = L::select(short, lambda, low);
        high = L::select(short, high, lambda);
        // d p_t / d lambda = -(A + lambda)^-1 p_t.
        let dt = [
            -(d1 * t[0] - a[0][1] * t[1]) * over,
            -(d0 * t[1] - a[1][0] * t[0]) * over,
        ];
        let dn = -(w[0][1] * dt[0] + w[0][2] * dt[1]) * iwnn;
        // Newton's method on mu n / |t| - 1, multiplied by |t|^2 to save divisions.
        let slope = mu * (dn * squared - n * (t[0] * dt[0] + t[1] * dt[1]));
        let newton = lambda - ratio * squared / slope;
        let between = L::all(0.5) * (low + high);
        let beyond = L::all(2.0) * lambda + a[0][0].abs().greatest(a[1][1].abs());
        let bounded = high.below(L::all(f64::INFINITY));
        let other = L::select(bounded, between, beyond);
        let next = L::select(newton.above(low) & newton.below(high), newton, other);
        let step = next - lambda;
        lambda = L::select(active, next, lambda);
        let close =
            ratio.abs().at_most(L::all(CLOSE) * length) | step.abs().at_most(L::all(EXACT) * next);
        let ends = active & close;
        let d = [dn, dt[0], dt[1]];
        p = [0, 1, 2].map(|k| L::select(ends, now[k] + d[k] * step, p[k]));
        active = active & !close;
        if !active.any() {
            break;
        }
    }
    // Put the result exactly on the cone.
    let n = p[0].greatest(zero);
    let length = (p[1] * p[1] + p[2] * p[2]).sqrt();
    let scale = L::select(length.above(zero), mu * n / length, one);
    ([n, p[1] * scale, p[2] * scale], lambda)
}
