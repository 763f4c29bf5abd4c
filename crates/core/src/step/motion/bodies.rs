//! Motion of the bodies in the Moreau-Jean theta-scheme: half moves, free velocities, work.
//!
//! For anisotropic inertia the spin changes as the body rotates: half moves integrate the free
//! rotation, and the velocities of the step are those at q_m.

use crate::bodies::Bodies;
use crate::energy::BodyWork;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::threads::{fill, map_chunks_mut, map_chunks_of_two, map_ranges, worth_dividing};

/// Number of bodies of a task.
const CHUNK: usize = 1024;
/// Approximate time per body of a pass over bodies (ns).
const EACH: f64 = 10.0;

/// Advances positions and orientations by `time` (s) without forces.
pub fn advance<S: Space>(bodies: &mut Bodies<S>, time: f64, parallel: bool) {
    let divide = worth_dividing(parallel, bodies.len(), EACH);
    let Bodies {
        position,
        rotation,
        velocity,
        spin,
        tensors,
        inverse_inertia,
        lost,
        ..
    } = bodies;
    let velocity = &*velocity;
    let moved = map_chunks_mut(divide, position, CHUNK, |first, position| {
        let mut lost = Vec::new();
        for (position, b) in position.iter_mut().zip(first..) {
            let (v, from) = (velocity[b], *position);
            *position += v * time;
            for k in 0..S::D {
                if position[k] == from[k] && v[k] != 0.0 {
                    lost.push((b, k, v[k] * time));
                }
            }
        }
        lost
    });
    for (b, k, distance) in moved.into_iter().flatten() {
        // The displacement is below the floating-point spacing of the position. The losses of an
        // oscillating motion cancel.
        lost.resize(position.len(), S::Vector::zero());
        lost[b][k] += distance;
    }
    map_chunks_of_two(divide, CHUNK, (rotation, spin), |first, rotation, spin| {
        for ((rotation, spin), b) in rotation.iter_mut().zip(spin).zip(first..) {
            if *spin == S::Spin::zero() {
                continue;
            }
            let tensor = tensors.get(b).and_then(Option::as_ref);
            (*rotation, *spin) = match tensor.filter(|_| inverse_inertia[b] > 0.0) {
                Some(tensor) => tensor.free_rotation(rotation, spin, time),
                None => (S::turned(rotation, &(*spin * time)), *spin),
            };
        }
    });
}

/// Computes v_free = v + h M^-1 F, and the imposed velocities at the end of the step. Forces are
/// evaluated at the theta-point, t + theta h.
pub fn free_velocities<S: Space>(
    bodies: &Bodies<S>,
    gravity: &S::Vector,
    time: f64,
    h: f64,
    theta: f64,
    parallel: bool,
) -> Vec<(S::Vector, S::Spin)> {
    let mut free = Vec::new();
    fill(
        worth_dividing(parallel, bodies.len(), EACH),
        &mut free,
        bodies.len(),
        |b| {
            let mut v = bodies.velocity[b];
            for k in 0..S::D {
                if bodies.inverse_mass[b][k] > 0.0 {
                    v[k] += h * gravity[k];
                }
            }
            (v, bodies.spin[b])
        },
    );
    for driven in &bodies.driven {
        let b = driven.body as usize;
        let (v, w) = &mut free[b];
        let mut moment = S::Spin::zero();
        for (k, dof) in driven.dofs.iter().enumerate() {
            let dof = dof.over(time, h);
            let imposed = dof.speeds(time, h, theta).map(|speeds| speeds.end);
            let force = dof.force(time + theta * h);
            if k < S::D {
                match imposed {
                    Some(velocity) => v[k] = velocity,
                    None => v[k] += h * bodies.inverse_mass[b][k] * force,
                }
            } else {
                match imposed {
                    Some(velocity) => w[k - S::D] = velocity,
                    None => moment[k - S::D] = h * force,
                }
            }
        }
        *w += bodies.inverse_tensor(b).apply(&moment);
    }
    free
}

