//! Linear systems of graphs: symmetric, positive definite, with diagonals that exceed the sums of their rows.

use crate::{DiffusionError, Edge};
use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet};

/// Share of the right-hand side to which residuals are reduced.
const TOLERANCE: f64 = 1e-13;
/// Iterations of conjugate gradients after which the system is factorised.
const MOST: usize = 60;

/// (diag(own) + L) x = right, with the Laplacian L of the edges between unknowns.
#[derive(Debug)]
pub struct System<'a> {
    /// The diagonal without the edges between unknowns.
    pub own: &'a [f64],
    /// Edges between unknowns.
    pub edges: &'a [Edge],
    /// Right-hand side.
    pub right: &'a [f64],
}

impl System<'_> {
    /// Solves it by conjugate gradients with the diagonal as preconditioner, and where these take long by a sparse Cholesky factorisation.
    ///
    /// # Errors
    /// The matrix cannot be factorised.
    pub fn solve(&self) -> Result<Vec<f64>, DiffusionError> {
        match self.gradients() {
            Some(x) => Ok(x),
            None => self.factorise(),
        }
    }

    fn diagonal(&self) -> Vec<f64> {
        let mut diagonal = self.own.to_vec();
        for e in self.edges {
            for n in e.nodes {
                diagonal[n as usize] += e.conductance;
            }
        }
        diagonal
    }

    /// The product of the matrix with x.
    fn product(&self, x: &[f64], out: &mut [f64]) {
        for ((out, own), x) in out.iter_mut().zip(self.own).zip(x) {
            *out = own * x;
        }
        for e in self.edges {
            let [a, b] = e.nodes.map(|n| n as usize);
            let flow = e.conductance * (x[a] - x[b]);
            out[a] += flow;
            out[b] -= flow;
        }
    }

    /// `None` if it does not converge in time.
    fn gradients(&self) -> Option<Vec<f64>> {
        let n = self.right.len();
        let diagonal = self.diagonal();
        let mut x = vec![0.0; n];
        let mut r = self.right.to_vec();
        let precondition = |r: &[f64]| -> Vec<f64> {
            let scaled = r.iter().zip(&diagonal);
            scaled
                .map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 })
                .collect()
        };
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let mut z = precondition(&r);
        let mut rz = dot(&r, &z);
        let goal = TOLERANCE * TOLERANCE * rz;
        if rz == 0.0 {
            return Some(x);
        }
        let mut p = z.clone();
        let mut ap = vec![0.0; n];
        for _ in 0..MOST {
            self.product(&p, &mut ap);
            let curvature = dot(&p, &ap);
            if curvature <= 0.0 || curvature.is_nan() {
                return None;
            }
            let length = rz / curvature;
            for k in 0..n {
                x[k] += length * p[k];
                r[k] -= length * ap[k];
            }
            z = precondition(&r);
            let next = dot(&r, &z);
            if next <= goal {
                return self.holds(&x, &diagonal, goal).then_some(x);
            }
            let ratio = next / rz;
            rz = next;
            for (p, z) in p.iter_mut().zip(&z) {
                *p = z + ratio * *p;
            }
        }
        None
    }

    /// Whether the true residual is what the recurrence says it is, up to rounding.
    fn holds(&self, x: &[f64], diagonal: &[f64], goal: f64) -> bool {
        let mut product = vec![0.0; x.len()];
        self.product(x, &mut product);
        let each = product.iter().zip(self.right).zip(diagonal);
        let norm: f64 = each
            .filter(|(_, d)| **d > 0.0)
            .map(|((p, b), d)| (b - p).powi(2) / d)
            .sum();
        norm <= 100.0 * goal
    }

    fn factorise(&self) -> Result<Vec<f64>, DiffusionError> {
        let n = self.right.len();
        let fail = |reason: String| DiffusionError::Linear { nodes: n, reason };
        let diagonal = self.diagonal();
        let mut entries: Vec<Triplet<usize, usize, f64>> = Vec::new();
        for (k, d) in diagonal.iter().enumerate() {
            // A node without anything keeps its value.
            entries.push(Triplet::new(k, k, if *d > 0.0 { *d } else { 1.0 }));
        }
        for e in self.edges.iter().filter(|e| e.nodes[0] != e.nodes[1]) {
            let [a, b] = e.nodes.map(|n| n as usize);
            entries.push(Triplet::new(a.max(b), a.min(b), -e.conductance));
        }
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &entries)
            .map_err(|e| fail(format!("{e:?}")))?;
        let factor = matrix
            .sp_cholesky(faer::Side::Lower)
            .map_err(|e| fail(format!("{e:?}")))?;
        let mut x = vec![0.0; n];
        // One refinement takes the rounding of the factors out.
        for _ in 0..2 {
            let mut product = vec![0.0; n];
            self.product(&x, &mut product);
            let right = faer::Mat::from_fn(n, 1, |k, _| self.right[k] - product[k]);
            let correction = factor.solve(&right);
            for (k, x) in x.iter_mut().enumerate() {
                *x += correction[(k, 0)];
            }
        }
        match x.iter().all(|x| x.is_finite()) {
            true => Ok(x),
            false => Err(fail("its factors are not finite".to_owned())),
        }
    }
}
