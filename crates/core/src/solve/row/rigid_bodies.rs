//! Masses and lengths of rigid bodies, from which rows of contacts are made.

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
    /// Returns the bodies of a contact. The indices are checked, also in a release build: sweeps
    /// rely on rows that name two different bodies of the problem, see
    /// [`SolverBodies`](super::SolverBodies).
    ///
    /// # Panics
    /// The bodies are the same, or one does not exist.
    fn of(&self, contact: &ContactForm<S>) -> [&SolverBody<S>; 2] {
        assert_ne!(
            contact.bodies[0], contact.bodies[1],
            "a contact of a body with itself"
        );
        contact.bodies.map(|b| &self.solver_bodies[b as usize])
    }

    /// Returns W along and across the normal of a contact of two balls (1/kg), with levers relative
    /// to their lengths.
    #[inline]
    pub fn of_balls(&self, contact: &ContactForm<S>, [i, j]: [f64; 2]) -> [f64; 2] {
        let [a, b] = self.of(contact);
        let w_n = a.im + b.im;
        [w_n, w_n + a.is * (i * i) + b.is * (j * j)]
    }

    /// Returns the levers of a central contact divided by the lengths of its bodies.
    pub fn reach(&self, contact: &ContactForm<S>) -> [f64; 2] {
        if !contact.apart {
            return [1.0; 2];
        }
        [(0, -1.0), (1, 1.0)].map(|(side, sign)| {
            let body = contact.bodies[side] as usize;
            let lever = sign * contact.normal.dot(&contact.arms[side]) / self.lengths[body];
            // A surface that stays in place has no length by which a spin would be scaled.
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
