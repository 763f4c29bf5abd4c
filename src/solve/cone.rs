//! The set of admissible impulses of one contact and the projection onto it.

use crate::geometry::space::VectorLike;
use std::hint::select_unpredictable;

/// { (P, t) : P >= 0, |t| <= mu P + c }: Coulomb's cone for c = 0, Tresca's cylinder for mu = 0.
/// P = p_n + h c_n and c = h c_t. Returns the nearest point (Euclidean).
#[inline]
pub fn project<T: VectorLike>(normal: f64, tangent: T, mu: f64, c: f64) -> (f64, T) {
    match outside(normal, tangent.dot(&tangent), mu, c) {
        None => (normal, tangent),
        Some((n, scale)) => (n, tangent * scale),
    }
}

/// The same of (P, t...) in an array.
#[inline(always)]
pub fn project_array<const D: usize>(z: &[f64; D], mu: f64, c: f64) -> [f64; D] {
    if D == 2 {
        // All answers are formed and one is chosen: the branches would be guessed wrong too often.
        let (n, length) = (z[0], z[1].abs());
        let inside = n >= 0.0 && length <= mu * n + c;
        let foot = (n + mu * (length - c)) / (1.0 + mu * mu);
        let slides = length > c && foot > 0.0;
        let foot = select_unpredictable(slides, foot, 0.0);
        let bound = select_unpredictable(slides, mu * foot + c, length.min(c));
        let mut y = [0.0; D];
        y[0] = select_unpredictable(inside, n, foot);
        y[1] = select_unpredictable(inside, z[1], bound.copysign(z[1]));
        return y;
    }
    let mut squared = 0.0;
    for x in &z[1..] {
        squared += x * x;
    }
    match outside(z[0], squared, mu, c) {
        None => *z,
        Some((n, scale)) => std::array::from_fn(|k| if k == 0 { n } else { z[k] * scale }),
    }
}

/// Of a point outside, by P and |t|^2: the nearest P, and what t is multiplied by.
#[inline(always)]
fn outside(normal: f64, squared: f64, mu: f64, c: f64) -> Option<(f64, f64)> {
    let bound = mu * normal + c;
    if normal >= 0.0 && squared <= bound * bound {
        return None;
    }
    let length = squared.sqrt();
    let foot = (normal + mu * (length - c)) / (1.0 + mu * mu);
    let (n, bound) = if length > c && foot > 0.0 {
        (foot, mu * foot + c)
    } else {
        (0.0, length.min(c))
    };
    Some((n, if length > 0.0 { bound / length } else { 0.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector1, Vector2};
    use rand::{RngExt, SeedableRng};

    /// Brute force over a fine sampling of the set's border and inside.
    fn nearest_by_sampling(normal: f64, s: f64, mu: f64, c: f64) -> f64 {
        let mut best = f64::INFINITY;
        for i in 0..4000 {
            let p = i as f64 * 1e-3;
            let t = s.clamp(-(mu * p + c), mu * p + c);
            best = best.min((p - normal).hypot(t - s));
        }
        best
    }

    #[test]
    fn is_the_nearest_point() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        for _ in 0..200 {
            let (n, s) = (rng.random_range(-1.5..1.5), rng.random_range(-1.5..1.5));
            let (mu, c) = (rng.random_range(0.0..1.5), rng.random_range(0.0..0.5));
            let (pn, pt) = project(n, Vector1::new(s), mu, c);
            assert!(pn >= 0.0 && pt.norm() <= mu * pn + c + 1e-15);
            let distance = (pn - n).hypot(pt[0] - s);
            assert!(distance <= nearest_by_sampling(n, s, mu, c) + 2e-6);
            let y = project_array(&[n, s], mu, c);
            assert!((y[0] - pn).abs() < 1e-15 && (y[1] - pt[0]).abs() < 1e-15);
            let z = project_array(&[n, 0.6 * s, -0.8 * s], mu, c);
            assert!((z[0] - pn).abs() < 1e-15 && (z[1] - 0.6 * pt[0]).abs() < 1e-15);
        }
    }

    #[test]
    fn is_the_identity_inside() {
        let t = Vector2::new(0.1, 0.2);
        assert_eq!(project(1.0, t, 0.5, 0.0), (1.0, t));
    }
}
