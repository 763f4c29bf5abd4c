//! Where the impulses of contacts act.

use super::Simulation;
use crate::contact::{Acts, Contact};
use crate::geometry::space::Space;
use crate::threads::{map_chunks_mut, pays};

/// Contacts of a task.
const CHUNK: usize = 4096;
/// About what it takes to look where a contact acts (ns).
const LOOK: f64 = 4.0;

/// What of an interface acts across a gap.
struct Across {
    spring: bool,
    attraction: bool,
    bond: bool,
}

impl<S: Space> Simulation<S> {
    /// Finds where each contact acts, once contacts and bonds of the step are known. Rigid bodies act on each other when they touch, on
    /// their surfaces: that these are apart at q_m is an error of the step. A bond, a spring or an attraction acts across the gap, or
    /// the overlap, that there is.
    pub(super) fn place_actions(&mut self) {
        let across = self.laws.iter().map(|law| Across {
            spring: law.compliant(),
            attraction: law.cohesion().is_some() && !law.opens(),
            bond: law.opens(),
        });
        let across: Vec<Across> = across.collect();
        // What acts on surfaces does so from the start.
        let never = |a: &Across| !(a.spring || a.attraction || a.bond);
        if across.iter().all(never) {
            return;
        }
        let bodies = &self.state.bodies;
        let deforms = !self.state.systems.is_empty();
        let (network, memory) = (&mut self.state.network.contacts, &self.state.network.memory);
        let divide = pays(self.options.solver.parallel, network.len(), LOOK);
        map_chunks_mut(divide, network, CHUNK, |_, contacts| {
            for contact in contacts {
                let law = usize::from(contact.law);
                let (across, bonds) = (&across[law], &memory[law].bonds);
                let bonded = |c: &Contact<S>| c.memory().is_some_and(|slot| bonds[slot].intact());
                let apart = across.spring
                    || (across.attraction && !contact.beyond)
                    || (across.bond && bonded(contact));
                let sides = contact
                    .bodies
                    .map(|b| deforms && bodies.carrier(b as usize).is_some());
                contact.acts = match (apart, sides) {
                    (false, _) | (true, [true, true]) => Acts::Surfaces,
                    (true, [false, false]) => Acts::Middle,
                    (true, [true, false]) => Acts::Candidate,
                    (true, [false, true]) => Acts::Antagonist,
                };
            }
        });
    }
}
