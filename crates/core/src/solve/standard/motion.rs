//! Solution of (N W N + S) x = b, with block-diagonal S, in terms of the motions of the bodies.
//!
//! Divide S and b by N, so that the matrix is W + S. W = H^T M^-1 H + C with the compliances C, so
//! with y = M^-1 H x and R = (S + C)^-1: (M + H R H^T) y = H R b and x = R (b - H^T y) (Woodbury).
//! Hyperstatic or bonded sets have fewer motions than impulses, and the matrix is sparser: a body
//! is coupled to its neighbours only, a contact to all contacts of both its bodies.
#![allow(
    clippy::needless_range_loop,
    reason = "loops over the components of blocks read like their formulas"
)]

use super::bodies::BodyOperator;
use super::pattern::{Neighbours, degrees_of_freedom};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::Mobility;
use crate::solve::local::block::{Block, times};
use crate::solve::local::factored::{Shift, Shifted};
use crate::solve::local::form::Delassus;
use crate::solve::local::linear::{Factor, SparseRows};

/// Returns the mass matrix of a body, with ones for imposed degrees of freedom.
pub(in crate::solve) fn mass<S: Space>(mobility: &Mobility<S>) -> [[f64; 6]; 6] {
    let mut out = [[0.0; 6]; 6];
    for (k, row) in out.iter_mut().enumerate().take(degrees_of_freedom::<S>()) {
        let inverse = mobility.along(k);
        row[k] = if inverse > 0.0 { 1.0 / inverse } else { 1.0 };
    }
    if let (true, Some(inertia)) = (mobility.turns(), mobility.inertia.inverse()) {
        for i in 0..S::Spin::N {
            for j in 0..S::Spin::N {
                out[S::D + i][S::D + j] = inertia.entry(i, j);
            }
        }
    }
    out
}

/// Returns the inverse of the leading block of `size` rows, padded with zeros; `None` where it is
/// singular.
fn invert<const D: usize>(s: &Block<D>, size: usize) -> Option<Block<D>> {
    let (mut a, mut out) = (*s, [[0.0; D]; D]);
    for (k, row) in out.iter_mut().enumerate().take(size) {
        row[k] = 1.0;
    }
    for k in 0..size {
        let pivot = (k..size).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()))?;
        a.swap(k, pivot);
        out.swap(k, pivot);
        let over = 1.0 / a[k][k];
        if !over.is_finite() {
            return None;
        }
        for j in 0..size {
            a[k][j] *= over;
            out[k][j] *= over;
        }
        for i in (0..size).filter(|i| *i != k) {
            let factor = a[i][k];
            for j in 0..size {
                a[i][j] -= factor * a[k][j];
                out[i][j] -= factor * out[k][j];
            }
        }
    }
    Some(out)
}

/// The factors, with the maps between impulses and motions.
struct MotionFactors<'a, S: Space, const D: usize> {
    w: &'a BodyOperator<'a, S, D>,
    s: Vec<Block<D>>,
    r: Vec<Block<D>>,
    sizes: Vec<usize>,
    /// Factors 1/N.
    over: Vec<f64>,
    lu: Factor,
}

