//! The balance of a step: its energy and momentum, and the check that all values are finite.

mod energy;
mod finite;
mod momentum;

pub(super) use energy::close_energy;
pub(super) use finite::check_finite;
pub(super) use momentum::close_momentum;

use super::Simulation;
use crate::geometry::space::Space;

/// Begins the records of a single step.
pub(super) fn begin_step<S: Space>(s: &mut Simulation<S>) {
    s.workspace.spring_energy = energy::spring_energy(s);
    let network = &mut s.state.network;
    network.bond_breaks.clear();
    network.bonds_formed.clear();
    if s.options.record_dissipation {
        network.dissipation.get_or_insert_default();
    }
}
