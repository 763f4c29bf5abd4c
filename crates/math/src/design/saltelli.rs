//! The points from which Sobol's sensitivity indices are estimated.
//!
//! Two independent sets A and B of n points (here halves of a scrambled Sobol sequence of twice the
//! dimension), and for each factor i the set A_B^(i): the points of A with the coordinate i of B.
//! Saltelli et al., Comput. Phys. Commun. 181 (2010) 259.
//! [`sobol_indices`](crate::sensitivity::sobol_indices::sobol_indices) takes the outputs in the
//! order of the rows.

use super::{DesignError, sobol::sobol};

/// Returns the number of rows of one base point: A, one per factor, B.
pub fn rows_per_base(factors: usize) -> usize {
    factors + 2
}

/// Returns the `bases` x (`factors` + 2) points in [0, 1)^`factors`. Row i (k + 2) is A_i, the next
/// k are A_B^(1)_i to A_B^(k)_i, the last is B_i. A larger number of base points from the same seed
/// begins with these rows. The number should be a power of two.
///
/// # Errors
///
/// There are more than [`MAX_POINTS`](super::sobol::MAX_POINTS) base points, or more than 128
/// factors.
pub fn saltelli(bases: usize, factors: usize, seed: u64) -> Result<Vec<Vec<f64>>, DesignError> {
    Ok(saltelli_from(&sobol(bases, 2 * factors, seed)?))
}

/// Returns Saltelli's rows from given base points, each of which has the coordinates of A, then
/// those of B.
pub fn saltelli_from(bases: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut rows = Vec::new();
    for both in bases {
        let (a, b) = both.split_at(both.len() / 2);
        rows.push(a.to_vec());
        for (i, other) in b.iter().enumerate().take(a.len()) {
            let mut mixed = a.to_vec();
            mixed[i] = *other;
            rows.push(mixed);
        }
        rows.push(b.to_vec());
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_coordinate_of_b_at_a_time() {
        let (n, k) = (16, 3);
        let rows = saltelli(n, k, 4).unwrap();
        assert_eq!(rows.len(), n * (k + 2));
        for group in rows.chunks(rows_per_base(k)) {
            let (a, b) = (&group[0], &group[k + 1]);
            for i in 0..k {
                for j in 0..k {
                    let from = if i == j { b } else { a };
                    assert_eq!(group[1 + i][j], from[j]);
                }
                assert_ne!(a[i], b[i]);
            }
        }
        assert_eq!(saltelli(8, k, 4).unwrap(), rows[..8 * (k + 2)]);
        assert!(saltelli(8, 129, 4).is_err());
    }
}
