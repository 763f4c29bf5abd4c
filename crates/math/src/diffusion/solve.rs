//! Linear systems of graphs: symmetric, positive definite.

use crate::diffusion::matrix::{Lanes, Matrix, sum};
use crate::diffusion::{DiffusionError, Edge};
use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet};

/// Ratio of residuals to the right-hand side at convergence.
const TOLERANCE: f64 = 1e-13;
/// Accuracy of a solution that is [completed](System::complete), relative to its largest value.
const COMPLETED: f64 = 1e-6;
/// Number of iterations of conjugate gradients after which the system is factorised.
const MAX_ITERATIONS: usize = 150;

/// System (diag(own) + L) x = right, with the Laplacian L of the edges between unknowns.
#[derive(Debug)]
pub(crate) struct System {
    matrix: Matrix,
    /// Right-hand side, in the order of rows.
    right: Vec<Lanes>,
}

impl System {
    /// Creates a system from the diagonal without the edges, the edges between unknowns and the
    /// right-hand side.
    pub fn new(own: &[f64], edges: &[Edge], right: &[f64]) -> Self {
        let matrix = Matrix::new(own, edges);
        Self {
            right: matrix.arrange(right),
            matrix,
        }
    }

    /// Solves the system by conjugate gradients with the diagonal as preconditioner, and if these
    /// converge slowly by a sparse Cholesky factorisation.
    ///
    /// # Errors
    /// The matrix cannot be factorised.
    pub fn solve(&self) -> Result<Vec<f64>, DiffusionError> {
        let start = vec![Lanes::default(); self.right.len()];
        let x = match self.gradients(start, |_, _| false) {
            Some(x) => x,
            None => self.factorise()?,
        };
        Ok(self.matrix.restore(&x))
    }

    /// Solves iteratively from a guess. The first list is the approximate solution; the second is
    /// the residual of each unknown over its own diagonal (positive except in padding rows), that
    /// is, the change of the unknown that alone would satisfy its equation. The sum of both lists
    /// therefore satisfies each equation to rounding, with the flows between unknowns given by the
    /// first list. Iterations end when the second list is small; if they do not converge, the
    /// matrix is factorised, and the second list is zero.
    ///
    /// # Errors
    /// The matrix cannot be factorised.
    pub fn complete(&self, guess: &[f64]) -> Result<[Vec<f64>; 2], DiffusionError> {
        let small = |x: &[Lanes], r: &[Lanes]| {
            let most = x.as_flattened().iter();
            let most = most.fold(0.0f64, |m, x| m.max(x.abs()));
            let mut each = r
                .as_flattened()
                .iter()
                .zip(self.matrix.own().as_flattened());
            most > 0.0 && each.all(|(r, own)| r.abs() <= COMPLETED * most * own)
        };
        let x = match self.gradients(self.matrix.arrange(guess), small) {
            Some(x) => x,
            None => self.factorise()?,
        };
        let mut left = self.residual(&x);
        // Where conductances exceed the diagonal by far, the solution alone is more accurate.
        let keeps = small(&x, &left);
        let each = left.as_flattened_mut().iter_mut();
        for (left, own) in each.zip(self.matrix.own().as_flattened()) {
            *left = if keeps && *own > 0.0 {
                *left / own
            } else {
                0.0
            };
        }
        Ok([&x, &left].map(|x| self.matrix.restore(x)))
    }

    /// The residual b - A x.
    fn residual(&self, x: &[Lanes]) -> Vec<Lanes> {
        let mut left = vec![Lanes::default(); x.len()];
        self.matrix.product(x, &mut left);
        let each = left.as_flattened_mut().iter_mut();
        for (left, right) in each.zip(self.right.as_flattened()) {
            *left = right - *left;
        }
        left
    }

