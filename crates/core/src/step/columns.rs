//! What a simulation holds at the end of a step, for those who read it: columns of bodies, rows of contacts.

use super::Simulation;
use crate::contact::Contact;
use crate::energy::Energy;
use crate::geometry::space::{Space, VectorLike};
use crate::momentum::Momentum;

/// A contact at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRow<S: Space> {
    /// The two bodies, by their places in the columns: candidate, antagonist.
    pub bodies: [u32; 2],
    /// Place of its interface in the case.
    pub interface: u16,
    /// Where it touches, seen from the candidate (m).
    pub point: S::Vector,
    /// Unit normal, from the antagonist to the candidate.
    pub normal: S::Vector,
    /// Distance at detection (m), positive when open.
    pub gap: f64,
    /// Mean force of the last step on the candidate (N; 2D N/m); the antagonist has its opposite.
    pub force: S::Vector,
    /// Its part along the normal (N; 2D N/m), positive in compression.
    pub normal_force: f64,
    /// Whether friction is at its bound.
    pub slides: bool,
}

impl<S: Space> Simulation<S> {
    /// Number of bodies, grains first, then first bodies: the length of every column.
    pub fn body_count(&self) -> usize {
        self.state.bodies.len()
    }

    /// The place of a first body in the columns, by its name.
    pub fn body_named(&self, name: &str) -> Option<usize> {
        let mut driven = self.state.bodies.driven.iter();
        driven.find(|d| d.name == name).map(|d| d.body as usize)
    }

    /// Centres of mass (m).
    pub fn positions(&self) -> &[S::Vector] {
        &self.state.bodies.position
    }

    /// Velocities of the centres of mass (m/s).
    pub fn velocities(&self) -> &[S::Vector] {
        &self.state.bodies.velocity
    }

    /// Angular velocities (rad/s).
    pub fn spins(&self) -> &[S::Spin] {
        &self.state.bodies.spin
    }

    /// The contacts of the last step, open ones within the alert distance too; empty before the first step.
    pub fn contacts(&self) -> impl ExactSizeIterator<Item = ContactRow<S>> + '_ {
        let contacts = self.state.network.contacts.iter();
        contacts.map(|contact| self.row(contact))
    }

    fn row(&self, contact: &Contact<S>) -> ContactRow<S> {
        let force = contact.impulse * (1.0 / self.options.scheme.h);
        let candidate = contact.bodies[0] as usize;
        ContactRow {
            bodies: contact.bodies,
            interface: contact.law,
            point: self.state.bodies.position[candidate] + contact.arms[0],
            normal: contact.normal,
            gap: contact.gap,
            force,
            normal_force: force.dot(&contact.normal),
            slides: contact.slides,
        }
    }

    /// Mean force (N; 2D N/m) and moment about its centre (N m; 2D N) of the last step by its contacts on a first body;
    /// none for a name that no first body has.
    pub fn contact_force_on(&self, name: &str) -> Option<(S::Vector, S::Spin)> {
        let place = self
            .state
            .bodies
            .driven
            .iter()
            .position(|d| d.name == name)?;
        let (impulse, moment) = self.state.received.get(place)?;
        let rate = 1.0 / self.options.scheme.h;
        Some((*impulse * rate, *moment * rate))
    }

    /// The ledger of momentum (N s, N m s; 2D per m).
    pub fn momentum(&self) -> &Momentum {
        &self.state.momentum
    }

    /// The energy ledger (J; 2D J/m).
    pub fn energies(&self) -> &Energy {
        &self.state.energy
    }
}
