//! Dynamical systems in the contact problem: the velocities of the nodes that contacts act on, and their compliance.

use super::form::{ContactForm, Mobility, Place, Problem};
use super::row::{SystemRow, Term};
use super::side::Side;
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use std::sync::Arc;

/// The nodes of a system that contacts of the step act on. The solver knows nothing else of it; the system finds the rest
/// of its velocities from the impulses on these nodes once the problem is solved.
///
/// Copies share the blocks: a step that is solved several times hands copies of one to the problem.
#[derive(Clone, Debug)]
pub struct NodalSystem<S: Space> {
    /// Ids of the nodes in the system, in increasing order.
    pub nodes: Vec<u32>,
    /// Their velocities without contacts (m/s).
    pub free: Vec<S::Vector>,
    compliance: Arc<[S::Matrix]>,
    pub(super) velocity: Vec<S::Vector>,
}

impl<S: Space> NodalSystem<S> {
    /// Of nodes in increasing order, with their free velocities (m/s) and their compliance, row by row (1/kg).
    pub fn new(nodes: Vec<u32>, free: Vec<S::Vector>, compliance: Vec<S::Matrix>) -> Self {
        debug_assert!(nodes.is_sorted() && free.len() == nodes.len());
        debug_assert!(compliance.len() == nodes.len() * nodes.len());
        Self {
            velocity: free.clone(),
            nodes,
            free,
            compliance: compliance.into(),
        }
    }

    /// Compliance P_a A^-1 P_b^T between its nodes, row by row (1/kg).
    pub fn compliance(&self) -> &[S::Matrix] {
        &self.compliance
    }

    /// The block of two of its nodes, by their places in the list.
    pub(super) fn block(&self, a: u32, b: u32) -> &S::Matrix {
        &self.compliance[a as usize * self.nodes.len() + b as usize]
    }

    /// Adds what an impulse on a node does to the velocities of all.
    pub(super) fn push(&mut self, at: u32, impulse: &S::Vector) {
        let count = self.nodes.len();
        for (a, velocity) in self.velocity.iter_mut().enumerate() {
            *velocity += self.compliance[a * count + at as usize].apply(impulse);
        }
    }
}

impl<S: Space> Problem<S> {
    /// Adds a dynamical system, before the contacts with it; systems are counted in the order in which they are added.
    pub fn push_system(&mut self, system: NodalSystem<S>) {
        self.systems.push(system);
    }

    /// Adds a contact of which a side is a dynamical system. The bodies of the form are those of detection; what the impulse
    /// acts on is said by the sides. False, and nothing is added, where a side names a system or a node that was not pushed.
    #[must_use]
    pub fn push_between(&mut self, contact: &ContactForm<S>, sides: &[Side<S>; 2]) -> bool {
        let mut rigid = [None; 2];
        let mut terms = Vec::new();
        let mut block = S::Matrix::diagonal(&S::Vector::zero());
        for (k, (side, sign)) in sides.iter().zip([1.0, -1.0]).enumerate() {
            match side {
                Side::Rigid { body, arm } => {
                    let Mobility { mass, inertia } = self.masses[*body as usize];
                    block = block + S::Matrix::diagonal(&mass) + S::rotation_block(arm, &inertia);
                    rigid[k] = Some((*body, *arm));
                }
                Side::Nodes { system, nodes } => {
                    for (node, weight) in nodes.terms() {
                        let known = self.systems.get(*system as usize);
                        let Some(Ok(at)) = known.map(|s| s.nodes.binary_search(&node)) else {
                            return false;
                        };
                        terms.push(Term {
                            system: *system,
                            node: at as u32,
                            weight: sign * weight,
                        });
                    }
                }
            }
        }
        for x in &terms {
            for y in terms.iter().filter(|y| y.system == x.system) {
                let of_nodes = self.systems[x.system as usize].block(x.node, y.node);
                block = block + of_nodes.scaled(x.weight * y.weight);
            }
        }
        self.places
            .push(Place::System(self.of_systems.len() as u32));
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
            .push(SystemRow::new(contact, block, bodies, terms));
        true
    }

    /// The impulses that contacts have on the nodes of the systems (N s), by system, in the order of its nodes.
    pub fn node_impulses(&self) -> Vec<Vec<S::Vector>> {
        let rest = |system: &NodalSystem<S>| vec![S::Vector::zero(); system.nodes.len()];
        let mut impulses: Vec<Vec<S::Vector>> = self.systems.iter().map(rest).collect();
        for row in &self.of_systems {
            row.add_impulses(&mut impulses);
        }
        impulses
    }

    /// Twice the energy |v - v_free|_A^2 of what contacts change of the systems (J).
    pub(super) fn work_on_systems(&self) -> f64 {
        let mut work = 0.0;
        for (system, impulses) in self.systems.iter().zip(self.node_impulses()) {
            let velocities = system.velocity.iter().zip(&system.free);
            for (p, (v, free)) in impulses.iter().zip(velocities) {
                work += p.dot(&(*v - *free));
            }
        }
        work
    }

    /// Gives the nodes of systems their free velocities.
    pub(super) fn free_systems(&mut self) {
        for system in &mut self.systems {
            system.velocity.clone_from(&system.free);
        }
    }
}
