//! Dynamical systems in the contact problem: the velocities of the nodes that contacts act on, and
//! their compliance.

use super::form::{ContactForm, Mobility, Place, Problem};
use super::loaded::{Loaded, Points, add_response, vector};
use super::row::{MomentForm, SystemRow, Term};
use super::side::Side;
use crate::bodies::{Compliance, TurningNode, block_of};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use std::sync::Arc;

/// The nodes of a system that contacts of the step act on. The solver knows nothing else of it; the
/// system finds the rest of its velocities from the impulses on these nodes once the problem is
/// solved.
///
/// Copies share the compliance: a step that is solved several times hands copies of one to the
/// problem.
#[derive(Clone, Debug)]
pub struct NodalSystem<S: Space> {
    /// Ids of the nodes in the system, in increasing order.
    pub nodes: Vec<u32>,
    /// Their velocities without contacts (m/s).
    pub free: Vec<S::Vector>,
    compliance: Columns<S>,
    /// Velocities of all nodes, one after the other (m/s); of a large system those at the last
    /// [`Self::settle`].
    velocity: Vec<f64>,
    /// What contacts act on.
    points: Points,
    /// What sweeps follow of a large system.
    loaded: Option<Loaded<S>>,
}

/// Fewest nodes of a large system, of which sweeps follow loaded points alone. Below that all
/// columns fit in a cache.
const LARGE: usize = 64;

/// Compliance of the nodes, by columns as in [`Compliance`]: the responses of all nodes to an
/// impulse on one are read in a row in each update of a contact.
#[derive(Clone, Debug)]
enum Columns<S: Space> {
    /// Of the step, one after the other.
    Own(Arc<Vec<f64>>),
    /// That the system keeps, with the columns of touched nodes.
    Kept(Arc<Compliance<S>>),
}

impl<S: Space> Columns<S> {
    fn column(&self, at: usize, count: usize) -> &[f64] {
        let size = S::D * S::D * count;
        match self {
            Self::Own(all) => &all[at * size..][..size],
            Self::Kept(compliance) => compliance.column(at),
        }
    }
}

impl<S: Space> NodalSystem<S> {
    /// Of all nodes of a compliance that the system keeps, with their free velocities (m/s).
    /// Contacts act on nodes whose columns are there.
    pub fn kept(compliance: Arc<Compliance<S>>, free: Vec<S::Vector>) -> Self {
        let nodes = compliance.nodes().to_vec();
        Self::with(nodes, free, Columns::Kept(compliance))
    }

    /// Of nodes in increasing order, with their free velocities (m/s) and their compliance, row by
    /// row (1/kg).
    pub fn new(nodes: Vec<u32>, free: Vec<S::Vector>, compliance: &[S::Matrix]) -> Self {
        debug_assert!(nodes.is_sorted() && free.len() == nodes.len());
        debug_assert!(compliance.len() == nodes.len() * nodes.len());
        let count = nodes.len();
        let mut columns = Vec::with_capacity(S::D * S::D * compliance.len());
        for b in 0..count {
            for axis in 0..S::D {
                for a in 0..count {
                    let block = &compliance[a * count + b];
                    columns.extend((0..S::D).map(|k| block.entry(k, axis)));
                }
            }
        }
        Self::with(nodes, free, Columns::Own(Arc::new(columns)))
    }

    fn with(nodes: Vec<u32>, free: Vec<S::Vector>, compliance: Columns<S>) -> Self {
        let mut system = Self {
            loaded: (nodes.len() >= LARGE).then(Loaded::new),
            points: Points::new(nodes.len()),
            velocity: Vec::with_capacity(S::D * nodes.len()),
            nodes,
            free,
            compliance,
        };
        system.set_free();
        system
    }

    /// Compliance P_a A^-1 P_b^T of two of its nodes, by their places in the list (1/kg).
    pub(super) fn block(&self, a: u32, b: u32) -> S::Matrix {
        block_of::<S>(self.column(b as usize), self.nodes.len(), a as usize)
    }

    /// The responses of all nodes for an impulse on one.
    fn column(&self, at: usize) -> &[f64] {
        let column = self.compliance.column(at, self.nodes.len());
        debug_assert!(!column.is_empty(), "contacts act on touched nodes alone");
        column
    }

    /// The velocities that impulses on its nodes give.
    pub(super) fn response(&self, impulses: &[S::Vector]) -> Vec<S::Vector> {
        let row = S::D * impulses.len();
        let mut velocities = vec![0.0; row];
        for (at, p) in impulses.iter().enumerate() {
            if *p != S::Vector::zero() {
                let column = self.column(at);
                add_response::<S>(&mut velocities, |axis| &column[axis * row..][..row], p);
            }
        }
        let all = velocities.chunks_exact(S::D);
        all.map(S::Vector::from_slice).collect()
    }

