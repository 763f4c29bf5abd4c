//! Accelerated projected gradient with restarts (Nesterov 1983; O'Donoghue and Candes 2015; for
//! cone complementarity Mazhar, Heyn, Negrut and Tasora 2015), with the De Saxce term evaluated at
//! the iterate.
//!
//! Each contact has its own step length, theta / lambda_max(W_cc), a scalar so that the projection
//! onto the cone stays exact; theta is reduced until the quadratic model bounds the energy.

use super::form::{Form, largest};
use super::law::slip;
use super::state::{Best, Budget, Iteration, Solver};

/// The method.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accelerated;

impl<const D: usize> Solver<D> for Accelerated {
    fn solve(&self, form: &Form<D>, state: &mut Iteration<D>, budget: &mut Budget) {
        let n = form.len();
        let size: Vec<f64> = (0..n).map(|c| largest(form.w.diagonal(c))).collect();
        // Contacts between immovable bodies keep their impulse.
        let scale: Vec<f64> = size
            .iter()
            .map(|l| if *l > 0.0 { 1.0 / l } else { 0.0 })
            .collect();
        let mut theta = 1.0;
        let mut momentum = 1.0f64;
        let (mut y, mut uy) = (state.p.clone(), state.u.clone());
        let (mut p, mut u) = (state.p.clone(), state.u.clone());
        let mut best = Best::of(state);
        while !budget.ends(state) {
            loop {
                for c in 0..n {
                    let shift = form.laws[c].friction() * slip(&uy[c]);
                    let rho = theta * scale[c];
                    let z: [f64; D] = std::array::from_fn(|k| {
                        y[c][k] - rho * (uy[c][k] + if k == 0 { shift } else { 0.0 })
                    });
                    p[c] = form.laws[c].project(&z, &y);
                }
                form.velocity(&p, &mut u);
                let (mut energy, mut bound) = (0.0, 0.0);
                for c in 0..n {
                    for k in 0..D {
                        let d = p[c][k] - y[c][k];
                        energy += d * (u[c][k] - uy[c][k]);
                        bound += d * d * size[c];
                    }
                }
                if energy * theta <= bound * (1.0 + 1e-12) || theta < 1e-12 {
                    break;
                }
                theta *= 0.7;
            }
            // Restart where the momentum points uphill.
            let uphill: f64 = (0..n)
                .map(|c| {
                    (0..D)
                        .map(|k| (y[c][k] - p[c][k]) * (p[c][k] - state.p[c][k]))
                        .sum::<f64>()
                        * size[c]
                })
                .sum();
            let next = if uphill > 0.0 {
                1.0
            } else {
                0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt())
            };
            let beta = if uphill > 0.0 {
                0.0
            } else {
                (momentum - 1.0) / next
            };
            momentum = next;
            // y = p + beta (p - p_old), and the velocities with it, since W is linear.
            for c in 0..n {
                for k in 0..D {
                    y[c][k] = p[c][k] + beta * (p[c][k] - state.p[c][k]);
                    uy[c][k] = u[c][k] + beta * (u[c][k] - state.u[c][k]);
                }
            }
            std::mem::swap(&mut state.p, &mut p);
            std::mem::swap(&mut state.u, &mut u);
            state.iterations += 1;
            state.update_error(form);
            best.keep(state);
        }
        best.restore(form, state);
    }
}
