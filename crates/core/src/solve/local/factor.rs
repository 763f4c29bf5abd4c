//! Factors of a square sparse matrix, one per connected component.
//!
//! The mass matrix of rigid bodies decomposes into blocks of 1 to 6 rows, which are factorised
//! densely with full pivoting; larger components use faer's sparse LU.

use super::Csr;
use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet, linalg::solvers::Lu as SparseLu};
use nalgebra::{DMatrix, Dyn, FullPivLU};

/// Components of at most this many rows are factorised densely.
const DENSE: usize = 64;

/// A singular component of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "it is numerically singular in the {rows} coupled rows that begin with row {first} (counted from 0)"
)]
pub struct Singular {
    /// First row of the singular component.
    pub first: usize,
    /// Number of rows of the component.
    pub rows: usize,
}

/// The factors of a matrix K.
pub struct Factors {
    components: Vec<Component>,
    size: usize,
}

impl std::fmt::Debug for Factors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factors")
            .field("size", &self.size)
            .field("components", &self.components.len())
            .finish()
    }
}

struct Component {
    /// Rows of the factor in K, increasing.
    rows: Vec<usize>,
    /// Scaling by powers of two: rows and columns are scaled to about one before the LU, so that a
    /// tiny pivot indicates a singular matrix, not small units.
    row_scale: Vec<f64>,
    column_scale: Vec<f64>,
    lu: Lu,
}

enum Lu {
    Dense(Box<FullPivLU<f64, Dyn, Dyn>>),
    Sparse(Box<SparseLu<usize, f64>>),
}

impl Factors {
    /// Factorises a square matrix.
    ///
    /// # Errors
    /// The matrix is numerically singular.
    ///
    /// # Panics
    /// Panics if the matrix is not square.
    pub fn new(k: &Csr) -> Result<Self, Singular> {
        assert_eq!(k.rows, k.columns, "a square matrix");
        let mut local = vec![0; k.rows];
        let mut components = Vec::new();
        for rows in linked(k) {
            for (place, row) in rows.iter().enumerate() {
                local[*row] = place;
            }
            components.push(Component::new(k, rows, &local)?);
        }
        Ok(Self {
            components,
            size: k.rows,
        })
    }

    /// Solves K x = b in place.
    pub fn solve(&self, b: &mut [f64]) {
        for component in &self.components {
            let mut x = DMatrix::from_fn(component.rows.len(), 1, |i, _| b[component.rows[i]]);
            component.solve(&mut x);
            for (i, row) in component.rows.iter().enumerate() {
                b[*row] = x[(i, 0)];
            }
        }
    }

    /// Returns an upper bound of the number of entries of [`Self::sandwich`].
    pub fn reach(&self, b: &Csr) -> usize {
        let squares = self.components.iter().map(|c| c.columns(b).len().pow(2));
        squares.fold(0, usize::saturating_add)
    }

    /// Returns B^T K^-1 B, a square matrix with one row per column of B. An entry is left out where
    /// every component contributes exactly zero.
    pub fn sandwich(&self, b: &Csr) -> Csr {
        let mut entries = Vec::new();
        for component in &self.components {
            let columns = component.columns(b);
            // Processes a few columns at a time, so that memory stays close to that of B and the
            // result.
            for part in columns.chunks(DENSE) {
                let mut x = DMatrix::zeros(component.rows.len(), part.len());
                for (i, row) in component.rows.iter().enumerate() {
                    for (c, value) in b.row(*row) {
                        if let Ok(k) = part.binary_search(&c) {
                            x[(i, k)] = value;
                        }
                    }
                }
                component.solve(&mut x);
                component.gather(b, part, &x, &columns, &mut entries);
            }
        }
        Csr::from_triplets(b.columns, b.columns, &entries)
    }
}

