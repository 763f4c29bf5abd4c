//! Linear systems given by rows: dense if small, sparse otherwise, both by `faer`.

use faer::linalg::solvers::{PartialPivLu, Solve, SolveCore};
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut};

/// A matrix in compressed rows with increasing columns.
#[derive(Clone, Debug, Default)]
pub struct SparseRows {
    /// Start of each row, and the end of the last.
    pub starts: Vec<usize>,
    /// Columns.
    pub columns: Vec<usize>,
    /// Values.
    pub values: Vec<f64>,
}

/// Maximum number of unknowns for which a dense factorisation is faster.
const DENSE: usize = 120;
/// Share of entries from which it is faster at any size: the factors would be full.
const FULL: f64 = 0.3;

/// A factorised matrix.
pub enum Factor {
    /// Dense.
    Dense(PartialPivLu<f64>),
    /// Sparse; the transpose is factorised.
    Sparse(Box<Lu<usize, f64>>),
}

impl Factor {
    /// Computes an LU factorisation with partial pivoting; `None` where the matrix is singular or
    /// not finite.
    pub fn new(a: &SparseRows) -> Option<Self> {
        let n = a.starts.len() - 1;
        if a.values.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let share = a.values.len() as f64 / (n as f64 * n as f64);
        if n <= DENSE || share > FULL {
            let mut m = Mat::<f64>::zeros(n, n);
            for r in 0..n {
                for k in a.starts[r]..a.starts[r + 1] {
                    m[(r, a.columns[k])] += a.values[k];
                }
            }
            return Some(Self::Dense(m.partial_piv_lu()));
        }
        // The rows of A are the columns of its transpose.
        let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &a.starts, None, &a.columns);
        let transposed = SparseColMatRef::new(symbolic, &a.values);
        let symbolic = SymbolicLu::try_new(transposed.symbolic()).ok()?;
        let lu = Lu::try_new_with_symbolic(symbolic, transposed).ok()?;
        Some(Self::Sparse(Box::new(lu)))
    }

    /// Computes x = A^-1 x; returns whether it is finite.
    pub fn solve(&self, x: &mut [f64]) -> bool {
        let n = x.len();
        let mut m = MatMut::from_column_major_slice_mut(x, n, 1);
        match self {
            Self::Dense(lu) => lu.solve_in_place(m.as_mut()),
            Self::Sparse(lu) => lu.solve_transpose_in_place_with_conj(Conj::No, m.as_mut()),
        }
        x.iter().all(|x| x.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn solves_dense_and_sparse() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        for n in [3usize, 50, 700] {
            let mut a = SparseRows {
                starts: vec![0],
                ..SparseRows::default()
            };
            for r in 0..n {
                for c in 0..n {
                    if r == c || rng.random_range(0.0..1.0) < 4.0 / n as f64 {
                        a.columns.push(c);
                        a.values
                            .push(rng.random_range(-1.0..1.0) + 6.0 * f64::from(r == c));
                    }
                }
                a.starts.push(a.columns.len());
            }
            let x: Vec<f64> = (0..n).map(|_| rng.random_range(-1.0..1.0)).collect();
            let mut b: Vec<f64> = (0..n)
                .map(|r| {
                    (a.starts[r]..a.starts[r + 1])
                        .map(|k| a.values[k] * x[a.columns[k]])
                        .sum()
                })
                .collect();
            let factor = Factor::new(&a).expect("not singular");
            assert!(factor.solve(&mut b));
            let off = x
                .iter()
                .zip(&b)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(off < 1e-12, "{n} {off}");
        }
    }
}
