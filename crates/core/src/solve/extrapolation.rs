//! Anderson extrapolation of a fixed-point iteration p -> g(p) (type II: Walker and Ni 2011), with
//! a safeguard against extrapolated points that increase the residual; see [`Safeguard`].

use pulp::{Arch, Simd, WithSimd};

/// Maximum number of stored differences.
const MAX_DIFFERENCES: usize = 8;

/// One number per stored difference, zero for unused ones.
type DifferenceLanes = [f64; MAX_DIFFERENCES];

/// The last differences of the map, stored side by side for each unknown, and their Gram matrix.
#[derive(Debug)]
struct DifferenceMemory {
    /// Changes of g(p).
    dg: Vec<DifferenceLanes>,
    /// Changes of f = g(p) - p.
    df: Vec<DifferenceLanes>,
    gram: [DifferenceLanes; MAX_DIFFERENCES],
    /// df . f.
    along: DifferenceLanes,
    next: usize,
    size: usize,
    most: usize,
}

impl DifferenceMemory {
    fn new(most: usize, n: usize) -> Self {
        Self {
            dg: vec![[0.0; MAX_DIFFERENCES]; n],
            df: vec![[0.0; MAX_DIFFERENCES]; n],
            gram: [[0.0; MAX_DIFFERENCES]; MAX_DIFFERENCES],
            along: [0.0; MAX_DIFFERENCES],
            next: 0,
            size: 0,
            most: most.clamp(1, MAX_DIFFERENCES),
        }
    }

    fn clear(&mut self) {
        self.dg.fill([0.0; MAX_DIFFERENCES]);
        self.df.fill([0.0; MAX_DIFFERENCES]);
        (self.size, self.next) = (0, 0);
    }

    fn full(&self) -> bool {
        self.size == self.most
    }

    /// Adds the differences to g0 and f0.
    #[inline(always)]
    fn push(&mut self, g: &[f64], g0: &[f64], f: &[f64], f0: &[f64]) {
        let k = self.next;
        self.next = (k + 1) % self.most;
        self.size = (self.size + 1).min(self.most);
        let (mut gram, mut along, mut own) =
            ([0.0; MAX_DIFFERENCES], [0.0; MAX_DIFFERENCES], (0.0, 0.0));
        let old = g0.iter().zip(f0);
        let rows = self.dg.iter_mut().zip(&mut self.df);
        for (((dg, df), (g0, f0)), (g, f)) in rows.zip(old).zip(g.iter().zip(f)) {
            let d = f - f0;
            for j in 0..MAX_DIFFERENCES {
                gram[j] += d * df[j];
                along[j] += f * df[j];
            }
            // Written last, to avoid a store-forwarding stall: a vector load just after a scalar
            // store waits for it.
            dg[k] = g - g0;
            df[k] = d;
            own.0 += d * d;
            own.1 += f * d;
        }
        (gram[k], along[k]) = own;
        for (row, x) in self.gram.iter_mut().zip(gram) {
            row[k] = x;
        }
        self.gram[k] = gram;
        self.along = along;
    }

    /// Returns gamma that minimises |f - sum gamma_k df_k|; `None` if the system is singular.
    fn weights(&self) -> Option<DifferenceLanes> {
        /// Regularisation of the least-squares system.
        const RIDGE: f64 = 1e-10;
        let n = self.size;
        let (mut a, mut b) = (self.gram, self.along);
        let most = (0..n).fold(0.0f64, |m, k| m.max(a[k][k]));
        for (k, row) in a.iter_mut().enumerate() {
            row[k] *= 1.0 + RIDGE;
        }
        // Gaussian elimination without pivoting: the matrix is positive definite.
        for k in 0..n {
            if a[k][k] <= 1e-15 * most {
                return None;
            }
            let (pivot, right) = (a[k], b[k]);
            for (row, b) in a.iter_mut().zip(&mut b).take(n).skip(k + 1) {
                let l = row[k] / pivot[k];
                for (x, y) in row.iter_mut().zip(&pivot).skip(k) {
                    *x -= l * y;
                }
                *b -= l * right;
            }
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| a[k][j] * b[j]).sum();
            b[k] = (b[k] - known) / a[k][k];
        }
        b[n..].fill(0.0);
        b.iter().all(|x| x.is_finite()).then_some(b)
    }

    /// p = g - sum gamma_k dg_k.
    #[inline(always)]
    fn extrapolate(&self, gamma: &DifferenceLanes, g: &[f64], p: &mut [f64]) {
        for ((p, g), dg) in p.iter_mut().zip(g).zip(&self.dg) {
            let mut x: DifferenceLanes = std::array::from_fn(|k| gamma[k] * dg[k]);
            for half in [4, 2, 1] {
                for k in 0..half {
                    x[k] += x[k + half];
                }
            }
            *p = g - x[0];
        }
    }
}

