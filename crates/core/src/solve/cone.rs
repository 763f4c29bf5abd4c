//! The set of admissible impulses of one contact and the projection onto it.

use crate::geometry::space::VectorLike;
use std::hint::select_unpredictable;

/// Projects onto { (P, t) : P >= 0, |t| <= mu P + c }: Coulomb's cone (c = 0) or Tresca's cylinder (mu = 0),
/// where P = p_n + h c_n and c = h c_t. Returns the nearest point (Euclidean).
#[inline]
pub fn project<T: VectorLike>(normal: f64, tangent: T, mu: f64, c: f64) -> (f64, T) {
    if T::N == 1 {
        let (n, bound) = nearest(normal, tangent[0].abs(), mu, c);
        let t = select_unpredictable(bound < 0.0, tangent[0], bound.copysign(tangent[0]));
        return (n, T::from_slice(&[t]));
    }
    let length = tangent.dot(&tangent).sqrt();
    let (n, bound) = nearest(normal, length, mu, c);
    (n, tangent * share(bound, length))
}

/// Projects (P, t...) given as an array; see [`project`].
#[inline(always)]
pub fn project_array<const D: usize>(z: &[f64; D], mu: f64, c: f64) -> [f64; D] {
    if D == 2 {
        let (n, bound) = nearest(z[0], z[1].abs(), mu, c);
        let t = select_unpredictable(bound < 0.0, z[1], bound.copysign(z[1]));
        return std::array::from_fn(|k| if k == 0 { n } else { t });
    }
    let mut squared = 0.0;
    for x in &z[1..] {
        squared += x * x;
    }
    let length = squared.sqrt();
    let (n, bound) = nearest(z[0], length, mu, c);
    let scale = share(bound, length);
    std::array::from_fn(|k| if k == 0 { n } else { z[k] * scale })
}

/// Returns P and |t| of the projection; |t| = -1 for a point inside. All cases are computed and one is
/// selected, because branches would be mispredicted too often.
#[inline(always)]
fn nearest(normal: f64, length: f64, mu: f64, c: f64) -> (f64, f64) {
    let inside = normal >= 0.0 && length <= mu * normal + c;
    let closest_point = (normal + mu * (length - c)) / (1.0 + mu * mu);
    let slides = length > c && closest_point > 0.0;
    let closest_point = select_unpredictable(slides, closest_point, 0.0);
    let bound = select_unpredictable(slides, mu * closest_point + c, length.min(c));
    (
        select_unpredictable(inside, normal, closest_point),
        select_unpredictable(inside, -1.0, bound),
    )
}

/// Returns the factor that limits a tangent of a given length to `bound`; 1 where it is inside.
#[inline(always)]
fn share(bound: f64, length: f64) -> f64 {
    let scale = select_unpredictable(length > 0.0, bound / length, 0.0);
    select_unpredictable(bound < 0.0, 1.0, scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Vector1, Vector2};
    use rand::{RngExt, SeedableRng};

    /// Brute-force projection over a fine sampling of the set.
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
