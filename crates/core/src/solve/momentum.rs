//! Nesterov's momentum on the Gauss-Seidel iteration over bodies: an iteration starts from impulses that are moved on by a factor times
//! what the previous iteration changed,
//!
//! y_k = p_k + beta_k (p_k - p_(k-1)),  beta_k = (t_k - 1) / t_(k+1),  t_(k+1) = (1 + sqrt(1 + 4 t_k^2)) / 2  (Nesterov 1983).
//!
//! Velocities are moved on by the same factor, since they are linear in the impulses. Momentum starts anew (t = 1) where it points against
//! what the iteration did, (y_k - p_(k+1)) . W (p_(k+1) - p_k) > 0 (the gradient test of O'Donoghue and Candes 2015, measured by the kinetic energy of
//! the velocities that the impulses make).
//!
//! With friction the contact problem is no minimisation, and full momentum may circle. Where the residual does not fall, t is limited
//! to half of what it was.

use super::form::Problem;
use super::row::{Parts, SolverBody};
use crate::geometry::space::{Space, VectorLike};
use crate::threads::{fill, map_chunks_of_two, pays};

/// Bodies of a task.
const CHUNK: usize = 2048;
/// About what a pass over bodies takes for each (ns).
const EACH: f64 = 4.0;

/// What the last iteration did to a body, in velocities (m/s).
#[derive(Clone, Copy, Debug)]
struct Moved<S: Space> {
    /// Where it ended.
    v: S::Vector,
    s: S::Spin,
    /// How far it came.
    dv: S::Vector,
    ds: S::Spin,
    /// Mass and moment of inertia over the square of the length (kg); zero of what does not move.
    mass: f64,
    inertia: f64,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Momentum<S: Space> {
    /// t_k of the module.
    t: f64,
    /// beta_k.
    factor: f64,
    /// Largest t_k.
    most: f64,
    bodies: Vec<Moved<S>>,
    /// Impulses after the last iteration: of the plain and full rows, of those with lever arms, with and without bonds.
    pub impulses: [Vec<Parts<S>>; 4],
    pub moments: Vec<S::Spin>,
}

impl<S: Space> Momentum<S> {
    /// Starts from the impulses and velocities of a problem.
    pub fn new(problem: &Problem<S>, parallel: bool) -> Self {
        let inverse = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
        let (mut bodies, count) = (Vec::new(), problem.solver_bodies.len());
        fill(pays(parallel, count, EACH), &mut bodies, count, |b| {
            let b = &problem.solver_bodies[b];
            Moved {
                v: b.v,
                s: b.s,
                dv: S::Vector::zero(),
                ds: S::Spin::zero(),
                mass: inverse(b.im),
                inertia: inverse(b.is),
            }
        });
        Self {
            t: 1.0,
            factor: 0.0,
            most: f64::INFINITY,
            bodies,
            impulses: [
                problem.plain.parts(parallel),
                problem.full.parts(parallel),
                problem.levers.parts(parallel),
                problem.bonded_levers.parts(parallel),
            ],
            moments: problem.moments.iter().map(|row| row.moment()).collect(),
        }
    }

    /// Starts anew from other impulses and velocities of the same problem.
    pub fn start_anew(&mut self, problem: &Problem<S>, parallel: bool) {
        *self = Self {
            most: self.most,
            ..Self::new(problem, parallel)
        };
    }

    /// The state after an iteration from t = 1, which moves nothing on.
    fn start(&mut self) {
        let golden = 0.5 * (1.0 + 5f64.sqrt());
        (self.t, self.factor) = (golden.min(self.most), 0.0);
    }

    /// Takes less momentum from now on.
    pub fn slow_down(&mut self) {
        self.most = (0.5 * self.t).max(1.0);
        self.t = self.t.min(self.most);
    }

    /// Takes more again, up to full momentum.
    pub fn speed_up(&mut self) {
        self.most *= 1.5;
    }

    /// Moves the velocities on, after an iteration; returns the factor by which the next one moves the impulses on.
    pub fn advance(&mut self, solver_bodies: &mut [SolverBody<S>], parallel: bool) -> f64 {
        let next = 0.5 * (1.0 + (1.0 + 4.0 * self.t * self.t).sqrt());
        let factor = (self.t - 1.0) / next;
        let divide = pays(parallel, solver_bodies.len(), EACH);
        let lists = (&mut self.bodies[..], &mut solver_bodies[..]);
        let parts = map_chunks_of_two(divide, CHUNK, lists, |_, moved, bodies| {
            let (mut squared, mut along) = (0.0, 0.0);
            for (m, b) in moved.iter_mut().zip(bodies) {
                let (dv, ds) = (b.v - m.v, b.s - m.s);
                squared += m.mass * dv.dot(&dv) + m.inertia * ds.dot(&ds);
                along += m.mass * dv.dot(&m.dv) + m.inertia * ds.dot(&m.ds);
                (m.v, m.s, m.dv, m.ds) = (b.v, b.s, dv, ds);
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
            // Seldom: nothing is moved on.
            let lists = (&mut self.bodies[..], solver_bodies);
            map_chunks_of_two(divide, CHUNK, lists, |_, moved, bodies| {
                for (m, b) in moved.iter().zip(bodies) {
                    (b.v, b.s) = (m.v, m.s);
                }
            });
            self.start();
            return 0.0;
        }
        (self.t, self.factor) = (next.min(self.most), factor);
        factor
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::space::{Dim2, Space, VectorLike};
    use crate::solve::{ContactForm, Options, Problem, nlgs};
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
                central: true,
                shift_n: 0.0,
                shift_t: <Dim2 as Space>::Tangent::zero(),
                friction,
                tension: 0.0,
                cohesion: 0.0,
                elastic: None,
                compliance: [0.0; 2],
                impulse: Vector2::zero(),
            });
        }
        problem
    }

    /// A contact carries what is above it; a sweep passes a force on to the next contact, so that without momentum the number of sweeps grows
    /// with the square of the height.
    #[test]
    fn a_column_is_solved_in_sweeps_that_grow_with_its_height() {
        let count = 200;
        for friction in [0.0, 0.3] {
            let mut problem = column(count, friction);
            let options = Options {
                tolerance: 1e-8,
                ..Options::default()
            };
            let report = nlgs::solve(&mut problem, &options);
            assert!(report.converged);
            assert!(report.iterations < 15 * count, "{}", report.iterations);
            for k in 0..count {
                let (carried, above) = (problem.solution(k as usize).impulse, count - k);
                let error = (carried - Vector2::new(0.0, f64::from(above))).norm();
                assert!(error < 1e-5 * f64::from(above), "{k}: {carried}");
            }
        }
    }
}
