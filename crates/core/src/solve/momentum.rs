//! Nesterov's momentum on the Gauss-Seidel iteration over bodies: an iteration starts from impulses
//! extrapolated by a factor times their change in the previous iteration,
//!
//! y_k = p_k + beta_k (p_k - p_(k-1)),  beta_k = (t_k - 1) / t_(k+1),  t_(k+1) = (1 + sqrt(1 + 4
//! t_k^2)) / 2  (Nesterov 1983).
//!
//! Velocities are extrapolated by the same factor, since they are linear in the impulses. Momentum
//! starts anew (t = 1) where it points against the change by the iteration, (y_k - p_(k+1)) . W
//! (p_(k+1) - p_k) > 0 (the gradient test of O'Donoghue and Candes 2015, measured by the kinetic
//! energy of the velocity changes due to the impulses).
//!
//! With friction the contact problem is not a minimisation, and full momentum may cycle. Where the
//! residual does not fall from one convergence test to the next, t is limited to half of its
//! largest value between them.

use super::kinds::{KINDS, of_kind};
use super::problem::Problem;
use super::row::{Parts, SolverBody};
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{fill, map_chunks_of_two, worth_dividing};

/// Number of bodies of a task.
const CHUNK: usize = 2048;
/// Approximate time per body of a pass over bodies (ns).
const EACH: f64 = 4.0;

/// Velocities of a body after the last iteration, and their change in it (m/s).
#[derive(Clone, Copy, Debug)]
struct BodyIncrement<S: Space> {
    v: S::Vector,
    s: S::Spin,
    dv: S::Vector,
    ds: S::Spin,
    /// Mass, and moment of inertia over the square of the length (kg); zero where immovable.
    mass: f64,
    inertia: f64,
}

/// The state of the momentum iteration.
#[derive(Debug)]
pub(super) struct MomentumIteration<S: Space> {
    /// The sequence t_k of the module.
    t: f64,
    /// The factor beta_k of the module.
    factor: f64,
    /// Upper bound of t_k.
    max_t: f64,
    /// Largest t_k since the last convergence test.
    peak_t: f64,
    bodies: Vec<BodyIncrement<S>>,
    /// Impulses after the last iteration, by kind of rows.
    pub impulses: [Vec<Parts<S>>; KINDS],
    pub moments: Vec<S::Spin>,
}

impl<S: Space> MomentumIteration<S> {
    /// Starts from the impulses and velocities of a problem.
    pub fn new(problem: &Problem<S>, parallel: bool) -> Self {
        let inverse = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
        let (mut bodies, count) = (Vec::new(), problem.solver_bodies.len());
        fill(
            worth_dividing(parallel, count, EACH),
            &mut bodies,
            count,
            |b| {
                let b = &problem.solver_bodies[b];
                BodyIncrement {
                    v: b.v,
                    s: b.s,
                    dv: S::Vector::zero(),
                    ds: S::Spin::zero(),
                    mass: inverse(b.im),
                    inertia: inverse(b.is),
                }
            },
        );
        Self {
            t: 1.0,
            factor: 0.0,
            max_t: f64::INFINITY,
            peak_t: 1.0,
            bodies,
            impulses: problem
                .rows
                .each_ref()
                .map(|rows| of_kind!(rows, rows => rows.local_impulses(parallel))),
            moments: problem.moments.iter().map(|row| row.moment()).collect(),
        }
    }

    /// Starts again from other impulses and velocities of the same problem, with the same bound.
    pub fn restart(&mut self, problem: &Problem<S>, parallel: bool) {
        *self = Self {
            max_t: self.max_t,
            ..Self::new(problem, parallel)
        };
    }

    /// Halves the bound on momentum, after a test at which the residual had not fallen.
    pub fn slow_down(&mut self) {
        self.max_t = (0.5 * self.peak_t).max(1.0);
        self.t = self.t.min(self.max_t);
        self.peak_t = self.t;
    }

    /// Increases the bound on momentum by half, if there is one, after a test at which the residual
    /// had fallen.
    pub fn speed_up(&mut self) {
        if self.peak_t >= self.max_t {
            self.max_t *= 1.5;
        }
        self.peak_t = self.t;
    }

