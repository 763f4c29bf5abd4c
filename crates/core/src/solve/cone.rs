//! The set of admissible impulses of one contact and the projection onto it.

use crate::lanes::{Lane, LaneVector};

/// Projects onto { (P, t) : P >= 0, |t| <= mu P + c }: Coulomb's cone (c = 0) or Tresca's cylinder
/// (mu = 0), where P = p_n + h c_n and c = h c_t. Returns the nearest point (Euclidean).
#[inline(always)]
pub fn project<L: Lane, T: LaneVector<L>>(normal: L, tangent: T, mu: L, c: L) -> (L, T) {
    let length = tangent.norm();
    let nearest = NearestImpulse::new(normal, length, mu, c);
    let t = if T::N == 1 {
        let on = T::from_fn(|k| nearest.bound.with_sign_of(tangent[k]));
        T::select(nearest.inside, tangent, on)
    } else {
        tangent * nearest.share(length)
    };
    (nearest.normal, t)
}

/// Projects (P, t...) given as an array; see [`project`].
#[inline(always)]
pub fn project_array<const D: usize>(z: &[f64; D], mu: f64, c: f64) -> [f64; D] {
    if D == 2 {
        let nearest = NearestImpulse::new(z[0], z[1].abs(), mu, c);
        let on = nearest.bound.copysign(z[1]);
        let t = f64::select(nearest.inside, z[1], on);
        return std::array::from_fn(|k| if k == 0 { nearest.normal } else { t });
    }
    let mut squared = 0.0;
    for x in &z[1..] {
        squared += x * x;
    }
    let length = squared.sqrt();
    let nearest = NearestImpulse::new(z[0], length, mu, c);
    let share = nearest.share(length);
    std::array::from_fn(|k| if k == 0 { nearest.normal } else { z[k] * share })
}

/// A projected point: whether the given point was inside, its P, and |t| where it was outside. All
/// cases are computed and one is selected, because branches would be mispredicted too often.
struct NearestImpulse<L: Lane> {
    inside: L::Mask,
    normal: L,
    bound: L,
}

impl<L: Lane> NearestImpulse<L> {
    #[inline(always)]
    fn new(normal: L, length: L, mu: L, c: L) -> Self {
        let (zero, one) = (L::all(0.0), L::all(1.0));
        let inside = normal.at_least(zero) & length.at_most(mu * normal + c);
        let closest_point = (normal + mu * (length - c)) / (one + mu * mu);
        let slides = length.above(c) & closest_point.above(zero);
        let closest_point = L::select(slides, closest_point, zero);
        Self {
            inside,
            normal: L::select(inside, normal, closest_point),
            bound: L::select(slides, mu * closest_point + c, length.least(c)),
        }
    }

    /// Returns the factor that limits a tangent of this length.
    #[inline(always)]
    fn share(&self, length: L) -> L {
        let (zero, one) = (L::all(0.0), L::all(1.0));
        let scale = L::select(length.above(zero), self.bound / length, zero);
        L::select(self.inside, one, scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::LaneArray;
    use rand::{RngExt, SeedableRng};

    /// Projects by brute force over a fine sampling of the set.
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
            let (pn, pt) = project(n, LaneArray([s]), mu, c);
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
        let t = LaneArray([0.1, 0.2]);
        assert_eq!(project(1.0, t, 0.5, 0.0), (1.0, t));
    }
}