/// State of the bodies at the start of a step, used to compute the work of the step.
pub struct StepStart<S: Space> {
    velocity: Vec<S::Vector>,
    spin: Vec<S::Spin>,
}

impl<S: Space> StepStart<S> {
    /// Copies the velocities.
    pub fn new(bodies: &Bodies<S>) -> Self {
        Self {
            velocity: bodies.velocity.clone(),
            spin: bodies.spin.clone(),
        }
    }

    /// Stores the spins that bodies reach by free rotation over the first half move.
    pub fn take_rotated_spins(&mut self, bodies: &Bodies<S>) {
        for b in 0..bodies.tensors.len() {
            if bodies.tensor(b).is_some() {
                self.spin[b] = bodies.spin[b];
            }
        }
    }

    /// Returns velocities and spins of the driven bodies at the start of the step, in their order.
    pub fn of_driven(&self, bodies: &Bodies<S>) -> Vec<(S::Vector, S::Spin)> {
        let of = |b: usize| (self.velocity[b], self.spin[b]);
        bodies.driven.iter().map(|d| of(d.body as usize)).collect()
    }

    /// Restores the velocities of the bodies.
    pub fn restore(&self, bodies: &mut Bodies<S>) {
        bodies.velocity.clone_from(&self.velocity);
        bodies.spin.clone_from(&self.spin);
    }

    /// Returns the velocity of a body at the start of the step.
    pub fn velocity(&self, body: usize) -> S::Vector {
        self.velocity[body]
    }

    /// Returns the spin of a body at the start of the step.
    pub fn spin(&self, body: usize) -> S::Spin {
        self.spin[body]
    }

    /// Computes the work done over the step. `received` holds the contact impulses and moments on
    /// the driven bodies in their order (N s, N m s).
    ///
    /// An imposed degree of freedom receives J = m (v+ - v) - h F - (H p), which works at v_theta.
    pub fn work(
        &self,
        bodies: &Bodies<S>,
        received: &[(S::Vector, S::Spin)],
        gravity: &S::Vector,
        time: f64,
        [h, theta]: [f64; 2],
        parallel: bool,
    ) -> BodyWork {
        let divide = worth_dividing(parallel, bodies.len(), EACH);
        let parts = map_ranges(divide, bodies.len(), CHUNK, |some| {
            let (mut potential, mut scheme) = (0.0, 0.0);
            for b in some.filter(|b| bodies.carrier(*b).is_none()) {
                let (v, w) = (self.velocity[b], self.spin[b]);
                let average = v * (1.0 - theta) + bodies.velocity[b] * theta;
                potential -= h * bodies.mass[b] * gravity.dot(&average);
                if theta != 0.5 {
                    let (dv, dw) = (bodies.velocity[b] - v, bodies.spin[b] - w);
                    let turning = dw.dot(&bodies.angular_momentum(b, &dw));
                    scheme += (theta - 0.5) * (bodies.mass[b] * dv.dot(&dv) + turning);
                }
            }
            (potential, scheme)
        });
        let mut work = BodyWork::default();
        for (potential, scheme) in parts {
            work.potential += potential;
            work.scheme += scheme;
        }
        for (driven, (impulse, moment)) in bodies.driven.iter().zip(received) {
            let b = driven.body as usize;
            for (k, dof) in driven.dofs.iter().enumerate() {
                let dof = dof.over(time, h);
                let (old, new, inertia, received, weight) = if k < S::D {
                    let g = h * bodies.mass[b] * gravity[k];
                    (
                        self.velocity[b][k],
                        bodies.velocity[b][k],
                        bodies.mass[b],
                        impulse[k],
                        g,
                    )
                } else {
                    let k = k - S::D;
                    (
                        self.spin[b][k],
                        bodies.spin[b][k],
                        bodies.inertia[b],
                        moment[k],
                        0.0,
                    )
                };
                let average = (1.0 - theta) * old + theta * new;
                work.external += average
                    * if dof.imposes() {
                        inertia * (new - old) - weight - received
                    } else {
                        h * dof.force(time + theta * h)
                    };
            }
        }
        work
    }
}
