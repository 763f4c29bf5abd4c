//! The Delassus operator as a matrix of D x D blocks, one block row a contact.

use super::csr::Csr;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// A block of W.
pub type Block<const D: usize> = [[f64; D]; D];

/// W by block rows, the diagonal apart: what a sweep reads.
#[derive(Clone, Debug)]
pub struct BlockMatrix<const D: usize> {
    /// Diagonal blocks.
    pub diagonal: Vec<Block<D>>,
    starts: Vec<u32>,
    columns: Vec<u32>,
    /// Column by column: the sums of a block row then wait for each other less.
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

/// u = W p + q for the vectors at hand.
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
    /// With these diagonal blocks, without others yet: [`Self::push`] and [`Self::end_row`] bring them.
    pub fn new(diagonal: Vec<Block<D>>) -> Self {
        Self {
            diagonal,
            starts: vec![0],
            columns: Vec::new(),
            blocks: Vec::new(),
        }
    }

    /// Adds a block to the open row; columns rise.
    pub fn push(&mut self, column: usize, block: &Block<D>) {
        self.columns.push(column as u32);
        for j in 0..D {
            self.blocks.extend(block.iter().map(|row| row[j]));
        }
    }

    /// Begins the next row.
    pub fn end_row(&mut self) {
        self.starts.push(self.columns.len() as u32);
    }

    /// Gathers the entries of a matrix of rows and columns divisible by D; blocks of zeros are left out.
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

    /// The same matrix by rows.
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

    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// Whether there is no contact.
    pub fn is_empty(&self) -> bool {
        self.diagonal.is_empty()
    }

    /// Number of blocks beside the diagonal.
    pub fn others(&self) -> usize {
        self.columns.len()
    }

    #[inline(always)]
    fn range(&self, c: usize) -> Range<usize> {
        self.starts[c] as usize..self.starts[c + 1] as usize
    }

    /// The blocks beside the diagonal of a block row, with their columns, which rise.
    pub fn row(&self, c: usize) -> impl Iterator<Item = (usize, Block<D>)> + Clone {
        self.range(c).map(|k| {
            let from = &self.blocks[k * D * D..];
            let block = std::array::from_fn(|i| std::array::from_fn(|j| from[j * D + i]));
            (self.columns[k] as usize, block)
        })
    }

    /// x + sum of W_cd p_d over d != c.
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

    /// u = W p + q.
    pub fn velocity(&self, p: &[[f64; D]], q: &[[f64; D]], u: &mut [[f64; D]]) {
        Arch::new().dispatch(Product(self, p, q, u));
    }
}
