//! Latin hypercubes: each coordinate of n points has one value in each of n intervals of the same
//! length.
//!
//! McKay, Beckman, Conover: A comparison of three methods for selecting values of input variables
//! in the analysis of output from a computer code, Technometrics 21 (1979) 239. The choice by the
//! smallest distance is that of Johnson, Moore, Ylvisaker: Minimax and maximin distance designs, J.
//! Statistical Planning and Inference 26 (1990) 131.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Returns a Latin hypercube of `points` points (rows) in [0, 1)^`factors`, random within the
/// intervals.
pub fn latin_hypercube(points: usize, factors: usize, seed: u64) -> Vec<Vec<f64>> {
    draw(points, factors, &mut Pcg64::seed_from_u64(seed))
}

/// Returns the one of `tries` Latin hypercubes (at least one) whose closest two points are farthest
/// apart. The first try is that of [`latin_hypercube`]. The time is proportional to `tries` x
/// `points`^2 x `factors`.
pub fn maximin_latin_hypercube(
    points: usize,
    factors: usize,
    seed: u64,
    tries: usize,
) -> Vec<Vec<f64>> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut best = draw(points, factors, &mut rng);
    let mut widest = least_distance_squared(&best);
    for _ in 1..tries {
        let other = draw(points, factors, &mut rng);
        let distance = least_distance_squared(&other);
        if distance > widest {
            (best, widest) = (other, distance);
        }
    }
    best
}

fn draw(points: usize, factors: usize, rng: &mut Pcg64) -> Vec<Vec<f64>> {
    let mut rows = vec![Vec::with_capacity(factors); points];
    let mut strata: Vec<usize> = (0..points).collect();
    for _ in 0..factors {
        strata.shuffle(rng);
        for (row, &stratum) in rows.iter_mut().zip(&strata) {
            let within: f64 = rng.random();
            // The sum may round up to the next interval.
            let value = (stratum as f64 + within) / points as f64;
            let end = (stratum + 1) as f64 / points as f64;
            row.push(value.min(end.next_down()));
        }
    }
    rows
}

/// Returns the smallest squared distance of two of the points; infinite for fewer than two.
fn least_distance_squared(rows: &[Vec<f64>]) -> f64 {
    let squared =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum() };
    let mut least = f64::INFINITY;
    for (i, a) in rows.iter().enumerate() {
        for b in &rows[..i] {
            least = least.min(squared(a, b));
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_latin(rows: &[Vec<f64>]) {
        let points = rows.len();
        for factor in 0..rows[0].len() {
            let mut strata: Vec<usize> = rows
                .iter()
                .map(|r| (r[factor] * points as f64).floor() as usize)
                .collect();
            strata.sort_unstable();
            assert_eq!(strata, (0..points).collect::<Vec<_>>());
        }
    }

    #[test]
    fn one_point_in_each_interval_of_each_factor() {
        for (points, factors) in [(1, 3), (7, 2), (50, 6)] {
            assert_latin(&latin_hypercube(points, factors, 3));
            assert_latin(&maximin_latin_hypercube(points, factors, 3, 5));
        }
        assert!(latin_hypercube(0, 2, 1).is_empty());
    }

    #[test]
    fn follows_from_the_seed() {
        assert_eq!(latin_hypercube(20, 3, 5), latin_hypercube(20, 3, 5));
        assert_ne!(latin_hypercube(20, 3, 5), latin_hypercube(20, 3, 6));
        assert_eq!(
            maximin_latin_hypercube(20, 3, 5, 1),
            latin_hypercube(20, 3, 5)
        );
    }

    /// The maximum over more tries is not smaller, and over many it is larger.
    #[test]
    fn more_tries_spread_the_points() {
        let distance = |tries| least_distance_squared(&maximin_latin_hypercube(12, 2, 1, tries));
        assert!(distance(10) >= distance(1));
        assert!(distance(1000) > 2.0 * distance(1));
    }

    /// The mean of a sum of functions of one factor has a far smaller error than by independent
    /// points (Stein, Technometrics 29 (1987) 143): within a stratum u^2 has the variance (2 u /
    /// n)^2 / 12, so that the mean over n has the standard deviation n^(-3/2) / 3, 0.0006 for three
    /// factors and n = 100; by independent points it is 0.05.
    #[test]
    fn means_of_additive_functions_are_accurate() {
        for seed in 0..20 {
            let rows = latin_hypercube(100, 3, seed);
            let mean = rows
                .iter()
                .map(|r| r.iter().map(|u| u * u).sum::<f64>())
                .sum::<f64>()
                / 100.0;
            assert!((mean - 1.0).abs() < 0.003, "{mean}");
        }
    }
}
