//! The problem as a solver sees it: the operator W, the free velocities q, and the law of each
//! block of unknowns.

use super::block::{Block, BlockMatrix};
use super::coulomb_sums;
use super::factored::{self, Shift, Shifted};
use super::law::{self, Law};
use crate::solve::error::{Norm, Residual, Scale, Sums, residual};
use crate::solve::extrapolation;

/// The Delassus operator, independent of its representation.
pub trait Delassus<const D: usize> {
    /// Returns the number of blocks.
    fn len(&self) -> usize;
    /// Returns whether there are no blocks.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Returns the diagonal block of a contact.
    fn diagonal(&self, c: usize) -> &Block<D>;
    /// Computes u = W p + q.
    fn velocity(&self, p: &[[f64; D]], q: &[[f64; D]], u: &mut [[f64; D]]);
    /// Returns W as a matrix, assembled where needed; `None` for an operator that provides products
    /// only. Methods that need a matrix declare it ([`crate::solve::Operator`]), and leave a
    /// problem without a matrix unchanged.
    fn matrix(&self) -> Option<&BlockMatrix<D>>;
    /// Returns the factors of N W N + S; `None` where it is singular to rounding, or where W is not
    /// available as a matrix.
    fn shifted(&self, shift: &Shift<D>) -> Option<Box<dyn Shifted<D> + '_>> {
        factored::factor(self.matrix()?, shift)
    }
}

impl<const D: usize> Delassus<D> for BlockMatrix<D> {
    fn len(&self) -> usize {
        self.diagonal.len()
    }

    fn diagonal(&self, c: usize) -> &Block<D> {
        &self.diagonal[c]
    }

    fn velocity(&self, p: &[[f64; D]], q: &[[f64; D]], u: &mut [[f64; D]]) {
        Self::velocity(self, p, q, u);
    }

    fn matrix(&self) -> Option<&BlockMatrix<D>> {
        Some(self)
    }
}

/// A problem: u = W p + q, where (p_c, u_c) satisfies the law of every block c.
#[derive(Clone, Copy)]
pub struct Form<'a, const D: usize> {
    /// The operator.
    pub w: &'a dyn Delassus<D>,
    /// Free velocities, including shifts.
    pub q: &'a [[f64; D]],
    /// Laws.
    pub laws: &'a [Law],
    /// Norm of the error.
    pub norm: Norm,
    /// |q|^2.
    pub free: f64,
    /// Sum of rho |q_c|^2.
    energy: f64,
}

impl<'a, const D: usize> Form<'a, D> {
    /// Creates a problem with a norm.
    pub fn new(w: &'a dyn Delassus<D>, q: &'a [[f64; D]], laws: &'a [Law], norm: Norm) -> Self {
        Self {
            w,
            q,
            laws,
            norm,
            free: squared(q),
            energy: match norm {
                Norm::Balance | Norm::Power => q
                    .iter()
                    .enumerate()
                    .map(|(c, q)| (1.0 / largest(w.diagonal(c)), q))
                    .filter(|(rho, _)| rho.is_finite())
                    .map(|(rho, q)| rho * q.iter().map(|x| x * x).sum::<f64>())
                    .sum(),
                _ => 0.0,
            },
        }
    }

    /// Returns the number of blocks.
    pub fn len(&self) -> usize {
        self.laws.len()
    }

    /// Returns whether there are no blocks.
    pub fn is_empty(&self) -> bool {
        self.laws.is_empty()
    }

    /// Computes u = W p + q.
    pub fn velocity(&self, p: &[[f64; D]], u: &mut [[f64; D]]) {
        self.w.velocity(p, self.q, u);
    }

    /// Returns the parameter rho of the natural map: 1 in the norm `Field`, otherwise 1 /
    /// lambda_max(W_cc), where an upper bound replaces lambda_max.
    pub fn rho(&self, c: usize) -> f64 {
        match self.norm {
            Norm::Field => 1.0,
            _ => 1.0 / largest(self.w.diagonal(c)),
        }
    }

