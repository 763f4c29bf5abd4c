//! The nodes of a large system that carry impulses.
//!
//! An impulse on a node changes the velocities of all nodes of its system, and its column of the compliance would be read from memory in
//! each update of a contact. Between two tests of convergence sweeps update the velocities of loaded nodes alone, by blocks
//! that fit in a cache; those of the others stay as they were at the last test, and are found exactly where a node
//! is loaded for the first time and for all at the next test.

use crate::geometry::space::{Space, VectorLike};
use pulp::Arch;

/// Of a node that is not loaded.
const NONE: u32 = u32::MAX;

/// Nodes for which columns have place beyond those that are loaded when they are found.
const SPARE: usize = 16;

/// Adds what an impulse does to velocities: `rows` has one row for each axis of the impulse (1/kg), `velocities` are those of nodes one after
/// the other (m/s).
pub(super) fn add_response<'a, S: Space>(
    velocities: &mut [f64],
    rows: impl Fn(usize) -> &'a [f64],
    impulse: &S::Vector,
) {
    let ([a, b], [p, q]) = ([rows(0), rows(1)], [impulse[0], impulse[1]]);
    // Compiled for wide registers where the processor has them; products and sums are rounded one by one all the same.
    if S::D == 2 {
        Arch::new().dispatch(|| {
            for ((v, a), b) in velocities.iter_mut().zip(a).zip(b) {
                *v += a * p + b * q;
            }
        });
    } else {
        let (c, r) = (rows(2), impulse[2]);
        Arch::new().dispatch(|| {
            for (((v, a), b), c) in velocities.iter_mut().zip(a).zip(b).zip(c) {
                *v += a * p + b * q + c * r;
            }
        });
    }
}

/// See the module. Nodes are told by their place in the list of the system; `column` gives the compliance of all nodes for an impulse
/// on one, see [`crate::bodies::Compliance`].
#[derive(Clone, Debug)]
pub(super) struct Loaded<S: Space> {
    nodes: Vec<u32>,
    /// The place of each node of the system among the loaded ones.
    index: Vec<u32>,
    /// Velocities of loaded nodes, one after the other (m/s).
    velocity: Vec<f64>,
    /// Compliance between loaded nodes, column by column and in it by axis of the impulse; a column is completed when an impulse needs it.
    blocks: Vec<[Vec<f64>; 3]>,
    /// Impulses since the velocities of all nodes were found (N s).
    since: Vec<S::Vector>,
}

impl<S: Space> Loaded<S> {
    /// No loaded node of a number of nodes.
    pub fn new(count: usize) -> Self {
        Self {
            nodes: Vec::new(),
            index: vec![NONE; count],
            velocity: Vec::new(),
            blocks: Vec::new(),
            since: Vec::new(),
        }
    }

    /// The current velocity of a node, if it is loaded (m/s).
    #[inline]
    pub fn velocity(&self, node: u32) -> Option<S::Vector> {
        match self.index[node as usize] {
            NONE => None,
            k => Some(vector::<S>(&self.velocity, k as usize)),
        }
    }

    /// The place of a node among the loaded ones, which it joins with a velocity (m/s).
    fn place(&mut self, node: u32, velocity: impl FnOnce(&Self) -> S::Vector) -> usize {
        if self.index[node as usize] == NONE {
            let velocity = velocity(self);
            self.index[node as usize] = self.nodes.len() as u32;
            self.nodes.push(node);
            self.velocity.extend((0..S::D).map(|k| velocity[k]));
            self.blocks.push(Default::default());
            self.since.push(S::Vector::zero());
        }
        self.index[node as usize] as usize
    }

    /// Adds an impulse (N s), whose velocities are found by [`Self::settle`].
    pub fn load(&mut self, node: u32, impulse: &S::Vector) {
        let k = self.place(node, |_| S::Vector::zero());
        self.since[k] += *impulse;
    }

