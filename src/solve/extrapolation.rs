//! Anderson's extrapolation of a fixed-point iteration p -> g(p) (type II: Walker and Ni 2011),
//! safeguarded: a start that the iteration itself finds worse is taken back.

/// The last differences of the map, and their Gram matrix.
#[derive(Debug)]
struct Memory {
    /// Changes of g(p).
    dg: Vec<Vec<f64>>,
    /// Changes of f = g(p) - p.
    df: Vec<Vec<f64>>,
    gram: Vec<Vec<f64>>,
    next: usize,
    size: usize,
}

impl Memory {
    fn new(size: usize, n: usize) -> Self {
        Self {
            dg: vec![vec![0.0; n]; size],
            df: vec![vec![0.0; n]; size],
            gram: vec![vec![0.0; size]; size],
            next: 0,
            size: 0,
        }
    }

    fn clear(&mut self) {
        (self.size, self.next) = (0, 0);
    }

    fn push(&mut self, g: &[f64], g0: &[f64], f: &[f64], f0: &[f64]) {
        let k = self.next;
        subtract(g, g0, &mut self.dg[k]);
        subtract(f, f0, &mut self.df[k]);
        self.next = (k + 1) % self.dg.len();
        self.size = (self.size + 1).min(self.dg.len());
        for j in 0..self.size {
            let x = dot(&self.df[k], &self.df[j]);
            (self.gram[k][j], self.gram[j][k]) = (x, x);
        }
    }

    /// p = g - sum gamma_k dg_k, where gamma makes f - sum gamma_k df_k least; false where that fails.
    fn extrapolate(&self, g: &[f64], f: &[f64], p: &mut [f64]) -> bool {
        /// Keeps the sum of squares away from singular.
        const RIDGE: f64 = 1e-10;
        let n = self.size;
        let mut a = vec![vec![0.0; n + 1]; n];
        let most = (0..n).fold(0.0f64, |m, k| m.max(self.gram[k][k]));
        for (i, row) in a.iter_mut().enumerate() {
            row[..n].copy_from_slice(&self.gram[i][..n]);
            row[i] *= 1.0 + RIDGE;
            row[n] = dot(&self.df[i], f);
        }
        // Elimination without pivots: the matrix is positive.
        for k in 0..n {
            if a[k][k] <= 1e-15 * most {
                return false;
            }
            let pivot = a[k].clone();
            for row in &mut a[k + 1..] {
                let l = row[k] / pivot[k];
                for (x, y) in row.iter_mut().zip(&pivot).skip(k) {
                    *x -= l * y;
                }
            }
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| a[k][j] * a[j][n]).sum();
            a[k][n] = (a[k][n] - known) / a[k][k];
        }
        p.copy_from_slice(g);
        for (row, dg) in a.iter().zip(&self.dg) {
            let gamma = row[n];
            for (p, d) in p.iter_mut().zip(dg) {
                *p -= gamma * d;
            }
        }
        p.iter().all(|x| x.is_finite())
    }
}

fn subtract(a: &[f64], b: &[f64], out: &mut [f64]) {
    for (o, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
        *o = a - b;
    }
}

/// x . y, by four partial sums in a fixed order.
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

/// The sequence of starts.
#[derive(Debug)]
pub struct Extrapolation {
    memory: Memory,
    /// Where the next iteration starts.
    pub start: Vec<f64>,
    f: Vec<f64>,
    /// Squared change of the iteration before.
    before: Option<f64>,
    g0: Vec<f64>,
    f0: Vec<f64>,
}

impl Extrapolation {
    /// Begins at a point, remembering so many differences.
    pub fn new(memory: usize, start: &[f64]) -> Self {
        let zero = vec![0.0; start.len()];
        Self {
            memory: Memory::new(memory, start.len()),
            start: start.to_vec(),
            f: zero.clone(),
            before: None,
            g0: zero.clone(),
            f0: zero,
        }
    }

    /// Takes in g(start) and chooses the next start.
    pub fn next(&mut self, g: &[f64]) {
        /// Growth of the squared change that an extrapolation may cause.
        const GROWTH: f64 = 4.0;
        subtract(g, &self.start, &mut self.f);
        let change = dot(&self.f, &self.f);
        if let Some(before) = self.before {
            if change > GROWTH * before {
                self.memory.clear();
                self.before = None;
                self.start.copy_from_slice(&self.g0);
                return;
            }
            self.memory.push(g, &self.g0, &self.f, &self.f0);
        }
        self.before = Some(change);
        self.g0.copy_from_slice(g);
        self.f0.copy_from_slice(&self.f);
        let went = self.memory.size > 0 && self.memory.extrapolate(g, &self.f, &mut self.start);
        if !went {
            self.memory.clear();
            self.start.copy_from_slice(g);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A linear map is solved in as many steps as it has eigenvalues.
    #[test]
    fn ends_on_a_linear_map() {
        let rates = [0.99, 0.9, 0.5, -0.7];
        let map =
            |p: &[f64]| -> Vec<f64> { p.iter().zip(rates).map(|(p, r)| r * p + 1.0).collect() };
        let mut sequence = Extrapolation::new(6, &[0.0; 4]);
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