/// Returns x . y, using four partial sums in a fixed order.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (xs, ys) = (x.chunks_exact(4), y.chunks_exact(4));
    let rest = xs.remainder().iter().zip(ys.remainder());
    let tail: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in xs.zip(ys) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + tail
}

/// Reaction to an extrapolation that increased the residual, and to a full memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Safeguard {
    /// Go back to the point before the extrapolation, and drop the oldest difference when full: for
    /// expensive maps, where no application should be wasted.
    Back,
    /// Restart with an empty memory from the result of the map: one application damps most of the
    /// error of a bad extrapolation, and differences across changes of contact status do not
    /// persist.
    Anew,
}

/// The sequence of points at which the map is applied.
#[derive(Debug)]
pub struct Extrapolation {
    memory: DifferenceMemory,
    safeguard: Safeguard,
    /// The point of the next iteration.
    pub start: Vec<f64>,
    f: Vec<f64>,
    /// Squared residual of the previous iteration.
    before: Option<f64>,
    g0: Vec<f64>,
    f0: Vec<f64>,
}

/// [`Extrapolation::next`] for the vector instructions of this machine.
struct Next<'a>(&'a mut Extrapolation, &'a [f64]);

impl WithSimd for Next<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, _: V) {
        self.0.choose(self.1);
    }
}

impl Extrapolation {
    /// Starts from a point, storing up to `memory` differences, at most eight.
    pub fn new(memory: usize, safeguard: Safeguard, start: &[f64]) -> Self {
        let zero = vec![0.0; start.len()];
        Self {
            memory: DifferenceMemory::new(memory, start.len()),
            safeguard,
            start: start.to_vec(),
            f: zero.clone(),
            before: None,
            g0: zero.clone(),
            f0: zero,
        }
    }

    /// Takes g(start) and chooses the next point.
    pub fn next(&mut self, g: &[f64]) {
        // Operations and their order do not depend on the vector width.
        Arch::new().dispatch(Next(self, g));
    }

    #[inline(always)]
    fn choose(&mut self, g: &[f64]) {
        /// Largest accepted growth of the squared residual by an extrapolation.
        const GROWTH: f64 = 4.0;
        for ((f, g), start) in self.f.iter_mut().zip(g).zip(&self.start) {
            *f = g - start;
        }
        let change = dot(&self.f, &self.f);
        if let Some(before) = self.before {
            let grew = change > GROWTH * before;
            if grew && self.safeguard == Safeguard::Back {
                self.memory.clear();
                self.before = None;
                self.start.copy_from_slice(&self.g0);
                return;
            }
            if grew || self.safeguard == Safeguard::Anew && self.memory.full() {
                self.memory.clear();
            }
            if !grew {
                self.memory.push(g, &self.g0, &self.f, &self.f0);
            }
        }
        self.before = Some(change);
        self.g0.copy_from_slice(g);
        std::mem::swap(&mut self.f0, &mut self.f);
        if self.memory.size > 0 {
            if let Some(gamma) = self.memory.weights() {
                return self.memory.extrapolate(&gamma, g, &mut self.start);
            }
            self.memory.clear();
        }
        self.start.copy_from_slice(g);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: [Safeguard; 2] = [Safeguard::Back, Safeguard::Anew];

    /// A linear map is solved in as many steps as it has distinct eigenvalues.
    #[test]
    fn ends_on_a_linear_map() {
        let rates = [0.99, 0.9, 0.5, -0.7];
        let map =
            |p: &[f64]| -> Vec<f64> { p.iter().zip(rates).map(|(p, r)| r * p + 1.0).collect() };
        for safeguard in BOTH {
            let mut sequence = Extrapolation::new(6, safeguard, &[0.0; 4]);
            for _ in 0..7 {
                let g = map(&sequence.start.clone());
                sequence.next(&g);
            }
            for (p, r) in sequence.start.iter().zip(rates) {
                let exact = 1.0 / (1.0 - r);
                assert!((p - exact).abs() < 1e-4 * exact, "{p} {exact}");
            }
        }
    }

    /// A bad extrapolation is undone or followed by the map's result, depending on the safeguard.
    #[test]
    fn answers_a_bad_start() {
        for safeguard in BOTH {
            let mut sequence = Extrapolation::new(6, safeguard, &[0.0]);
            sequence.next(&[1.0]);
            assert_eq!(sequence.start, [1.0]);
            sequence.next(&[11.0]);
            let wanted = match safeguard {
                Safeguard::Back => 1.0,
                Safeguard::Anew => 11.0,
            };
            assert_eq!(sequence.start, [wanted]);
        }
    }
}
