//! Reading the contacts of a simulation.

use super::placement;
use super::rows::{BondCounts, ContactView};
use crate::bodies::Nodes;
use crate::contact::{
    Break, Contact, ContactDissipation, ContactHeat, ShapeIndex, StepSizeDiagnostics,
};
use crate::geometry::space::{Space, VectorLike};
use crate::step::{ContactForces, Simulation};
use std::collections::BTreeMap;

/// The contacts of the last step of a run, and the bonds between its bodies.
///
/// Contacts are numbered in the order of [`ContactsView::visit_contacts`], interfaces as in
/// [`RunView::laws`](super::RunView::laws).
pub trait ContactsView {
    /// Returns the number of contacts, including open ones within the alert distance.
    fn contact_count(&self) -> usize;
    /// Returns the number of contacts that [count](ContactView::counts).
    fn counted_contacts(&self) -> usize;
    /// Calls a function with each contact of the last step, in the order of their keys.
    fn visit_contacts(&self, visit: &mut dyn FnMut(&ContactView));
    /// Returns the forces of the contacts of points of deformable bodies, other than grains, with
    /// surfaces of others (N; N/m in 2D), and whether each acted on the mean position that its
    /// point faces; the others acted on the nearest position.
    fn forces_on_points(&self) -> Vec<(f64, bool)>;
    /// Returns the end points of a contact (m): the candidate's centre, and the antagonist's centre
    /// or the closest point on its surface.
    fn ends_of_contact(&self, contact: usize) -> [[f64; 3]; 2];
    /// Returns the end points of the contacts that [count](ContactView::counts) (m), the first in
    /// the periodic cell.
    fn contact_ends(&self) -> Vec<[[f64; 3]; 2]>;
    /// The forces of the contacts.
    fn contact_forces(&self) -> ContactForces;
    /// Returns the nodes of a dynamical system on which a contact acts, on the side 0 of its
    /// candidate or 1 of its antagonist; `None` where that side is rigid.
    fn nodes_of_side(&self, contact: usize, side: usize) -> Option<Nodes>;
    /// Returns the energy dissipated by each contact in the last step (J; J/m in 2D), where the run
    /// records it ([`Options::record_dissipation`](crate::step::Options::record_dissipation)).
    fn dissipation(&self) -> Option<&[ContactDissipation]>;
    /// Returns temperatures and conductances of the contacts in the last step; `None` where no heat
    /// is computed.
    fn contact_heat(&self) -> Option<&ContactHeat>;

    /// Returns an internal variable of the laws of an interface at its contacts, by the index of
    /// the variable among those of the interface.
    fn law_variable(&self, interface: usize, variable: usize) -> Vec<f64>;

    /// Returns the number of bonds formed so far.
    fn bonds_made(&self) -> u64;
    /// Returns the number of bonds broken so far.
    fn bonds_broken(&self) -> u64;
    /// Returns bodies and interface of the bonds that formed in the last step.
    fn bonds_formed(&self) -> &[([u32; 2], u16)];
    /// The bonds of an interface.
    fn bonds_of(&self, interface: usize) -> BondCounts;
    /// Returns the bonds that broke in the last step.
    fn bond_breaks(&self) -> &[Break];
    /// Returns the bodies of each pair of shapes whose bond broke, in no particular order.
    fn broken_pairs(&self) -> Vec<[u32; 2]>;
    /// Returns the mean damage of the bonds.
    fn mean_damage(&self) -> f64;

    /// Returns the volume worn off each surface with wear (m^3; m^2 in 2D), by its index among the
    /// surfaces.
    fn worn(&self) -> &BTreeMap<usize, f64>;
    /// Returns the number of cycles that the current one represents; 1 without jumps.
    fn cycle_multiplier(&self) -> f64;
    /// Returns the diagnostics of the step size.
    fn step_size(&self) -> &StepSizeDiagnostics;
}

