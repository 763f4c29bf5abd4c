//! Symmetric sparse matrices, and their Cholesky factors by `faer`.

use crate::panels::Panels;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymbolicCholeskyRaw, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A symmetric matrix in compressed rows, both triangles stored, columns in increasing order.
#[derive(Clone, Debug, Default)]
pub struct Sparse {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Sparse {
    /// Builds the matrix from entries (row, column, value); entries with the same indices are added
    /// in their order.
    pub fn from_entries(rows: usize, entries: impl Iterator<Item = (usize, usize, f64)>) -> Self {
        let mut by_row: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); rows];
        for (row, column, value) in entries {
            *by_row[row].entry(column).or_default() += value;
        }
        let mut out = Self {
            starts: vec![0],
            ..Self::default()
        };
        for row in by_row {
            for (column, value) in row {
                out.columns.push(column as u32);
                out.values.push(value);
            }
            out.starts.push(out.columns.len() as u32);
        }
        out
    }

    /// Number of rows.
    fn rows(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Returns the pattern for `faer`; rows of a symmetric matrix are its columns.
    fn pattern(&self) -> SymbolicSparseColMatRef<'_, u32> {
        let n = self.rows();
        SymbolicSparseColMatRef::new_checked(n, n, &self.starts, None, &self.columns)
    }

    /// Returns the range of the entries of a row.
    fn range(&self, row: usize) -> std::ops::Range<usize> {
        self.starts[row] as usize..self.starts[row + 1] as usize
    }

    /// Iterates over the entries of a row, by column.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.range(row);
        let columns = self.columns[range.clone()].iter().map(|c| *c as usize);
        columns.zip(self.values[range].iter().copied())
    }

    /// The product with a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let row = |r: usize| {
            let range = self.range(r);
            let (columns, values) = (&self.columns[range.clone()], &self.values[range]);
            // Two sums avoid that one addition waits for the previous one.
            let mut sums = [0.0; 2];
            let (pairs, of) = (columns.chunks_exact(2), values.chunks_exact(2));
            if let ([c], [a]) = (pairs.remainder(), of.remainder()) {
                sums[0] = a * x[*c as usize];
            }
            for (c, a) in pairs.zip(of) {
                sums[0] += a[0] * x[c[0] as usize];
                sums[1] += a[1] * x[c[1] as usize];
            }
            sums[0] + sums[1]
        };
        (0..self.rows()).map(row).collect()
    }

    /// Returns x . A x.
    pub fn form(&self, x: &[f64]) -> f64 {
        let product = self.times(x);
        product.iter().zip(x).map(|(a, b)| a * b).sum()
    }

    /// Returns the index of an entry among the values; `None` outside the pattern.
    pub fn slot(&self, row: usize, column: usize) -> Option<usize> {
        let range = self.range(row);
        let within = self.columns[range.clone()].binary_search(&(column as u32));
        let within = within.ok()?;
        Some(range.start + within)
    }

    /// Returns a matrix of the same pattern with other values, as many as [`Self::values`] has.
    pub fn with_values(&self, values: Vec<f64>) -> Self {
        Self {
            starts: self.starts.clone(),
            columns: self.columns.clone(),
            values,
        }
    }

    /// Returns all entries, row by row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns its memory (bytes).
    pub fn bytes(&self) -> usize {
        size_of_val(&self.starts[..])
            + size_of_val(&self.columns[..])
            + size_of_val(&self.values[..])
    }

    /// The first `n` rows and columns times `scale`, plus a diagonal.
    pub fn leading(&self, n: usize, scale: f64, diagonal: &[f64]) -> Self {
        let mut out = Self {
            starts: vec![0],
            ..Self::default()
        };
        for (r, added) in diagonal.iter().enumerate().take(n) {
            let mut put = false;
            for (c, a) in self.row(r).filter(|(c, _)| *c < n) {
                if c > r && !put {
                    out.columns.push(r as u32);
                    out.values.push(*added);
                    put = true;
                }
                out.columns.push(c as u32);
                out.values
                    .push(scale * a + if c == r { *added } else { 0.0 });
                put |= c == r;
            }
            if !put {
                out.columns.push(r as u32);
                out.values.push(*added);
            }
            out.starts.push(out.columns.len() as u32);
        }
        out
    }
}

/// The Cholesky factor of a positive definite matrix; by default that of one without rows.
#[derive(Clone, Debug, Default)]
pub struct Factor {
    pattern: Pattern,
    values: Vec<f64>,
}

/// The pattern of a matrix with the order of elimination, shared by the factors of several
/// matrices.
#[derive(Clone, Debug, Default)]
pub struct Pattern {
    /// Order of elimination; `None` without rows.
    order: Option<Arc<Order>>,
}

