//! Semi-smooth Newton method on the Alart-Curnier function, inside a proximal-point iteration.
//!
//! With z = p - rho u, F_n = p_n - max(z_n, 0) and F_t = p_t - proj(z_t; |.| <= mu max(z_n, 0))
//! (Alart and Curnier 1991). Rigid packings have a rank-deficient W, so Newton solves u = W p + q +
//! alpha (p - p_k), and the outer loop updates p_k (proximal point around Newton: Acary, Bremond
//! and Huber 2018); alpha is reduced while this converges well. Contacts that are open in the
//! prediction are eliminated from the linear system.

use super::form::{Form, largest, squared};
use super::law::{Law, slip};
use super::linear::{Factor, SparseRows};
use super::state::{Best, Budget, Iteration, Solver};
use std::time::Instant;

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Newton {
    /// Initial alpha divided by the mean diagonal entry of W.
    pub alpha: f64,
}

impl Default for Newton {
    fn default() -> Self {
        Self { alpha: 1e-3 }
    }
}

/// Derivatives of one contact's F with respect to p and u.
struct Slopes<const D: usize> {
    p: [[f64; D]; D],
    u: [[f64; D]; D],
}

/// Returns F of a contact, and whether it is open in the prediction.
fn value<const D: usize>(p: &[f64; D], u: &[f64; D], law: &Law, rho: f64) -> ([f64; D], bool) {
    let z: [f64; D] = std::array::from_fn(|k| p[k] - rho * u[k]);
    let (mu, cohesion) = match law {
        Law::Coulomb(mu) => (*mu, 0.0),
        Law::Cohesive { mu, cohesion } => (*mu, *cohesion),
        Law::Free => return (u.map(|x| rho * x), false),
        Law::Pull => {
            let mut f = u.map(|x| rho * x);
            f[0] = p[0] - z[0].min(0.0);
            return (f, false);
        }
        Law::Moment { .. } => return (*p, true),
    };
    let zn = z[0].max(0.0);
    let bound = mu * zn + cohesion;
    let length = slip(&z);
    let scale = if length > bound { bound / length } else { 1.0 };
    let f = std::array::from_fn(|k| {
        if k == 0 {
            p[0] - zn
        } else {
            p[k] - scale * z[k]
        }
    });
    (f, zn == 0.0 && bound == 0.0)
}

fn slopes<const D: usize>(p: &[f64; D], u: &[f64; D], law: &Law, rho: f64) -> Slopes<D> {
    let mut s = Slopes {
        p: [[0.0; D]; D],
        u: [[0.0; D]; D],
    };
    let z: [f64; D] = std::array::from_fn(|k| p[k] - rho * u[k]);
    let (mu, cohesion) = match law {
        Law::Coulomb(mu) => (*mu, 0.0),
        Law::Cohesive { mu, cohesion } => (*mu, *cohesion),
        Law::Pull => {
            for k in 0..D {
                s.u[k][k] = rho;
            }
            if z[0] > 0.0 {
                s.u[0][0] = 0.0;
                s.p[0][0] = 1.0;
            }
            return s;
        }
        Law::Free | Law::Moment { .. } => {
            for k in 0..D {
                s.u[k][k] = rho;
            }
            return s;
        }
    };
    let pressed = z[0] > 0.0;
    if pressed {
        s.u[0][0] = rho;
    } else {
        s.p[0][0] = 1.0;
    }
    let bound = mu * z[0].max(0.0) + cohesion;
    let length = slip(&z);
    if length <= bound {
        for k in 1..D {
            s.u[k][k] = rho;
        }
        return s;
    }
    // F_t = p_t - bound z_t/|z_t|.
    let tau: [f64; D] = std::array::from_fn(|k| if k == 0 { 0.0 } else { z[k] / length });
    for i in 1..D {
        s.p[i][i] += 1.0;
        if pressed {
            s.p[i][0] -= mu * tau[i];
            s.u[i][0] += mu * rho * tau[i];
        }
        for j in 1..D {
            let m = bound / length * (f64::from(u8::from(i == j)) - tau[i] * tau[j]);
            s.p[i][j] -= m;
            s.u[i][j] += rho * m;
        }
    }
    s
}

/// One proximal problem: u = W p + q + alpha (p - centre).
struct Prox<'a, const D: usize> {
    form: &'a Form<'a, D>,
    rho: Vec<f64>,
    alpha: f64,
    centre: Vec<[f64; D]>,
}

