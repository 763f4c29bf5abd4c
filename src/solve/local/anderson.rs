//! Gauss-Seidel sweeps with Anderson's acceleration (type II: Walker and Ni 2011), safeguarded: an
//! extrapolation that the next sweep finds worse is taken back.

use super::form::{Form, dot};
use super::nlgs::Sweep;
use super::state::{Budget, Solver, State};

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Anderson {
    /// Sweeps remembered.
    pub memory: usize,
    /// Relaxation of each sweep.
    pub relaxation: f64,
}

impl Default for Anderson {
    fn default() -> Self {
        Self {
            memory: 8,
            relaxation: 1.0,
        }
    }
}

/// The last differences of the fixed-point map, and their Gram matrix.
struct Memory<const D: usize> {
    /// Changes of g(p).
    dg: Vec<Vec<[f64; D]>>,
    /// Changes of f = g(p) - p.
    df: Vec<Vec<[f64; D]>>,
    gram: Vec<Vec<f64>>,
    next: usize,
    size: usize,
}

impl<const D: usize> Memory<D> {
    fn new(size: usize, n: usize) -> Self {
        Self {
            dg: vec![vec![[0.0; D]; n]; size],
            df: vec![vec![[0.0; D]; n]; size],
            gram: vec![vec![0.0; size]; size],
            next: 0,
            size: 0,
        }
    }

    fn clear(&mut self) {
        (self.size, self.next) = (0, 0);
    }

    fn push(&mut self, g: &[[f64; D]], g0: &[[f64; D]], f: &[[f64; D]], f0: &[[f64; D]]) {
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

    /// p = g - sum gamma_k dg_k, where gamma makes f - sum gamma_k df_k least.
    fn extrapolate(&self, g: &[[f64; D]], f: &[[f64; D]], p: &mut [[f64; D]]) -> bool {
        let n = self.size;
        let mut a = vec![vec![0.0; n + 1]; n];
        let most = (0..n).fold(0.0f64, |m, k| m.max(self.gram[k][k]));
        for i in 0..n {
            a[i][..n].copy_from_slice(&self.gram[i][..n]);
            a[i][i] *= 1.0 + std::env::var("REG").map_or(1e-13, |x| x.parse::<f64>().unwrap());
            a[i][n] = dot(&self.df[i], f);
        }
        // Cholesky-like elimination without pivots: the matrix is positive.
        for k in 0..n {
            if a[k][k] <= 1e-15 * most {
                return false;
            }
            for i in k + 1..n {
                let l = a[i][k] / a[k][k];
                for j in k..=n {
                    a[i][j] -= l * a[k][j];
                }
            }
        }
        for k in (0..n).rev() {
            for j in k + 1..n {
                a[k][n] -= a[k][j] * a[j][n];
            }
            a[k][n] /= a[k][k];
        }
        p.copy_from_slice(g);
        for (k, row) in a.iter().enumerate() {
            let gamma = row[n];
            for (p, d) in p.as_flattened_mut().iter_mut().zip(self.dg[k].as_flattened()) {
                *p -= gamma * d;
            }
        }
        p.as_flattened().iter().all(|x| x.is_finite())
    }
}

fn subtract<const D: usize>(a: &[[f64; D]], b: &[[f64; D]], out: &mut [[f64; D]]) {
    let pairs = a.as_flattened().iter().zip(b.as_flattened());
    for (o, (a, b)) in out.as_flattened_mut().iter_mut().zip(pairs) {
        *o = a - b;
    }
}

impl<const D: usize> Solver<D> for Anderson {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let n = form.len();
        let mut sweep = Sweep::new(form);
        let mut memory = Memory::new(self.memory, n);
        let mut best = (state.error, state.p.clone());
        let (mut g0, mut f0) = (vec![[0.0; D]; n], vec![[0.0; D]; n]);
        let mut f = vec![[0.0; D]; n];
        let mut start = state.p.clone();
        let mut f0_norm = f64::INFINITY;
        let mut first = true;
        let mut next_test = state.iterations + 1;
        while !budget.ends(state) {
            loop {
                // state.p := g(start)
                state.p.copy_from_slice(&start);
                sweep.forward(&mut state.p, self.relaxation);
                state.iterations += 1;
                if state.iterations >= next_test {
                    break;
                }
                self.next(
                    form, &mut memory, state, &mut start, &mut f, &mut f0, &mut g0, &mut f0_norm,
                    &mut first,
                );
            }
            state.measure(form);
            if state.error < best.0 {
                best.0 = state.error;
                best.1.copy_from_slice(&state.p);
            }
            next_test = state.iterations + (state.iterations / 4).clamp(1, 10);
            self.next(
                form, &mut memory, state, &mut start, &mut f, &mut f0, &mut g0, &mut f0_norm,
                &mut first,
            );
        }
        if state.error > best.0 {
            state.p.copy_from_slice(&best.1);
            state.measure(form);
        }
    }
}

impl Anderson {
    #[allow(clippy::too_many_arguments)]
    fn next<const D: usize>(
        &self,
        form: &Form<D>,
        memory: &mut Memory<D>,
        state: &State<D>,
        start: &mut Vec<[f64; D]>,
        f: &mut Vec<[f64; D]>,
        f0: &mut Vec<[f64; D]>,
        g0: &mut Vec<[f64; D]>,
        f0_norm: &mut f64,
        first: &mut bool,
    ) {
        let g = &state.p;
        subtract(g, start, f);
        let norm = dot(f, f);
        if !*first && norm > std::env::var("GROW").map_or(4.0, |x| x.parse::<f64>().unwrap()) * *f0_norm {
            // The extrapolation was bad: go on from the last sweep's end.
            memory.clear();
            *first = true;
            start.copy_from_slice(g0);
            *f0_norm = f64::INFINITY;
            return;
        }
        if !*first {
            memory.push(g, g0, f, f0);
        }
        *first = false;
        g0.copy_from_slice(g);
        f0.copy_from_slice(f);
        *f0_norm = norm;
        if memory.size == 0 || !memory.extrapolate(g, f, start) {
            memory.clear();
            start.copy_from_slice(g);
        } else {
            for c in 0..start.len() {
                start[c] = form.laws[c].project(&start[c], g);
            }
        }
    }
}