impl<S: Space, const D: usize> BodyOperator<'_, S, D> {
    /// Returns the column of H of a component for one of its bodies, by degrees of freedom.
    fn column(&self, c: usize, k: usize, side: usize) -> [f64; 6] {
        let axis = &self.unknowns[c].axes[k];
        let sign = if side == 0 { 1.0 } else { -1.0 };
        std::array::from_fn(|i| {
            if i < S::D {
                sign * axis.linear[i]
            } else if i < degrees_of_freedom::<S>() {
                sign * axis.angular[side][i - S::D]
            } else {
                0.0
            }
        })
    }

    /// Factorises the system; see the module.
    pub(super) fn factor(&self, shift: &Shift<D>) -> Option<Box<dyn Shifted<D> + '_>> {
        let (sizes, over) = (shift.sizes, shift.normal.iter().map(|n| 1.0 / n));
        let mut s = shift.s.to_vec();
        for (s, over) in s.iter_mut().zip(over.clone()) {
            for k in 0..D {
                s[0][k] *= over;
                s[k][0] *= over;
            }
        }
        let pattern = self.pattern();
        let d = degrees_of_freedom::<S>();
        let mut r = Vec::with_capacity(s.len());
        for (c, s) in s.iter().enumerate() {
            let mut s = *s;
            for k in 0..D {
                s[k][k] += self.unknowns[c].axes[k].compliance;
            }
            r.push(invert(&s, sizes[c])?);
        }
        let mut a = self.masses_alone(pattern);
        for (c, unknown) in self.unknowns.iter().enumerate() {
            let columns: [[[f64; 6]; D]; 2] =
                std::array::from_fn(|side| std::array::from_fn(|k| self.column(c, k, side)));
            for i in 0..2 {
                for j in 0..2 {
                    let (x, y) = (unknown.bodies[i], unknown.bodies[j]);
                    if !pattern.moves(x) || !pattern.moves(y) {
                        continue;
                    }
                    let near = &pattern.near[x as usize];
                    let place = near.binary_search(&y).ok()?;
                    for p in 0..d {
                        if self.masses[x as usize].along(p) == 0.0 {
                            continue;
                        }
                        let row = a.starts[pattern.starts[x as usize] + p] + place * d;
                        for k in 0..D {
                            let left: f64 = (0..D).map(|l| columns[i][l][p] * r[c][l][k]).sum();
                            for q in 0..d {
                                if self.masses[y as usize].along(q) > 0.0 {
                                    a.values[row + q] += left * columns[j][k][q];
                                }
                            }
                        }
                    }
                }
            }
        }
        let lu = Factor::new(&a)?;
        Some(Box::new(MotionFactors {
            w: self,
            s,
            r,
            sizes: sizes.to_vec(),
            over: over.collect(),
            lu,
        }))
    }

    /// Returns M with the sparsity pattern of the system; an imposed degree of freedom has a
    /// decoupled row.
    fn masses_alone(&self, pattern: &Neighbours) -> SparseRows {
        let d = degrees_of_freedom::<S>();
        let mut a = SparseRows::default();
        a.starts.push(0);
        for (b, near) in pattern.near.iter().enumerate() {
            if near.is_empty() {
                continue;
            }
            let mass = mass(&self.masses[b]);
            for row in mass.iter().take(d) {
                for e in near {
                    for (q, m) in row.iter().enumerate().take(d) {
                        a.columns.push(pattern.starts[*e as usize] + q);
                        a.values.push(if *e as usize == b { *m } else { 0.0 });
                    }
                }
                a.starts.push(a.columns.len());
            }
        }
        a
    }
}

impl<S: Space, const D: usize> MotionFactors<'_, S, D> {
    /// Solves once with the factors.
    fn once(&self, b: &[[f64; D]]) -> Option<Vec<[f64; D]>> {
        let pattern = self.w.pattern();
        let mut y = vec![0.0; pattern.rows()];
        for (c, unknown) in self.w.unknowns.iter().enumerate() {
            let x = times(&self.r[c], &b[c]);
            for (side, body) in unknown.bodies.into_iter().enumerate() {
                if !pattern.moves(body) {
                    continue;
                }
                for k in 0..D {
                    let column = self.w.column(c, k, side);
                    for p in 0..degrees_of_freedom::<S>() {
                        if self.w.masses[body as usize].along(p) > 0.0 {
                            y[pattern.starts[body as usize] + p] += column[p] * x[k];
                        }
                    }
                }
            }
        }
        if !self.lu.solve(&mut y) {
            return None;
        }
        let x = self.w.unknowns.iter().enumerate().map(|(c, unknown)| {
            let mut left = b[c];
            for (side, body) in unknown.bodies.into_iter().enumerate() {
                if pattern.moves(body) {
                    for k in 0..D {
                        let column = self.w.column(c, k, side);
                        for p in 0..degrees_of_freedom::<S>() {
                            left[k] -= column[p] * y[pattern.starts[body as usize] + p];
                        }
                    }
                }
            }
            times(&self.r[c], &left)
        });
        Some(x.collect())
    }
}

impl<S: Space, const D: usize> Shifted<D> for MotionFactors<'_, S, D> {
    fn solve(&self, b: &mut [[f64; D]]) -> bool {
        /// R may be large; iterative refinement recovers the digits lost to rounding.
        const REFINEMENTS: usize = 1;
        let zero = vec![[0.0; D]; b.len()];
        let mut wx = zero.clone();
        for (b, over) in b.iter_mut().zip(&self.over) {
            b[0] *= over;
        }
        let Some(mut x) = self.once(b) else {
            return false;
        };
        for _ in 0..REFINEMENTS {
            self.w.velocity(&x, &zero, &mut wx);
            let mut left = zero.clone();
            for c in 0..b.len() {
                let sx = times(&self.s[c], &x[c]);
                for k in 0..self.sizes[c] {
                    left[c][k] = b[c][k] - wx[c][k] - sx[k];
                }
            }
            let Some(more) = self.once(&left) else {
                return false;
            };
            for (x, more) in x.iter_mut().zip(&more) {
                for k in 0..D {
                    x[k] += more[k];
                }
            }
        }
        b.copy_from_slice(&x);
        for (b, over) in b.iter_mut().zip(&self.over) {
            b[0] *= over;
        }
        b.as_flattened().iter().all(|x| x.is_finite())
    }
}
