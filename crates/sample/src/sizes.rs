//! Grain size distributions, piecewise power laws of the radius.
//!
//! A distribution by mass is one by number with another exponent: in dimension D the mass of a
//! grain is proportional to r^D, so a density f(r) by mass is f(r) r^-D by number.

use rand::RngExt;
use rand::seq::SliceRandom;
use rand_pcg::Pcg64;

/// A number density c r^-exponent between two radii.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    low: f64,
    high: f64,
    exponent: f64,
    /// Cumulative fraction of the grains up to the end of this piece.
    until: f64,
}

/// A distribution of radii by number.
#[derive(Clone, Debug, PartialEq)]
pub struct Sizes(Vec<Piece>);

/// Integral of r^-exponent.
fn integral(low: f64, high: f64, exponent: f64) -> f64 {
    let e = 1.0 - exponent;
    if e.abs() < 1e-9 {
        (high / low).ln()
    } else {
        (high.powf(e) - low.powf(e)) / e
    }
}

impl Sizes {
    /// The distribution with a number density r^-exponent between two radii (m), positive and
    /// increasing.
    pub fn power(radius: (f64, f64), exponent: f64) -> Self {
        Self(vec![Piece {
            low: radius.0,
            high: radius.1,
            exponent,
            until: 1.0,
        }])
    }

    /// The distribution of a grading curve: increasing radii (m), and the mass fraction of smaller
    /// grains, from 0 to 1. Between two points the mass is uniform in the logarithm of the size, as
    /// grading curves are drawn.
    pub fn sieve(curve: &[(f64, f64)], dimension: usize) -> Self {
        let exponent = 1.0 + dimension as f64;
        let mut pieces = Vec::new();
        let mut total = 0.0;
        for pair in curve.windows(2) {
            let [(low, before), (high, after)] = [pair[0], pair[1]];
            if after > before {
                // Radii are divided by the largest one, since powers of small numbers underflow.
                let largest = curve[curve.len() - 1].0;
                let (a, b) = (low / largest, high / largest);
                total += (after - before) / (high / low).ln() * integral(a, b, exponent);
                pieces.push(Piece {
                    low,
                    high,
                    exponent,
                    until: total,
                });
            }
        }
        pieces.iter_mut().for_each(|p| p.until /= total);
        Self(pieces)
    }

    /// The radius (m) below which a given fraction of the grains lies.
    pub fn quantile(&self, share: f64) -> f64 {
        let mut before = 0.0;
        for (k, piece) in self.0.iter().enumerate() {
            if share <= piece.until || k + 1 == self.0.len() {
                let part = ((share - before) / (piece.until - before)).clamp(0.0, 1.0);
                return piece.quantile(part);
            }
            before = piece.until;
        }
        f64::NAN
    }

    /// The fraction of grains below a radius (m).
    pub fn share_below(&self, radius: f64) -> f64 {
        let mut before = 0.0;
        for piece in &self.0 {
            if radius < piece.high {
                if radius <= piece.low {
                    return before;
                }
                let part = integral(1.0, radius / piece.low, piece.exponent)
                    / integral(1.0, piece.high / piece.low, piece.exponent);
                return before + part * (piece.until - before);
            }
            before = piece.until;
        }
        1.0
    }

    /// Draws `count` radii (m), one from each of `count` equal quantile intervals, in random order.
    /// The sample's cumulative curve differs from the distribution's by at most one grain, while
    /// independent draws would differ by the square root of their number.
    pub fn draw(&self, count: usize, rng: &mut Pcg64) -> Vec<f64> {
        let mut radii: Vec<f64> = (0..count)
            .map(|k| self.quantile((k as f64 + rng.random_range(0.0..1.0)) / count as f64))
            .collect();
        radii.shuffle(rng);
        radii
    }
}

