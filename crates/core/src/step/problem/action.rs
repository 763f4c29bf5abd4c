//! Positions at which the impulses of contacts act.

use crate::contact::{ActionPoint, Contact};
use crate::geometry::space::Space;
use crate::step::Simulation;
use crate::threads::{map_chunks_mut, worth_dividing};

/// Number of contacts of a task.
const CHUNK: usize = 4096;
/// Approximate time to find where a contact acts (ns).
const LOOK: f64 = 4.0;

/// Parts of an interface that act across a gap.
struct GapActions {
    spring: bool,
    attraction: bool,
    bond: bool,
}

/// Finds where each contact acts, once contacts and bonds of the step are known. Rigid bodies act
/// on each other when they touch, on their surfaces: a gap at q_m is an error of the step. A bond,
/// a spring or an attraction acts across the actual gap or overlap.
pub(super) fn place_actions<S: Space>(s: &mut Simulation<S>) {
    let across = s.laws.iter().map(|law| GapActions {
        spring: law.compliant(),
        attraction: law.cohesion().is_some() && !law.opens(),
        bond: law.opens(),
    });
    let across: Vec<GapActions> = across.collect();
    // Contacts are created with an action on the surfaces.
    let never = |a: &GapActions| !(a.spring || a.attraction || a.bond);
    if across.iter().all(never) {
        return;
    }
    let bodies = &s.state.bodies;
    let deforms = !s.state.systems.is_empty();
    let (network, memory) = (&mut s.state.network.contacts, &s.state.network.memory);
    let divide = worth_dividing(s.options.solver.parallel, network.len(), LOOK);
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
            contact.action_point = match (apart, sides) {
                (false, _) | (true, [true, true]) => ActionPoint::Surfaces,
                (true, [false, false]) => ActionPoint::Middle,
                (true, [true, false]) => ActionPoint::Candidate,
                (true, [false, true]) => ActionPoint::Antagonist,
            };
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::detect::LawTable;
    use crate::geometry::space::Dim2;
    use crate::laws::sample_laws::{bond, interface, sticky};

    /// An attraction without a bond acts in the middle of the gap, unless the contact is beyond the
    /// alert distance; friction acts on the surfaces, also where another interface attracts.
    #[test]
    fn attraction_acts_across_the_gap() {
        for (law, acts) in [
            (0, [ActionPoint::Middle, ActionPoint::Surfaces]),
            (1, [ActionPoint::Surfaces; 2]),
        ] {
            let s = Simulation::<Dim2>::of_disks(&[([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)]);
            let mut table = LawTable::new(1);
            table.set(0, 0, law);
            let laws = vec![interface([sticky()]), interface([])];
            let mut s = Simulation::new(s.state.bodies, s.shapes, laws, table, 1e-3, 1e-3);
            s.step().unwrap();
            let placed = [false, true].map(|beyond| {
                s.state.network.contacts[0].beyond = beyond;
                place_actions(&mut s);
                s.state.network.contacts[0].action_point
            });
            assert_eq!(placed, acts);
        }
    }

    /// A bond acts across its gap; a contact of the same interface without a bond acts on the
    /// surfaces.
    #[test]
    fn a_bond_acts_across_its_gap() {
        let s = Simulation::<Dim2>::of_disks(&[([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)]);
        let mut s = s.with_law(interface([bond()]));
        s.step().unwrap();
        let slot = s.state.network.memory[0].allocate(true, 0.0, 1.0, &[]);
        let placed = [slot, Contact::<Dim2>::NO_MEMORY].map(|slot| {
            s.state.network.contacts[0].slot = slot;
            place_actions(&mut s);
            s.state.network.contacts[0].action_point
        });
        assert_eq!(placed, [ActionPoint::Middle, ActionPoint::Surfaces]);
    }
}
