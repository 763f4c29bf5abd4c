//! Problems in terms of body velocities, and local problems with multipliers; both are reduced to a
//! [`LocalProblem`].

use super::{Csr, LocalProblem};

/// A global problem: M v = H r + G l + f, G^T v + b = 0, u = H^T v + w, and the law of friction
/// between u and r. Units are the file's own: velocities or displacements, impulses or forces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GlobalProblem {
    /// Number of components of a contact: 2 or 3.
    pub dimension: usize,
    /// Mass or iteration matrix, n x n; need not be symmetric.
    pub m: Csr,
    /// Map from contact impulses to the degrees of freedom, n x m.
    pub h: Csr,
    /// Free impulses, of length n.
    pub f: Vec<f64>,
    /// Constant term of the relative velocities, of length m.
    pub w: Vec<f64>,
    /// Friction coefficients, of length m / dimension.
    pub mu: Vec<f64>,
    /// Equality constraints.
    pub equalities: Option<Equalities>,
}

/// Equality constraints of a global problem, G^T v + b = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Equalities {
    /// Matrix G, n x p.
    pub g: Csr,
    /// Vector b, of length p.
    pub b: Vec<f64>,
}

/// Multipliers of a local problem: u = W r + V l + q, V^T r + R l + s = 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multipliers {
    /// Matrix V, m x p.
    pub v: Csr,
    /// Matrix R, p x p.
    pub r: Csr,
    /// Vector s, of length p.
    pub s: Vec<f64>,
}

impl GlobalProblem {
    /// Returns u = H^T v + w.
    pub fn relative_velocities(&self, v: &[f64]) -> Vec<f64> {
        let mut u = self.w.clone();
        for (i, v) in v.iter().enumerate() {
            for (k, h) in self.h.row(i) {
                u[k] += h * v;
            }
        }
        u
    }
}

impl LocalProblem {
    /// Returns u = W p + q.
    pub fn velocities(&self, p: &[f64]) -> Vec<f64> {
        let mut u = vec![0.0; self.q.len()];
        self.w.apply(p, &mut u);
        for (u, q) in u.iter_mut().zip(&self.q) {
            *u += q;
        }
        u
    }

    /// Scales the unit of impulses so that the mean normal diagonal entry of W is 1; returns the
    /// factor applied to impulses, or 1 where nothing can move.
    pub fn normalise(&mut self) -> f64 {
        let diagonal: Vec<f64> = (0..self.mu.len())
            .map(|c| c * self.dimension)
            .filter_map(|r| self.w.row(r).find(|(c, _)| *c == r))
            .map(|(_, w)| w)
            .filter(|w| *w > 0.0)
            .collect();
        if diagonal.is_empty() {
            return 1.0;
        }
        let mean = diagonal.iter().sum::<f64>() / diagonal.len() as f64;
        for w in &mut self.w.values {
            *w /= mean;
        }
        mean
    }

    /// Returns sum_j |W_ij p_j|, the reference for the rounding of W p.
    pub(super) fn sizes(&self, p: &[f64]) -> Vec<f64> {
        (0..self.w.rows)
            .map(|r| self.w.row(r).map(|(c, w)| (w * p[c]).abs()).sum())
            .collect()
    }
}
