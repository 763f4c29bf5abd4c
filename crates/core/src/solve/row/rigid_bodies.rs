//! What rows of contacts are made of: the masses and lengths of rigid bodies.

use super::motion::Levers;
use super::solver_bodies::SolverBody;
use crate::geometry::space::{Space, VectorLike};
use crate::solve::form::{ContactForm, Mobility};

/// The bodies of a problem.
pub(in crate::solve) struct RigidBodies<'a, S: Space> {
    pub solver_bodies: &'a [SolverBody<S>],
    pub masses: &'a [Mobility<S>],
    pub lengths: &'a [f64],
}

impl<S: Space> RigidBodies<'_, S> {
    /// The bodies of a contact. They are looked up, also in a release build: sweeps then take it
    /// for granted that rows name two different bodies of the problem, see
    /// [`SolverBodies`](super::SolverBodies).
    ///
    /// # Panics
    /// Where the bodies are the same, or one is not there.
    fn of(&self, contact: &ContactForm<S>) -> [&SolverBody<S>; 2] {
        assert_ne!(
            contact.bodies[0], contact.bodies[1],
            "a contact of a body with itself"
        );
        contact.bodies.map(|b| &self.solver_bodies[b as usize])
    }

    /// W along and across the normal of a contact of two balls (1/kg), at a reach of their lengths.
    #[inline]
    pub fn of_balls(&self, contact: &ContactForm<S>, [i, j]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.of(contact);
        let w_n = a.im + b.im;
        [w_n, w_n + a.is * (i * i) + b.is * (j * j)]
    }

    /// Levers of a central contact over the lengths of its bodies.
    pub fn reach(&self, contact: &ContactForm<S>) -> [f64; 2] {
        if !contact.apart {
            return [1.0; 2];
        }
        [(0, -1.0), (1, 1.0)].map(|(side, sign)| {
            let body = contact.bodies[side] as usize;
            let lever = sign * contact.normal.dot(&contact.arms[side]) / self.lengths[body];
            // A surface that stays in place has no length that a spin would scale.
            if lever.is_finite() { lever } else { 1.0 }
        })
    }

    /// The levers of a contact, and W_cc in world axes.
    pub fn levers(&self, contact: &ContactForm<S>) -> (Levers<S>, S::Matrix) {
        self.of(contact);
        let body = |b: u32| (&self.masses[b as usize], self.lengths[b as usize]);
        Levers::new(contact, contact.bodies.map(body))
    }
}
