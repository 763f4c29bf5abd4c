//! Semi-smooth Newton on the Alart-Curnier function, inside proximal steps.
//!
//! With z = p - rho u, F_n = p_n - max(z_n, 0) and F_t = p_t - proj(z_t; |.| <= mu max(z_n, 0))
//! (Alart and Curnier 1991). Rigid packings have rank-deficient W, so Newton solves
//! u = W p + q + alpha (p - p_k) and the outer loop lets p_k follow (proximal point around Newton:
//! Acary, Bremond and Huber 2018); alpha falls while that goes well. Contacts whose prediction is open
//! leave the linear system.

use super::form::{Form, dot, largest, squared};
use super::law::{Law, slip};
use super::linear::{Factor, Rows};
use super::state::{Budget, Solver, State};
use std::time::Instant;

/// The method and its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Newton {
    /// First alpha over the mean diagonal of W.
    pub alpha: f64,
}

impl Default for Newton {
    fn default() -> Self {
        Self { alpha: 1e-3 }
    }
}

/// Derivatives of one contact's F by p and by u.
struct Slopes<const D: usize> {
    p: [[f64; D]; D],
    u: [[f64; D]; D],
}

/// F of a contact, and whether it is open in the prediction.
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
    rho: &'a [f64],
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

    /// F and |F|^2.
    fn residual(&self, p: &[[f64; D]], u: &[[f64; D]], f: &mut [[f64; D]]) -> f64 {
        for c in 0..p.len() {
            f[c] = value(&p[c], &u[c], &self.form.laws[c], self.rho[c]).0;
        }
        squared(f)
    }

    /// Newton's direction.
    fn direction(&self, p: &[[f64; D]], u: &[[f64; D]], f: &[[f64; D]]) -> Option<Vec<[f64; D]>> {
        let w = self.form.w.matrix();
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
        let mut a = Rows::default();
        a.starts.push(0);
        let mut b = Vec::with_capacity(active.len() * D);
        for &c in &active {
            let s = slopes(&p[c], &u[c], &self.form.laws[c], self.rho[c]);
            let (columns, blocks) = w.row(c);
            // What open contacts do, W_cd d_d, goes to the right.
            let mut known = [0.0; D];
            for (e, block) in columns.iter().zip(blocks) {
                let e = *e as usize;
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
                        let x = w.diagonal[c][l][j]
                            + if l == j { self.alpha } else { 0.0 };
                        own[j] += s.u[i][l] * x;
                    }
                }
                let mut right = -f[c][i];
                for l in 0..D {
                    right -= s.u[i][l] * known[l];
                }
                b.push(right);
                let mut put = false;
                for (e, block) in columns.iter().zip(blocks) {
                    let at = place[*e as usize];
                    if at == usize::MAX {
                        continue;
                    }
                    if !put && *e as usize > c {
                        push(&mut a, place[c], &own);
                        put = true;
                    }
                    let row: [f64; D] = std::array::from_fn(|j| {
                        (0..D).map(|l| s.u[i][l] * block[l][j]).sum()
                    });
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

fn push<const D: usize>(a: &mut Rows, block: usize, row: &[f64; D]) {
    for (j, x) in row.iter().enumerate() {
        a.columns.push(block * D + j);
        a.values.push(*x);
    }
}

impl<const D: usize> Solver<D> for Newton {
    fn solve(&self, form: &Form<D>, state: &mut State<D>, budget: &mut Budget) {
        let n = form.len();
        let steps: Vec<f64> = (0..n)
            .map(|c| {
                let l = largest(form.w.diagonal(c));
                if l > 0.0 { 1.0 / l } else { 1.0 }
            })
            .collect();
        let mean = (0..n).map(|c| 1.0 / steps[c]).sum::<f64>() / n.max(1) as f64;
        let mut alpha = self.alpha * mean;
        let mut p = state.p.clone();
        let (mut u, mut f) = (vec![[0.0; D]; n], vec![[0.0; D]; n]);
        let (mut trial, mut trial_u, mut trial_f) = (p.clone(), u.clone(), f.clone());
        let mut best = (state.error, state.p.clone());
        while !budget.ends(state) {
            let prox = Prox {
                form,
                rho: &steps,
                alpha,
                centre: state.p.clone(),
            };
            p.copy_from_slice(&state.p);
            prox.velocity(&p, &mut u);
            let mut merit = prox.residual(&p, &u, &mut f);
            let first = merit;
            let mut good = false;
            for _ in 0..30 {
                if state.iterations >= budget.max_iterations || Instant::now() > budget.deadline {
                    break;
                }
                let Some(d) = prox.direction(&p, &u, &f) else {
                    break;
                };
                state.iterations += 1;
                let mut t = 1.0;
                let mut fell = false;
                for _ in 0..12 {
                    for c in 0..n {
                        for k in 0..D {
                            trial[c][k] = p[c][k] + t * d[c][k];
                        }
                    }
                    prox.velocity(&trial, &mut trial_u);
                    let m = prox.residual(&trial, &trial_u, &mut trial_f);
                    if m <= (1.0 - 1e-4 * t) * merit || m < 1e-28 * first {
                        fell = true;
                        std::mem::swap(&mut p, &mut trial);
                        std::mem::swap(&mut u, &mut trial_u);
                        std::mem::swap(&mut f, &mut trial_f);
                        merit = m;
                        break;
                    }
                    t *= 0.5;
                }
                let far: f64 = p
                    .iter()
                    .zip(&prox.centre)
                    .map(|(a, b)| {
                        (0..D).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>()
                    })
                    .sum::<f64>();
                let moved = alpha * alpha * far / (mean * mean);
                if std::env::var("SHOW").is_ok() {
                    eprintln!("   alpha {:.1e} it {} merit {merit:.3e} t {t:.1e} moved {moved:.2e} fell {fell}", alpha / mean, state.iterations);
                }
                if merit <= 1e-2 * moved || merit <= 1e-26 * dot(&p, &p) {
                    good = true;
                    break;
                }
                if !fell {
                    break;
                }
            }
            // The projection of a Newton iterate onto the cone costs nothing and never hurts.
            let before = state.error;
            state.p.copy_from_slice(&p);
            let keep = state.p.clone();
            for c in 0..n {
                state.p[c] = form.laws[c].project(&keep[c], &keep);
            }
            state.measure(form);
            if std::env::var("SHOW").is_ok() {
                eprintln!("alpha {:.1e} good {good} error {before:.2e} -> {:.2e}", alpha / mean, state.error);
            }
            if state.error < best.0 {
                best.0 = state.error;
                best.1.copy_from_slice(&state.p);
            }
            if good {
                alpha *= 0.1;
                alpha = alpha.max(1e-14 * mean);
            } else {
                alpha *= 10.0;
                if state.error > before {
                    state.p.copy_from_slice(&prox.centre);
                    state.measure(form);
                }
                if alpha > 1e3 * mean {
                    break;
                }
            }
        }
        if state.error > best.0 {
            state.p.copy_from_slice(&best.1);
            state.measure(form);
        }
    }
}