impl Component {
    fn new(k: &Csr, rows: Vec<usize>, local: &[usize]) -> Result<Self, Singular> {
        let size = rows.len();
        let singular = Singular {
            first: rows[0],
            rows: size,
        };
        let mut entries = Vec::new();
        for (i, row) in rows.iter().enumerate() {
            entries.extend(
                k.row(*row)
                    .filter(|(_, x)| *x != 0.0)
                    .map(|(c, x)| (i, local[c], x)),
            );
        }
        let row_scale = scales(size, entries.iter().map(|(i, _, x)| (*i, *x)));
        for (i, _, x) in &mut entries {
            *x *= row_scale[*i];
        }
        let column_scale = scales(size, entries.iter().map(|(_, j, x)| (*j, *x)));
        for (_, j, x) in &mut entries {
            *x *= column_scale[*j];
        }
        let rounding = 8.0 * size as f64 * f64::EPSILON;
        let lu = if size <= DENSE {
            let mut a = DMatrix::zeros(size, size);
            for (i, j, x) in entries {
                a[(i, j)] = x;
            }
            let lu = a.full_piv_lu();
            let u = lu.u();
            if (0..size).any(|i| u[(i, i)].is_nan() || u[(i, i)].abs() <= rounding) {
                return Err(singular);
            }
            Lu::Dense(Box::new(lu))
        } else {
            let triplets: Vec<_> = entries
                .iter()
                .map(|(i, j, x)| Triplet::new(*i, *j, *x))
                .collect();
            let a =
                SparseColMat::try_new_from_triplets(size, size, &triplets).map_err(|_| singular)?;
            let lu = a.sp_lu().map_err(|_| singular)?;
            // faer reports only structural singularity. Numerical singularity shows as a huge
            // solution or a large residual. The fixed right-hand side is not in the range of a
            // singular matrix, except by coincidence.
            let b: Vec<f64> = (0..size)
                .map(|i| ((i as u64 * 2_654_435_761) % 1009) as f64 / 1009.0 - 0.4)
                .collect();
            let mut x = faer::Mat::from_fn(size, 1, |i, _| b[i]);
            lu.solve_in_place(&mut x);
            let mut residual = b;
            let mut largest = 0.0f64;
            for (i, j, a) in &entries {
                residual[*i] -= a * x[(*j, 0)];
                largest = largest.max(x[(*j, 0)].abs());
            }
            let worst = residual.iter().fold(0.0f64, |w, r| w.max(r.abs()));
            let good = largest.is_finite() && largest < 1.0 / rounding && worst < 1e-6;
            if !good {
                return Err(singular);
            }
            Lu::Sparse(Box::new(lu))
        };
        Ok(Self {
            rows,
            row_scale,
            column_scale,
            lu,
        })
    }

    /// Returns the columns of B with an entry in the component's rows, increasing.
    fn columns(&self, b: &Csr) -> Vec<usize> {
        let mut columns: Vec<usize> = self
            .rows
            .iter()
            .flat_map(|r| b.row(*r).map(|(c, _)| c))
            .collect();
        columns.sort_unstable();
        columns.dedup();
        columns
    }

    /// Solves in place for every column.
    fn solve(&self, x: &mut DMatrix<f64>) {
        for mut column in x.column_iter_mut() {
            for (x, scale) in column.iter_mut().zip(&self.row_scale) {
                *x *= scale;
            }
        }
        match &self.lu {
            Lu::Dense(lu) => {
                // The LU found a pivot in every column, so that the solve cannot fail.
                lu.solve_mut(x);
            }
            Lu::Sparse(lu) => {
                let (rows, columns) = x.shape();
                let mut y = faer::Mat::from_fn(rows, columns, |i, j| x[(i, j)]);
                lu.solve_in_place(&mut y);
                for j in 0..columns {
                    for i in 0..rows {
                        x[(i, j)] = y[(i, j)];
                    }
                }
            }
        }
        for mut column in x.column_iter_mut() {
            for (x, scale) in column.iter_mut().zip(&self.column_scale) {
                *x *= scale;
            }
        }
    }

    /// Adds B^T x for the columns of B in `part`.
    fn gather(
        &self,
        b: &Csr,
        part: &[usize],
        x: &DMatrix<f64>,
        columns: &[usize],
        entries: &mut Vec<(u32, u32, f64)>,
    ) {
        let mut out = DMatrix::<f64>::zeros(columns.len(), part.len());
        for (i, row) in self.rows.iter().enumerate() {
            for (c, value) in b.row(*row) {
                if let Ok(at) = columns.binary_search(&c) {
                    for k in 0..part.len() {
                        out[(at, k)] += value * x[(i, k)];
                    }
                }
            }
        }
        for (k, column) in part.iter().enumerate() {
            for (at, row) in columns.iter().enumerate() {
                if out[(at, k)] != 0.0 {
                    entries.push((*row as u32, *column as u32, out[(at, k)]));
                }
            }
        }
    }
}

/// Returns, for each row or column, the power of two that scales its largest entry to between 1 and
/// 2; 1 for an empty one.
fn scales(count: usize, entries: impl Iterator<Item = (usize, f64)>) -> Vec<f64> {
    let mut largest = vec![0.0f64; count];
    for (line, x) in entries {
        largest[line] = largest[line].max(x.abs());
    }
    largest
        .into_iter()
        .map(|x| {
            if x > 0.0 && x.is_finite() {
                // Keeps the scale within the range of normal numbers.
                (-x.log2().floor().clamp(-1000.0, 1000.0)).exp2()
            } else {
                1.0
            }
        })
        .collect()
}

/// Returns the connected components: lists of rows, increasing, that are linked by entries on
/// either side of the diagonal.
fn linked(k: &Csr) -> Vec<Vec<usize>> {
    let mut parent: Vec<usize> = (0..k.rows).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for r in 0..k.rows {
        for (c, x) in k.row(r) {
            if x != 0.0 {
                let (a, b) = (root(&mut parent, r), root(&mut parent, c));
                parent[a.max(b)] = a.min(b);
            }
        }
    }
    let mut slots = vec![usize::MAX; k.rows];
    let mut out: Vec<Vec<usize>> = Vec::new();
    for i in 0..k.rows {
        let r = root(&mut parent, i);
        if slots[r] == usize::MAX {
            slots[r] = out.len();
            out.push(Vec::new());
        }
        out[slots[r]].push(i);
    }
    out
}