/// An order of elimination, and the pattern of the factor.
#[derive(Debug)]
struct Order {
    symbolic: SymbolicCholesky<u32>,
    /// Panels by which solutions traverse a factor whose columns share few rows; `None` for a
    /// factor that `faer` keeps as dense blocks.
    panels: Option<Panels>,
}

impl Order {
    fn of(a: &Sparse) -> Option<Self> {
        let (order, params) = Default::default();
        let symbolic = factorize_symbolic_cholesky(a.pattern(), Side::Lower, order, params).ok()?;
        let panels = match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(columns) => {
                Some(Panels::new(columns.col_ptr(), columns.row_idx())?)
            }
            SymbolicCholeskyRaw::Supernodal(_) => None,
        };
        Some(Self { symbolic, panels })
    }

    /// Row of the matrix for each row of the factor, in the order of elimination.
    fn rows(&self) -> Option<&[u32]> {
        Some(self.symbolic.perm()?.arrays().0)
    }
}

impl Pattern {
    /// Finds the pattern of a matrix; `None` if it has too many entries.
    pub fn of(a: &Sparse) -> Option<Self> {
        let order = (a.rows() > 0).then(|| Order::of(a).map(Arc::new));
        match order {
            Some(None) => None,
            order => Some(Self {
                order: order.flatten(),
            }),
        }
    }

    /// Factorises a matrix of this pattern; `None` where it is not positive definite.
    pub fn factor(&self, a: &Sparse) -> Option<Factor> {
        let pattern = self.clone();
        let Some(order) = &self.order else {
            let values = Vec::new();
            return Some(Factor { pattern, values });
        };
        if !a.values.iter().all(|x| x.is_finite()) {
            return None;
        }
        let matrix = SparseColMatRef::new(a.pattern(), &a.values[..]);
        let symbolic = &order.symbolic;
        let mut values = vec![0.0; symbolic.len_val()];
        let needed = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let mut memory = MemBuffer::new(needed);
        let factor = symbolic.factorize_numeric_llt(
            &mut values,
            matrix,
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Spec::default(),
        );
        factor.ok()?;
        if let (Some(panels), SymbolicCholeskyRaw::Simplicial(columns)) =
            (&order.panels, symbolic.raw())
        {
            values = panels.arrange(columns.col_ptr(), &values);
        }
        Some(Factor { pattern, values })
    }
}

/// Size of a factor, known without factorising.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FactorSize {
    /// Memory of its values and of its pattern (bytes).
    pub bytes: usize,
    /// Floating-point operations of a factorisation.
    pub factorise: f64,
    /// Operations of a solution.
    pub solve: f64,
}

impl FactorSize {
    /// Computes the size for a matrix, with the order of elimination that [`Pattern::of`] uses;
    /// `None` if it has too many entries.
    pub fn of(a: &Sparse) -> Option<Self> {
        if a.rows() == 0 {
            return Some(Self::default());
        }
        let Order { symbolic, panels } = Order::of(a)?;
        let values = symbolic.len_val();
        let mut factorise = 0.0;
        // A column with k entries on and below the diagonal takes k^2.
        let bytes = match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(columns) => {
                for ends in columns.col_ptr().windows(2) {
                    factorise += ((ends[1] - ends[0]) as f64).powi(2);
                }
                let columns = columns.row_idx().len() + columns.col_ptr().len();
                panels.map_or(0, |panels| panels.bytes()) + columns * size_of::<u32>()
            }
            SymbolicCholeskyRaw::Supernodal(blocks) => {
                for k in 0..blocks.n_supernodes() {
                    let below = blocks.supernode(k).pattern().len();
                    let columns = blocks.supernode_end()[k] - blocks.supernode_begin()[k];
                    for c in 1..=columns {
                        factorise += ((c as usize + below) as f64).powi(2);
                    }
                }
                // These are the rows of all blocks, the blocks of all rows, and start and end of
                // each block.
                let indices = 2 * blocks.row_idx().len() + 6 * blocks.n_supernodes();
                values * size_of::<f64>() + indices * size_of::<u32>()
            }
        };
        Some(Self {
            // The order of elimination and its inverse are added.
            bytes: bytes + 2 * a.rows() * size_of::<u32>(),
            factorise,
            solve: 4.0 * values as f64,
        })
    }
}

impl Factor {
    /// Factorises; `None` where the matrix is not positive definite.
    pub fn new(a: &Sparse) -> Option<Self> {
        Pattern::of(a)?.factor(a)
    }

