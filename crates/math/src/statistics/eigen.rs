//! Eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations.
//!
//! Golub, Van Loan, Matrix Computations, section 8.5. Slower than other methods for large matrices,
//! but accurate, short, and made of sums, products and square roots alone, so that the result has
//! the same bits on all machines. A library that chooses instructions at run time for products of
//! larger matrices does not guarantee this.

use nalgebra::DMatrix;

/// Upper limit of the rounds over all pairs of rows; large matrices usually need about ten.
const MAX_ROUNDS: usize = 60;

/// Returns the eigenvalues (n), unsorted, and the eigenvectors as columns (n x n) in their order.
pub(crate) fn eigen(symmetric: &DMatrix<f64>) -> (Vec<f64>, DMatrix<f64>) {
    let n = symmetric.nrows();
    let mut a = symmetric.clone();
    let mut vectors = DMatrix::identity(n, n);
    for _ in 0..MAX_ROUNDS {
        let mut turned = false;
        for p in 0..n {
            for q in p + 1..n {
                let size = (a[(p, p)] * a[(q, q)]).abs().sqrt();
                if a[(p, q)].abs() > f64::EPSILON * size {
                    rotate(&mut a, &mut vectors, p, q);
                    turned = true;
                }
            }
        }
        if !turned {
            break;
        }
    }
    ((0..n).map(|i| a[(i, i)]).collect(), vectors)
}

/// Rotates `a` in the plane of axes p and q so that a_pq vanishes, and `vectors` with it.
fn rotate(a: &mut DMatrix<f64>, vectors: &mut DMatrix<f64>, p: usize, q: usize) {
    let n = a.nrows();
    let half = (a[(q, q)] - a[(p, p)]) / (2.0 * a[(p, q)]);
    let t = half.signum() / (half.abs() + (1.0 + half * half).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = t * c;
    let change = t * a[(p, q)];
    a[(p, p)] -= change;
    a[(q, q)] += change;
    a[(p, q)] = 0.0;
    a[(q, p)] = 0.0;
    for k in 0..n {
        if k != p && k != q {
            let (x, y) = (a[(k, p)], a[(k, q)]);
            let (x, y) = (c * x - s * y, s * x + c * y);
            a[(k, p)] = x;
            a[(p, k)] = x;
            a[(k, q)] = y;
            a[(q, k)] = y;
        }
        let (x, y) = (vectors[(k, p)], vectors[(k, q)]);
        vectors[(k, p)] = c * x - s * y;
        vectors[(k, q)] = s * x + c * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::random::normal;
    use rand::SeedableRng;

    /// V diag V^T is the matrix and V is orthogonal, for condition numbers up to 1e12.
    #[test]
    fn reconstructs_the_matrix() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        for n in [1, 2, 5, 12] {
            let stretch = |i: usize| 10f64.powf(-6.0 * i as f64 / n as f64);
            let root = DMatrix::from_fn(n, n, |i, _| stretch(i) * normal(&mut rng));
            let matrix = &root * root.transpose();
            let (values, vectors) = eigen(&matrix);
            let back = &vectors * DMatrix::from_diagonal(&values.into()) * vectors.transpose();
            assert!((back - &matrix).norm() < 1e-13 * matrix.norm());
            let unit = vectors.tr_mul(&vectors) - DMatrix::identity(n, n);
            assert!(unit.norm() < 1e-13);
        }
    }

    /// [[2, 1], [1, 2]] has the eigenvalues 1 and 3; the singular matrix of ones has 0, 0 and 3.
    #[test]
    fn known_values() {
        let sorted = |m: &DMatrix<f64>| {
            let mut values = eigen(m).0;
            values.sort_by(f64::total_cmp);
            values
        };
        let values = sorted(&DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]));
        assert!((values[0] - 1.0).abs() < 1e-15 && (values[1] - 3.0).abs() < 1e-15);
        let values = sorted(&DMatrix::from_element(3, 3, 1.0));
        assert!(values[0].abs() < 1e-15 && (values[2] - 3.0).abs() < 1e-14);
    }
}
