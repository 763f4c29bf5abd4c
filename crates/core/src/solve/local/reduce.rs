//! Reduction of a global problem, or a local one with multipliers, to the local form u = W p + q.
//!
//! Global: W = H^T M^-1 H, q = H^T M^-1 f + w. With equality constraints, M v = H r + G l + f and
//! G^T v + b = 0, the matrix is the saddle-point matrix K = [M, -G; G^T, 0] of (v, l), and H is
//! padded with zero rows: W = [H; 0]^T K^-1 [H; 0], q = [H; 0]^T K^-1 (f, -b) + w. Local with
//! multipliers: W - V R^-1 V^T and q - V R^-1 s.
//!
//! M need not be symmetric.

use super::factor::{Factors, Singular};
use super::global::{GlobalProblem, Multipliers};
use super::{Csr, LocalProblem};

/// Reason why a problem cannot be reduced to a local form.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReduceError {
    /// M is singular.
    #[error(
        "the matrix M cannot be inverted: {0}; give every degree of freedom a mass or stiffness"
    )]
    Mass(Singular),
    /// The saddle-point matrix is singular.
    #[error(
        "the matrix [M, -G; G^T, 0] cannot be inverted: {0}; give every degree of freedom a mass or a \
         constraint, and remove constraints that follow from others"
    )]
    Saddle(Singular),
    /// R is singular.
    #[error(
        "the multipliers cannot be eliminated, because R cannot be inverted: {0}; remove the constraints \
         that follow from others, or give the problem in global form"
    )]
    Multipliers(Singular),
    /// The local form would exceed the memory limit.
    #[error(
        "the local form would have up to {entries} entries, above {MAX_ENTRIES}: so many contacts share a body \
         or a structure; give the problem in local form, or fewer contacts"
    )]
    Large {
        /// Upper bound of the number of entries of W.
        entries: usize,
    },
    /// Values outside the range of double precision.
    #[error(
        "the local form has values beyond the range of a double; scale the units of the problem"
    )]
    Overflow,
}

/// Largest number of entries of W: about 3 GB while it is assembled.
const MAX_ENTRIES: usize = 100_000_000;

/// Computes B^T K^-1 B if it fits in memory.
fn sandwich(factors: &Factors, b: &Csr) -> Result<Csr, ReduceError> {
    match factors.reach(b) {
        entries if entries > MAX_ENTRIES => Err(ReduceError::Large { entries }),
        _ => Ok(factors.sandwich(b)),
    }
}

/// The local form of a global problem, and the recovery of its unknowns.
#[derive(Debug)]
pub struct Reduction {
    /// The local form; its p corresponds to the r of the global problem.
    pub local: LocalProblem,
    factors: Factors,
}

impl Reduction {
    /// Eliminates v, and l where there are constraints.
    ///
    /// # Errors
    /// The matrix M, or the saddle-point matrix, is singular.
    pub fn new(problem: &GlobalProblem) -> Result<Self, ReduceError> {
        let n = problem.m.rows;
        let (factors, rows) = match &problem.equalities {
            None => (Factors::new(&problem.m).map_err(ReduceError::Mass)?, n),
            Some(e) => {
                let mut entries = triplets(&problem.m);
                for (row, column, g) in triplets(&e.g) {
                    let below = n as u32 + column;
                    entries.extend([(row, below, -g), (below, row, g)]);
                }
                let size = n + e.b.len();
                let saddle = Csr::from_triplets(size, size, &entries);
                (Factors::new(&saddle).map_err(ReduceError::Saddle)?, size)
            }
        };
        let w = if rows == n {
            sandwich(&factors, &problem.h)?
        } else {
            let mut tall = problem.h.clone();
            tall.starts.resize(rows + 1, tall.indices.len());
            tall.rows = rows;
            sandwich(&factors, &tall)?
        };
        let mut reduction = Self {
            local: LocalProblem {
                dimension: problem.dimension,
                w,
                q: Vec::new(),
                mu: problem.mu.clone(),
            },
            factors,
        };
        let (v, _) = reduction.back(problem, None);
        reduction.local.q = problem.relative_velocities(&v);
        finite(&reduction.local)?;
        Ok(reduction)
    }

    /// Returns v (n) and l (p, empty without constraints) for the contact impulses r (m).
    pub fn velocities(&self, problem: &GlobalProblem, r: &[f64]) -> (Vec<f64>, Vec<f64>) {
        self.back(problem, Some(r))
    }

    fn back(&self, problem: &GlobalProblem, r: Option<&[f64]>) -> (Vec<f64>, Vec<f64>) {
        let n = problem.m.rows;
        let mut x = vec![0.0; n];
        if let Some(r) = r {
            problem.h.apply(r, &mut x);
        }
        for (x, f) in x.iter_mut().zip(&problem.f) {
            *x += f;
        }
        if let Some(e) = &problem.equalities {
            x.extend(e.b.iter().map(|b| -b));
        }
        self.factors.solve(&mut x);
        let l = x.split_off(n);
        (x, l)
    }
}

/// The local form of a local problem with multipliers, and the recovery of the multipliers.
#[derive(Debug)]
pub struct Elimination {
    /// The local form; its p corresponds to the r of the problem.
    pub local: LocalProblem,
    factors: Factors,
}

impl Elimination {
    /// Eliminates l.
    ///
    /// # Errors
    /// The matrix R is singular.
    pub fn new(problem: &LocalProblem, multipliers: &Multipliers) -> Result<Self, ReduceError> {
        let factors = Factors::new(&multipliers.r).map_err(ReduceError::Multipliers)?;
        let mut entries = triplets(&problem.w);
        let share = sandwich(&factors, &multipliers.v.transpose())?;
        entries.extend(triplets(&share).iter().map(|(r, c, x)| (*r, *c, -x)));
        let mut local = problem.clone();
        local.w = Csr::from_triplets(problem.w.rows, problem.w.columns, &entries);
        let mut x = multipliers.s.clone();
        factors.solve(&mut x);
        for (k, q) in local.q.iter_mut().enumerate() {
            *q -= multipliers.v.row(k).map(|(c, v)| v * x[c]).sum::<f64>();
        }
        finite(&local)?;
        Ok(Self { local, factors })
    }

    /// Returns l (p) for the contact impulses r (m).
    pub fn multipliers(&self, multipliers: &Multipliers, r: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = multipliers.s.iter().map(|s| -s).collect();
        for (k, r) in r.iter().enumerate() {
            for (c, v) in multipliers.v.row(k) {
                x[c] -= v * r;
            }
        }
        self.factors.solve(&mut x);
        x
    }
}

fn triplets(a: &Csr) -> Vec<(u32, u32, f64)> {
    (0..a.rows)
        .flat_map(|r| a.row(r).map(move |(c, x)| (r as u32, c as u32, x)))
        .collect()
}

fn finite(local: &LocalProblem) -> Result<(), ReduceError> {
    let fine = local.w.values.iter().chain(&local.q).all(|x| x.is_finite());
    fine.then_some(()).ok_or(ReduceError::Overflow)
}

#[cfg(test)]
#[path = "reduce_tests.rs"]
mod tests;
