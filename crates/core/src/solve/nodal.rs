//! Dynamical systems in the contact problem: the velocities of the nodes that contacts act on, and
//! their compliance.

use super::loaded::{LoadedPoints, Points, add_response, vector};
use crate::bodies::{Compliance, block_of};
use crate::geometry::space::{MatrixLike, Space, VectorLike};
use std::sync::Arc;

/// The nodes of a system on which contacts of the step act. This is all that the solver knows of
/// the system, which computes its other velocities from the impulses on these nodes once the
/// problem is solved.
///
/// Copies share the compliance: a step that is solved several times passes copies to the problem.
#[derive(Clone, Debug)]
pub struct NodalSystem<S: Space> {
    /// Ids of the nodes in the system, in increasing order.
    pub nodes: Vec<u32>,
    /// Velocities of the nodes without contacts (m/s).
    pub free: Vec<S::Vector>,
    compliance: ComplianceColumns<S>,
    /// Components of the velocities of all nodes (m/s); for a large system those at the last
    /// [`Self::settle`].
    pub(super) velocity: Vec<f64>,
    /// Points on which contacts act.
    points: Points,
    /// Points that sweeps update, for a large system.
    pub(super) loaded: Option<LoadedPoints<S>>,
}

/// Smallest number of nodes of a large system, in which sweeps update loaded points only. The
/// columns of smaller systems all fit in a cache.
const MIN_LARGE_SYSTEM: usize = 64;

/// Compliance of the nodes, by columns as in [`Compliance`]: each update of a contact reads the
/// responses of all nodes to an impulse on one node consecutively.
#[derive(Clone, Debug)]
enum ComplianceColumns<S: Space> {
    /// Blocks of the step, stored consecutively.
    Own(Arc<Vec<f64>>),
    /// Compliance that the system keeps, with the columns of touched nodes.
    Retained(Arc<Compliance<S>>),
}

impl<S: Space> ComplianceColumns<S> {
    fn column(&self, at: usize, count: usize) -> &[f64] {
        let size = S::D * S::D * count;
        match self {
            Self::Own(all) => &all[at * size..][..size],
            Self::Retained(compliance) => compliance.column(at),
        }
    }
}

impl<S: Space> NodalSystem<S> {
    /// Creates the system from a compliance that it keeps, with the free velocities of all nodes
    /// (m/s). Contacts may act on nodes whose columns are computed.
    pub fn kept(compliance: Arc<Compliance<S>>, free: Vec<S::Vector>) -> Self {
        let nodes = compliance.nodes().to_vec();
        Self::with(nodes, free, ComplianceColumns::Retained(compliance))
    }

    /// Creates the system from nodes in increasing order, with their free velocities (m/s) and
    /// their compliance, row by row (1/kg).
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
        Self::with(nodes, free, ComplianceColumns::Own(Arc::new(columns)))
    }

    fn with(nodes: Vec<u32>, free: Vec<S::Vector>, compliance: ComplianceColumns<S>) -> Self {
        let mut system = Self {
            loaded: (nodes.len() >= MIN_LARGE_SYSTEM).then(LoadedPoints::new),
            points: Points::new(nodes.len()),
            velocity: Vec::with_capacity(S::D * nodes.len()),
            nodes,
            free,
            compliance,
        };
        system.set_free();
        system
    }

    /// Returns the compliance P_a A^-1 P_b^T of two nodes, by their indices in the list (1/kg).
    pub(super) fn block(&self, a: u32, b: u32) -> S::Matrix {
        block_of::<S>(self.column(b as usize), self.nodes.len(), a as usize)
    }

    /// Returns the responses of all nodes to an impulse on one node.
    fn column(&self, at: usize) -> &[f64] {
        let column = self.compliance.column(at, self.nodes.len());
        debug_assert!(!column.is_empty(), "contacts act on touched nodes alone");
        column
    }

    /// Returns the velocities due to impulses on the nodes.
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

    /// Adds a point as a weighted sum of nodes, by their indices in the list; returns its index.
    /// The point of a single node has the index of the node.
    pub(super) fn add_point(&mut self, terms: &[(u32, f64)]) -> u32 {
        self.points.add(terms)
    }

    /// Returns whether sweeps update loaded points only, so that the other velocities are those of
    /// the last [`Self::settle`].
    pub(super) fn is_large(&self) -> bool {
        self.loaded.is_some()
    }

    /// Returns the current velocity of a point (m/s). In a large system it is exact for loaded
    /// points, and for the others after [`Self::settle`].
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

    /// Returns whether sweeps update nodes instead of points, for a large system on which contacts
    /// act at more points than there are nodes.
    pub(super) fn follows_nodes(&self) -> bool {
        self.points.outnumber_nodes()
    }

    /// Adds the effect of an impulse on a point to the velocities.
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

    /// Adds the effect of one of many impulses to the velocities, which are valid after
    /// [`Self::settle`].
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

    /// Computes the velocities of all nodes.
    pub(super) fn settle(&mut self) {
        let (compliance, count) = (&self.compliance, self.nodes.len());
        if let Some(loaded) = &mut self.loaded {
            loaded.settle(&self.points, &mut self.velocity, |b| {
                compliance.column(b, count)
            });
        }
    }

    /// Gives all nodes their free velocities.
    pub(super) fn set_free(&mut self) {
        self.velocity.clear();
        for v in &self.free {
            self.velocity.extend((0..S::D).map(|k| v[k]));
        }
        if let Some(loaded) = &mut self.loaded {
            loaded.adopt(&self.points, &self.velocity);
        }
    }
}