impl<const D: usize> Prox<'_, D> {
    fn velocity(&self, p: &[[f64; D]], u: &mut [[f64; D]]) {
        self.form.velocity(p, u);
        for (u, (p, c)) in u.iter_mut().zip(p.iter().zip(&self.centre)) {
            for k in 0..D {
                u[k] += self.alpha * (p[k] - c[k]);
            }
        }
    }

    /// Computes F and |F|^2.
    fn residual(&self, p: &[[f64; D]], u: &[[f64; D]], f: &mut [[f64; D]]) -> f64 {
        for c in 0..p.len() {
            f[c] = value(&p[c], &u[c], &self.form.laws[c], self.rho[c]).0;
        }
        squared(f)
    }

    /// Computes Newton's direction.
    fn direction(&self, p: &[[f64; D]], u: &[[f64; D]], f: &[[f64; D]]) -> Option<Vec<[f64; D]>> {
        let w = self.form.w.matrix()?;
        let n = p.len();
        let mut place = vec![usize::MAX; n];
        let mut active = Vec::with_capacity(n);
        for c in 0..n {
            if !value(&p[c], &u[c], &self.form.laws[c], self.rho[c]).1 {
                place[c] = active.len();
                active.push(c);
            }
        }
        let mut d: Vec<[f64; D]> = f.iter().map(|f| f.map(|x| -x)).collect();
        if active.is_empty() {
            return Some(d);
        }
        let mut a = SparseRows::default();
        a.starts.push(0);
        let mut b = Vec::with_capacity(active.len() * D);
        for &c in &active {
            let s = slopes(&p[c], &u[c], &self.form.laws[c], self.rho[c]);
            // The known increments of open contacts, W_cd d_d, move to the right-hand side.
            let mut known = [0.0; D];
            for (e, block) in w.row(c) {
                if place[e] == usize::MAX {
                    for i in 0..D {
                        for j in 0..D {
                            known[i] += block[i][j] * d[e][j];
                        }
                    }
                }
            }
            for i in 0..D {
                let mut own = s.p[i];
                for j in 0..D {
                    for l in 0..D {
                        let x = w.diagonal[c][l][j] + if l == j { self.alpha } else { 0.0 };
                        own[j] += s.u[i][l] * x;
                    }
                }
                let mut right = -f[c][i];
                for l in 0..D {
                    right -= s.u[i][l] * known[l];
                }
                b.push(right);
                let mut put = false;
                for (e, block) in w.row(c) {
                    let at = place[e];
                    if at == usize::MAX {
                        continue;
                    }
                    if !put && e > c {
                        push(&mut a, place[c], &own);
                        put = true;
                    }
                    let row: [f64; D] =
                        std::array::from_fn(|j| (0..D).map(|l| s.u[i][l] * block[l][j]).sum());
                    push(&mut a, at, &row);
                }
                if !put {
                    push(&mut a, place[c], &own);
                }
                a.starts.push(a.columns.len());
            }
        }
        let factor = Factor::new(&a)?;
        if !factor.solve(&mut b) {
            return None;
        }
        for (k, &c) in active.iter().enumerate() {
            d[c].copy_from_slice(&b[k * D..k * D + D]);
        }
        Some(d)
    }
}

fn push<const D: usize>(a: &mut SparseRows, block: usize, row: &[f64; D]) {
    for (j, x) in row.iter().enumerate() {
        a.columns.push(block * D + j);
        a.values.push(*x);
    }
}

/// An iterate of Newton's method with its residual.
#[derive(Clone)]
struct NewtonIterate<const D: usize> {
    p: Vec<[f64; D]>,
    u: Vec<[f64; D]>,
    f: Vec<[f64; D]>,
    merit: f64,
}

impl<const D: usize> NewtonIterate<D> {
    fn new(n: usize) -> Self {
        let zero = vec![[0.0; D]; n];
        Self {
            p: zero.clone(),
            u: zero.clone(),
            f: zero,
            merit: f64::INFINITY,
        }
    }

    fn evaluate(&mut self, prox: &Prox<D>) {
        prox.velocity(&self.p, &mut self.u);
        self.merit = prox.residual(&self.p, &self.u, &mut self.f);
    }

    /// Evaluates from + t d.
    fn step(&mut self, from: &[[f64; D]], t: f64, d: &[[f64; D]], prox: &Prox<D>) {
        let parts = from.as_flattened().iter().zip(d.as_flattened());
        for (x, (a, d)) in self.p.as_flattened_mut().iter_mut().zip(parts) {
            *x = a + t * d;
        }
        self.evaluate(prox);
    }
}

/// Maximum number of Newton steps of one proximal problem.
const INNER: u32 = 16;
/// Number of full steps accepted although the merit function grows: between kinks the line search
/// makes little progress, while the full step reaches the right branch.
const BOLD: u32 = 8;
/// A line-search step shorter than this is replaced by the full step.
const SHORT: f64 = 0.1;

