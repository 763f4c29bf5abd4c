//! Bodies that are taken out of a running scene.

use super::Simulation;
use crate::geometry::space::Space;

impl<S: Space> Simulation<S> {
    /// Takes a grain out for good: it stands still, touches nothing, and its bonds tear. The kinetic energy that it
    /// had is an entry of the energy ledger.
    pub fn remove_body(&mut self, body: usize) {
        let energy = self.bodies.energy_of(body);
        self.energy.carried += energy;
        self.energy.kinetic -= energy;
        self.bodies.remove_body(body);
        self.network.forget_neighbours();
    }
}
