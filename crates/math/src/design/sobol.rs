//! The Sobol sequence with Owen's scrambling.
//!
//! Sobol', USSR Comput. Math. Math. Phys. 7 (1967) 86; direction numbers by Joe and Kuo, SIAM J.
//! Sci. Comput. 30 (2008) 2635; scrambling by Owen, Ann. Statist. 25 (1997) 1541, in the form of
//! Burley, J. Computer Graphics Techniques 9 (2020) 1. The scrambling makes means unbiased and
//! different seeds independent, and keeps the strata: of the first 2^m points one lies in each of
//! 2^m intervals of every coordinate, and so in the boxes of 2^m equal volumes of the first two.

use super::DesignError;

/// Largest number of points of a sequence.
pub const MAX_POINTS: usize = 1 << 16;

/// Largest number of dimensions of a sequence.
pub const MAX_DIMENSIONS: usize = sobol_burley::NUM_DIMENSIONS as usize;

/// Returns the first `points` points (rows) of the scrambled sequence in [0, 1)^`factors`, with 24
/// bits per coordinate. A larger number of points from the same seed begins with these. A power of
/// two has the best strata.
///
/// # Errors
///
/// There are more than [`MAX_POINTS`] points or [`MAX_DIMENSIONS`] factors.
pub fn sobol(points: usize, factors: usize, seed: u64) -> Result<Vec<Vec<f64>>, DesignError> {
    if points > MAX_POINTS || factors > MAX_DIMENSIONS {
        return Err(DesignError::Sobol {
            points,
            dimensions: factors,
            most_points: MAX_POINTS,
            most_dimensions: MAX_DIMENSIONS,
        });
    }
    let seed = folded(seed);
    let coordinate = |i: usize, d: usize| f64::from(sobol_burley::sample(i as u32, d as u32, seed));
    Ok((0..points)
        .map(|i| (0..factors).map(|d| coordinate(i, d)).collect())
        .collect())
}

/// Returns the 32 bits of a seed that the sequence uses: seeds below 2^32 are not changed.
fn folded(seed: u64) -> u32 {
    (seed ^ (seed >> 32)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_fill_the_strata() {
        for seed in [0, 1, 77, u64::MAX] {
            for exponent in [0, 3, 7] {
                let n = 1usize << exponent;
                let rows = sobol(n, 30, seed).unwrap();
                for factor in 0..30 {
                    let mut strata: Vec<usize> = rows
                        .iter()
                        .map(|r| (r[factor] * n as f64).floor() as usize)
                        .collect();
                    strata.sort_unstable();
                    assert_eq!(strata, (0..n).collect::<Vec<_>>(), "{seed} {factor}");
                }
            }
            // The first two coordinates are a net: each box of 4 x 16 has one of 64 points.
            let rows = sobol(64, 2, seed).unwrap();
            let mut boxes: Vec<usize> = rows
                .iter()
                .map(|r| (r[0] * 4.0) as usize * 16 + (r[1] * 16.0) as usize)
                .collect();
            boxes.sort_unstable();
            assert_eq!(boxes, (0..64).collect::<Vec<_>>());
        }
    }

    #[test]
    fn longer_sequences_begin_with_shorter_ones() {
        let long = sobol(300, 5, 9).unwrap();
        assert_eq!(sobol(100, 5, 9).unwrap(), long[..100]);
        assert_ne!(sobol(100, 5, 10).unwrap(), long[..100]);
    }

    /// The error of the mean of a smooth function falls faster than 1/sqrt(n): prod (1 + (u_i -
    /// 1/2)) has the mean 1 and, with independent points, the standard deviation
    /// sqrt((13/12)^5 - 1) = 0.70 per point, 0.0110 for 4096.
    #[test]
    fn integrates_better_than_independent_points() {
        for seed in 0..10 {
            let rows = sobol(4096, 5, seed).unwrap();
            let sum: f64 = rows
                .iter()
                .map(|r| r.iter().map(|u| u + 0.5).product::<f64>())
                .sum();
            assert!((sum / 4096.0 - 1.0).abs() < 0.0011, "{seed}: {sum}");
        }
    }

    #[test]
    fn says_its_limits() {
        let error = sobol(10, 1000, 0).unwrap_err().to_string();
        assert!(
            error.contains("at most 65536 points in 256 dimensions"),
            "{error}"
        );
    }
}
