//! Gauss-Seidel sweeps with Anderson's acceleration (type II: Walker and Ni 2011), safeguarded: an
//! extrapolation that the next sweep finds worse is taken back.

use super::form::{Form, dot};
use super::nlgs::{Sweep, Tests};
use super::state::{Best, Budget, Solver, State};

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Anderson {
    /// Sweeps remembered.
    pub memory: usize,
}

/// Sweeps before the memory is begun: where few do, its sums would cost more than they save.
const PLAIN: u32 = 8;
/// Over-relaxation of these.
const RELAXED: f64 = 1.3;

impl Default for Anderson {
    fn default() -> Self {
        Self { memory: 8 }
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
            a[i][i] *= 1.0 + 1e-10;
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
            for (p, d) in p
                .as_flattened_mut()
                .iter_mut()
                .zip(self.dg[k].as_flattened())
            {
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

/// The sequence of sweeps and extrapolations.
struct Sequence<const D: usize> {
    memory: Memory<D>,
    /// Where the next sweep starts.
    start: Vec<[f64; D]>,
    f: Vec<[f64; D]>,
    /// End and change of the sweep before; its squared change.
    before: Option<f64>,
    g0: Vec<[f64; D]>,
    f0: Vec<[f64; D]>,
}

impl<const D: usize> Sequence<D> {
    fn new(memory: usize, start: &[[f64; D]]) -> Self {
        let zero = vec![[0.0; D]; start.len()];
        Self {
            memory: Memory::new(memory, start.len()),
            start: start.to_vec(),
            f: zero.clone(),
            before: None,
            g0: zero.clone(),
            f0: zero,
        }
    }

    /// Takes in the end of a sweep from `start` and chooses the next start.
    fn next(&mut self, form: &Form<D>, g: &[[f64; D]]) {
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
        if self.memory.size > 0 && self.memory.extrapolate(g, &self.f, &mut self.start) {
            for (c, p) in self.start.iter_mut().enumerate() {
                *p = form.laws[c].project(p, g);
            }
        } else {
            self.memory.clear();
            self.start.copy_from_slice(g);
        }
    }
}

impl<const D: usize> Solver<D> for Anderson {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let mut sweep = Sweep::new(form);
        let mut sequence: Option<Sequence<D>> = None;
        let mut best = Best::of(state);
        let mut tests = Tests::new();
        let mut done = 0;
        while !budget.ends(state) {
            loop {
                if done < PLAIN {
                    // The first sweep often ends it, so it is not relaxed.
                    let relaxation = if done == 0 { 1.0 } else { RELAXED };
                    sweep.forward(&mut state.p, relaxation);
                } else {
                    match &mut sequence {
                        Some(sequence) => sequence.next(form, &state.p),
                        none => *none = Some(Sequence::new(self.memory, &state.p)),
                    }
                    if let Some(sequence) = &sequence {
                        state.p.copy_from_slice(&sequence.start);
                    }
                    sweep.forward(&mut state.p, 1.0);
                }
                done += 1;
                state.iterations += 1;
                if tests.due(&sweep, state, budget) {
                    break;
                }
            }
            state.measure(form);
            best.keep(state);
        }
        best.restore(form, state);
    }
}