    /// Adds a weighted sum of its nodes, by their places in the list; gives the index of the point.
    /// A node alone is a point with its place.
    pub(super) fn add_point(&mut self, terms: &[(u32, f64)]) -> u32 {
        self.points.add(terms)
    }

    /// Whether sweeps follow loaded points alone, so that velocities are those of the last
    /// [`Self::settle`] elsewhere.
    pub(super) fn is_large(&self) -> bool {
        self.loaded.is_some()
    }

    /// The current velocity of a point (m/s). Of a large system it is exact for loaded points, and
    /// for the others after [`Self::settle`].
    #[inline]
    pub(super) fn velocity(&self, point: u32) -> S::Vector {
        let Some(loaded) = &self.loaded else {
            return self.points.sum::<S>(point, &self.velocity);
        };
        if let Some(velocity) = loaded.velocity(point) {
            return velocity;
        }
        let of_node = |node: u32| {
            let velocity = loaded.velocity(node);
            velocity.unwrap_or_else(|| vector::<S>(&self.velocity, node as usize))
        };
        let terms = self.points.terms(point).iter();
        terms.fold(S::Vector::zero(), |sum, (node, weight)| {
            sum + of_node(*node) * *weight
        })
    }

    /// Whether sweeps follow nodes and not points, of a large system on which contacts act on more
    /// points than nodes.
    pub(super) fn follows_nodes(&self) -> bool {
        self.points.outnumber_nodes()
    }

    /// Adds what an impulse on a point does to velocities.
    pub(super) fn push(&mut self, point: u32, impulse: &S::Vector) {
        let by_nodes = self.follows_nodes();
        let (compliance, count) = (&self.compliance, self.nodes.len());
        let column = |b: usize| compliance.column(b, count);
        let (points, all) = (&self.points, &self.velocity);
        match &mut self.loaded {
            Some(loaded) if by_nodes => {
                for (node, weight) in points.terms(point) {
                    loaded.push(*node, &(*impulse * *weight), points, all, column);
                }
            }
            Some(loaded) => loaded.push(point, impulse, points, all, column),
            None => {
                let row = S::D * count;
                for (node, weight) in points.terms(point) {
                    let column = column(*node as usize);
                    add_response::<S>(
                        &mut self.velocity,
                        |axis| &column[axis * row..][..row],
                        &(*impulse * *weight),
                    );
                }
            }
        }
    }

    /// The same as one of many impulses: velocities are right after [`Self::settle`].
    pub(super) fn load(&mut self, point: u32, impulse: &S::Vector) {
        let by_nodes = self.follows_nodes();
        match &mut self.loaded {
            Some(loaded) if by_nodes => {
                for (node, weight) in self.points.terms(point) {
                    loaded.load(*node, &(*impulse * *weight));
                }
            }
            Some(loaded) => loaded.load(point, impulse),
            None => self.push(point, impulse),
        }
    }

    /// Finds the velocities of all nodes.
    pub(super) fn settle(&mut self) {
        let (compliance, count) = (&self.compliance, self.nodes.len());
        if let Some(loaded) = &mut self.loaded {
            loaded.settle(&self.points, &mut self.velocity, |b| {
                compliance.column(b, count)
            });
        }
    }

    /// Gives all nodes their free velocities.
    fn set_free(&mut self) {
        self.velocity.clear();
        for v in &self.free {
            self.velocity.extend((0..S::D).map(|k| v[k]));
        }
        if let Some(loaded) = &mut self.loaded {
            loaded.adopt(&self.points, &self.velocity);
        }
    }
}

impl<S: Space> Problem<S> {
    /// Adds a dynamical system, before the contacts with it; systems are counted in the order in
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

    /// Adds a contact of which a side is a dynamical system. The bodies of the form are those of
    /// detection; what the impulse acts on is said by the sides. False, and nothing is added, where
    /// a side names a system or a node that was not pushed.
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
            .push(SystemRow::new(contact, block, bodies, points, terms));
        true
    }

    /// Adds the moments of a contact with a dynamical system, which was pushed with its nodes: by
    /// side of a system that turns the node that turns with it. False, and nothing is added, where
    /// a side names a system or a node that was not pushed.
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

    /// The impulses that contacts have on the nodes of the systems (N s), by system, in the order
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

    /// Twice the energy |v - v_free|_A^2 of what contacts change of the systems (J).
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

    /// Relative velocities at the contacts with systems, at the current velocities (m/s).
    #[cfg(test)]
    fn relative_velocities_of_systems(&self) -> Vec<S::Vector> {
        let rows = self.of_systems.iter();
        rows.map(|row| row.relative(&self.solver_bodies, &self.systems))
            .collect()
    }

    /// Finds the velocities of all nodes of systems, after sweeps.
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
