//! Removal of bodies from a running scene.

use super::Simulation;
use crate::geometry::space::Space;

impl<S: Space> Simulation<S> {
    /// Removes a grain for good: it is at rest, has no contacts, and its bonds break. Its kinetic energy
    /// becomes an entry of the energy ledger.
    pub fn remove_body(&mut self, body: usize) {
        let energy = self.state.bodies.energy_of(body);
        self.state.energy.carried += energy;
        self.state.energy.kinetic -= energy;
        self.state.bodies.remove_body(body);
        self.insulate(body);
        self.state.network.forget_neighbours();
    }
}
