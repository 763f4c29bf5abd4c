//! Factorisation of N W N + S for a matrix W and diagonal blocks S.

use super::block::{Block, BlockMatrix};
use super::linear::{Factor, SparseRows};

/// Matrix added to W, and the scaling of the system.
#[derive(Clone, Copy, Debug)]
pub struct Shift<'a, const D: usize> {
    /// S, as its diagonal blocks.
    pub s: &'a [Block<D>],
    /// Number of leading components of each block that belong to the system.
    pub sizes: &'a [usize],
    /// N: factor on the normal component of each block.
    pub normal: &'a [f64],
}

/// Factors of N W N + S.
pub trait Shifted<const D: usize> {
    /// Computes x = (N W N + S)^-1 x, with zero in components outside the system; returns whether
    /// the result is finite.
    fn solve(&self, x: &mut [[f64; D]]) -> bool;
}

struct Factored {
    factor: Factor,
    /// First row of each block, and the total.
    starts: Vec<usize>,
}

/// Factorises W plus a diagonal shift, W given by its blocks; `None` where it is singular.
pub fn factor<'a, const D: usize>(
    w: &BlockMatrix<D>,
    shift: &Shift<D>,
) -> Option<Box<dyn Shifted<D> + 'a>> {
    let Shift { s, sizes, normal } = *shift;
    let mut starts = vec![0];
    for size in sizes {
        starts.push(starts[starts.len() - 1] + size);
    }
    let mut a = SparseRows::default();
    a.starts.push(0);
    for c in 0..s.len() {
        for i in 0..sizes[c] {
            let left = if i == 0 { normal[c] } else { 1.0 };
            let push = |a: &mut SparseRows, e: usize, row: &[f64; D]| {
                for (j, x) in row.iter().take(sizes[e]).enumerate() {
                    a.columns.push(starts[e] + j);
                    a.values
                        .push(left * x * if j == 0 { normal[e] } else { 1.0 });
                }
            };
            let own = |a: &mut SparseRows| {
                for j in 0..sizes[c] {
                    let right = if j == 0 { normal[c] } else { 1.0 };
                    a.columns.push(starts[c] + j);
                    a.values
                        .push(left * right * w.diagonal[c][i][j] + s[c][i][j]);
                }
            };
            let mut put = false;
            for (e, block) in w.row(c) {
                if !put && e > c {
                    own(&mut a);
                    put = true;
                }
                push(&mut a, e, &block[i]);
            }
            if !put {
                own(&mut a);
            }
            a.starts.push(a.columns.len());
        }
    }
    let factor = Factor::new(&a)?;
    Some(Box::new(Factored { factor, starts }))
}

impl<const D: usize> Shifted<D> for Factored {
    fn solve(&self, x: &mut [[f64; D]]) -> bool {
        let size = |c: usize| self.starts[c + 1] - self.starts[c];
        let mut packed = Vec::with_capacity(self.starts[x.len()]);
        for (c, x) in x.iter().enumerate() {
            packed.extend_from_slice(&x[..size(c)]);
        }
        let finite = self.factor.solve(&mut packed);
        for (c, x) in x.iter_mut().enumerate() {
            *x = [0.0; D];
            x[..size(c)].copy_from_slice(&packed[self.starts[c]..self.starts[c + 1]]);
        }
        finite
    }
}