fn view<S: Space>(s: &Simulation<S>, place: usize, contact: &Contact<S>) -> ContactView {
    let force = contact.impulse * (1.0 / s.options.scheme.h);
    let candidate = contact.bodies[0] as usize;
    ContactView {
        place,
        key: contact.key,
        bodies: contact.bodies,
        interface: contact.law,
        point: (s.state.bodies.position[candidate] + contact.arms[0]).padded(),
        arms: contact.arms.map(|arm| arm.padded()),
        normal: contact.normal.padded(),
        gap: contact.gap,
        radius: contact.radius,
        impulse: contact.impulse.padded(),
        force: force.padded(),
        normal_force: force.dot(&contact.normal),
        slides: contact.slides,
        central: contact.central,
        formed_at: contact.formed_at,
        bond: s.state.network.bond_state(contact),
        counts: contact.counts(),
    }
}

impl<S: Space> ContactsView for Simulation<S> {
    fn contact_count(&self) -> usize {
        self.state.network.contacts.len()
    }
    fn counted_contacts(&self) -> usize {
        let parallel = self.options.solver.parallel;
        self.state.network.contact_count(parallel)
    }
    fn visit_contacts(&self, visit: &mut dyn FnMut(&ContactView)) {
        for (place, contact) in self.state.network.contacts.iter().enumerate() {
            visit(&view(self, place, contact));
        }
    }
    fn forces_on_points(&self) -> Vec<(f64, bool)> {
        let per_time = 1.0 / self.options.scheme.h;
        let all = self.acted_on_mean_places();
        all.map(|(contact, mean)| (contact.impulse.norm() * per_time, mean))
            .collect()
    }
    fn ends_of_contact(&self, contact: usize) -> [[f64; 3]; 2] {
        let (a, b) = placement::ends(self, &self.state.network.contacts[contact]);
        [a.padded(), b.padded()]
    }
    fn contact_ends(&self) -> Vec<[[f64; 3]; 2]> {
        let contacts = self.state.network.counted_contacts();
        let ends = contacts.map(|contact| {
            let (a, b) = placement::ends(self, contact);
            let at = self.shapes.periodic.wrapped(a);
            [at.padded(), (b - a + at).padded()]
        });
        ends.collect()
    }
    fn contact_forces(&self) -> ContactForces {
        self.contact_forces()
    }
    fn law_variable(&self, interface: usize, variable: usize) -> Vec<f64> {
        let network = &self.state.network;
        let memory = network.memory.get(interface);
        let Some(values) = memory.and_then(|m| m.variables.get(variable)) else {
            return Vec::new();
        };
        let own = network
            .contacts
            .iter()
            .filter(|c| usize::from(c.law) == interface);
        own.filter_map(|c| values.get(c.memory()?).copied())
            .collect()
    }
    fn nodes_of_side(&self, contact: usize, side: usize) -> Option<Nodes> {
        self.nodes_of_side(&self.state.network.contacts[contact], side)
    }
    fn dissipation(&self) -> Option<&[ContactDissipation]> {
        self.state.network.dissipation.as_deref()
    }
    fn contact_heat(&self) -> Option<&ContactHeat> {
        self.state.network.thermal.as_ref()
    }

    fn bonds_made(&self) -> u64 {
        self.state.network.bonds_made()
    }
    fn bonds_broken(&self) -> u64 {
        self.state.network.bonds_broken()
    }
    fn bonds_formed(&self) -> &[([u32; 2], u16)] {
        &self.state.network.bonds_formed
    }
    fn bonds_of(&self, interface: usize) -> BondCounts {
        let memory = &self.state.network.memory[interface];
        BondCounts {
            made: memory.made,
            broken: memory.broken,
            slides: memory.slides,
        }
    }
    fn bond_breaks(&self) -> &[Break] {
        &self.state.network.bond_breaks
    }
    fn broken_pairs(&self) -> Vec<[u32; 2]> {
        let pairs = self.state.network.broken_pairs.iter();
        let body = |key| ShapeIndex::of(key).body(&self.shapes);
        pairs
            .filter_map(|(a, b)| Some([body(*a)?, body(*b)?]))
            .collect()
    }
    fn mean_damage(&self) -> f64 {
        self.state.network.mean_damage()
    }

    fn worn(&self) -> &BTreeMap<usize, f64> {
        &self.state.network.worn
    }
    fn cycle_multiplier(&self) -> f64 {
        self.state.network.cycle_multiplier
    }
    fn step_size(&self) -> &StepSizeDiagnostics {
        &self.state.network.step_size
    }
}
