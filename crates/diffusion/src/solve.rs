//! Linear systems of graphs: symmetric, positive definite.

use crate::{DiffusionError, Edge};
use faer::prelude::Solve;
use faer::sparse::{SparseColMat, Triplet};

/// Share of the right-hand side to which residuals are reduced.
const TOLERANCE: f64 = 1e-13;
/// Accuracy of a solution that is [completed](System::complete), as a share of its largest value.
const COMPLETED: f64 = 1e-6;
/// Iterations of conjugate gradients after which the system is factorised.
const MOST: usize = 150;

/// Terms that are summed one after another.
const PART: usize = 8;

/// The scalar product, in parts whose sums do not wait for each other.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let part = |(a, b): (&[f64], &[f64])| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    a.chunks(PART).zip(b.chunks(PART)).map(part).sum()
}

/// (diag(own) + L) x = right, with the Laplacian L of the edges between unknowns.
#[derive(Debug)]
pub struct System<'a> {
    /// The diagonal without the edges between unknowns.
    own: &'a [f64],
    /// Right-hand side.
    right: &'a [f64],
    /// The whole diagonal.
    diagonal: Vec<f64>,
    /// Where the neighbours of each unknown begin and end.
    rows: Vec<[u32; 2]>,
    /// Neighbours of the unknowns in turn, with the sum of the conductances to each.
    neighbours: Vec<(u32, f64)>,
}

impl<'a> System<'a> {
    /// Of the diagonal without the edges, the edges between unknowns and the right-hand side.
    pub fn new(own: &'a [f64], edges: &[Edge], right: &'a [f64]) -> Self {
        let n = right.len();
        let mut diagonal = own.to_vec();
        let mut counts = vec![0u32; n];
        let joins = |e: &&Edge| e.nodes[0] != e.nodes[1] && e.conductance != 0.0;
        for e in edges.iter().filter(joins) {
            for k in e.nodes {
                diagonal[k as usize] += e.conductance;
                counts[k as usize] += 1;
            }
        }
        let mut rows = Vec::with_capacity(n);
        let mut total = 0u32;
        for count in &counts {
            rows.push([total; 2]);
            total += count;
        }
        let mut neighbours = vec![(0u32, 0.0); total as usize];
        for e in edges.iter().filter(joins) {
            let [a, b] = e.nodes;
            let find = |from: u32, to: u32| {
                let [first, end] = rows[from as usize].map(|x| x as usize);
                let known = &neighbours[first..end];
                // Contacts of one pair follow each other.
                let place = known.iter().rposition(|(k, _)| *k == to)?;
                Some(first + place)
            };
            // A node may have thousands of neighbours: the other says whether the pair is new.
            let degree = |k: u32| rows[k as usize][1] - rows[k as usize][0];
            let (few, many) = if degree(a) <= degree(b) {
                (a, b)
            } else {
                (b, a)
            };
            let found = find(few, many).and_then(|place| Some([place, find(many, few)?]));
            match found {
                // Two contacts of one pair add up.
                Some(both) => both.map(|place| neighbours[place].1 += e.conductance),
                None => [(a, b), (b, a)].map(|(from, to)| {
                    let end = &mut rows[from as usize][1];
                    neighbours[*end as usize] = (to, e.conductance);
                    *end += 1;
                }),
            };
        }
        Self {
            own,
            right,
            diagonal,
            rows,
            neighbours,
        }
    }

    /// Solves it by conjugate gradients with the diagonal as preconditioner, and where these take long by a sparse Cholesky factorisation.
    ///
    /// # Errors
    /// The matrix cannot be factorised.
    pub fn solve(&self) -> Result<Vec<f64>, DiffusionError> {
        let start = vec![0.0; self.right.len()];
        match self.gradients(start, |_, _| false) {
            Some(x) => Ok(x),
            None => self.factorise(),
        }
    }

    /// As [`Self::solve`], from a guess, and only until the second list is small: the residual of each unknown over its own diagonal, which is positive. That is what
    /// the unknown changes by if it takes up alone what is left: the first list with the second added obeys each equation to rounding, with flows
    /// between unknowns as of the first. Where it does not become small it is zero, and the first list is the solution to rounding.
    ///
    /// # Errors
    /// The matrix cannot be factorised.
    pub fn complete(&self, guess: Vec<f64>) -> Result<[Vec<f64>; 2], DiffusionError> {
        let small = |x: &[f64], r: &[f64]| {
            let most = x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let left = r
                .iter()
                .zip(self.own)
                .all(|(r, own)| r.abs() <= COMPLETED * most * own);
            left && most > 0.0
        };
        let x = match self.gradients(guess, small) {
            Some(x) => x,
            None => self.factorise()?,
        };
        let mut left = vec![0.0; x.len()];
        self.product(&x, &mut left);
        for (left, right) in left.iter_mut().zip(self.right) {
            *left = right - *left;
        }
        // Where conductances exceed the diagonal by far, the solution is the better one alone.
        let keeps = small(&x, &left);
        for (left, own) in left.iter_mut().zip(self.own) {
            *left = if keeps { *left / own } else { 0.0 };
        }
        Ok([x, left])
    }

