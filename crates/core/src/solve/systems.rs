//! Dynamical systems in the contact problem.

use super::form::{ContactForm, Mobility, RowPlace};
use super::nodal::NodalSystem;
use super::problem::Problem;
use super::row::{MomentForm, SystemRow, Term};
use super::side::Side;
use crate::bodies::TurningNode;
use crate::geometry::space::{MatrixLike, Space, VectorLike};

impl<S: Space> Problem<S> {
    /// Adds a dynamical system, before the contacts with it; systems are numbered in the order in
    /// which they are added.
    pub fn push_system(&mut self, mut system: NodalSystem<S>) {
        if let (Some(loaded), Some(memory)) = (&mut system.loaded, self.loaded.pop()) {
            *loaded = memory;
        }
        self.systems.push(system);
    }

    /// Takes all systems away and keeps the memory of large ones for those that follow.
    pub(super) fn clear_systems(&mut self) {
        for system in self.systems.drain(..).rev() {
            if let Some(mut loaded) = system.loaded {
                loaded.clear();
                self.loaded.push(loaded);
            }
        }
    }

    /// Adds a contact with a dynamical system on at least one side. The bodies of the form are
    /// those of detection; the sides say on what the impulse acts. Returns false, and adds nothing,
    /// where a side names a system or a node that was not pushed.
    #[must_use]
    pub fn push_between(&mut self, contact: &ContactForm<S>, sides: &[Side<S>; 2]) -> bool {
        let (mut rigid, mut points) = ([None; 2], [None; 2]);
        let mut terms: Vec<Term> = Vec::new();
        let mut block = S::Matrix::diagonal(&S::Vector::zero());
        for (k, (side, sign)) in sides.iter().zip([1.0, -1.0]).enumerate() {
            match side {
                Side::Rigid { body, arm } => {
                    let Mobility { mass, inertia } = self.masses[*body as usize];
                    block = block + S::Matrix::diagonal(&mass) + S::rotation_block(arm, &inertia);
                    rigid[k] = Some((*body, *arm));
                }
                Side::Nodes { system, nodes } => {
                    let Some(known) = self.systems.get_mut(*system as usize) else {
                        return false;
                    };
                    let mut of_side = Vec::new();
                    for (node, weight) in nodes.terms() {
                        let Ok(at) = known.nodes.binary_search(&node) else {
                            return false;
                        };
                        of_side.push((at as u32, weight));
                        terms.push(Term {
                            system: *system,
                            node: at as u32,
                            weight: sign * weight,
                        });
                    }
                    points[k] = Some((*system, known.add_point(&of_side), sign));
                }
            }
        }
        for x in &terms {
            for y in terms.iter().filter(|y| y.system == x.system) {
                let of_nodes = self.systems[x.system as usize].block(x.node, y.node);
                block = block + of_nodes.scaled(x.weight * y.weight);
            }
        }
        self.compliant |= contact.compliance != [0.0; 2];
        self.places
            .push(RowPlace::System(self.of_systems.len() as u32));
        let bodies = rigid.map(|side| {
            side.map(|(body, arm)| {
                (
                    body,
                    arm,
                    &self.masses[body as usize],
                    self.lengths[body as usize],
                )
            })
        });
        self.of_systems
            .push(SystemRow::new(contact, block, bodies, points, terms));
        true
    }

    /// Adds the moments of a contact with a dynamical system, which was pushed with its nodes: for
    /// each side with a system that rotates, the node that represents rotation. Returns false, and
    /// adds nothing, where a side names a system or a node that was not pushed.
    #[must_use]
    pub fn push_moment_between(
        &mut self,
        form: &MomentForm<S>,
        contact: &ContactForm<S>,
        sides: [Option<TurningNode>; 2],
    ) -> bool {
        let mut terms = [None; 2];
        for ((side, term), sign) in sides.into_iter().zip(&mut terms).zip([1.0, -1.0]) {
            let Some(side) = side else {
                continue;
            };
            let known = self.systems.get(side.system as usize);
            let Some(Ok(at)) = known.map(|s| s.nodes.binary_search(&side.node)) else {
                return false;
            };
            *term = Some(Term {
                system: side.system,
                node: at as u32,
                weight: sign / side.length,
            });
        }
        let row = self.moment_row(form, contact);
        self.moments.push(row.with_systems(terms, &self.systems));
        true
    }

    /// Returns the impulses of contacts on the nodes of the systems (N s), by system, in the order
    /// of its nodes.
    pub fn node_impulses(&self) -> Vec<Vec<S::Vector>> {
        let rest = |system: &NodalSystem<S>| vec![S::Vector::zero(); system.nodes.len()];
        let mut impulses: Vec<Vec<S::Vector>> = self.systems.iter().map(rest).collect();
        for row in &self.of_systems {
            row.add_impulses(&mut impulses);
        }
        for row in &self.moments {
            row.add_impulses(&mut impulses);
        }
        impulses
    }

    /// Returns twice the energy |v - v_free|_A^2 of the velocity changes of the systems by contacts
    /// (J).
    pub(super) fn work_on_systems(&self) -> f64 {
        let mut work = 0.0;
        for (system, impulses) in self.systems.iter().zip(self.node_impulses()) {
            let velocities = system.velocity.chunks_exact(S::D).zip(&system.free);
            for (p, (v, free)) in impulses.iter().zip(velocities) {
                work += p.dot(&(S::Vector::from_slice(v) - *free));
            }
        }
        work
    }

    /// Returns the relative velocities at the contacts with systems, at the current velocities
    /// (m/s).
    #[cfg(test)]
    fn relative_velocities_of_systems(&self) -> Vec<S::Vector> {
        let rows = self.of_systems.iter();
        rows.map(|row| row.relative(&self.solver_bodies, &self.systems))
            .collect()
    }

    /// Computes the velocities of all nodes of systems, after sweeps.
    pub(super) fn settle_systems(&mut self) {
        self.systems.iter_mut().for_each(NodalSystem::settle);
    }

    /// Gives the nodes of systems their free velocities.
    pub(super) fn free_systems(&mut self) {
        for system in &mut self.systems {
            system.set_free();
        }
    }
}

#[cfg(test)]
mod tests;
