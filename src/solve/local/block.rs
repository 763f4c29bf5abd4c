//! The Delassus operator as a matrix of D x D blocks, one block row a contact.

use super::csr::Csr;

/// A block of W.
pub type Block<const D: usize> = [[f64; D]; D];

/// W by block rows, the diagonal apart: what a sweep reads.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix<const D: usize> {
    /// Diagonal blocks.
    pub diagonal: Vec<Block<D>>,
    /// Where each block row starts in `columns` and `blocks`.
    pub starts: Vec<u32>,
    /// Block column of each block beside the diagonal.
    pub columns: Vec<u32>,
    /// The blocks beside the diagonal.
    pub blocks: Vec<Block<D>>,
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

impl<const D: usize> BlockMatrix<D> {
    /// Gathers the entries of a matrix of rows and columns divisible by D; blocks of zeros are left out.
    pub fn from_csr(w: &Csr) -> Self {
        let count = w.rows / D;
        let mut out = Self {
            diagonal: vec![[[0.0; D]; D]; count],
            starts: Vec::with_capacity(count + 1),
            ..Self::default()
        };
        out.starts.push(0);
        let mut slot = vec![u32::MAX; count];
        for c in 0..count {
            let first = out.columns.len();
            for k in 0..D {
                for (column, x) in w.row(c * D + k) {
                    let (d, l) = (column / D, column % D);
                    if d == c {
                        out.diagonal[c][k][l] = x;
                    } else if x != 0.0 {
                        if slot[d] == u32::MAX {
                            slot[d] = out.columns.len() as u32;
                            out.columns.push(d as u32);
                            out.blocks.push([[0.0; D]; D]);
                        }
                        out.blocks[slot[d] as usize][k][l] = x;
                    }
                }
            }
            for d in &out.columns[first..] {
                slot[*d as usize] = u32::MAX;
            }
            let mut order: Vec<usize> = (first..out.columns.len()).collect();
            order.sort_by_key(|k| out.columns[*k]);
            let columns: Vec<u32> = order.iter().map(|k| out.columns[*k]).collect();
            let blocks: Vec<Block<D>> = order.iter().map(|k| out.blocks[*k]).collect();
            out.columns[first..].copy_from_slice(&columns);
            out.blocks[first..].copy_from_slice(&blocks);
            out.starts.push(out.columns.len() as u32);
        }
        out
    }

    /// The same matrix by rows.
    pub fn to_csr(&self) -> Csr {
        let mut entries = Vec::new();
        for c in 0..self.diagonal.len() {
            let (columns, blocks) = self.row(c);
            let own = std::iter::once((c, &self.diagonal[c]));
            for (d, block) in columns.iter().map(|d| *d as usize).zip(blocks).chain(own) {
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

    /// The blocks beside the diagonal of a block row.
    #[inline(always)]
    pub fn row(&self, c: usize) -> (&[u32], &[Block<D>]) {
        let range = self.starts[c] as usize..self.starts[c + 1] as usize;
        (&self.columns[range.clone()], &self.blocks[range])
    }

    /// x + sum of W_cd p_d over d != c.
    #[inline(always)]
    pub fn gather(&self, c: usize, p: &[[f64; D]], mut x: [f64; D]) -> [f64; D] {
        let (columns, blocks) = self.row(c);
        for (d, block) in columns.iter().zip(blocks) {
            let p = &p[*d as usize];
            for i in 0..D {
                for j in 0..D {
                    x[i] += block[i][j] * p[j];
                }
            }
        }
        x
    }

    /// u = W p + q.
    pub fn velocity(&self, p: &[[f64; D]], q: &[[f64; D]], u: &mut [[f64; D]]) {
        for (c, u) in u.iter_mut().enumerate() {
            let own = times(&self.diagonal[c], &p[c]);
            *u = self.gather(c, p, std::array::from_fn(|k| q[c][k] + own[k]));
        }
    }
}