/// Solves one proximal problem from its centre; returns whether the residual is well below the
/// change due to alpha.
fn inner<const D: usize>(
    prox: &Prox<D>,
    mean: f64,
    at: &mut NewtonIterate<D>,
    trial: &mut NewtonIterate<D>,
    state: &mut Iteration<D>,
    budget: &Budget,
) -> bool {
    at.p.copy_from_slice(&prox.centre);
    at.evaluate(prox);
    let mut bold = 0;
    for _ in 0..INNER {
        if state.iterations >= budget.max_iterations || Instant::now() > budget.deadline {
            return false;
        }
        let Some(d) = prox.direction(&at.p, &at.u, &at.f) else {
            return false;
        };
        state.iterations += 1;
        let mut t = 1.0;
        let fell = loop {
            trial.step(&at.p, t, &d, prox);
            if trial.merit <= (1.0 - 1e-4 * t) * at.merit {
                break true;
            }
            t *= 0.5;
            if t < if bold < BOLD { SHORT } else { 2e-4 } {
                break false;
            }
        };
        if !fell {
            if bold >= BOLD {
                return false;
            }
            bold += 1;
            trial.step(&at.p, 1.0, &d, prox);
        }
        std::mem::swap(at, trial);
        let moved: f64 =
            at.p.as_flattened()
                .iter()
                .zip(prox.centre.as_flattened())
                .map(|(a, b)| (a - b).powi(2))
                .sum();
        let enough = 1e-2 * (prox.alpha / mean).powi(2) * moved;
        if at.merit <= enough.max(1e-26 * squared(&at.p)) {
            return true;
        }
    }
    false
}

impl Newton {
    /// Checks that every law has derivatives independent of other blocks.
    ///
    /// # Errors
    /// Returns a sentence that names the first law whose bound depends on another block's impulse.
    pub fn serves(laws: &[Law]) -> Result<(), String> {
        let bounded = laws
            .iter()
            .position(|law| matches!(law, Law::Moment { .. }));
        match bounded {
            None => Ok(()),
            Some(block) => Err(format!(
                "Newton's method does not solve moments that another block's impulse bounds, as those of \
                 block {block}"
            )),
        }
    }
}

impl<const D: usize> Solver<D> for Newton {
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        const FALL: f64 = 0.3;
        const RISE: f64 = 3.0;
        const HOLD: u32 = 4;
        const SCALES: [f64; 3] = [1.0, 10.0, 0.1];
        let n = form.len();
        let steps: Vec<f64> = (0..n)
            .map(|c| {
                let l = largest(form.w.diagonal(c));
                if l > 0.0 { 1.0 / l } else { 1.0 }
            })
            .collect();
        let mean = steps.iter().map(|s| 1.0 / s).sum::<f64>() / n.max(1) as f64;
        let mut prox = Prox {
            form,
            rho: steps.clone(),
            alpha: self.alpha * mean,
            centre: state.p.clone(),
        };
        let (mut at, mut trial) = (NewtonIterate::new(n), NewtonIterate::new(n));
        let mut best = Best::of(state);
        let mut hold = 0u32;
        let mut failures = 0;
        while !budget.ends(state) {
            prox.centre.copy_from_slice(&state.p);
            let before = state.error;
            let good = inner(&prox, mean, &mut at, &mut trial, state, budget);
            // Newton's iterate may lie slightly outside the cones.
            for c in 0..n {
                // Contacts between immovable bodies keep their impulse, which would otherwise grow
                // without bound.
                if largest(form.w.diagonal(c)) > 0.0 {
                    state.p[c] = form.laws[c].project(&at.p[c], &at.p);
                }
            }
            state.measure(form);
            best.keep(state);
            if good {
                // A failed variant is not tried again at once, unless there is no other progress.
                let slow = state.error > 0.9 * before;
                hold = if slow { 0 } else { hold.saturating_sub(1) };
                if hold == 0 {
                    prox.alpha = (FALL * prox.alpha).max(1e-14 * mean);
                }
                continue;
            }
            prox.alpha *= RISE;
            hold = HOLD;
            // A different rho moves the kinks of the projections.
            failures += 1;
            let scale = SCALES[failures % SCALES.len()];
            for (rho, step) in prox.rho.iter_mut().zip(&steps) {
                *rho = scale * step;
            }
            if state.error > before {
                state.p.copy_from_slice(&prox.centre);
                state.measure(form);
            }
            if prox.alpha > 1e3 * mean {
                break;
            }
        }
        best.restore(form, state);
    }
}