impl Piece {
    fn quantile(&self, part: f64) -> f64 {
        let ratio = self.high / self.low;
        let e = 1.0 - self.exponent;
        let grown = if e.abs() < 1e-9 {
            ratio.powf(part)
        } else {
            (1.0 + part * (ratio.powf(e) - 1.0)).powf(1.0 / e)
        };
        (self.low * grown).clamp(self.low, self.high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    /// Largest distance between a weighted sample's cumulative curve and a given one.
    fn kolmogorov(
        mut radii: Vec<f64>,
        weight: impl Fn(f64) -> f64,
        curve: impl Fn(f64) -> f64,
    ) -> f64 {
        radii.sort_by(f64::total_cmp);
        let total: f64 = radii.iter().map(|r| weight(*r)).sum();
        let (mut below, mut worst) = (0.0, 0.0f64);
        for r in radii {
            let expected = curve(r);
            worst = worst.max((expected - below / total).abs());
            below += weight(r);
            worst = worst.max((expected - below / total).abs());
        }
        worst
    }

    /// Each quantile interval has one grain, so the curve by number differs from the exact one by
    /// at most 1/n, and the curve by mass by at most twice the mass difference of the heaviest and
    /// the lightest grain over the total mass.
    #[test]
    fn samples_follow_their_distribution_by_number_and_by_mass() {
        let n = 4_000;
        let (a, b) = (1.0f64, 3.0f64);
        for d in [2usize, 3] {
            let dim = d as f64;
            let power = |q: f64| move |r: f64| integral(a, r.clamp(a, b), q) / integral(a, b, q);
            for (exponent, by_mass) in [(0.0, false), (2.7, false), (dim, true), (1.5 + dim, true)]
            {
                let sizes = Sizes::power((a, b), exponent);
                let radii = sizes.draw(n, &mut Pcg64::seed_from_u64(3));
                let off = kolmogorov(radii.clone(), |_| 1.0, power(exponent));
                assert!(off <= 1.0 / n as f64 + 1e-12, "{exponent}: {off}");
                let mean = radii.iter().map(|r| r.powi(d as i32)).sum::<f64>() / n as f64;
                let bound = 2.0 * (b.powi(d as i32) - a.powi(d as i32)) / (n as f64 * mean);
                let by = |r: f64| r.powi(d as i32);
                let off = kolmogorov(radii.clone(), by, power(exponent - dim));
                assert!(off <= bound, "{exponent} by mass: {off} of {bound}");
                // The curves by mass and by number differ clearly.
                if by_mass {
                    assert!(kolmogorov(radii, |_| 1.0, power(exponent - dim)) > 0.05);
                }
            }
        }
    }

    /// The error is compared with that of independent draws from one generator, for which the
    /// Kolmogorov-Smirnov bound of 1.95/sqrt(n) holds for 999 of 1000 samples (Smirnov 1948).
    #[test]
    fn quantiles_invert_the_curve() {
        let curve = [(1e-3, 0.0), (2e-3, 0.2), (4e-3, 0.2), (8e-3, 1.0)];
        for d in [2usize, 3] {
            let sizes = Sizes::sieve(&curve, d);
            let mut rng = Pcg64::seed_from_u64(11);
            let n = 5_000;
            let radii: Vec<f64> = (0..n)
                .map(|_| sizes.quantile(rng.random_range(0.0..1.0)))
                .collect();
            let off = kolmogorov(radii, |_| 1.0, |r| sizes.share_below(r));
            assert!(off < 1.95 / f64::from(n).sqrt(), "{off}");
        }
    }

    #[test]
    fn a_sample_passes_the_sieves_it_was_given() {
        let curve = [(1e-3, 0.0), (2e-3, 0.2), (4e-3, 0.2), (8e-3, 1.0)];
        for d in [2usize, 3] {
            let radii = Sizes::sieve(&curve, d).draw(20_000, &mut Pcg64::seed_from_u64(5));
            let weight = |r: f64| r.powi(d as i32);
            let total: f64 = radii.iter().map(|r| weight(*r)).sum();
            for (sieve, passing) in curve {
                let through: f64 = radii
                    .iter()
                    .filter(|r| **r <= sieve)
                    .map(|r| weight(*r))
                    .sum();
                let bound = 2.0 * weight(8e-3) / total;
                assert!((through / total - passing).abs() <= bound, "{d}: {sieve}");
            }
            assert!(!radii.iter().any(|r| *r > 2e-3 * (1.0 + 1e-12) && *r < 4e-3));
        }
    }
}