    /// Adds an impulse (N s) and what it does to loaded nodes; `all` are the velocities of all nodes at the last test (m/s).
    pub fn push<'a>(
        &mut self,
        node: u32,
        impulse: &S::Vector,
        all: &[f64],
        column: impl Fn(usize) -> &'a [f64],
    ) {
        let (at, row) = (node as usize, all.len());
        let k = self.place(node, |loaded| {
            let mut velocity = vector::<S>(all, at);
            for (b, p) in loaded.nodes.iter().zip(&loaded.since) {
                let of = column(*b as usize);
                for axis in 0..S::D {
                    velocity += vector::<S>(&of[axis * row..], at) * p[axis];
                }
            }
            velocity
        });
        let known = self.blocks[k][0].len() / S::D;
        if known < self.nodes.len() {
            let of = column(at);
            for (axis, block) in self.blocks[k].iter_mut().enumerate().take(S::D) {
                let of = &of[axis * row..][..row];
                // With place for nodes that are loaded later.
                let needed = (self.nodes.len() + SPARE) * S::D;
                block.reserve(needed - block.len());
                for a in &self.nodes[known..] {
                    block.extend_from_slice(&of[*a as usize * S::D..][..S::D]);
                }
            }
        }
        let blocks = &self.blocks[k];
        add_response::<S>(&mut self.velocity, |axis| &blocks[axis], impulse);
        self.since[k] += *impulse;
    }

    /// Finds the velocities of all nodes (m/s) from those at the last test and the impulses since.
    pub fn settle<'a>(&mut self, all: &mut [f64], column: impl Fn(usize) -> &'a [f64]) {
        let row = all.len();
        for (node, impulse) in self.nodes.iter().zip(&self.since) {
            if *impulse != S::Vector::zero() {
                let of = column(*node as usize);
                add_response::<S>(all, |axis| &of[axis * row..][..row], impulse);
            }
        }
        self.adopt(all);
    }

    /// Takes the velocities of all nodes (m/s), with no impulse since.
    pub fn adopt(&mut self, all: &[f64]) {
        self.since.fill(S::Vector::zero());
        for (velocity, node) in self.velocity.chunks_exact_mut(S::D).zip(&self.nodes) {
            velocity.copy_from_slice(&all[*node as usize * S::D..][..S::D]);
        }
    }
}

/// The velocity of the node at a place of a list.
#[inline]
pub(super) fn vector<S: Space>(all: &[f64], at: usize) -> S::Vector {
    S::Vector::from_slice(&all[at * S::D..][..S::D])
}

#[cfg(test)]
mod tests {
    use crate::geometry::space::{Dim3, VectorLike};
    use crate::solve::NodalSystem;
    use nalgebra::{Matrix3, Vector3};

    /// Impulses on nodes of a large system, of which new ones are loaded between two tests and after one: the velocities of loaded nodes
    /// are at all times those of the whole product, and those of all nodes once they are asked for.
    #[test]
    fn loaded_nodes_move_as_with_the_whole_compliance() {
        let count = 90usize;
        let block = |a: usize, b: usize| {
            let far = 1.0 + (a as f64 - b as f64).abs();
            let shear = 0.1 * (a as f64 - b as f64) / far;
            Matrix3::new(2.0, shear, 0.1, -shear, 3.0, 0.2, 0.1, 0.2, 1.0) / far
        };
        let free = |a: usize| Vector3::new((a as f64).sin(), 1.0, -0.5);
        let rows: Vec<_> = (0..count * count)
            .map(|k| block(k / count, k % count))
            .collect();
        let nodes = (0..count as u32).collect();
        let mut system = NodalSystem::<Dim3>::new(nodes, (0..count).map(free).collect(), &rows);
        let mut impulses = vec![Vector3::zeros(); count];
        let expected = |impulses: &[Vector3<f64>], a: usize| {
            let pairs = impulses.iter().enumerate();
            pairs.fold(free(a), |sum, (b, p)| sum + block(a, b) * p)
        };
        let impulse = |k: usize| Vector3::new(1.0, (k as f64).cos(), 0.3 * k as f64);
        for k in 0..5 {
            impulses[7 * k] += impulse(k);
            system.load(7 * k as u32, &impulse(k));
        }
        system.settle();
        for round in 0..3 {
            for k in 0..12 {
                let at = (5 * k + 11 * round) % count;
                impulses[at] += impulse(k);
                system.push(at as u32, &impulse(k));
                let loaded = (0..count).filter(|a| impulses[*a] != Vector3::zero());
                for a in loaded {
                    let off = system.velocity(a as u32) - expected(&impulses, a);
                    assert!(off.norm() < 1e-12, "{round} {k} {a}: {off}");
                }
            }
            let stale = (0..count).filter(|a| impulses[*a] == Vector3::zero());
            let off = |a: usize| (system.velocity(a as u32) - expected(&impulses, a)).norm();
            assert!(stale.clone().map(off).fold(0.0, f64::max) > 0.1);
            system.settle();
            for a in 0..count {
                let off = system.velocity(a as u32) - expected(&impulses, a);
                assert!(off.norm() < 1e-12, "{round} {a}: {off}");
            }
        }
    }
}