    /// Iterates with conjugate gradients, with the diagonal as preconditioner, until the residual
    /// is rounding or `enough` accepts solution and residual; `None` if they do not converge in
    /// time.
    fn gradients(
        &self,
        mut x: Vec<Lanes>,
        enough: impl Fn(&[Lanes], &[Lanes]) -> bool,
    ) -> Option<Vec<Lanes>> {
        let inverse = |d: &Lanes| d.map(|d| if d > 0.0 { 1.0 / d } else { 0.0 });
        let inverse: Vec<Lanes> = self.matrix.diagonal().iter().map(inverse).collect();
        let goal = TOLERANCE * TOLERANCE * size(&self.right, &inverse);
        if goal == 0.0 {
            x.fill(Lanes::default());
            return Some(x);
        }
        let mut r = self.residual(&x);
        let mut rz = size(&r, &inverse);
        if rz <= goal {
            return Some(x);
        }
        let mut p = vec![Lanes::default(); x.len()];
        let mut ap = p.clone();
        let mut ratio = 0.0;
        for iteration in 1..=MAX_ITERATIONS {
            let each = p.as_flattened_mut().iter_mut();
            let each = each.zip(r.as_flattened()).zip(inverse.as_flattened());
            for ((p, r), d) in each {
                *p = r * d + ratio * *p;
            }
            let curvature = self.matrix.product(&p, &mut ap);
            if curvature <= 0.0 || curvature.is_nan() {
                return None;
            }
            let length = rz / curvature;
            let each = x.as_flattened_mut().iter_mut().zip(p.as_flattened());
            each.for_each(|(x, p)| *x += length * p);
            let each = r.as_flattened_mut().iter_mut().zip(ap.as_flattened());
            each.for_each(|(r, p)| *r -= length * p);
            let next = size(&r, &inverse);
            if next <= goal {
                // The recurrence gives the true residual, up to rounding.
                let holds = size(&self.residual(&x), &inverse) <= 100.0 * goal;
                return holds.then_some(x);
            }
            if iteration % 4 == 0 && enough(&x, &r) {
                return Some(x);
            }
            ratio = next / rz;
            rz = next;
        }
        None
    }

    fn factorise(&self) -> Result<Vec<Lanes>, DiffusionError> {
        let diagonal = self.matrix.diagonal().as_flattened();
        let n = diagonal.len();
        let nodes = self.matrix.unknowns();
        let fail = |reason: String| DiffusionError::Linear { nodes, reason };
        // A node without capacity and edges keeps its value.
        let diagonal = diagonal.iter().enumerate();
        let mut entries: Vec<Triplet<usize, usize, f64>> = diagonal
            .map(|(k, d)| Triplet::new(k, k, if *d > 0.0 { *d } else { 1.0 }))
            .collect();
        // Entries at the same position are added.
        let pairs = self.matrix.pairs();
        entries.extend(pairs.map(|(row, other, g)| Triplet::new(row, other, -g)));
        let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &entries)
            .map_err(|e| fail(format!("{e:?}")))?;
        let factor = matrix
            .sp_cholesky(faer::Side::Lower)
            .map_err(|e| fail(format!("{e:?}")))?;
        let mut x = vec![Lanes::default(); self.right.len()];
        // One refinement removes the rounding of the factors.
        for _ in 0..2 {
            let left = self.residual(&x);
            let right = faer::Mat::from_fn(n, 1, |k, _| left.as_flattened()[k]);
            let correction = factor.solve(&right);
            for (k, x) in x.as_flattened_mut().iter_mut().enumerate() {
                *x += correction[(k, 0)];
            }
        }
        match x.as_flattened().iter().all(|x| x.is_finite()) {
            true => Ok(x),
            false => Err(fail("its factors are not finite".to_owned())),
        }
    }
}

/// Returns r.D^-1 r, with the diagonal D.
fn size(r: &[Lanes], inverse: &[Lanes]) -> f64 {
    let mut all = Lanes::default();
    for (r, d) in r.iter().zip(inverse) {
        for lane in 0..r.len() {
            all[lane] += r[lane] * r[lane] * d[lane];
        }
    }
    sum(all)
}