    /// The neighbours of an unknown.
    fn around(&self, k: usize) -> &[(u32, f64)] {
        let [first, end] = self.rows[k].map(|x| x as usize);
        &self.neighbours[first..end]
    }

    /// The product of the matrix with x. Differences are formed first, so that what leaves one unknown arrives in the other to the last bit.
    fn product(&self, x: &[f64], out: &mut [f64]) {
        for (k, ((out, own), here)) in out.iter_mut().zip(self.own).zip(x).enumerate() {
            let mut sum = own * here;
            for (j, g) in self.around(k) {
                sum += g * (here - x[*j as usize]);
            }
            *out = sum;
        }
    }

    /// Until residuals are rounding, or `enough` of solution and residual; `None` if it does not converge in time.
    fn gradients(
        &self,
        start: Vec<f64>,
        enough: impl Fn(&[f64], &[f64]) -> bool,
    ) -> Option<Vec<f64>> {
        let n = self.right.len();
        let inverse: Vec<f64> = self
            .diagonal
            .iter()
            .map(|d| if *d > 0.0 { 1.0 / d } else { 0.0 })
            .collect();
        let mut x = start;
        let mut ap = vec![0.0; n];
        self.product(&x, &mut ap);
        let size = |r: &[f64]| -> f64 {
            let each =
                |(r, d): (&[f64], &[f64])| -> f64 { r.iter().zip(d).map(|(r, d)| r * r * d).sum() };
            // In parts, whose sums do not wait for each other.
            let sums = r.chunks(PART).zip(inverse.chunks(PART)).map(each);
            sums.sum()
        };
        let goal = TOLERANCE * TOLERANCE * size(self.right);
        let mut r: Vec<f64> = self.right.iter().zip(&ap).map(|(b, p)| b - p).collect();
        let mut p: Vec<f64> = r.iter().zip(&inverse).map(|(r, d)| r * d).collect();
        let mut rz: f64 = r.iter().zip(&p).map(|(r, z)| r * z).sum();
        if goal == 0.0 {
            return Some(vec![0.0; n]);
        }
        if rz <= goal {
            return Some(x);
        }
        for sweep in 0..MOST {
            self.product(&p, &mut ap);
            let curvature = dot(&p, &ap);
            if curvature <= 0.0 || curvature.is_nan() {
                return None;
            }
            let length = rz / curvature;
            x.iter_mut().zip(&p).for_each(|(x, p)| *x += length * p);
            r.iter_mut().zip(&ap).for_each(|(r, p)| *r -= length * p);
            let next = size(&r);
            if next <= goal {
                return self.holds(&x, goal).then_some(x);
            }
            if sweep % 4 == 3 && enough(&x, &r) {
                return Some(x);
            }
            let ratio = next / rz;
            rz = next;
            let preconditioned = r.iter().zip(&inverse).map(|(r, d)| r * d);
            for (p, z) in p.iter_mut().zip(preconditioned) {
                *p = z + ratio * *p;
            }
        }
        None
    }

    /// Whether the true residual is what the recurrence says it is, up to rounding.
    fn holds(&self, x: &[f64], goal: f64) -> bool {
        let mut product = vec![0.0; x.len()];
        self.product(x, &mut product);
        let each = product.iter().zip(self.right).zip(&self.diagonal);
        let norm: f64 = each
            .filter(|(_, d)| **d > 0.0)
            .map(|((p, b), d)| (b - p).powi(2) / d)
            .sum();
        norm <= 100.0 * goal
    }

    fn factorise(&self) -> Result<Vec<f64>, DiffusionError> {
        let n = self.right.len();
        let fail = |reason: String| DiffusionError::Linear { nodes: n, reason };
        let mut entries: Vec<Triplet<usize, usize, f64>> = Vec::new();
        for (k, d) in self.diagonal.iter().enumerate() {
            // A node without anything keeps its value.
            entries.push(Triplet::new(k, k, if *d > 0.0 { *d } else { 1.0 }));
            for (j, g) in self.around(k).iter().filter(|(j, _)| (*j as usize) < k) {
                entries.push(Triplet::new(k, *j as usize, -g));
            }
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
