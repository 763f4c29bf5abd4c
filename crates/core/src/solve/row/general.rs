//! A contact with lever arms, or of a body that is free along some axes only: solved as a block, exactly
//! where there is no shear cohesion.

use super::block::BlockContact;
use super::{Residual, Row, SolverBody};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use crate::solve::form::{ContactForm, ContactSolution, Mobility};

/// A contact with lever arms, or of a body that is free along some axes only: a full block.
#[derive(Clone, Debug)]
pub(in crate::solve) struct GeneralRow<S: Space> {
    bodies: [u32; 2],
    /// Arms over the lengths of the bodies.
    arms: [S::Vector; 2],
    inverse_masses: [S::Vector; 2],
    /// Inverse inertia times the lengths squared (1/kg).
    inverse_spins: [S::Tensor; 2],
    contact: BlockContact<S>,
}

impl<S: Space> GeneralRow<S> {
    pub fn new(
        contact: &ContactForm<S>,
        block: S::Matrix,
        inertia: impl Fn(usize) -> (Mobility<S>, f64),
    ) -> Self {
        let [i, j] = contact.bodies.map(|b| inertia(b as usize));
        Self {
            bodies: contact.bodies,
            arms: [contact.arms[0] * (1.0 / i.1), contact.arms[1] * (1.0 / j.1)],
            inverse_masses: [i.0.mass, j.0.mass],
            inverse_spins: [i, j].map(|(m, length)| m.inertia.scaled(length).scaled(length)),
            contact: BlockContact::new(contact, block),
        }
    }

    fn relative(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> S::Vector {
        a.v + S::spin_velocity(&a.s, &self.arms[0]) - b.v - S::spin_velocity(&b.s, &self.arms[1])
    }

    fn push(&self, p: &S::Vector, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        a.v += p.scaled_by(&self.inverse_masses[0]);
        b.v -= p.scaled_by(&self.inverse_masses[1]);
        a.s += self.inverse_spins[0].apply(&S::moment(&self.arms[0], p));
        b.s -= self.inverse_spins[1].apply(&S::moment(&self.arms[1], p));
    }
}

impl<S: Space> Row<S> for GeneralRow<S> {
    fn bodies(&self) -> [u32; 2] {
        self.bodies
    }

    fn update(&mut self, a: &mut SolverBody<S>, b: &mut SolverBody<S>, relaxation: f64) {
        let change = self.contact.update(self.relative(a, b), relaxation);
        self.push(&change, a, b);
    }

    fn load(&self, a: &mut SolverBody<S>, b: &mut SolverBody<S>) {
        self.push(self.contact.impulse(), a, b);
    }

    fn store(&self, out: &mut Vec<f64>) {
        self.contact.store(out);
    }

    fn restore(&mut self, from: &mut &[f64]) {
        self.contact.restore(from);
    }

    fn set(&mut self, impulse: &S::Vector) {
        self.contact.set(impulse);
    }

    fn normal(&self) -> f64 {
        self.contact.normal()
    }

    fn speed(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> f64 {
        let u = self.relative(a, b);
        u.dot(&u)
    }

    fn friction(&self) -> f64 {
        self.contact.friction()
    }

    fn rho(&self) -> f64 {
        self.contact.rho()
    }

    fn residual(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> Residual {
        self.contact.residual(&self.relative(a, b))
    }

    fn solution(&self, a: &SolverBody<S>, b: &SolverBody<S>) -> ContactSolution<S> {
        self.contact.solution(&self.relative(a, b))
    }
}
