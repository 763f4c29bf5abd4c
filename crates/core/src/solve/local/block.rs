//! The Delassus operator as a matrix of D x D blocks, with one block row per contact.

use super::csr::Csr;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// A block of W.
pub type Block<const D: usize> = [[f64; D]; D];

/// W by block rows with a separate diagonal, the layout used by Gauss-Seidel.
#[derive(Clone, Debug)]
pub struct BlockMatrix<const D: usize> {
    /// Diagonal blocks.
    pub diagonal: Vec<Block<D>>,
    starts: Vec<u32>,
    columns: Vec<u32>,
    /// Stored column by column, which shortens the dependency chains of the sums.
    blocks: Vec<f64>,
}

/// A x of a block.
#[inline(always)]
pub fn times<const D: usize>(a: &Block<D>, x: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| {
        let mut sum = 0.0;
        for j in 0..D {
            sum += a[i][j] * x[j];
        }
        sum
    })
}

/// u = W p + q for the vector instructions of this machine.
struct Product<'a, const D: usize>(
    &'a BlockMatrix<D>,
    &'a [[f64; D]],
    &'a [[f64; D]],
    &'a mut [[f64; D]],
);

impl<const D: usize> WithSimd for Product<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) {
        let Self(w, p, q, u) = self;
        for (c, u) in u.iter_mut().enumerate() {
            let own = times(&w.diagonal[c], &p[c]);
            *u = w.gather(c, p, std::array::from_fn(|k| q[c][k] + own[k]));
        }
    }
}

impl<const D: usize> BlockMatrix<D> {
    /// Creates a matrix with these diagonal blocks; [`Self::push`] and [`Self::end_row`] add the
    /// others.
    pub fn new(diagonal: Vec<Block<D>>) -> Self {
        Self {
            diagonal,
            starts: vec![0],
            columns: Vec::new(),
            blocks: Vec::new(),
        }
    }

    /// Adds a block to the current row, with increasing columns.
    pub fn push(&mut self, column: usize, block: &Block<D>) {
        self.columns.push(column as u32);
        for j in 0..D {
            self.blocks.extend(block.iter().map(|row| row[j]));
        }
    }

    /// Ends the current row.
    pub fn end_row(&mut self) {
        self.starts.push(self.columns.len() as u32);
    }

    /// Converts a matrix whose numbers of rows and columns are divisible by D; zero blocks are left
    /// out.
    pub fn from_csr(w: &Csr) -> Self {
        let count = w.rows / D;
        let mut out = Self::new(vec![[[0.0; D]; D]; count]);
        let mut slot = vec![usize::MAX; count];
        let mut open: Vec<(usize, Block<D>)> = Vec::new();
        for c in 0..count {
            for k in 0..D {
                for (column, x) in w.row(c * D + k) {
                    let (d, l) = (column / D, column % D);
                    if d == c {
                        out.diagonal[c][k][l] = x;
                    } else if x != 0.0 {
                        if slot[d] == usize::MAX {
                            slot[d] = open.len();
                            open.push((d, [[0.0; D]; D]));
                        }
                        open[slot[d]].1[k][l] = x;
                    }
                }
            }
            open.sort_unstable_by_key(|(d, _)| *d);
            for (d, block) in open.drain(..) {
                slot[d] = usize::MAX;
                out.push(d, &block);
            }
            out.end_row();
        }
        out
    }

    /// Converts to compressed sparse rows.
    pub fn to_csr(&self) -> Csr {
        let mut entries = Vec::new();
        for c in 0..self.diagonal.len() {
            let own = std::iter::once((c, self.diagonal[c]));
            for (d, block) in self.row(c).chain(own) {
                for (k, row) in block.iter().enumerate() {
                    for (l, x) in row.iter().enumerate() {
                        entries.push(((c * D + k) as u32, (d * D + l) as u32, *x));
                    }
                }
            }
        }
        let n = self.diagonal.len() * D;
        Csr::from_triplets(n, n, &entries)
    }

    /// Returns the number of contacts.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// Returns whether there are no contacts.
    pub fn is_empty(&self) -> bool {
        self.diagonal.is_empty()
    }

    /// Returns the number of off-diagonal blocks.
    pub fn others(&self) -> usize {
        self.columns.len()
    }

    #[inline(always)]
    fn range(&self, c: usize) -> Range<usize> {
        self.starts[c] as usize..self.starts[c + 1] as usize
    }

    /// Iterates over the off-diagonal blocks of a block row, with increasing columns.
    pub fn row(&self, c: usize) -> impl Iterator<Item = (usize, Block<D>)> + Clone {
        self.range(c).map(|k| {
            let from = &self.blocks[k * D * D..];
            let block = std::array::from_fn(|i| std::array::from_fn(|j| from[j * D + i]));
            (self.columns[k] as usize, block)
        })
    }

    /// Returns x + sum of W_cd p_d over d != c.
    #[inline(always)]
    pub fn gather(&self, c: usize, p: &[[f64; D]], mut x: [f64; D]) -> [f64; D] {
        let range = self.range(c);
        let stride = D * D;
        let blocks = &self.blocks[range.start * stride..range.end * stride];
        let mut sums = [[0.0; D]; D];
        for (d, block) in self.columns[range].iter().zip(blocks.chunks_exact(stride)) {
            let p = &p[*d as usize];
            for j in 0..D {
                for i in 0..D {
                    sums[j][i] += block[j * D + i] * p[j];
                }
            }
        }
        for sums in &sums {
            for (x, y) in x.iter_mut().zip(sums) {
                *x += y;
            }
        }
        x
    }

    /// Computes u = W p + q.
    pub fn velocity(&self, p: &[[f64; D]], q: &[[f64; D]], u: &mut [[f64; D]]) {
        Arch::new().dispatch(Product(self, p, q, u));
    }
}