    /// Computes x = A^-1 x for a number of columns that `x` holds one after the other.
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        let Some(order) = &self.pattern.order else {
            return;
        };
        let rows = x.len() / columns;
        let Some(panels) = &order.panels else {
            let symbolic = &order.symbolic;
            let mut memory =
                MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq));
            let factor = LltRef::new(symbolic, &self.values);
            let matrix = MatMut::from_column_major_slice_mut(x, rows, columns);
            factor.solve_in_place_with_conj(Conj::No, matrix, Par::Seq, MemStack::new(&mut memory));
            return;
        };
        let Some(order) = order.rows() else {
            let all = x.chunks_exact_mut(rows);
            return all.for_each(|x| panels.solve(&self.values, x));
        };
        let mut eliminated = vec![0.0; rows];
        for x in x.chunks_exact_mut(rows) {
            for (of, row) in eliminated.iter_mut().zip(order) {
                *of = x[*row as usize];
            }
            panels.solve(&self.values, &mut eliminated);
            for (of, row) in eliminated.iter().zip(order) {
                x[*row as usize] = *of;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the Laplacian of a grid with several coupled unknowns at each point, as for a mesh,
    /// plus a diagonal.
    fn coupled_grid(cells: [usize; 3], unknowns: usize) -> Sparse {
        let [nx, ny, nz] = cells;
        let at = |i: usize, j: usize, k: usize| (k * ny + j) * nx + i;
        let mut pairs = Vec::new();
        for (k, j, i) in
            (0..nz).flat_map(|k| (0..ny).flat_map(move |j| (0..nx).map(move |i| (k, j, i))))
        {
            for (di, dj, dk) in [(1, 0, 0), (0, 1, 0), (0, 0, 1)] {
                if i + di < nx && j + dj < ny && k + dk < nz {
                    pairs.push((at(i, j, k), at(i + di, j + dj, k + dk)));
                }
            }
        }
        let block = |a: usize, b: usize| if a == b { 1.0 } else { 0.2 };
        let entries = pairs.into_iter().flat_map(|(p, q)| {
            (0..unknowns * unknowns).flat_map(move |ab| {
                let (a, b) = (ab / unknowns, ab % unknowns);
                let (p, q) = (unknowns * p, unknowns * q);
                let value = block(a, b);
                [
                    (p + a, p + b, value),
                    (q + a, q + b, value),
                    (p + a, q + b, -value),
                    (q + a, p + b, -value),
                ]
            })
        });
        let n = unknowns * nx * ny * nz;
        Sparse::from_entries(n, entries).leading(n, 1.0, &vec![0.05; n])
    }

    /// Panels of one to four columns give the solution of the matrix, in the plane and in space.
    #[test]
    fn factors_of_meshes_solve_by_panels_of_all_widths() {
        let mut widths = [0; 5];
        for (cells, unknowns) in [
            ([12, 9, 1], 1),
            ([14, 11, 1], 2),
            ([4, 3, 3], 3),
            ([20, 1, 1], 4),
        ] {
            let a = coupled_grid(cells, unknowns);
            let factor = Factor::new(&a).unwrap();
            let panels = factor.pattern.order.as_ref().unwrap().panels.as_ref();
            panels
                .unwrap()
                .widths()
                .for_each(|width| widths[width] += 1);
            let x: Vec<f64> = (0..a.rows()).map(|k| (1.3 * k as f64).sin()).collect();
            let mut b = a.times(&x);
            factor.solve(&mut b, 1);
            let off = b.iter().zip(&x).map(|(b, x)| (b - x).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12);
        }
        assert!(widths[1..].iter().all(|count| *count > 0), "{widths:?}");
    }

    #[test]
    fn factors_solve() {
        // The matrix is that of a chain of springs, and of a second one without mass at an end.
        let n = 200;
        let entries = (0..n - 1).flat_map(|k| {
            [
                (k, k, 1.0),
                (k + 1, k + 1, 1.0),
                (k, k + 1, -1.0),
                (k + 1, k, -1.0),
            ]
        });
        let k = Sparse::from_entries(n, entries);
        assert_eq!(k.form(&vec![3.0; n]), 0.0);
        let a = k.leading(n, 2.0, &vec![0.1; n]);
        let factor = Factor::new(&a).unwrap();
        let x: Vec<f64> = (0..n).map(|k| (k as f64).sin()).collect();
        let mut b = a.times(&x);
        b.extend(a.times(&vec![1.0; n]));
        factor.solve(&mut b, 2);
        for (k, x) in x.iter().enumerate() {
            assert!((b[k] - x).abs() < 1e-12 && (b[n + k] - 1.0).abs() < 1e-12);
        }
        // Free at both ends the matrix is singular; without the last node it is not.
        let singular = k.leading(n, 1.0, &vec![-1e-9; n]);
        assert!(Factor::new(&singular).is_none());
        assert!(Factor::new(&k.leading(n - 1, 1.0, &vec![0.0; n])).is_some());
    }
}