    /// Extrapolates the velocities after an iteration; returns the factor by which the next
    /// iteration extrapolates the impulses.
    pub fn advance(&mut self, solver_bodies: &mut [SolverBody<S>], parallel: bool) -> f64 {
        let next = |t: f64| 0.5 * (1.0 + (1.0 + 4.0 * t * t).sqrt());
        let next_t = next(self.t);
        let factor = (self.t - 1.0) / next_t;
        let divide = worth_dividing(parallel, solver_bodies.len(), EACH);
        let lists = (&mut self.bodies[..], &mut solver_bodies[..]);
        let parts = map_chunks_of_two(divide, CHUNK, lists, |_, increments, bodies| {
            let (mut squared, mut along) = (0.0, 0.0);
            for (last, b) in increments.iter_mut().zip(bodies) {
                let (dv, ds) = (b.v - last.v, b.s - last.s);
                squared += last.mass * dv.dot(&dv) + last.inertia * ds.dot(&ds);
                along += last.mass * dv.dot(&last.dv) + last.inertia * ds.dot(&last.ds);
                (last.v, last.s, last.dv, last.ds) = (b.v, b.s, dv, ds);
                b.v += dv * factor;
                b.s += ds * factor;
            }
            [squared, along]
        });
        let (mut squared, mut along) = (0.0, 0.0);
        for part in parts {
            squared += part[0];
            along += part[1];
        }
        if self.factor * along > squared {
            // Momentum points against the iteration: t = 1, and the extrapolation is undone. This
            // is rare.
            let lists = (&mut self.bodies[..], solver_bodies);
            map_chunks_of_two(divide, CHUNK, lists, |_, increments, bodies| {
                for (last, b) in increments.iter().zip(bodies) {
                    (b.v, b.s) = (last.v, last.s);
                }
            });
            (self.t, self.factor) = (next(1.0).min(self.max_t), 0.0);
        } else {
            (self.t, self.factor) = (next_t.min(self.max_t), factor);
        }
        self.peak_t = self.peak_t.max(self.t);
        self.factor
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::space::{Dim2, VectorLike};
    use crate::solve::{ContactForm, Problem, SolverOptions, nlgs};
    use nalgebra::{Matrix1, Vector1, Vector2};

    /// A column of `count` disks of 1 kg on a floor, each with velocity -1 m/s without contacts.
    fn column(count: u32, friction: f64) -> Problem<Dim2> {
        let mut problem = Problem::default();
        let (spin, turned) = (Vector1::new(0.0), Matrix1::new(2.0));
        for _ in 0..count {
            let (down, mobility) = (Vector2::new(0.0, -1.0), Vector2::new(1.0, 1.0));
            problem.push_body(down, spin, mobility, turned, 1.0);
        }
        let (zero, none) = (Vector2::zero(), Matrix1::new(0.0));
        problem.push_body(zero, spin, zero, none, 1.0);
        for k in 0..count {
            let below = if k == 0 { count } else { k - 1 };
            problem.push(&ContactForm {
                bodies: [k, below],
                normal: Vector2::new(0.0, 1.0),
                arms: [Vector2::new(0.0, -1.0), Vector2::new(0.0, 1.0)],
                friction,
                ..ContactForm::default()
            });
        }
        problem
    }

    /// Each contact carries the load above it. A sweep passes a force on to the next contact, so
    /// that the number of sweeps grows with the square of the height without momentum, and in
    /// proportion to the height with momentum.
    #[test]
    fn a_column_is_solved_in_sweeps_that_grow_with_its_height() {
        for friction in [0.0, 0.3] {
            let sweeps = [100, 200, 400].map(|count| {
                let mut problem = column(count, friction);
                let options = SolverOptions {
                    tolerance: 1e-12,
                    ..SolverOptions::default()
                };
                let report = nlgs::solve(&mut problem, &options);
                assert!(report.converged);
                for k in 0..count {
                    let (carried, above) = (problem.solution(k as usize).impulse, count - k);
                    let error = (carried - Vector2::new(0.0, f64::from(above))).norm();
                    // The square root of the tolerance: the unbalanced share of the weight.
                    assert!(error < 1e-6 * f64::from(count), "{k}: {carried}");
                }
                f64::from(report.iterations)
            });
            assert!(sweeps[2] < 6.0 * sweeps[0], "{sweeps:?}");
        }
    }

    /// With sliding contacts and fast common motion, the solution equals that of plain sweeps.
    #[test]
    fn it_solves_the_same_problem() {
        for drift in [0.0, 1e3] {
            let solved = [true, false].map(|accelerated| {
                let mut problem = column(60, 0.02);
                for (k, body) in problem.free.iter_mut().enumerate() {
                    // A sideways velocity that increases with height lets some contacts slide.
                    body.0.x = drift + 0.5 * k as f64;
                }
                let options = SolverOptions {
                    tolerance: 1e-12,
                    max_iterations: 1_000_000,
                    accelerated,
                    ..SolverOptions::default()
                };
                let report = nlgs::solve(&mut problem, &options);
                assert!(report.converged, "{report:?}");
                let all = (0..60).map(|k| problem.solution(k).impulse);
                (all.collect::<Vec<_>>(), report.iterations)
            });
            let [(fast, few), (plain, many)] = &solved;
            assert!(few < many, "{few} of {many}");
            let slides = |p: &Vector2<f64>| p.x.abs() > 0.02 * p.y * (1.0 - 1e-6);
            assert!(plain.iter().any(slides));
            for (p, q) in fast.iter().zip(plain) {
                assert!((p - q).norm() < 1e-4 * plain[0].norm(), "{p} {q}");
            }
        }
    }
}