    /// Returns the error of p, where u = W p + q.
    pub fn error(&self, p: &[[f64; D]], u: &[[f64; D]]) -> Measure {
        let quick = match self.norm {
            Norm::Field => coulomb_sums::sums(p, u, self.laws),
            _ => None,
        };
        let (sums, mut finite) = match quick {
            Some(sums) => (sums, true),
            None => self.sums(p, u),
        };
        let work = match self.norm {
            Norm::Balance | Norm::Power => dot(p, u) - dot(p, self.q),
            _ => 0.0,
        };
        let scale = Scale {
            free: self.free,
            energy: self.energy,
            noise: 0.0,
            work,
            contacts: self.len(),
        };
        // The projection of NaN gives 0, and so does division by infinity: neither must pass as a
        // zero error.
        finite &= (sums.residual + sums.velocity + sums.impulse + self.free).is_finite();
        Measure {
            error: if finite {
                sums.error(self.norm, &scale)
            } else {
                f64::INFINITY
            },
            scale: sums.against(self.norm, self.free),
        }
    }

    /// Returns the sums of the error, and whether the velocities of immovable blocks are finite.
    fn sums(&self, p: &[[f64; D]], u: &[[f64; D]]) -> (Sums, bool) {
        let mut sums = Sums::default();
        let mut finite = true;
        for c in 0..self.len() {
            let rho = self.rho(c);
            if !rho.is_finite() {
                finite &= u[c].iter().all(|x| x.is_finite());
                continue;
            }
            let r = self.laws[c].natural(&p[c], &u[c], rho, p);
            let over = if rho == 1.0 { 1.0 } else { 1.0 / rho };
            let dot = |a: &[f64; D], b: &[f64; D]| (0..D).map(|k| a[k] * b[k]).sum::<f64>();
            let natural = dot(&r, &r) * over * over;
            let squared = match self.laws[c] {
                Law::Coulomb(mu) | Law::Cohesive { mu, .. } => {
                    residual(natural, p[c][0] * over, u[c][0], mu)
                }
                _ => natural,
            };
            let slip = match self.laws[c] {
                Law::Coulomb(_) | Law::Cohesive { .. } => dot(&p[c], &u[c]) - p[c][0] * u[c][0],
                _ => 0.0,
            };
            let slip = slip.abs();
            sums.add(
                &Residual {
                    squared,
                    velocity: dot(&u[c], &u[c]),
                    impulse: dot(&p[c], &p[c]) * over * over,
                    power: dot(&p[c], &r) * over,
                    unbalanced: (dot(&p[c], &r).abs() * over).max(rho * natural),
                    slip,
                },
                c,
            );
        }
        (sums, finite)
    }
}

/// An error with its reference value.
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// The error.
    pub error: f64,
    /// Value by which the residual was divided.
    pub scale: f64,
}

/// Returns an upper bound of the largest eigenvalue of a block (largest absolute row sum of the
/// symmetric part).
pub fn largest<const D: usize>(w: &Block<D>) -> f64 {
    let mut most = 0.0f64;
    for i in 0..D {
        let sum: f64 = (0..D).map(|j| 0.5 * (w[i][j] + w[j][i]).abs()).sum();
        most = most.max(sum);
    }
    most
}

/// Returns the sum of squares of a vector of blocks.
pub fn squared<const D: usize>(x: &[[f64; D]]) -> f64 {
    dot(x, x)
}

/// Returns x . y of vectors of blocks.
pub fn dot<const D: usize>(x: &[[f64; D]], y: &[[f64; D]]) -> f64 {
    extrapolation::dot(x.as_flattened(), y.as_flattened())
}

/// Returns Coulomb's law for each block, for problems from files.
pub fn coulomb(mu: &[f64]) -> Vec<Law> {
    mu.iter().map(|mu| law::Law::Coulomb(*mu)).collect()
}

/// Returns the power of two below the largest number; 1 where all are 0.
pub(super) fn magnitude<'a>(x: impl Iterator<Item = &'a f64>) -> f64 {
    let most = x.fold(0.0f64, |m, x| m.max(x.abs()));
    if most > 0.0 {
        most.log2().floor().clamp(-1000.0, 1000.0).exp2()
    } else {
        1.0
    }
}
